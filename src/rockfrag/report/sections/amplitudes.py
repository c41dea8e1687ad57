"""Overturning amplitudes: as recorded, of every test, and side by side by object, floor and pedestal."""

from functools import partial
from typing import Any

import pandas as pd

from rockfrag.files import file_name
from rockfrag.pedestal.paired_tests import with_counterparts
from rockfrag.report import findings
from rockfrag.report.figures import amplitudes as figures
from rockfrag.report.figures import as_recorded, ida
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import says
from rockfrag.report.sides import sides_of
from rockfrag.report.wording import amplitude

_MOTION = (Column("earthquake", "Earthquake"), Column("floor", "Floor"), Column("motion", "Motion"))
_MEANS = (
    Column("what", "Of"),
    Column("mean_g", "Geometric mean [g]", 3),
    Column("motions", "Tests each", 0),
    Column("of", "of", 0),
)


def _wide(table: pd.DataFrame, texts: list[str], about: tuple[str, ...]) -> pd.DataFrame:
    """A row per motion, with what is known about it and a column of texts per configuration."""
    rows: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row, text in zip(table.to_dict("records"), texts, strict=True):
        known = {key: row[key] for key in about}
        rows.setdefault(tuple(known.values()), known)[row["configuration"]] = text
    return pd.DataFrame(list(rows.values())).fillna("–")


def _as_recorded(results: Results) -> Section:
    recorded = results.table("as_recorded")
    names = recorded["configuration"].unique()
    columns = [*_MOTION, Column("pga_g", "Peak [g]", 3), *(Column(name, name) for name in names)]
    found = findings.recorded_found(recorded)
    motions = recorded["motion"].nunique()
    text = says.as_recorded_figure(found, motions, as_recorded.MOST_ROWS)
    figure = figure_of(text, "as_recorded", lambda: as_recorded.recorded_map(recorded))
    texts = [_outcome(row) for row in recorded.to_dict("records")]
    shown = _wide(recorded, texts, ("earthquake", "floor", "motion", "pga_g"))
    caption = "Outcome under each motion as recorded."
    table = table_html(shown, columns, caption, "as_recorded.csv")
    return section_of(says.as_recorded(found), "as_recorded", [figure, table])


def _outcome(row: dict[Any, Any]) -> str:
    if row["overturned"]:
        words = "overturns"
    elif row["rocked"]:
        words = "rocks"
    else:
        words = "slides" if row.get("peak_slip_m", 0.0) > 0 else "stays"
    return f"{words} (sensitive)" if 0 < row["fraction_near"] < 1 else words


def _amplitudes(results: Results) -> Section:
    resurrections = findings.resurrections_found(
        results.table("resurrections"), results.table("tests")
    )
    tests = results.tests
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    names = tests["configuration"].unique()
    columns = [*_MOTION, *(Column(name, f"{name} [g]", numeric=True) for name in names)]
    texts = [amplitude(test) for test in tests.to_dict("records")]
    shown = _wide(tests, texts, ("earthquake", "floor", "motion"))
    caption = "Overturning amplitude of every test (step protocol)."
    table = table_html(shown, columns, caption, "tests.csv")
    text = says.amplitudes(findings.amplitudes_found(results.tests), resurrections)
    return section_of(text, "amplitudes", [table, *_maps(results)])


def _maps(results: Results) -> list[FigureSpec]:
    outcomes, resurrections = results.outcomes, results.table("resurrections")
    specs = []
    for name in results.objects:
        own = outcomes[outcomes["object"] == name]
        configurations = list(dict.fromkeys(own["configuration"]))
        curves = resurrections[resurrections["configuration"].isin(configurations)]
        fallen, motions = curves["first_upper"].count(), curves["motion"].nunique()
        text = says.outcomes_figure(name, fallen, len(curves), motions, ida.MOST_ROWS)
        draw = partial(ida.outcome_map, own, configurations)
        specs.append(figure_of(text, f"outcomes_{file_name(name)}", draw))
    return specs


def _comparisons(results: Results) -> Section | None:
    study, tests, means = results.study, results.tests, results.table("mean_amplitudes")
    if len(tests) < 2:
        return None
    found, words = (
        findings.objects_compared(means, results.slenderness),
        findings.mean_sentence(means),
    )
    known = means[means["mean_g"].notna()]
    whole = known[known["by"] == "configuration"].assign(what=lambda t: t["configuration"])
    floors = known[known["by"] == "floor"].assign(
        what=lambda t: t["floor"] + t["pedestal"].map({"P": ", with pedestal", "NP": ""})
    )
    text = says.by_object_figure(len(results.objects), words, study.has_pairs)
    draw = partial(figures.amplitudes_by_object, tests, means)
    parts: list[Any] = [figure_of(text, "amplitudes_by_object", draw)]
    of_floors = tests["floor"].nunique()
    if of_floors > 1:
        text = says.by_floor_figure(of_floors)
        draw = partial(figures.amplitudes_by_floor, tests, means)
        parts.append(figure_of(text, "amplitudes_by_floor", draw))
    if study.has_pairs:
        parts.append(_scatter(results))
    if len(whole) > 1:
        parts.append(table_html(whole, _MEANS, "Means over the same motions."))
    if len(set(floors["floor"])) > 1:
        parts.append(table_html(floors, _MEANS, "Means over the same records and objects."))
    return section_of(says.comparisons(found, words), "comparisons", parts)


def _scatter(results: Results) -> FigureSpec:
    about = sides_of(results.study)
    ratio = findings.ratio_of(results.table("pedestal/effects"), about)("whole", "all")
    tests, _ = with_counterparts(results.tests, results.study.counterparts)
    draw = partial(figures.pedestal_scatter, tests, ratio, about)
    return figure_of(says.pedestal_scatter_figure(about, ratio), "with_and_without_pedestal", draw)


AS_RECORDED = Part(_as_recorded)
AMPLITUDES = Part(_amplitudes)
COMPARISONS = Part(_comparisons)
