"""Which amplitudes overturn and which are survived: the windows behind every single figure."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.report.figures.style import BLUE, COLUMN_WIDTH, ORANGE, figure_style, new_figure

MOST_ROWS = 24
"""More motions than this are not legible; the first are drawn."""


def verdict_map(sweep: pd.DataFrame, object_name: str) -> Figure:
    """Draw for one object, per motion, the amplitudes that overturn it.

    Parameters
    ----------
    sweep
        Sweeps of all configurations, see :func:`rockfrag.stages.sweep.sweep`.
    object
        The object; its sweeps with (P) and without (NP) the pedestal share a row of the figure.
    """
    rows = sweep[sweep["object"] == object_name]
    motions = list(dict.fromkeys(rows["motion"]))[:MOST_ROWS]
    sides = [side for side in ("NP", "P") if (rows["pedestal"] == side).any()]
    colours = {"NP": ORANGE, "P": BLUE}
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.9 + 0.22 * len(motions))
        axes = figure.subplots()
        height = 0.8 / len(sides)
        for i, motion in enumerate(motions):
            for j, side in enumerate(sides):
                one = rows[(rows["motion"] == motion) & (rows["pedestal"] == side)]
                bottom = len(motions) - 1 - i + 0.4 - (j + 1) * height
                axes.broken_barh(
                    _overturning_ranges(one),
                    (bottom, height),
                    facecolor=colours[side],
                    linewidth=0,
                )
        axes.set_xscale("log")
        lowest = rows.loc[rows["overturned"], "amplitude_g"].min()
        axes.set_xlim(0.9 * lowest, rows["amplitude_g"].max())
        ticks = [t for t in (0.1, 0.2, 0.3, 0.5, 1, 2, 3, 5) if 0.9 * lowest <= t]
        ticks = [t for t in ticks if t <= rows["amplitude_g"].max()]
        axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
        axes.minorticks_off()
        axes.set_yticks(range(len(motions)), [name.replace("_", " ") for name in motions[::-1]])
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("Peak of the motion [g]")
        names = {"NP": "overturns, alone", "P": "overturns, on the pedestal"}
        figure.legend(
            handles=[Patch(color=colours[side], label=names[side]) for side in sides],
            loc="outside upper center",
            ncols=2,
            title=object_name,
        )
        return figure


def _overturning_ranges(one: pd.DataFrame) -> list[tuple[float, float]]:
    """Ranges (start, width) [g] of consecutive amplitudes that overturn, for ``broken_barh``."""
    ordered = one.sort_values("amplitude_g")
    amplitude = ordered["amplitude_g"].to_numpy()
    # each amplitude stands for the range up to the next one
    edges = np.append(amplitude, amplitude[-1] * amplitude[-1] / amplitude[-2])
    fallen = np.concatenate([[False], ordered["overturned"].to_numpy(), [False]])
    starts = np.flatnonzero(~fallen[:-1] & fallen[1:])
    ends = np.flatnonzero(fallen[:-1] & ~fallen[1:])
    return [
        (float(edges[s]), float(edges[e] - edges[s])) for s, e in zip(starts, ends, strict=True)
    ]
