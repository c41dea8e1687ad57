"""Counterparts of the thesis's figures 3.4 and 4.1 to 4.7."""

from rockfrag.report.figures.amplitudes import (
    amplitudes_by_floor,
    amplitudes_by_object,
    pedestal_scatter,
    slenderness_figure,
)
from rockfrag.report.findings import mean_sentence, ratio_of
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.sections.comparisons import COMPARISONS
from rockfrag.report.wording import shortened


def _section(results: Results) -> Section | None:
    if not results.study.has_pairs:
        return COMPARISONS.section(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    slenderness = {name: block.slenderness for name, block in results.study.specimens.items()}
    ratio = ratio_of(results.table("pedestal/effects"))
    words = mean_sentence(means)

    def panel(scope: str, level: str) -> str:
        name = "" if level == "all" else f"{shortened(level)}\n"
        return name + ratio(scope, level)

    drawn = (
        (
            "figure_4_1",
            "overturning amplitude against slenderness, with means",
            words,
            lambda: slenderness_figure(tests, means, slenderness),
        ),
        (
            "figure_4_2",
            "the same for each floor",
            "A column of panels for each floor; no means are drawn.",
            lambda: slenderness_figure(tests, means, slenderness, by_floor=True),
        ),
        (
            "figure_4_3",
            "amplitude with the pedestal against that without",
            f"All pairs: {ratio('whole', 'all')}.",
            lambda: pedestal_scatter(tests, title=lambda level: panel("whole", level)),
        ),
        (
            "figure_4_4",
            "amplitude by object, without and with the pedestal",
            words,
            lambda: amplitudes_by_object(tests, means),
        ),
        (
            "figure_4_5",
            "figure 4.3 for each floor",
            _levels(results, "floor"),
            lambda: pedestal_scatter(tests, "floor", lambda level: panel("floor", level)),
        ),
        (
            "figure_4_6a",
            "amplitude by floor, without and with the pedestal",
            words,
            lambda: amplitudes_by_floor(tests, means),
        ),
        (
            "figure_4_6b",
            "the same for each object",
            words,
            lambda: amplitudes_by_floor(tests, means, panels=results.objects),
        ),
        (
            "figure_4_7",
            "figure 4.3 for each earthquake",
            _levels(results, "event"),
            lambda: pedestal_scatter(tests, "event", lambda level: panel("event", level)),
        ),
    )
    specs = []
    for name, what, alt, draw in drawn:
        number = name.removeprefix("figure_").replace("_", ".")
        caption = f"Counterpart of figure {number}: {what}."
        specs.append(FigureSpec(name, f"{caption} {alt}", caption, draw))
    return Section(
        "counterparts",
        "Counterparts of the thesis’s figures",
        [
            "Simulated counterparts of the thesis’s figures 4.1 to 4.7; that of figure 3.4 shows the "
            f"accelerations, under Motions. {words}"
        ],
        specs,
    )


def _levels(results: Results, scope: str) -> str:
    """Ratios P/NP of each level of a scope, in words."""
    ratio = ratio_of(results.table("pedestal/effects"))
    levels = dict.fromkeys(results.tests[scope])
    return "; ".join(f"{level}: {ratio(scope, level)}" for level in levels) + "."


COUNTERPARTS = Part(("tests", "mean_amplitudes"), _section)
