"""Counterparts of the thesis's figures 4.1 to 4.7, each question drawn once.

In: the tables ``tests``, ``mean_amplitudes`` and ``pedestal/effects``; amplitudes [g]. Out: a section of the
report.
"""

from collections.abc import Mapping
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.base import figure_style as style
from rockfrag.report import figures as amplitudes
from rockfrag.report.findings import (
    WITH_PEDESTAL,
    mean_sentence,
    objects_compared,
    ratio_of,
)
from rockfrag.report.part import FigureSpec, Results, Section, chapter
from rockfrag.report.sections.amplitudes import comparisons


def counterparts(results: Results) -> Section | None:
    """Counterparts of the figures; without pairs what any study shows there."""
    if not results.study.has_pairs:
        return comparisons(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    ratio = partial(ratio_of, results.table("pedestal/effects"), WITH_PEDESTAL)
    found = objects_compared(means, results.study.slenderness)
    words = mean_sentence(means)
    levels = [
        f"{level}: {ratio(scope, level)}"
        for scope in ("floor", "earthquake")
        for level in dict.fromkeys(tests[scope])
    ]
    whole = ratio("whole", "all")
    draw = partial(slenderness_figure, tests, means, results.study.slenderness)
    scatter = partial(amplitudes.pedestal_scatter, tests, whole)
    by_floor = partial(amplitudes.amplitudes_by, "floor", tests, means)
    parts = [
        FigureSpec(
            name="figure_4_1",
            alt=f"Amplitude against slenderness. {found[0].said if found else words}",
            caption=(
                "Counterpart of figures 4.1, 4.2 and 4.4: overturning amplitude against slenderness, with means."
            ),
            draw=draw,
        ),
        FigureSpec(
            name="figure_4_3",
            alt=f"Amplitude with against without pedestal. All pairs: {whole}; {'; '.join(levels)}.",
            caption=(
                "Counterpart of figures 4.3, 4.5 and 4.7: amplitude with the pedestal against that without; the "
                "grey band is ±10 %."
            ),
            draw=scatter,
        ),
        FigureSpec(
            name="figure_4_6",
            alt=f"Amplitude by floor, without and with the pedestal. {words}",
            caption="Counterpart of figure 4.6: amplitude by floor, without and with the pedestal.",
            draw=by_floor,
        ),
    ]
    title = "Counterparts of the thesis’s figures"
    reading = (
        f"{words} The thesis draws the same amplitudes again for each floor, tower and earthquake; here each "
        "comparison is drawn once. The accelerations of its figure 3.4 are in the chapter Motions."
    )
    if not found:
        return Section("counterparts", title, words, [reading], parts)
    return chapter("counterparts", title, found[0], [reading], parts)


def slenderness_figure(
    tests: pd.DataFrame, means: pd.DataFrame, slenderness: Mapping[str, float]
) -> Figure:
    """Amplitude against slenderness, a panel without and one with the pedestal."""
    rows = amplitudes.drawn_tests(tests)
    rows = rows.assign(x=rows["object"].map(slenderness))
    known = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    earthquakes = list(dict.fromkeys(tests["earthquake"]))
    are_many = len(tests) > amplitudes.MOST_MARKS
    with style.panels(style.COLUMN_WIDTH, 3.0, 1, 2, sharex=True, sharey=True) as (
        figure,
        grid,
    ):
        for axes, side in zip(grid, amplitudes.SIDES, strict=True):
            part = rows[rows["pedestal"] == side]
            if are_many:
                levels = sorted(part["x"].unique())
                amplitudes.box_at(axes, part, "x", levels, width=0.3, colour=style.BLUE)
            # by earthquake with a little sideways shift
            shifts = np.linspace(-0.14, 0.14, max(len(earthquakes), 2))
            styles = {} if are_many else amplitudes.styles_of(earthquakes)
            for shift, (name, style_of) in zip(shifts, styles.items(), strict=False):
                marked = part[part["earthquake"] == name]
                x = marked["x"].to_numpy(dtype=float) + shift
                marker, colour = style_of
                amplitudes.plot_tests(axes, x, marked, marker, colour)
            own = known[known["pedestal"] == side]
            x = own["object"].map(slenderness).to_numpy(dtype=float)
            axes.plot(
                x, own["mean_g"], color=style.BLACK, lw=1.0, marker="_", ms=10, mew=1.8
            )
            axes.set_title(amplitudes.SIDE_NAME[side], loc="left")
            axes.set_ylim(
                0,
                amplitudes.highest_box(rows, "x") if are_many else amplitudes.top(rows),
            )
            axes.set_xticks(sorted(rows["x"].unique()))
        figure.supxlabel("Slenderness H/B", fontsize=8)
        style.letter_panels(grid)
        figure.supylabel(amplitudes.AMPLITUDE, fontsize=8)
        handles = [Line2D([], [], color=style.BLUE, label=amplitudes.BOX)]
        if not are_many:
            handles = amplitudes.handles_of(earthquakes) + amplitudes.bound_handle(
                tests
            )
        handles.append(
            Line2D([], [], color=style.BLACK, marker="_", ms=10, label="geometric mean")
        )
        figure.legend(
            handles=handles, loc="outside upper center", ncols=3, handletextpad=0.3
        )
    return figure
