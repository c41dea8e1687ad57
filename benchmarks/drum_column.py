"""Draw when a column of seven drums and a capital overturns under a pulse: accelerations against durations."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# the column lies with the oracles of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from rockfrag.base.figure_style import COLUMN_WIDTH, figure_style
from rockfrag.base.units import GRAVITY as G
from rockfrag.simulation import overturns
from rockfrag.system import Column
from tests.oracle.cases import drum_column, drum_pulse

FRICTION = 0.6
DT = 0.005


def domain(
    column: Column, accelerations: np.ndarray, durations: np.ndarray
) -> np.ndarray:
    """Whether the column overturns, shape (durations, accelerations)."""
    motions = [drum_pulse(float(duration), DT) for duration in durations]
    scales = np.tile(accelerations * G, (len(motions), 1))
    found = overturns(column, motions, DT, scales, friction=[FRICTION])
    return np.asarray(found.overturned[0])


def main(path: Path) -> None:
    """Draw the domains of the drums and of the monolith of the same shape."""
    accelerations = np.linspace(0.1, 1.2, 23)
    durations = np.linspace(0.1, 1.2, 23)
    with figure_style():
        figure, panels = plt.subplots(
            1, 2, sharey=True, figsize=(2 * COLUMN_WIDTH, COLUMN_WIDTH)
        )
        for panel, (name, column) in zip(
            panels, {"7 drums and a capital": drum_column(), "one drum and the capital": drum_column(1)}.items(),
            strict=True,
        ):  # fmt: skip
            fell = domain(column, accelerations, durations)
            panel.pcolormesh(
                durations, accelerations, fell.T, cmap="Greys", vmin=0, vmax=1.6
            )
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
    main(
        Path(sys.argv[1]) if len(sys.argv) > 1 else Path("docs/images/drum_column.png")
    )
