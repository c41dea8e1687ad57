"""Acceleration histories of the ground motions."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, RED, figure_style, letter_panels, new_figure
from rockfrag.records.motion import Motion
from rockfrag.report.wording import shortened
from rockfrag.units import GRAVITY

MOST_PANELS = 8
"""More motions than this do not fit one figure; the first are drawn."""


def _title(motion: Motion, peak_g: float) -> str:
    """Name of the earthquake and of the record, and the peak."""
    earthquake = str(motion.metadata.get("earthquake") or "")
    name = (
        motion.name
        if earthquake.casefold() in motion.name.casefold()
        else f"{earthquake}, {motion.name}"
    )
    return f"{shortened(name, 44)}: {peak_g:.2f} g"


def acceleration_histories(motions: Sequence[Motion]) -> Figure:
    """Draw the acceleration of each motion over time, one panel a motion, on the same scales.

    The peak is marked. No more than ``MOST_PANELS`` motions are drawn.
    """
    shown = motions[:MOST_PANELS]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.5 + 0.95 * len(shown))
        panels = figure.subplots(len(shown), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        highest = 1.12 * max(motion.pga for motion in shown) / GRAVITY
        for panel, motion in zip(panels, shown, strict=True):
            values = motion.acceleration / GRAVITY
            peak = int(np.abs(values).argmax())
            panel.axhline(0, color="#999999", linewidth=0.6, zorder=1)
            panel.plot(motion.time, values, color=BLUE, linewidth=0.5)
            panel.plot(motion.time[peak], values[peak], "o", color=RED, markersize=3)
            panel.set_ylim(-highest, highest)
            panel.set_title(_title(motion, abs(values[peak])), loc="left")
        letter_panels(panels, size=6.5)
        panels[-1].set_xlabel("Time [s]")
        panels[-1].set_xlim(0, max(motion.time[-1] for motion in shown))
        figure.supylabel("Acceleration [g]", fontsize=8)
        return figure
