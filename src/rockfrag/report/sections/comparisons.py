"""Amplitudes side by side: objects, floors, with and without a pedestal."""

from rockfrag.pedestal.paired_tests import with_counterparts
from rockfrag.report.figures.amplitudes import (
    amplitudes_by_floor,
    amplitudes_by_object,
    pedestal_scatter,
)
from rockfrag.report.findings import mean_sentence, objects_compared, ratio_of
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened
from rockfrag.report.sides import sides_of
from rockfrag.report.wording import counted

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
    return Section(
        "comparisons",
        "Objects, floors and pedestals compared",
        f"{found[0].headline}." if found else words,
        [*opened(found[0]), words] if found else [],
        [*figures, *tables],
    )


def _by_object(results: Results) -> FigureSpec:
    tests, means = results.tests, results.table("mean_amplitudes")
    alt = f"Overturning amplitudes of {counted(len(results.objects), 'object')}. {mean_sentence(means)}"
    caption = (
        "Overturning amplitude of every test by object; thin lines join the tests of one motion with "
        "and without pedestal."
        if results.study.has_pairs
        else "Overturning amplitude of every test by object."
    )
    return FigureSpec(
        "amplitudes_by_object", alt, caption, lambda: amplitudes_by_object(tests, means)
    )


def _by_floor(results: Results) -> FigureSpec:
    tests, means = results.tests, results.table("mean_amplitudes")
    alt = f"Overturning amplitudes on {counted(tests['floor'].nunique(), 'floor')}."
    caption = "Overturning amplitude of every test by floor."
    return FigureSpec(
        "amplitudes_by_floor", alt, caption, lambda: amplitudes_by_floor(tests, means)
    )


def _scatter(results: Results) -> FigureSpec:
    about = sides_of(results.study)
    ratio = ratio_of(results.table("pedestal/effects"), about)
    pair = f"Amplitude {about.first} against that {about.second}"
    alt = f"{pair}. {ratio('whole', 'all')}."
    caption = f"{pair}; the grey band is ±10 %, arrows are bounds."
    tests, _ = with_counterparts(results.tests, results.study.counterparts)
    return FigureSpec(
        "with_and_without_pedestal",
        alt,
        caption,
        lambda: pedestal_scatter(tests, ratio("whole", "all"), about),
    )


COMPARISONS = Part(("tests", "mean_amplitudes"), _section)
