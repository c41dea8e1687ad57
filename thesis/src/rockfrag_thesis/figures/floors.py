"""What the building's assumptions do to the thesis's hypotheses on floors: order and margins."""

from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.figure_style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    ORANGE,
    WIDEST,
    figure_style,
    new_figure,
)
from rockfrag_thesis.figures.building import AXIS_NAMES
from rockfrag_thesis.floor_order import HYPOTHESES, TIE

FLOOR_STYLES = {
    "GF": ("ground floor", BLUE, "o"),
    "F3": ("3rd floor", ORANGE, "s"),
    "F5": ("5th floor", GREEN, "^"),
}

MEANINGFUL = 0.02
"""Margins below this mean nothing: the amplitudes of an IDA curve are 1 or 2 % apart."""


def floor_order(means: pd.DataFrame, margins: pd.DataFrame, definition: str) -> Figure:
    """Draw the mean overturning amplitude of lone objects on each floor against the first period.

    Shaded are the periods at which the order is the thesis's, ground highest and 3rd lowest. For ``margins`` see
    :func:`rockfrag_thesis.floor_order.margins_table`.
    """
    means = means[(means["axis"] == "first_period_s") & (means["by"] == "floor")]
    margins = margins[(margins["axis"] == "first_period_s") & (margins["hypothesis"] == "order")]
    order = margins[margins["definition"] == definition].sort_values("value")
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 2.9)
        axes = figure.subplots()
        _draw_order(axes, means[means["pedestal"] == "NP"])
        _shade(axes, order["value"].to_numpy(), order["margin"].to_numpy())
        axes.set_xlabel("First period [s]")
        axes.set_ylabel("Mean overturning amplitude,\nlone objects [g]")
        handles, labels = axes.get_legend_handles_labels()
        handles += [Patch(color="#bbbbbb"), Patch(color="#e8e8e8")]
        labels += ["the thesis's order", f"by less than {100 * MEANINGFUL:.0f} %"]
        figure.legend(handles, labels, loc="outside upper center", ncols=2)
        return figure


def _draw_order(axes: Axes, tests: pd.DataFrame) -> None:
    means = tests.pivot_table(index="value", columns="floor", values="mean_g", dropna=False)
    for floor, (name, colour, marker) in FLOOR_STYLES.items():
        axes.plot(means.index, means[floor], color=colour, marker=marker, ms=3, label=name)
    axes.set_ylim(bottom=0)


def _shade(axes: Axes, periods: np.ndarray, margins: np.ndarray) -> None:
    """Shade the surroundings of each period where the order holds, half-way to its neighbours."""
    if periods.size == 0:
        return
    middles = (periods[1:] + periods[:-1]) / 2
    edges = np.concatenate([periods[:1], middles, periods[-1:]])
    for left, right, margin in zip(edges[:-1], edges[1:], margins, strict=True):
        if margin > TIE:
            colour = "#bbbbbb" if margin > MEANINGFUL else "#e8e8e8"
            axes.axvspan(left, right, color=colour, lw=0, zorder=0)


def floor_hypotheses(margins: pd.DataFrame, axis: str, definition: str) -> Figure:
    """Draw by how much each hypothesis about floors holds along an assumption such as ``first_period_s``."""
    chosen = margins[(margins["axis"] == axis) & (margins["definition"] == definition)]
    chosen = chosen[chosen["hypothesis"].isin(list(HYPOTHESES))]
    chosen = chosen.sort_values("value", kind="stable")
    labels = list(dict.fromkeys(chosen["label"]))
    values = [f"{value:g}" for value in dict.fromkeys(chosen["value"])]
    table = chosen.pivot_table(index="hypothesis", columns="label", values="margin")
    table = table.reindex(index=list(HYPOTHESES), columns=labels)
    with figure_style():
        figure = new_figure(WIDEST, 4.6)
        axes = figure.subplots()
        largest = 100 * max(0.1, float(np.nanmax(np.abs(table.to_numpy()), initial=0.0)))
        image = axes.imshow(
            100 * table.to_numpy(),
            norm=SymLogNorm(linthresh=1, vmin=-largest, vmax=largest),
            cmap="PuOr",
            aspect="auto",
        )
        _mark(axes, table)
        axes.set_xticks(
            range(len(labels)), values if len(set(values)) == len(labels) else labels, rotation=90
        )
        axes.set_xlabel(AXIS_NAMES[axis])
        names = [fill(f"{number}  {text}", 48) for number, text in HYPOTHESES.items()]
        axes.set_yticks(range(len(names)), names, fontsize=7)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        bar = figure.colorbar(image, ax=axes, pad=0.01, ticks=[-50, -10, -1, 0, 1, 10, 50])
        bar.ax.set_yticklabels(["-50", "-10", "-1", "0", "1", "10", "50"])
        bar.set_label("Margin [%], positive: holds")
        return figure


def _mark(axes: Axes, table: pd.DataFrame) -> None:
    """Put a dot where a hypothesis holds by enough to mean something."""
    rows, columns = np.nonzero(table.to_numpy() > MEANINGFUL)
    axes.plot(columns, rows, "o", color="black", ms=2)
