"""Counterparts of the thesis's figures 4.1 to 4.7, each question drawn once."""

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
from rockfrag.report.part import Results, Section
from rockfrag.report.sections.amplitudes import comparisons
from rockfrag_thesis.sections import says


def counterparts(results: Results) -> Section | None:
    """Counterparts of the figures; without pairs what any study shows there."""
    if not results.study.has_pairs:
        return comparisons(results)
    tests, means = results.tests, results.table("mean_amplitudes")
    ratio = partial(ratio_of, results.table("pedestal/effects"), WITH_PEDESTAL)
    found, words = (
        objects_compared(means, results.study.slenderness),
        mean_sentence(means),
    )
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
        says.figure(
            "figure_4_1", draw, found[0].said if found else words, of="slenderness"
        ),
        says.figure("figure_4_3", scatter, whole, levels, of="scatter"),
        says.figure("figure_4_6", by_floor, words, of="floors"),
    ]
    return says.section("counterparts", parts, found, words)


def slenderness_figure(
    tests: pd.DataFrame, means: pd.DataFrame, slenderness: Mapping[str, float]
) -> Figure:
    """Amplitude against slenderness, a panel without and one with the pedestal."""
    rows = amplitudes.drawn_tests(tests)
    rows = rows.assign(x=rows["object"].map(slenderness))
    known = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    earthquakes = list(dict.fromkeys(tests["earthquake"]))
    crowded = len(tests) > amplitudes.MOST_MARKS
    with style.panels(style.COLUMN_WIDTH, 3.0, 1, 2, sharex=True, sharey=True) as (
        figure,
        grid,
    ):
        for axes, side in zip(grid, amplitudes.SIDES, strict=True):
            part = rows[rows["pedestal"] == side]
            if crowded:
                amplitudes.box_at(
                    axes, part, "x", sorted(part["x"].unique()), 0.3, style.BLUE
                )
            # by earthquake with a little sideways shift
            shifts = np.linspace(-0.14, 0.14, max(len(earthquakes), 2))
            styles = {} if crowded else amplitudes.styles_of(earthquakes)
            for shift, (name, marks) in zip(shifts, styles.items(), strict=False):
                marked = part[part["earthquake"] == name]
                amplitudes.plot_tests(
                    axes, marked["x"].to_numpy(dtype=float) + shift, marked, *marks
                )
            own = known[known["pedestal"] == side]
            x = own["object"].map(slenderness).to_numpy(dtype=float)
            axes.plot(
                x, own["mean_g"], color=style.BLACK, lw=1.0, marker="_", ms=10, mew=1.8
            )
            axes.set_title(amplitudes.SIDE_NAME[side], loc="left")
            axes.set_ylim(
                0,
                amplitudes.highest_box(rows, "x") if crowded else amplitudes.top(rows),
            )
            axes.set_xticks(sorted(rows["x"].unique()))
        figure.supxlabel("Slenderness H/B", fontsize=8)
        style.letter_panels(grid)
        figure.supylabel(amplitudes.AMPLITUDE, fontsize=8)
        handles = [Line2D([], [], color=style.BLUE, label=amplitudes.BOX)]
        if not crowded:
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
