"""Overturning amplitudes: of every test, and which amplitudes overturn."""

from functools import partial

import pandas as pd

from rockfrag.files import file_name
from rockfrag.report.figures.ida import MOST_ROWS, outcome_map
from rockfrag.report.findings import amplitudes_found, resurrections_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.wording import amplitude


def _section(results: Results) -> Section:
    resurrections = resurrections_found(results.table("resurrections"), results.table("tests"))
    tests = results.tests
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    columns = [
        *(Column("earthquake", "Earthquake"), Column("floor", "Floor"), Column("motion", "Motion")),
        *(Column(name, f"{name} [g]", numeric=True) for name in tests["configuration"].unique()),
    ]
    caption = "Overturning amplitude of every test (step protocol)."
    table = table_html(_wide(tests), columns, caption, "tests.csv")
    text = sentences().amplitudes(amplitudes_found(results.tests), resurrections)
    return section_of(text, "amplitudes", [table, *_maps(results)])


def _wide(tests: pd.DataFrame) -> pd.DataFrame:
    """A row per motion and a column per configuration, amplitudes and bounds as text."""
    texts = tests.assign(text=[amplitude(test) for test in tests.to_dict("records")])
    keys = ["earthquake", "floor", "motion"]
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for row in texts.to_dict("records"):
        key = tuple(row[name] for name in keys)
        about = rows.setdefault(key, dict(zip(keys, key, strict=True)))
        about[row["configuration"]] = row["text"]
    return pd.DataFrame(list(rows.values())).fillna("–")


def _maps(results: Results) -> list[FigureSpec]:
    outcomes, resurrections = results.outcomes, results.table("resurrections")
    specs = []
    for name in results.objects:
        own = outcomes[outcomes["object"] == name]
        configurations = list(dict.fromkeys(own["configuration"]))
        ida_curves = resurrections[resurrections["configuration"].isin(configurations)]
        fallen, motions = ida_curves["first_upper"].count(), ida_curves["motion"].nunique()
        text = sentences().outcomes_figure(name, fallen, len(ida_curves), motions, MOST_ROWS)
        draw = partial(outcome_map, own, configurations)
        specs.append(figure_of(text, f"outcomes_{file_name(name)}", draw))
    return specs


AMPLITUDES = Part(("tests", "resurrections"), _section)
