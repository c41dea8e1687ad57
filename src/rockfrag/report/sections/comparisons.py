"""Amplitudes side by side: objects, floors, with and without a pedestal."""

from functools import partial

from rockfrag.pedestal.paired_tests import with_counterparts
from rockfrag.report.figures.amplitudes import (
    amplitudes_by_floor,
    amplitudes_by_object,
    pedestal_scatter,
)
from rockfrag.report.findings import mean_sentence, objects_compared, ratio_of
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.sides import sides_of

_COLUMNS = (
    Column("what", "Of"),
    Column("mean_g", "Geometric mean [g]", 3),
    Column("motions", "Tests each", 0),
    Column("of", "of", 0),
)


def _section(results: Results) -> Section | None:
    tests, means = results.tests, results.table("mean_amplitudes")
    slenderness = {name: results.study.specimens[name].slenderness for name in results.objects}
    found, words = objects_compared(means, slenderness), mean_sentence(means)
    figures = [_by_object(results)]
    if tests["floor"].nunique() > 1:
        figures.append(_by_floor(results))
    if results.study.has_pairs:
        figures.append(_scatter(results))
    if len(tests) < 2:
        return None
    means = means[means["mean_g"].notna()]
    whole = means[means["by"] == "configuration"].assign(what=lambda t: t["configuration"])
    floors = means[means["by"] == "floor"].assign(
        what=lambda t: t["floor"] + t["pedestal"].map({"P": ", with pedestal", "NP": ""})
    )
    tables = [table_html(whole, _COLUMNS, "Means over the same motions.")] if len(whole) > 1 else []
    if floors["floor"].nunique() > 1:
        tables.append(table_html(floors, _COLUMNS, "Means over the same records and objects."))
    return section_of(sentences().comparisons(found, words), "comparisons", [*figures, *tables])


def _by_object(results: Results) -> FigureSpec:
    tests, means = results.tests, results.table("mean_amplitudes")
    words, pairs = mean_sentence(means), results.study.has_pairs
    text = sentences().by_object_figure(len(results.objects), words, pairs)
    return figure_of(text, "amplitudes_by_object", lambda: amplitudes_by_object(tests, means))


def _by_floor(results: Results) -> FigureSpec:
    tests, means = results.tests, results.table("mean_amplitudes")
    text = sentences().by_floor_figure(tests["floor"].nunique())
    return figure_of(text, "amplitudes_by_floor", lambda: amplitudes_by_floor(tests, means))


def _scatter(results: Results) -> FigureSpec:
    about = sides_of(results.study)
    ratio = ratio_of(results.table("pedestal/effects"), about)("whole", "all")
    tests, _ = with_counterparts(results.tests, results.study.counterparts)
    text = sentences().pedestal_scatter_figure(about, ratio)
    draw = partial(pedestal_scatter, tests, ratio, about)
    return figure_of(text, "with_and_without_pedestal", draw)


COMPARISONS = Part(("tests", "mean_amplitudes"), _section)
