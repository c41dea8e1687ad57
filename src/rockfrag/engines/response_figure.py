"""Figures of one response, of planar bodies over time, and of a body in space along the path of its axis."""

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag import figure_style as style
from rockfrag.engines.response import Response
from rockfrag.engines.steps import rocking_shapes
from rockfrag.system import geometry
from rockfrag.units import GRAVITY

if TYPE_CHECKING:
    from rockfrag.engines.spatial.engine import SpatialOutcome

MOST_ROCKING_MODES = len(style.OKABE_ITO)  # rows of patterns; more are counted
GREY = "#999999"
_ROCKING_MODES = ("1a", "1b", "2a", "2b", "3a", "3b", "4a", "4b", "flight")


def response_figure(response: Response, title: str) -> Figure:
    """Draw acceleration [g], rotations over the critical angle with impacts, slip and the pattern over time."""
    shapes, names = rocking_shapes(response.system), response.system.names
    critical = [
        min(geometry.critical_angle(shape, side) for side in (+1, -1))
        for shape in shapes
    ]
    single = len(names) == 1
    # the object has its colour wherever it stands
    colours = [style.BLUE, style.ORANGE, *style.OKABE_ITO[2:]][: len(names)][::-1]
    slides = bool((response.slides != 0).any())
    heights = [2, 3, 2, 2] if slides else [2, 3, 2]
    shape: Any = {"nrows": len(heights), "sharex": True, "height_ratios": heights}
    with style.panels(style.COLUMN_WIDTH, 0.6 * sum(heights), **shape) as (
        figure,
        panels,
    ):
        ground, rotation, *between, rocking_mode = panels
        acceleration = response.ground_acceleration / GRAVITY
        ground.plot(response.time, acceleration, color=style.BLACK, lw=0.5)
        ground.set_ylabel("Ground [g]")
        ground.set_title(title, loc="left")
        for i, name in enumerate(names):
            turned = response.theta[:, i] / critical[i]
            rotation.plot(response.time, turned, color=colours[i], lw=0.8, label=name)
        rotation.axhline(1, color=GREY, lw=0.6, ls="--")
        rotation.axhline(-1, color=GREY, lw=0.6, ls="--")
        # a body that never rocked has a panel, too
        largest = float(np.abs(response.theta / critical).max()) or 1.0
        rotation.set_ylim(-min(1.6, 1.15 * largest), min(1.6, 1.15 * largest))
        rotation.set_ylabel("Rotation / critical [-]")
        impacts = response.contact_events.loc[
            response.contact_events["kind"] == "impact", "time"
        ]
        rotation.plot(
            impacts,
            np.zeros(len(impacts)),
            "|",
            color=style.BLACK,
            ms=5,
            mew=0.5,
            label="impact",
        )
        if not single or len(impacts):
            rotation.legend(loc="upper right", ncols=3)
        if response.overturned:
            for panel in panels:
                panel.axvline(response.overturning_time, color=style.RED, lw=0.8)
        for panel in between:
            _slips(panel, response, colours)
        _rocking_modes(rocking_mode, response)
        rocking_mode.set_xlabel("Time [s]")
        rocking_mode.set_xlim(0, response.time[-1])
        return figure


def _slips(panel: Axes, response: Response, colours: list[str]) -> None:
    """Draw how far each interface has slid."""
    names = ["ground", *(f"under {name}" for name in response.system.names[1:])]
    for i, (name, colour) in enumerate(zip(names, colours, strict=True)):
        panel.plot(
            response.time, 1000 * response.slip[:, i], color=colour, lw=0.8, label=name
        )
    panel.set_ylabel("Slip [mm]")
    if len(colours) > 1:
        panel.legend(loc="upper right", ncols=2)


def _rocking_modes(panel: Axes, response: Response) -> None:
    """Mark at which times each pattern of rocking is there."""
    labels = response.rocking_mode
    known = _ROCKING_MODES if len(response.system.names) < 3 else sorted(set(labels))
    seen = [name for name in known if (labels == name).any()]
    if len(seen) > MOST_ROCKING_MODES:
        # of a long column the number of bodies that rock or fly tells more than a row for each pattern
        moving = (response.state != 0).sum(axis=1)
        panel.step(response.time, moving, color=style.BLACK, lw=0.6)
        panel.set_ylabel("Open contacts")
        return
    for row, name in enumerate(seen):
        times = response.time[labels == name]
        panel.plot(
            times,
            np.full(times.size, row),
            "|",
            color=style.OKABE_ITO[row],
            ms=6,
            mew=0.6,
        )
    panel.set_yticks(range(len(seen)), seen)
    panel.set_ylim(-0.6, max(len(seen), 1) - 0.4)
    panel.set_ylabel("Pattern")


def spatial_figure(
    outcome: "SpatialOutcome",
    history: pd.DataFrame,
    outline: NDArray[np.float64],
    title: str,
) -> Figure:
    """Draw the path of the axis [rad] and the plan [m] of a response, whose base has this outline, (n, 2) [m]."""
    with style.panels(style.COLUMN_WIDTH, 6.0, 2) as (figure, (axis, plan)):
        figure.suptitle(title, x=0.02, ha="left")
        _path_of_axis(axis, outcome, history)
        _plan(plan, history, outline)
        return figure


def _path_of_axis(
    panel: Axes, outcome: "SpatialOutcome", history: pd.DataFrame
) -> None:
    axis = history[["axis_x", "axis_y"]].to_numpy()
    sine = np.maximum(np.hypot(*axis.T), 1e-300)
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
    _square(panel, np.array([x, y]), 1.25)
    panel.set_xlabel("Tilt of the axis along x [rad]")
    panel.set_ylabel("Tilt of the axis along y [rad]")


def _plan(panel: Axes, history: pd.DataFrame, outline: NDArray[np.float64]) -> None:
    closed = np.vstack([outline, outline[:1]])
    corners = []
    for row, colour, name in (
        (history.iloc[0], GREY, "at the start"),
        (history.iloc[-1], style.ORANGE, "at the end"),
    ):
        c, s = np.cos(row.turn_rad), np.sin(row.turn_rad)
        moved = closed @ np.array([[c, s], [-s, c]]) + (row.base_x_m, row.base_y_m)
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
    turn = round(float(np.degrees(history.turn_rad.iloc[-1])), 1) + 0.0
    panel.set_title(f"Turned by {turn:.1f}°".replace("-", "−"), loc="left")
    _square(panel, np.vstack(corners).T, 1.1)
    panel.set_xlabel("x [m]")
    panel.set_ylabel("y [m]")
    panel.legend(
        loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=3, columnspacing=1.0
    )


def _square(panel: Axes, points: NDArray[np.float64], margin: float) -> None:
    """Show all points at one scale for both directions."""
    middle = (points.max(axis=1) + points.min(axis=1)) / 2
    half = max(margin * float(np.ptp(points, axis=1).max()) / 2, 1e-6)
    panel.set_xlim(middle[0] - half, middle[0] + half)
    panel.set_ylim(middle[1] - half, middle[1] + half)
    panel.set_aspect("equal")
