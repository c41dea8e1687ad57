"""What rockfrag finds under the entry point ``rockfrag.study``: keys, rules and parts of the report."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

from rockfrag.config.plugins import Plugin
from rockfrag_thesis.settings import read_settings, settings_of

if TYPE_CHECKING:
    from rockfrag.config.plugins import FirstPage, Parts
    from rockfrag.study.study import Study

FOLDER = Path(__file__).parent


def report(
    study: "Study", parts: "Parts", answer: "FirstPage"
) -> "tuple[Parts, FirstPage]":
    """Return the parts of a study's report with those of the thesis, and what makes its first page."""
    from rockfrag_thesis.parts import with_thesis
    from rockfrag_thesis.sections.first_page import thesis_answer

    compares = settings_of(study).compares
    return with_thesis(parts, compares), thesis_answer if compares else answer


PLUGIN = Plugin(
    schema=json.loads((FOLDER / "schema.json").read_text(encoding="utf-8")),
    settings=read_settings,
    rules=FOLDER / "rules.smk",
    report=report,
)
