"""Figure of one response of a body in space: the path of its axis, and its base in the plan.

In: outcome and history of one analysis, and the outline of the base [m]. Out: a matplotlib figure. What is drawn
are the coordinates of ``docs/space.md``, "Coordinates".

The history is the table of :class:`rockfrag.engines.spatial.SpatialResponse`: its columns ``axis_x``, ``axis_y``
and ``tilt_rad`` say how the axis leans, ``base_x_m``, ``base_y_m`` and ``turn_rad`` where the base is.
"""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag.base import figure_style as style
from rockfrag.engines.algebra.vectors import TINY

if TYPE_CHECKING:
    from rockfrag.engines.spatial.engine import SpatialOutcome

LEAST_TILT = 1e-2  # what leans less is drawn as next to nothing [rad]


def spatial_figure(
    outcome: "SpatialOutcome",
    history: pd.DataFrame,
    outline: NDArray[np.float64],
    title: str,
) -> Figure:
    """Draw the path of the axis [rad] and the plan [m] of a response.

    Parameters
    ----------
    outcome : of the analysis: whether, over what and where to the body fell, and how far it turned
    history : a row a sample, see above
    outline : of the base at first, from below the centre of mass, shape (n, 2) [m]
    title : of the figure

    Returns
    -------
    The figure, of two panels.
    """
    with style.panels(style.COLUMN_WIDTH, 6.0, 2) as (figure, (axis, plan)):
        figure.suptitle(title, x=0.02, ha="left")
        _path_of_axis(axis, outcome, history)
        _plan(plan, history, outline, outcome.turn)
        return figure


def _path_of_axis(
    panel: Axes, outcome: "SpatialOutcome", history: pd.DataFrame
) -> None:
    """Draw which way the axis leans, and how far, as seen from above [rad]."""
    axis = history[["axis_x", "axis_y"]].to_numpy()
    # the horizontal part of the axis is as long as the sine of the tilt: it is drawn as long as the tilt
    sine = np.maximum(np.hypot(*axis.T), TINY)
    x, y = axis.T * (history["tilt_rad"].to_numpy() / sine)
    panel.plot(x, y, color=style.BLUE, lw=0.7)
    panel.plot(x[-1], y[-1], "o", color=style.BLACK, ms=3)
    if outcome.overturned:
        towards = np.degrees(outcome.fall_direction)
        panel.set_title(
            f"Falls over {outcome.fell_over} towards {towards:.0f}°".replace("-", "−"),
            loc="left",
        )
    else:
        panel.set_title("Does not fall", loc="left")
    _square(panel, np.array([x, y]), 1.25, least=LEAST_TILT)
    panel.set_xlabel("Tilt of the axis along x [rad]")
    panel.set_ylabel("Tilt of the axis along y [rad]")


def _plan(
    panel: Axes, history: pd.DataFrame, outline: NDArray[np.float64], turned: float
) -> None:
    """Draw the base at the start and at the end [m], and how far it has ``turned`` about the vertical [rad]."""
    closed = np.vstack([outline, outline[:1]])
    corners = []
    for row, colour, name in (
        (history.iloc[0], style.GUIDE, "at the start"),
        (history.iloc[-1], style.ORANGE, "at the end"),
    ):
        cosine, sine = np.cos(row.turn_rad), np.sin(row.turn_rad)
        to_ground = np.array([[cosine, sine], [-sine, cosine]])
        moved = closed @ to_ground + (row.base_x_m, row.base_y_m)
        panel.plot(*moved.T, color=colour, lw=1.0, label=name)
        corners.append(moved)
    panel.plot(
        history.base_x_m,
        history.base_y_m,
        color=style.BLUE,
        lw=0.7,
        label="path of its middle",
    )
    corners.append(history[["base_x_m", "base_y_m"]].to_numpy())
    # of the outcome: a history goes on until its last sample, beyond the end of the motion
    turn = round(float(np.degrees(turned)), 1) + 0.0
    panel.set_title(f"Turned by {turn:.1f}°".replace("-", "−"), loc="left")
    _square(panel, np.vstack(corners).T, 1.1)
    panel.set_xlabel("x [m]")
    panel.set_ylabel("y [m]")
    panel.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, columnspacing=1.0
    )


def _square(
    panel: Axes, points: NDArray[np.float64], margin: float, least: float = 1e-6
) -> None:
    """Show all points, shape (2, n), at one scale for both axes of a panel.

    Half a side is ``margin`` times half of the larger extent, and ``least`` at least, in units of the axes.
    """
    middle = (points.max(axis=1) + points.min(axis=1)) / 2
    half = max(margin * float(np.ptp(points, axis=1).max()) / 2, least)
    panel.set_xlim(middle[0] - half, middle[0] + half)
    panel.set_ylim(middle[1] - half, middle[1] + half)
    panel.set_aspect("equal")
