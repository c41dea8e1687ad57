"""One motion: its acceleration, velocity and displacement over time."""

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag.figure_style import BLUE, COLUMN_WIDTH, RED, figure_style, new_figure
from rockfrag.records.motion import integrate
from rockfrag.units import GRAVITY

Floats = NDArray[np.float64]


def motion_figure(acceleration: Floats, dt: float, title: str) -> Figure:
    """Draw acceleration [g], velocity [cm/s] and displacement [cm]; a dot marks the largest sample of each."""
    velocity, displacement = integrate(acceleration, dt)
    drawn = (
        ("Acceleration [g]", acceleration / GRAVITY),
        ("Velocity [cm/s]", 100 * velocity),
        ("Displacement [cm]", 100 * displacement),
    )
    time = np.arange(acceleration.size) * dt
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 4.2)
        panels = figure.subplots(3, 1, sharex=True)
        for panel, (label, values) in zip(panels, drawn, strict=True):
            peak = int(np.abs(values).argmax())
            panel.axhline(0, color="#999999", linewidth=0.6, zorder=1)
            panel.plot(time, values, color=BLUE, linewidth=0.6)
            panel.plot(time[peak], values[peak], "o", color=RED, markersize=3)
            panel.set_ylabel(label)
        panels[0].set_title(title, loc="left")
        panels[-1].set_xlabel("Time [s]")
        figure.align_ylabels(panels)
        return figure
