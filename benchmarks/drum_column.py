"""Draw when a column of seven drums and a capital overturns under a pulse: accelerations against durations."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from rockfrag.figure_style import COLUMN_WIDTH, figure_style
from rockfrag.rocking import overturns
from rockfrag.system import Block, Column
from rockfrag.units import GRAVITY as G

HEIGHT, BASE, TOP, DENSITY = 5.95, 1.11, 0.90, 2620.0
DRUMS, CAPITAL = 7, 0.45
FRICTION = 0.6
DT = 0.005


def drum_column(drums: int = DRUMS) -> Column:
    """Drums of equal height that taper, and a capital as wide as the top."""
    shaft = HEIGHT - CAPITAL
    height = shaft / drums
    widths = [BASE + (TOP - BASE) * (k + 0.5) / drums for k in range(drums)]
    # round: mass of a cylinder, inertia of one across its axis
    blocks = []
    for width, tall in [*((w, height) for w in widths), (TOP, CAPITAL)]:
        mass = DENSITY * np.pi / 4 * width**2 * tall
        blocks.append(Block(width, tall, mass, mass * (0.75 * width**2 + tall**2) / 12))
    return Column(tuple(blocks))


def pulse(duration: float) -> np.ndarray:
    """+1 for a duration, -1/2 for twice as long [m/s²]: the ground ends at rest."""
    time = np.arange(0, 3 * duration + DT / 2, DT)
    return np.where(time < duration, 1.0, np.where(time < 3 * duration, -0.5, 0.0))


def domain(column: Column, accelerations: np.ndarray, durations: np.ndarray) -> np.ndarray:
    """Whether the column overturns, shape (durations, accelerations)."""
    motions = [pulse(float(duration)) for duration in durations]
    scales = np.tile(accelerations * G, (len(motions), 1))
    return overturns(column, motions, DT, scales, friction=[FRICTION]).overturned[0]


def main(path: Path) -> None:
    """Draw the domains of the drums and of the monolith of the same shape."""
    accelerations = np.linspace(0.1, 1.2, 23)
    durations = np.linspace(0.1, 1.2, 23)
    with figure_style():
        figure, panels = plt.subplots(1, 2, sharey=True, figsize=(2 * COLUMN_WIDTH, COLUMN_WIDTH))
        for panel, (name, column) in zip(
            panels, {"7 drums and a capital": drum_column(), "one drum and the capital": drum_column(1)}.items(),
            strict=True,
        ):  # fmt: skip
            fell = domain(column, accelerations, durations)
            panel.pcolormesh(durations, accelerations, fell.T, cmap="Greys", vmin=0, vmax=1.6)
            panel.set_title(name, loc="left")
            panel.set_xlabel("Duration of the pulse [s]")
            print(f"{name}: {fell.sum()} of {fell.size} overturn")
            for row, duration in list(enumerate(durations))[2::5]:
                least = accelerations[fell[row]]
                print(
                    f"  {duration:.2f} s: from {least.min() if least.size else float('nan'):.2f} g"
                )
        panels[0].set_ylabel("Acceleration [g]")
        figure.savefig(path, dpi=200, bbox_inches="tight")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/images/drum_column.png"))
