"""How strong the shaking must be: every test of each configuration, and the median with its limits."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import BLACK, BLUE, COLUMN_WIDTH, ORANGE, one_panel, plain_log
from rockfrag.report.figures.amplitudes import GREY, SIDE_NAME, drawn_tests
from rockfrag.report.wording import shortened

MOST_ROWS = 24
"""More configurations than this are not legible; the first are drawn."""

_COLOUR = {"NP": ORANGE, "P": BLUE}
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
            axes.plot(
                x[known], np.full(known.sum(), y + 0.12), "|", color=_COLOUR[side], ms=7, mew=1.0
            )
            for bound, marker in _BOUNDS.items():
                own = rows[bound].to_numpy(dtype=bool)
                axes.plot(
                    x[own],
                    np.full(own.sum(), y + 0.12),
                    marker=marker,
                    ls="",
                    color=_COLOUR[side],
                    ms=5,
                )
            _median(figure, curves[curves["configuration"] == name], y - 0.2)
        axes.set_ylim(len(shown) - 0.4, -0.6)
        axes.set_yticks(range(len(shown)), [shortened(name, 20) for name in shown])
        axes.tick_params(axis="y", length=0)
        axes.set_xscale("log")
        low, high = axes.get_xlim()
        axes.set_xlim(min(low, 0.8 * high), high)
        plain_log(axes, "x")
        axes.set_xlabel("Overturning amplitude [g]")
        sides = list(dict.fromkeys(tests["pedestal"]))
        handles = [
            Line2D(
                [],
                [],
                ls="",
                marker="|",
                color=_COLOUR[side],
                ms=8,
                label=f"tests {SIDE_NAME[side]}",
            )
            for side in sides
            if len(sides) > 1
        ]
        if len(curves):
            handles.append(
                Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label="median, interval")
            )
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
