"""Overturning amplitudes of tests: by object, by floor, and with a pedestal against without.

A test that never overturned is an open marker with an arrow up, at the largest amplitude it survived;
one that overturned at the first step has an arrow down. Neither is in a mean: means come from
:func:`rockfrag.shaketable.definitions.mean_amplitudes`, over motions that overturned all.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.path import Path

from rockfrag.base import figure_style as style
from rockfrag.base.arrays import Floats
from rockfrag.base.figure_style import BAND, GREY
from rockfrag.report.findings import WITH_PEDESTAL, Sides
from rockfrag.words.sentences import shortened

SIDES = ("NP", "P")
SIDE_COLOUR = {"NP": style.ORANGE, "P": style.BLUE}
SIDE_MARKER = {"NP": "o", "P": "s"}
SIDE_NAME = {"NP": "without pedestal", "P": "with pedestal"}
SIDE_SHIFT = {"NP": -0.13, "P": 0.13}
MARKERS = ("o", "s", "^", "D", "v", "P")
AMPLITUDE = "Overturning amplitude [g]"
# of more tests than this a figure shows the distribution, not every one
MOST_MARKS = 150
BOX = "median, 25–75 %, 5–95 %"  # what a box of that distribution shows

_ARROW = np.array([(0, 0), (0, 1.6), (-0.4, 1.0), (0, 1.6), (0.4, 1.0)])
_STROKES = [Path.MOVETO, Path.LINETO, Path.MOVETO, Path.LINETO, Path.LINETO]
_UP = Path(_ARROW, _STROKES)
_DOWN = Path(_ARROW * np.array([1, -1]), _STROKES)
_RIGHT = Path(_ARROW[:, ::-1], _STROKES)


def drawn_tests(tests: pd.DataFrame) -> pd.DataFrame:
    """Tests with what is drawn of each: an amplitude, or only a bound of it.

    Parameters
    ----------
    tests : a row a test

    Returns
    -------
    The tests with the columns ``a`` [g], ``up``, whether that is a lower bound as the test never overturned, and
    ``down``, whether it is an upper bound.
    """
    known = tests["amplitude_g"].notna()
    up = ~known & tests["upper_g"].isna()
    down = ~known & ~up
    a = tests["amplitude_g"].where(known, tests["lower_g"].where(up, tests["upper_g"]))
    return tests.assign(a=a, up=up, down=down)


def plot_tests(
    axes: Axes, x: Floats, rows: pd.DataFrame, marker: str, colour: str
) -> None:
    """Draw tests at ``x``, with arrows where only a bound is known.

    Parameters
    ----------
    axes, x : where to draw, shape (n,)
    rows : n tests of :func:`drawn_tests`
    marker, colour : of the tests
    """
    y = rows["a"].to_numpy(dtype=float)
    axes.plot(x, y, ls="", marker=marker, mfc="none", mec=colour, ms=4, mew=0.9)
    for bound, arrow in (("up", _UP), ("down", _DOWN)):
        if rows[bound].any():
            _plot_arrows(axes, x, y, bound=rows[bound], arrow=arrow, colour=colour)


def _plot_arrows(
    axes: Axes, x: Floats, y: Floats, *, bound: pd.Series, arrow: Path, colour: str
) -> None:
    """Draw an arrow at each point (x, y) whose ``bound`` is open."""
    chosen = bound.to_numpy(dtype=bool)
    axes.plot(
        x[chosen],
        y[chosen],
        ls="",
        marker=arrow,
        mfc="none",
        mec=colour,
        ms=11,
        mew=0.9,
    )


def bound_handle(tests: pd.DataFrame) -> list[Line2D]:
    """Entry of a legend for tests that never overturned, if there are any.

    Parameters
    ----------
    tests : a row a test

    Returns
    -------
    One entry or none.
    """
    if not tests["amplitude_g"].isna().any():
        return []
    return [
        Line2D(
            [], [], ls="", marker=_UP, color=GREY, mfc="none", ms=9, label="bound only"
        )
    ]


def top(rows: pd.DataFrame) -> float:
    """Upper end of an axis of amplitudes, with room for arrows [g].

    Parameters
    ----------
    rows : tests of :func:`drawn_tests`

    Returns
    -------
    The end [g].
    """
    return 1.15 * float(rows["a"].max())


def amplitudes_by(by: str, tests: pd.DataFrame, means: pd.DataFrame) -> Figure:
    """Amplitudes by ``object`` or ``floor``, with and without a pedestal, of one definition, with their means.

    Parameters
    ----------
    by, tests, means : the column, a row a test, and their means [g]

    Returns
    -------
    The figure.
    """
    means = means[means["by"] == ("configuration" if by == "object" else by)]
    levels, rows = list(dict.fromkeys(tests[by])), drawn_tests(tests)
    width = (
        style.PAGE_WIDTH if by == "object" and len(levels) > 5 else style.COLUMN_WIDTH
    )
    with style.panels(width, 2.8) as (figure, axes):
        _sides_panel(axes, rows, by, levels, means)
        axes.set_ylim(0, highest_box(rows, by) if len(rows) > MOST_MARKS else top(rows))
        _finish_sides(figure, axes, tests, bool(means["mean_g"].notna().any()))
    return figure


def _join_pairs(axes: Axes, rows: pd.DataFrame) -> None:
    """Join the tests of one object under one motion, with and without pedestal; ``x`` is their place."""
    keys = ["object", "motion"]
    without = rows[rows["pedestal"] == "NP"].drop_duplicates(keys)
    pairs = rows[rows["pedestal"] == "P"].merge(
        without, on=keys, suffixes=("_p", "_np")
    )
    ends = pairs[["x_np", "a_np", "x_p", "a_p"]].to_numpy(dtype=float)
    axes.add_collection(
        LineCollection(
            list(ends.reshape(-1, 2, 2)), colors="#cccccc", linewidths=0.5, zorder=1
        )
    )


def _sides_panel(
    axes: Axes, rows: pd.DataFrame, by: str, levels: Sequence[str], means: pd.DataFrame
) -> None:
    """Tests of both sides beside each other, those of one pair joined, and the means of each side.

    Parameters
    ----------
    axes : to draw on
    rows : a row a test, with ``pedestal`` P or NP
    by, levels : column that parts the tests, and its values in the order of the axis
    means : geometric means by that column and ``pedestal``
    """
    place = {level: float(number) for number, level in enumerate(levels)}
    both = set(rows["pedestal"]) == set(SIDES)
    shift = SIDE_SHIFT if both else dict.fromkeys(SIDES, 0.0)
    x = rows[by].map(place) + rows["pedestal"].map(shift)
    are_many = len(rows) > MOST_MARKS
    if both and not are_many:
        _join_pairs(axes, rows.assign(x=x))
    for side in SIDES:
        own = rows["pedestal"] == side
        if are_many and own.any():
            part = rows[own].assign(x=x[own])
            levels_x = sorted(part["x"].unique())
            box_at(axes, part, "x", levels_x, width=0.18, colour=SIDE_COLOUR[side])
        elif own.any():
            where = x[own].to_numpy(dtype=float)
            plot_tests(axes, where, rows[own], SIDE_MARKER[side], SIDE_COLOUR[side])
        known = means[(means["pedestal"] == side) & means["mean_g"].notna()]
        where = known[by].map(place).to_numpy(dtype=float) + shift[side]
        axes.plot(where, known["mean_g"], "_", ms=15, mew=2.4, mec=SIDE_COLOUR[side])
    axes.set_xticks(range(len(levels)), [shortened(level, 14) for level in levels])
    if len(levels) > 4:
        axes.tick_params(axis="x", rotation=40)
    axes.set_xlim(-0.5, len(levels) - 0.5)


def _finish_sides(figure: Figure, axes: Axes, tests: pd.DataFrame, means: bool) -> None:
    """Label the axis, and explain sides, means (if there are any) and marks of the ``tests`` in the legend."""
    axes.set_ylabel(AMPLITUDE)
    sides = [side for side in SIDES if (tests["pedestal"] == side).any()]
    handles = []
    for side in sides if len(sides) > 1 else []:
        marker, colour, name = SIDE_MARKER[side], SIDE_COLOUR[side], SIDE_NAME[side]
        handles.append(
            Line2D([], [], ls="", color=colour, mfc="none", marker=marker, label=name)
        )
    if means:
        words = "geometric mean"
        handles.append(
            Line2D([], [], ls="", marker="_", ms=12, mew=2.4, color=GREY, label=words)
        )
    if len(tests) > MOST_MARKS:
        handles.append(Line2D([], [], color=GREY, label=BOX))
    else:
        handles += bound_handle(tests)
    if handles:
        figure.legend(handles=handles, loc="outside upper center", ncols=2)


def pedestal_scatter(
    tests: pd.DataFrame, title: str, sides: Sides = WITH_PEDESTAL
) -> Figure:
    """Amplitude of an arrangement against that of its counterpart under the same motion.

    Parameters
    ----------
    tests, title : pairs of tests, and what stands above the panel
    sides : the comparison

    Returns
    -------
    The figure.
    """
    rows = drawn_tests(tests)
    keys = ["object", "earthquake", "floor", "motion"]
    without = rows[rows["pedestal"] == "NP"]
    pairs = rows[rows["pedestal"] == "P"].merge(
        without, on=keys, suffixes=("_p", "_np")
    )
    objects = list(dict.fromkeys(pairs["object"]))
    upper = 1.08 * float(pairs[["a_p", "a_np"]].to_numpy(dtype=float).max())
    with style.panels(style.COLUMN_WIDTH, 0.6 + style.COLUMN_WIDTH) as (figure, axes):
        line = np.array([0.0, upper])
        # the line of equality with its band of ±10 %
        axes.fill_between(line, line / 1.1, line * 1.1, color=BAND, lw=0)
        axes.plot(line, line, color=GREY, lw=0.8)
        for name, (marker, colour) in styles_of(objects).items():
            own = pairs[pairs["object"] == name]
            x, y = own["a_np"].to_numpy(dtype=float), own["a_p"].to_numpy(dtype=float)
            axes.plot(
                x, y, ls="", marker=marker, mfc="none", mec=colour, mew=1.0, ms=4.5
            )
            for bound, arrow in (("up_p", _UP), ("up_np", _RIGHT)):
                _plot_arrows(axes, x, y, bound=own[bound], arrow=arrow, colour=colour)
        axes.set(xlim=(0, upper), ylim=(0, upper), aspect="equal")
        axes.locator_params(nbins=5)
        # above the panel, where it hides no test
        axes.set_title(title, loc="left", pad=4)
        axes.set_xlabel(f"Overturning amplitude {sides.second} [g]")
        axes.set_ylabel(f"Overturning amplitude {sides.first} [g]")
        if len(objects) > 1 and (handles := handles_of(objects)):
            axes.legend(handles=handles, loc="lower right", handletextpad=0.2)
    return figure


def handles_of(names: Sequence[str]) -> list[Line2D]:
    """Entries of a legend for names that differ in marker and colour.

    Parameters
    ----------
    names : in order

    Returns
    -------
    The entries; none of more names than there are markers.
    """
    return [
        Line2D(
            [], [], ls="", marker=marker, mfc="none", mec=colour, label=shortened(name)
        )
        for name, (marker, colour) in styles_of(names).items()
        if len(names) <= len(MARKERS)
    ]


def styles_of(names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Marker and colour of each name; of many all are alike.

    Parameters
    ----------
    names : in order

    Returns
    -------
    Marker and colour by name.
    """
    if len(names) > len(MARKERS):
        return dict.fromkeys(names, ("o", style.BLUE))
    return dict(zip(names, zip(MARKERS, style.OKABE_ITO, strict=False), strict=False))


def highest_box(rows: pd.DataFrame, by: str) -> float:
    """Upper end of an axis of distributions [g].

    Parameters
    ----------
    rows, by : tests of :func:`drawn_tests`, and the column of the levels

    Returns
    -------
    The end [g].
    """
    return 1.15 * float(rows.groupby([by, "pedestal"])["a"].quantile(0.95).max())


def box_at(
    axes: Axes,
    part: pd.DataFrame,
    by: str,
    levels: Sequence[Any],
    *,
    width: float,
    colour: str,
) -> None:
    """Draw the distribution of amplitudes at each level of a column.

    Parameters
    ----------
    axes, part : where to draw, and tests of :func:`drawn_tests`
    by, levels : column of the levels, and their order
    width, colour : of the boxes
    """
    values = [
        part.loc[part[by] == level, "a"].to_numpy(dtype=float) for level in levels
    ]
    drawn: dict[str, Any] = {
        f"{name}props": {"color": colour} for name in ("box", "whisker", "cap")
    }
    drawn |= {"medianprops": {"color": colour, "linewidth": 1.6}, "whis": (5, 95)}
    drawn |= {"showfliers": False, "manage_ticks": False}
    axes.boxplot(values, positions=levels, widths=width, **drawn)
