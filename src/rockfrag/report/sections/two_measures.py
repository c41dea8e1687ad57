"""Fragility in two intensity measures: contours, coefficients, and whether the fit describes the tests."""

from functools import partial

import pandas as pd

from rockfrag.files import file_name
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.vector import INTERACTION_LEVEL
from rockfrag.fragility.vector_tables import VectorTables, describe_pair
from rockfrag.report.figures.two_measures import two_measures_figure
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences

_COLUMNS = (
    Column("configuration", "Object"),
    Column("pair", "Measures"),
    Column("c0", "b₀", 2),
    Column("c1", "b₁", 2),
    Column("c2", "b₂", 2),
    Column("c12", "b₁₂", 2),
    Column("aic", "AIC", 1),
    Column("p_interaction", "p of no interaction", 3),
    Column("p_fit", "p of the fit", 3),
)


def _section(results: Results) -> Section | None:
    tables = VectorTables(
        *(results.table(f"fragility_{name}") for name in ("two_measures", "contours", "cells"))
    )
    return two_measures_section(tables, results.study.fragility.confidence)


def two_measures_section(tables: VectorTables, confidence: float) -> Section | None:
    """Return the section of fits in two measures; None where no tests allowed one."""
    fits = tables.fits
    found = fits[fits["method"] != "none"]
    if found.empty:
        return None
    pairs = [describe_pair(a, b) for a, b in zip(found["first"], found["second"], strict=True)]
    text = sentences().two_measures(
        ", ".join(dict.fromkeys(pairs)),
        len(found),
        int((found["p_fit"] < REJECTED).sum()),
        INTERACTION_LEVEL,
        f"{100 * confidence:g} %",
        list(dict.fromkeys(fits["warnings"])),
    )
    shown, caption = found.assign(pair=pairs), "Fits in two measures."
    table = table_html(shown, _COLUMNS, caption, "fragility_two_measures")
    return section_of(text, "two-measures", [*_figures(tables, found), table])


def _figures(tables: VectorTables, found: pd.DataFrame) -> list[FigureSpec]:
    contours, cells = tables.contours, tables.cells
    keys = ["configuration", "first", "second"]
    specs = []
    for row in found[keys].to_dict("records"):
        own, tests = (t[(t[keys] == pd.Series(row)).all(axis=1)] for t in (contours, cells))
        pair = describe_pair(str(row["first"]), str(row["second"]))
        caption = (
            f"{row['configuration']}: probability of overturning in {pair}. Lines are fitted, the band holds the "
            "median; squares show the fraction of tests that overturned by cell, rising in both measures."
        )
        specs.append(
            FigureSpec(
                file_name(f"two_measures_{'_'.join(map(str, row.values()))}"),
                caption,
                caption,
                partial(two_measures_figure, own, tests),
            )
        )
    return specs


TWO_MEASURES = Part(
    ("fragility_two_measures", "fragility_contours", "fragility_cells"),
    _section,
    lambda study: bool(study.fragility.pairs),
)
