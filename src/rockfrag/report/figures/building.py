"""What the building's assumptions do to the floors: order of the floors and margins of statements."""

from collections.abc import Sequence
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.report.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    ORANGE,
    PAGE_WIDTH,
    RED,
    figure_style,
    new_figure,
)
from rockfrag.thesis.floor_order import STATEMENTS, TIE

FLOOR_STYLES = {
    "GF": ("ground floor", BLUE, "o"),
    "F3": ("3rd floor", ORANGE, "s"),
    "F5": ("5th floor", GREEN, "^"),
}

AXIS_NAMES = {
    "first_period_s": "First period of the elastic building [s]",
    "damping_ratio": "Damping, fraction of critical",
    "base_shear": "Shear strength of the masonry over the weight",
    "ground_scale": "Factor on the records that the masonry building feels",
    "levels": "Levels called 3rd and 5th floor",
}

MEANINGFUL = 0.02
"""Margins below this mean nothing: the amplitudes of a sweep are 1 or 2 % apart."""

READING_NAMES = {
    "step_protocol": "step protocol",
    "first_overturning": "first overturning",
    "always_overturning": "always overturning",
}


def floor_order(tests: pd.DataFrame, margins: pd.DataFrame, readings: Sequence[str]) -> Figure:
    """Draw the mean overturning amplitude of lone objects on each floor against the first period.

    Parameters
    ----------
    tests, margins
        As :func:`rockfrag.shaketable.sensitivity.building_sensitivity` returns them.
    readings
        Readings to be drawn, a panel each.

    Returns
    -------
    Figure; shaded are the periods at which the order is the thesis's, ground highest and 3rd lowest.
    """
    tests = tests[(tests["axis"] == "first_period_s") & (tests["pedestal"] == "NP")]
    margins = margins[(margins["axis"] == "first_period_s") & (margins["statement"] == "order")]
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 2.6)
        panels = figure.subplots(1, len(readings), sharex=True, squeeze=False)[0]
        for axes, reading in zip(panels, readings, strict=True):
            _draw_order(axes, tests[tests["reading"] == reading])
            order = margins[margins["reading"] == reading].sort_values("value")
            _shade(axes, order["value"].to_numpy(), order["margin"].to_numpy())
            axes.set_title(READING_NAMES[reading])
            axes.set_xlabel("First period [s]")
        panels[0].set_ylabel("Mean overturning amplitude,\nlone objects [g]")
        handles, labels = panels[0].get_legend_handles_labels()
        handles += [Patch(color="#bbbbbb"), Patch(color="#e8e8e8")]
        labels += ["the thesis's order", f"by less than {MEANINGFUL:.0%}"]
        figure.legend(handles, labels, loc="outside upper center", ncols=5)
        return figure


def _draw_order(axes: Axes, tests: pd.DataFrame) -> None:
    known = tests.assign(amplitude=tests["amplitude_g"].fillna(tests["lower_g"]))
    means = known.pivot_table(index="value", columns="floor", values="amplitude", aggfunc="mean")
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


def floor_statements(margins: pd.DataFrame, axis: str, reading: str) -> Figure:
    """Draw by how much each statement about floors holds along one assumption.

    Parameters
    ----------
    margins
        As :func:`rockfrag.shaketable.sensitivity.building_sensitivity` returns them.
    axis
        Assumption along which to draw, such as ``first_period_s``.
    reading
        Reading of the sweeps.
    """
    chosen = margins[(margins["axis"] == axis) & (margins["reading"] == reading)]
    chosen = chosen[chosen["statement"].isin(list(STATEMENTS))]
    chosen = chosen.sort_values("value", kind="stable")
    labels = list(dict.fromkeys(chosen["label"]))
    values = [f"{value:g}" for value in dict.fromkeys(chosen["value"])]
    table = chosen.pivot_table(index="statement", columns="label", values="margin")
    table = table.loc[list(STATEMENTS), labels]
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 3.8)
        axes = figure.subplots()
        largest = 100 * max(0.1, float(np.abs(table.to_numpy()).max()))
        image = axes.imshow(
            100 * table.to_numpy(),
            norm=SymLogNorm(linthresh=1, vmin=-largest, vmax=largest),
            cmap="PuOr",
            aspect="auto",
        )
        _mark(axes, table)
        axes.set_xticks(range(len(labels)), labels if axis == "levels" else values, rotation=90)
        axes.set_xlabel(AXIS_NAMES[axis])
        names = [fill(f"{number}  {text}", 48) for number, text in STATEMENTS.items()]
        axes.set_yticks(range(len(names)), names, fontsize=7)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        bar = figure.colorbar(image, ax=axes, pad=0.01, ticks=[-50, -10, -1, 0, 1, 10, 50])
        bar.ax.set_yticklabels(["-50", "-10", "-1", "0", "1", "10", "50"])
        bar.set_label("Margin [%], positive: holds")
        return figure


def _mark(axes: Axes, table: pd.DataFrame) -> None:
    """Put a dot where a statement holds by enough to mean something."""
    rows, columns = np.nonzero(table.to_numpy() > MEANINGFUL)
    axes.plot(columns, rows, "o", color="black", ms=2)


def shaker_limits(table: pd.DataFrame, overturning: pd.DataFrame) -> Figure:
    """Draw the amplitude at which each motion leaves the shaker's limits beside what objects need.

    Parameters
    ----------
    table
        As :func:`rockfrag.shaketable.shaker.shaker_table` returns it.
    overturning
        Tests of lone objects and one reading: ``object``, ``motion``, ``upper_g``.
    """
    motions = list(table["motion"])[::-1]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.9 + 0.22 * len(motions))
        axes = figure.subplots()
        limits = table.set_index("motion")["limit_g"]
        axes.barh(
            range(len(motions)),
            limits[motions],
            color="#dddddd",
            height=0.8,
            label="within the shaker's limits",
        )
        markers = dict(zip(sorted(set(overturning["object"])), "os^Dv", strict=False))
        colours = dict(zip(markers, (BLUE, ORANGE, GREEN, RED, "black"), strict=False))
        for object_name, marker in markers.items():
            one = overturning[overturning["object"] == object_name].set_index("motion")["upper_g"]
            places = [i for i, motion in enumerate(motions) if motion in one.index]
            axes.plot(
                one[[motions[i] for i in places]],
                places,
                marker,
                color=colours[object_name],
                label=f"{object_name} overturns",
            )
        axes.set_yticks(range(len(motions)), [name.replace("_", " ") for name in motions])
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("Peak of the motion [g]")
        figure.legend(loc="outside upper center", ncols=2)
        return figure
