"""Counterparts of the thesis's figures 4.1 to 4.7, each question drawn once."""

from functools import partial

from rockfrag.report.figures.amplitudes import (
    amplitudes_by_floor,
    pedestal_scatter,
    slenderness_figure,
)
from rockfrag.report.findings import mean_sentence, objects_compared, ratio_of
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.comparisons import COMPARISONS
from rockfrag_thesis.sections.words import sentences


def _section(results: Results) -> Section | None:
    if not results.study.has_pairs:
        return COMPARISONS.section(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    slenderness = {name: block.slenderness for name, block in results.study.specimens.items()}
    ratio = ratio_of(results.table("pedestal/effects"))
    found = objects_compared(means, slenderness)
    words = mean_sentence(means)
    levels = [
        f"{level}: {ratio(scope, level)}"
        for scope in ("floor", "earthquake")
        for level in dict.fromkeys(tests[scope])
    ]
    whole = ratio("whole", "all")
    figures = {
        "figure_4_1": (
            sentences().slenderness_figure(found[0].said if found else words),
            partial(slenderness_figure, tests, means, slenderness),
        ),
        "figure_4_3": (
            sentences().scatter_figure(whole, levels),
            partial(pedestal_scatter, tests, whole),
        ),
        "figure_4_6": (
            sentences().floors_figure(words),
            partial(amplitudes_by_floor, tests, means),
        ),
    }
    parts = [figure_of(text, name, draw) for name, (text, draw) in figures.items()]
    return section_of(sentences().counterparts(found, words), "counterparts", parts)


COUNTERPARTS = Part(("tests", "mean_amplitudes"), _section)
