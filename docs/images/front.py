"""Draw the picture of the first page: a statue that rocks on its pedestal, and how probable it is that it falls.

.venv/bin/python docs/images/front.py
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Polygon

from rockfrag import Block, Stack, fit_lognormal, overturns, simulate
from rockfrag.fragility import Observations
from rockfrag.motions import evolutionary, mavroeidis_papageorgiou, scale_to_pgv

BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#b8b8b8"
STATUE = Block(width=0.35, height=1.20, mass=180.0)
PEDESTAL = Block(width=0.50, height=0.90, mass=400.0)
PGV = np.geomspace(25, 200, 9)


def outline(block: Block, centre: tuple[float, float], angle: float) -> np.ndarray:
    """Corners of a block turned clockwise by an angle about its centre [m]."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * (
        block.width / 2,
        block.height / 2,
    )
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return corners @ turn + centre


def draw_rocking(axes: plt.Axes) -> None:
    """Instants of the response to a near-fault pulse, side by side."""
    response = simulate(
        Stack(PEDESTAL, STATUE), mavroeidis_papageorgiou(0.75, 1.2, 1.5, dt=0.01)
    )
    first = response.time[np.abs(response.theta[:, 1]) > 0.02][0]
    for place, time in enumerate(first + np.array([-0.2, 0.1, 0.35, 0.6, 0.85])):
        i = int(np.searchsorted(response.time, time))
        for block, number, colour in ((PEDESTAL, 0, GREY), (STATUE, 1, BLUE)):
            centre = response.position[i, number] + (1.15 * place, 0.0)
            axes.add_patch(
                Polygon(
                    outline(block, centre, response.theta[i, number]),
                    facecolor=colour,
                    edgecolor="white",
                )
            )
        axes.text(
            1.15 * place,
            -0.16,
            f"{time - first:+.2f} s".replace("-", "\N{MINUS SIGN}"),
            ha="center",
            fontsize=8,
        )
    axes.axhline(0, color="black", linewidth=1)
    axes.set(xlim=(-0.6, 5.6), ylim=(-0.35, 2.5), aspect="equal")
    axes.axis("off")


def draw_fragility(axes: plt.Axes) -> None:
    """Probability of falling over peak velocity, alone and on the pedestal, under 40 synthetic motions."""
    noise = {
        "arias_m_s": 1.0,
        "d5_95_s": 8.0,
        "mid_s": 4.0,
        "slope_hz_s": -0.05,
        "filter_damping": 0.3,
    }
    draw = np.random.default_rng(1)
    motions = [
        scale_to_pgv(evolutionary(seed, mid_hz=draw.uniform(1.0, 4.0), **noise), 100.0)
        for seed in range(40)
    ]
    fallen = overturns(
        [STATUE, Stack(PEDESTAL, STATUE)], motions, scales=PGV / 100
    ).overturned
    names = np.repeat([f"motion {number}" for number in range(40)], PGV.size).astype(
        object
    )
    at = np.geomspace(25, 200, 200)
    for outcomes, label, colour, mark in (
        (fallen[0], "alone", ORANGE, "o"),
        (fallen[1], "on its pedestal", BLUE, "s"),
    ):
        tests = np.tile(PGV, 40), outcomes.ravel().astype(float), np.ones(outcomes.size)
        fit = fit_lognormal(Observations(*tests, names, names, "PGV", "cm/s"))
        axes.plot(at, fit.probability(at), color=colour, label=label)
        axes.plot(PGV, outcomes.mean(axis=0), mark, color=colour, markersize=4)
    axes.set(xlabel="peak ground velocity [cm/s]", ylabel="probability of falling")
    axes.set(xscale="log", ylim=(0, 1.02))
    axes.set_xticks([25, 50, 100, 200], ["25", "50", "100", "200"])
    axes.minorticks_off()
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)


def main() -> None:
    """Write the picture beside this file."""
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9, 3.2), width_ratios=(1.7, 1), layout="constrained"
    )
    draw_rocking(left)
    draw_fragility(right)
    figure.savefig(
        Path(__file__).with_name("front.png"), dpi=160, metadata={"Software": None}
    )


if __name__ == "__main__":
    main()
