"""Which amplitudes overturn and which are survived: the windows behind every single figure."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rockfrag.figure_style import CONFIGURATION_COLOURS, WIDEST, one_panel
from rockfrag.report.wording import label, shortened

MOST_ROWS = 24
"""More motions than this are not legible; the first are drawn."""

_TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)


def outcome_map(ida: pd.DataFrame, configurations: Sequence[str]) -> Figure:
    """Draw the amplitudes that overturn one object per motion, its configurations in one row of the figure."""
    rows = ida[ida["configuration"].isin(list(configurations))]
    motions = list(dict.fromkeys(rows["motion"]))[:MOST_ROWS]
    height = 0.8 / len(configurations)
    bars: dict[str, list[NDArray[np.float64]]] = {name: [] for name in configurations}
    line = {motion: len(motions) - 1 - i for i, motion in enumerate(motions)}
    for (motion, name), group in rows.groupby(["motion", "configuration"], sort=False):
        if motion in line:
            bottom = line[motion] + 0.4 - (list(configurations).index(str(name)) + 1) * height
            bars[str(name)] += _bars(group, bottom, height)
    low, high = rows["amplitude_g"].min(), rows["amplitude_g"].max()
    with one_panel(WIDEST, 0.9 + 0.22 * len(motions)) as (figure, axes):
        handles = []
        for name, colour in zip(configurations, CONFIGURATION_COLOURS, strict=False):
            axes.add_collection(PolyCollection(bars[name], facecolor=colour, linewidth=0))
            handles.append(Patch(color=colour, label=f"{shortened(name)} overturns"))
        axes.set_xscale("log")
        axes.set_xlim(0.98 * low, 1.02 * high)
        ticks = [tick for tick in _TICKS if low <= tick <= high] or [float(f"{low:.2g}")]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_ylim(-0.6, len(motions) - 0.4)
        axes.set_yticks(range(len(motions)), [label(name) for name in motions[::-1]])
        axes.tick_params(axis="y", length=0, labelsize=7)
        axes.set_xlabel("Peak acceleration of the motion [g]")
        figure.legend(handles=handles, loc="outside upper center", ncols=2)
        return figure


def _bars(table: pd.DataFrame, bottom: float, height: float) -> list[NDArray[np.float64]]:
    """Corners of a bar over each range of consecutive amplitudes that overturn."""
    ordered = table.sort_values("amplitude_g")
    amplitude = ordered["amplitude_g"].to_numpy(dtype=float)
    # each amplitude stands for the range up to the next one
    ratio = amplitude[-1] / amplitude[-2] if amplitude.size > 1 else 1.05
    edges = np.append(amplitude, amplitude[-1] * ratio)
    fallen = np.concatenate([[False], ordered["overturned"].to_numpy(), [False]])
    starts = edges[np.flatnonzero(~fallen[:-1] & fallen[1:])]
    ends = edges[np.flatnonzero(fallen[:-1] & ~fallen[1:])]
    return [
        np.array([(a, bottom), (b, bottom), (b, bottom + height), (a, bottom + height)])
        for a, b in zip(starts, ends, strict=True)
    ]
