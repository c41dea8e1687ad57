"""Draw the map of Shenton (1996) from simulations: what a block at rest does under a sudden acceleration."""

import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

from rockfrag import Block
from rockfrag.base.units import GRAVITY as G
from rockfrag.simulation import simulate

MODES = ("stands", "slides left", "rocks left", "rocks left, slides left")
NAMES = ("rests", "slides", "rocks", "slides\nand rocks")
COLOURS = (
    "#e6e6e6",
    "#56b4e9",
    "#f0a830",
    "#9c5fa8",
)  # told apart by every kind of sight, and in grey


def first_mode(block: Block, acceleration: float, friction: float) -> int:
    response = simulate(block, np.full(2, acceleration), 1e-4, friction=friction)
    return MODES.index(str(response.mode[0, 0]))


def demand(block: Block, acceleration: np.ndarray) -> np.ndarray:
    """Friction that the start of pure rocking needs, docs/contact.md (14)."""
    turning = (
        block.mass * (acceleration * block.h - G * block.b) / block.pivot_inertia()
    )
    return (acceleration - block.h * turning) / (G + block.b * turning)


def draw(path: Path, block: Block) -> None:
    frictions, levels = np.linspace(0.0125, 0.9875, 40), np.linspace(0.02, 1.58, 40)
    found = np.array(
        [[first_mode(block, a * G, mu) for mu in frictions] for a in levels]
    )
    figure, axes = plt.subplots(figsize=(5.2, 4.2), layout="constrained")
    axes.pcolormesh(
        frictions, levels, found, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=3.5
    )
    ratio = block.b / block.h
    line: dict[str, Any] = {"color": "black", "linewidth": 1.2}
    axes.plot([0, ratio], [0, ratio], **line)
    axes.plot([ratio, 1.0], [ratio, ratio], **line)
    axes.plot([ratio, ratio], [ratio, 1.6], **line)
    rising = np.linspace(ratio, 1.6, 100)
    axes.plot(demand(block, rising * G), rising, **line)
    for name, x, y in zip(
        NAMES, (0.7, 0.14, 0.78, 0.415), (0.15, 0.9, 0.75, 1.35), strict=True
    ):
        axes.text(x, y, name, ha="center", va="center")
    axes.set(
        xlim=(0, 1),
        ylim=(0, 1.6),
        xlabel="coefficient of friction µ [-]",
        ylabel="sudden acceleration a / g [-]",
    )
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    draw(
        Path(sys.argv[1] if len(sys.argv) > 1 else "docs/images/shenton_map.png"),
        Block(0.124, 0.372, 2.172),
    )
