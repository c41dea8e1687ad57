"""Fragility in two intensity measures: contours with limits over what the tests say without a fit."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, one_panel, plain_log
from rockfrag.fragility.observations import name_and_unit

LINES = {0.1: "dotted", 0.5: "solid", 0.9: "dashed"}
"""How contours of probabilities are drawn."""

MEDIAN = 0.5


def two_measures_figure(contours: pd.DataFrame, cells: pd.DataFrame) -> Figure:
    """Draw contours of the fitted probability of overturning over cells of tests.

    The first measure is across, the second one up; the band holds the median's limits.
    """
    first, second = str(cells["first"].iloc[0]), str(cells["second"].iloc[0])
    x, y = cells["at_first"].to_numpy(), cells["at_second"].to_numpy()
    with one_panel(COLUMN_WIDTH, 3.2) as (figure, axes):
        shown = axes.scatter(
            x,
            y,
            c=cells["probability"],
            s=6 + 30 * np.sqrt(cells["tests"] / cells["tests"].max()),
            cmap="Greys",
            vmin=0,
            vmax=1,
            marker="s",
            edgecolors="#999999",
            linewidths=0.3,
        )
        reach, rise = (0.8 * x.min(), 1.25 * x.max()), (0.9 * y.min(), 1.1 * y.max())
        across = bool((contours["of"] == first).all())
        within = reach if across else rise
        fill = axes.fill_betweenx if across else axes.fill_between
        for probability, line in LINES.items():
            part = contours[np.isclose(contours["probability"], probability)]
            at, value = part["at"], part["value"].where(part["value"].between(*within))
            drawn = (value, at) if across else (at, value)
            axes.plot(*drawn, color=BLUE, linestyle=line, label=f"{100 * probability:.0f} %")
            if probability == MEDIAN:
                lower, upper = (part[side].clip(*within) for side in ("lower", "upper"))
                fill(at, lower, upper, color=BLUE, alpha=0.2, linewidth=0)
        axes.set(xlim=reach, ylim=rise, xlabel=_axis(first), ylabel=_axis(second))
        plain_log(axes, "xy")
        percent = PercentFormatter(1.0, decimals=0, symbol=" %")
        bar = figure.colorbar(shown, ax=axes, format=percent, pad=0.02)
        bar.set_label("Observed, rising in both measures")
        title = "Fitted probability of overturning"
        figure.legend(loc="outside upper center", ncols=3, title=title)
    return figure


def _axis(column: str) -> str:
    name, unit = name_and_unit(column)
    return f"{name} [{unit}]" if unit else name
