"""The effect of the pedestal in the simulations beside the direction that the thesis reports."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, ORANGE, figure_style, new_figure
from rockfrag.report.figures.amplitudes import BAND, GREY
from rockfrag.report.figures.effects import NONE, ratio_axis
from rockfrag.report.wording import counted
from rockfrag_thesis.hypotheses.floors import FIFTH, GROUND, THIRD

REPORTED_SIDE = {GROUND: 1, THIRD: -1, FIFTH: -1}
"""Whether the thesis reports a ratio above (1) or below one (-1) on a floor (sections 4.3 and 4.4)."""


def has_thesis_floors(effects: pd.DataFrame) -> bool:
    """Whether effects have a floor of which the thesis reports a direction."""
    return bool(set(effects.loc[effects["scope"] == "floor", "level"]) & set(REPORTED_SIDE))


def ratios_figure(effects: pd.DataFrame) -> Figure:
    """Draw the ratio with over without pedestal, of all pairs and on each floor, of effects of one definition."""
    whole, floors = effects[effects["scope"] == "whole"], effects[effects["scope"] == "floor"]
    rows = [("all pairs", row) for row in whole.to_dict("records")]
    rows += [(str(row["level"]), row) for row in floors.to_dict("records")]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 1.0 + 0.33 * len(rows))
        axes = figure.subplots()
        axes.axvspan(*NONE, color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        drawn = [1 / 1.25, 1.25]
        for y, (name, row) in enumerate(rows):
            limits = [row["lower"], row["upper"]]
            if np.isfinite(limits).all() and limits[0] < limits[1]:
                axes.plot(limits, [y, y], color=BLUE, lw=1.4)
                drawn += limits
            axes.plot(row["ratio"], y, "o", mec=BLUE, mfc="white", ms=5)
            drawn.append(row["ratio"])
            if side := REPORTED_SIDE.get(name):
                axes.annotate(
                    "",
                    xy=(1.2**side, y),
                    xytext=(1.115**side, y),
                    arrowprops={"arrowstyle": "-|>", "color": ORANGE, "lw": 1.8},
                )
        axes.set_yticks(
            range(len(rows)),
            [f"{name} ({counted(int(row['pairs']), 'pair')})" for name, row in rows],
        )
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.tick_params(axis="y", length=0)
        ratio_axis(axes, drawn)
        handles = [Line2D([], [], color=BLUE, marker="o", mfc="white", label="simulated")]
        if has_thesis_floors(effects):
            handles.append(
                Line2D([], [], color=ORANGE, lw=1.8, marker=">", label="direction in the thesis")
            )
        figure.legend(handles=handles, loc="outside upper center", ncols=2, handlelength=1.6)
        return figure
