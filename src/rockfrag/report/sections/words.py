"""What the parts of a report say; it stands in ``sections.j2``."""

from functools import cache
from typing import Any

from rockfrag.report.wording import macros


@cache
def sentences() -> Any:
    """The macros of ``sections.j2``: a part by its anchor, a figure by its name and ``_figure``."""
    return macros("rockfrag.report.sections", "sections.j2", {})
