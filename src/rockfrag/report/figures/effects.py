"""Ratios of overturning amplitudes with and without a pedestal, with their intervals."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, one_panel
from rockfrag.report.figures.amplitudes import BAND, GREY
from rockfrag.report.sides import WITH_PEDESTAL, Sides
from rockfrag.report.wording import counted, shortened

NONE = (1 / 1.1, 1.1)
"""Ratios between which an effect counts as none."""

_TICKS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.5, 2, 3, 5, 10)
_MOST_TICKS = 7
_LEAST_APART = 0.11
"""Ticks nearer than this part of the axis would print over each other."""


def forest_figure(effects: pd.DataFrame, sides: Sides = WITH_PEDESTAL) -> Figure:
    """Ratio of amplitudes of every scope with its 95 % interval, and the ±10 % that counts as none."""
    scope = effects["scope"].to_numpy()
    # room for one empty line between the scopes
    place = np.arange(len(effects)) + 0.7 * np.cumsum(np.r_[False, scope[1:] != scope[:-1]])
    names = ["level", "units", "unit"]
    labels = [_label(*row) for row in effects[names].itertuples(index=False, name=None)]
    columns = ["lower", "ratio", "upper", "p_holm"]
    figures = effects[columns].to_numpy(dtype=float)
    with one_panel(COLUMN_WIDTH + 1.1, 0.9 + 0.19 * float(place[-1] + 1)) as (figure, axes):
        axes.axvspan(*NONE, color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        for y, (lower, ratio, upper, p) in zip(place, figures, strict=True):
            if np.isfinite([lower, upper]).all():
                axes.plot([lower, upper], [y, y], color=BLUE, lw=1.2)
            axes.plot(ratio, y, "o", mec=BLUE, mfc=BLUE if p < 0.05 else "white", ms=5)
        axes.set_yticks(place, labels)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        ratio_axis(axes, figures[:, :3].ravel(), sides)
        handles = [
            Line2D([], [], color=BLUE, marker="o", mfc=BLUE, label="differs from 1 (Holm, 5 %)"),
            Line2D([], [], color=BLUE, marker="o", mfc="white", label="does not"),
            Line2D([], [], color=BAND, lw=6, label="±10 %"),
        ]
        figure.legend(handles=handles, loc="outside upper center", ncols=3, handlelength=1.4)
    return figure


def _label(level: str, units: int, unit: str) -> str:
    name = "all pairs" if level == "all" else shortened(level.replace("/", ", "), 30)
    return f"{name} ({counted(int(units), 'earthquake' if unit == 'earthquake' else unit)})"


def _too_near(ticks: Sequence[float], low: float, high: float) -> bool:
    places = np.log(ticks) / np.log(high / low)
    return bool(len(ticks) > 1 and np.diff(places).min() < _LEAST_APART)


def ratio_axis(
    axes: Axes, values: NDArray[np.float64] | Sequence[float], sides: Sides = WITH_PEDESTAL
) -> None:
    """A logarithmic axis of ratios with plain ticks that covers all values and the band of none."""
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known) & (known > 0)]
    # one interval without a useful limit may not press all others together
    low = max(0.2, min(0.97 * known.min(initial=1.0), NONE[0] / 1.03))
    high = min(5.0, max(1.03 * known.max(initial=1.0), NONE[1] * 1.03))
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    ticks = [tick for tick in _TICKS if low <= tick <= high]
    for crowded in ((0.9, 1.1), (0.7, 1.2), (0.8, 1.5), (0.3, 3)):
        if len(ticks) > _MOST_TICKS or _too_near(ticks, low, high):
            ticks = [tick for tick in ticks if tick not in crowded]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlabel(sides.axis)
