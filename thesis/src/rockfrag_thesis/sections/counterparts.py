"""Counterparts of the thesis's figures 4.1 to 4.7, each question drawn once."""

from functools import partial

from rockfrag.report.figures import amplitudes
from rockfrag.report.findings import mean_sentence, objects_compared, ratio_of
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.amplitudes import COMPARISONS
from rockfrag_thesis.sections import says


def _section(results: Results) -> Section | None:
    if not results.study.has_pairs:
        return COMPARISONS.section(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    ratio = ratio_of(results.table("pedestal/effects"))
    found, words = objects_compared(means, results.slenderness), mean_sentence(means)
    levels = [
        f"{level}: {ratio(scope, level)}"
        for scope in ("floor", "earthquake")
        for level in dict.fromkeys(tests[scope])
    ]
    whole = ratio("whole", "all")
    slenderness = says.slenderness_figure(found[0].said if found else words)
    draw = partial(amplitudes.slenderness_figure, tests, means, results.slenderness)
    scatter = partial(amplitudes.pedestal_scatter, tests, whole)
    by_floor = partial(amplitudes.amplitudes_by, "floor", tests, means)
    parts = [
        figure_of(slenderness, "figure_4_1", draw),
        figure_of(says.scatter_figure(whole, levels), "figure_4_3", scatter),
        figure_of(says.floors_figure(words), "figure_4_6", by_floor),
    ]
    return section_of(says.counterparts(found, words), "counterparts", parts)


COUNTERPARTS = Part(_section)
