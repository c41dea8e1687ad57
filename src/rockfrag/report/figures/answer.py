"""How strong the shaking must be: every test of each configuration, and the median with its limits."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import BLACK, COLUMN_WIDTH, one_panel, plain_log
from rockfrag.report.figures.amplitudes import GREY, SIDE_COLOUR, SIDE_NAME, drawn_tests
from rockfrag.report.wording import shortened

MOST_ROWS = 24
"""More configurations than this are not legible; the first are drawn."""

_BOUNDS = {"up": 5, "down": 4}  # carets to the right and to the left


def strength_figure(tests: pd.DataFrame, curves: pd.DataFrame, names: Sequence[str]) -> Figure:
    """Draw a row for each configuration: its tests, and its curves with medians of PGA [g], if any."""
    shown = list(names)[:MOST_ROWS]
    with one_panel(COLUMN_WIDTH, 0.8 + 0.33 * len(shown)) as (figure, axes):
        for y, name in enumerate(shown):
            rows = drawn_tests(tests[tests["configuration"] == name])
            side = str(rows["pedestal"].iloc[0])
            x = rows["a"].to_numpy(dtype=float)
            known = ~(rows["up"] | rows["down"]).to_numpy(dtype=bool)
            place, colour = np.full(len(x), y + 0.12), SIDE_COLOUR[side]
            axes.plot(x[known], place[known], "|", color=colour, ms=7, mew=1.0)
            for bound, marker in _BOUNDS.items():
                own = rows[bound].to_numpy(dtype=bool)
                axes.plot(x[own], place[own], marker=marker, ls="", color=colour, ms=5)
            _median(figure, curves[curves["configuration"] == name], y - 0.2)
        axes.set_ylim(len(shown) - 0.4, -0.6)
        axes.set_yticks(range(len(shown)), [shortened(name, 20) for name in shown])
        axes.tick_params(axis="y", length=0)
        axes.set(xscale="log", xlabel="Overturning amplitude [g]")
        low, high = axes.get_xlim()
        axes.set_xlim(min(low, 0.8 * high), high)
        plain_log(axes, "x")
        sides = list(dict.fromkeys(tests["pedestal"]))
        handles = []
        for side in sides if len(sides) > 1 else []:
            words, colour = f"tests {SIDE_NAME[side]}", SIDE_COLOUR[side]
            handles.append(Line2D([], [], ls="", marker="|", color=colour, ms=8, label=words))
        if len(curves):
            median = Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4)
            median.set_label("median, interval")
            handles.append(median)
        if tests["amplitude_g"].isna().any():
            handles.append(Line2D([], [], ls="", marker=5, color=GREY, label="bound only"))
        if handles:
            figure.legend(handles=handles, loc="outside upper center", ncols=2, handlelength=1.4)
        return figure


def _median(figure: Figure, curve: pd.DataFrame, y: float) -> None:
    """Mark a median and its interval, where there are any."""
    axes = figure.axes[0]
    for row in curve.to_dict("records"):
        limits = [row["theta_lower"], row["theta_upper"]]
        if np.isfinite(limits).all() and limits[0] < limits[1]:
            axes.plot(limits, [y, y], color=BLACK, lw=1.2)
        axes.plot(row["theta"], y, "D", mec=BLACK, mfc="white", ms=4)
