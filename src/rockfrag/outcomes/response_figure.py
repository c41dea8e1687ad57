"""Figure of one response of planar bodies: motion, rotations, slip and rocking mode over time.

In: a response. Out: a figure with rotations over the critical angle [-] and slips [mm]. Docs: ``docs/rocking.md``.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.units import GRAVITY
from rockfrag.system import geometry
from rockfrag.system.system import rocking_shapes

if TYPE_CHECKING:
    from rockfrag.outcomes.response import Response

MOST_ROCKING_MODES = len(style.OKABE_ITO)  # rows of patterns; more are counted
_ROCKING_MODES = ("1a", "1b", "2a", "2b", "3a", "3b", "4a", "4b", "flight")


def response_figure(response: "Response", title: str) -> Figure:
    """Draw acceleration [g], rotations over the critical angle with impacts, slip and the pattern over time."""
    names = response.system.names
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
        ground.set_title(style.checked_title(title), loc="left")
        _rotations(rotation, response, colours)
        impacts = _impacts(rotation, response)
        if response.overturned:
            for panel in panels:
                label = "overturned" if panel is rotation else None
                end = response.overturning_time
                panel.axvline(end, color=style.RED, lw=0.8, label=label)
        if len(names) > 1 or impacts or response.overturned:
            _legend_above(rotation)
        for panel in between:
            _slips(panel, response, colours)
        _rocking_modes(rocking_mode, response)
        rocking_mode.set_xlabel("Time [s]")
        rocking_mode.set_xlim(0, response.time[-1])
        return figure


def _rotations(panel: Axes, response: "Response", colours: Sequence[str]) -> None:
    """Draw the rotation of each body over its critical angle [-]."""
    critical = [
        min(geometry.critical_angle(shape, side) for side in (+1, -1))
        for shape in rocking_shapes(response.system)
    ]
    for i, name in enumerate(response.system.names):
        turned = response.theta[:, i] / critical[i]
        panel.plot(response.time, turned, color=colours[i], lw=0.8, label=name)
    panel.axhline(1, color=style.GUIDE, lw=0.6, ls="--")
    panel.axhline(-1, color=style.GUIDE, lw=0.6, ls="--")
    # a body that never rocked has a panel, too
    largest = float(np.abs(response.theta / critical).max()) or 1.0
    panel.set_ylim(-min(1.6, 1.15 * largest), min(1.6, 1.15 * largest))
    panel.set_ylabel("Rotation / critical")


def _impacts(panel: Axes, response: "Response") -> int:
    """Mark the impacts on the zero line; return their number."""
    contact_events = response.contact_events
    times = contact_events.loc[contact_events["kind"] == "impact", "time"]
    style_of_marks: Any = {"color": style.BLACK, "ms": 5, "mew": 0.5}
    panel.plot(times, np.zeros(len(times)), "|", label="impact", **style_of_marks)
    return len(times)


def _legend_above(panel: Axes) -> None:
    """Put the legend between a panel and the one above it, where it hides no curve."""
    panel.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0),
        ncols=7,
        borderaxespad=0.1,
        handlelength=1.2,
        columnspacing=0.8,
    )


def _slips(panel: Axes, response: "Response", colours: list[str]) -> None:
    """Draw how far each interface has slid."""
    names = ["ground", *(f"under {name}" for name in response.system.names[1:])]
    for i, (name, colour) in enumerate(zip(names, colours, strict=True)):
        panel.plot(
            response.time, 1000 * response.slip[:, i], color=colour, lw=0.8, label=name
        )
    panel.set_ylabel("Slip [mm]")
    if len(colours) > 1:
        _legend_above(panel)


def _rocking_modes(panel: Axes, response: "Response") -> None:
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
    panel.set_ylabel("Rocking mode")
