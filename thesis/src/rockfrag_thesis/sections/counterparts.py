"""Counterparts of the thesis's figures 4.1 to 4.7, each question drawn once."""

from rockfrag.report.figures.amplitudes import (
    amplitudes_by_floor,
    pedestal_scatter,
    slenderness_figure,
)
from rockfrag.report.findings import mean_sentence, objects_compared, ratio_of
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened
from rockfrag.report.sections.comparisons import COMPARISONS


def _section(results: Results) -> Section | None:
    if not results.study.has_pairs:
        return COMPARISONS.section(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    slenderness = {name: block.slenderness for name, block in results.study.specimens.items()}
    ratio = ratio_of(results.table("pedestal/effects"))
    found = objects_compared(means, slenderness)
    words = mean_sentence(means)
    levels = "; ".join(
        f"{level}: {ratio(scope, level)}"
        for scope in ("floor", "earthquake")
        for level in dict.fromkeys(tests[scope])
    )
    return Section(
        "counterparts",
        "Counterparts of the thesis’s figures",
        f"{found[0].headline}." if found else words,
        [
            *(opened(found[0]) if found else []),
            f"{words} The thesis draws the same amplitudes again for each floor, tower and earthquake; here each "
            "comparison is drawn once. The accelerations of its figure 3.4 are in the chapter Motions.",
        ],
        [
            FigureSpec(
                "figure_4_1",
                f"Amplitude against slenderness. {found[0].said if found else words}",
                "Counterpart of figures 4.1, 4.2 and 4.4: overturning amplitude against slenderness, with means.",
                lambda: slenderness_figure(tests, means, slenderness),
            ),
            FigureSpec(
                "figure_4_3",
                f"Amplitude with against without pedestal. All pairs: {ratio('whole', 'all')}; {levels}.",
                "Counterpart of figures 4.3, 4.5 and 4.7: amplitude with the pedestal against that without; the "
                "grey band is ±10 %.",
                lambda: pedestal_scatter(tests, title=ratio("whole", "all")),
            ),
            FigureSpec(
                "figure_4_6",
                f"Amplitude by floor, without and with the pedestal. {words}",
                "Counterpart of figure 4.6: amplitude by floor, without and with the pedestal.",
                lambda: amplitudes_by_floor(tests, means),
            ),
        ],
    )


COUNTERPARTS = Part(("tests", "mean_amplitudes"), _section)
