"""Figure of the checks in space: ``python benchmarks/space_checks.py docs/images/space-checks.svg``."""

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from rockfrag import Block, simulate
from rockfrag.base.figure_style import (
    BLACK,
    BLUE,
    ORANGE,
    PAGE_WIDTH,
    figure_style,
    new_figure,
    plain_log,
    save_figure,
)
from rockfrag.engines.spatial.engine import history_table, run_case

# what the checks measure lies with the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tests.engines.spatial import checks
from tests.engines.spatial.samples import DT, box

DOT: dict[str, Any] = {"ls": "", "marker": "o", "ms": 3.5, "mfc": "none"}


def plane(axes: Axes) -> None:
    """Check 1: the tilt of a box along an axis of symmetry beside the planar block's."""
    width, depth, height, motion = checks.planar_case(np.random.default_rng(11))
    _, history = run_case(box(width, depth, height), motion, DT, samples=len(motion))
    tilt = history_table(history, DT, height / 2).tilt_rad.to_numpy()
    theta = np.abs(simulate(Block(width, height, 100.0), motion[:, 0], DT).theta[:, 0])
    n = min(len(tilt), len(theta))
    axes.plot(DT * np.arange(n), theta[:n], color=ORANGE, lw=2.2, label="planar engine")
    axes.plot(DT * np.arange(n), tilt[:n], color=BLUE, lw=0.8, label="in space")
    axes.set(
        xlabel="Time [s]", ylabel="Tilt [rad]", title="1  Along an axis of symmetry"
    )
    axes.legend()


def vertex(axes: Axes) -> None:
    """Check 2: drift of energy and vertical angular momentum about a fixed vertex."""
    energies, momenta, _ = checks.about_a_vertex()
    time = DT * np.arange(len(energies))
    for values, colour, name in (
        (energies, BLUE, "energy"),
        (momenta, ORANGE, "momentum"),
    ):
        axes.plot(time, 1e12 * (values - values[0]), color=colour, label=name)
    axes.set(
        xlabel="Time [s]",
        ylabel="Change [10⁻¹² J/kg, m²/s]",
        title="2  About a fixed vertex",
    )
    axes.legend()


def lifting(axes: Axes) -> None:
    """Check 3: uplift by direction."""
    angles = np.linspace(0, 90, 19)
    before, after, limit, _ = np.array([checks.uplift(angle) for angle in angles]).T
    axes.plot(angles, limit, color=BLACK, lw=0.8, label="formula")
    axes.plot(angles, (before + after) / 2, color=BLUE, label="engine", **DOT)
    axes.set(
        xlabel="Direction [°]",
        ylabel="Uplift [m/s²]",
        title="3  End of rest, 0.4 × 0.6 × 1.5 m",
    )
    axes.legend()


def wobbles(axes: Axes) -> None:
    """Check 4: rate of a wobble with the centre at rest."""
    tilts = np.linspace(0.04, 0.32, 60)
    axes.plot(
        tilts,
        [checks.wobbling(t)[2] for t in tilts],
        color=BLACK,
        lw=0.8,
        label="formula",
    )
    few = [0.05, 0.1, 0.2, 0.3]
    axes.plot(
        few, [checks.wobble(t)[2] for t in few], color=BLUE, label="engine", **DOT
    )
    axes.set(
        xlabel="Tilt [rad]", ylabel="Rate [rad/s]", title="4  Wobble of a cylinder"
    )
    axes.legend()


def passes(axes: Axes) -> None:
    """Check 5: turn of the contact in a pass near flat."""
    for disk, name, limit in (
        (True, "disk", math.pi * 5**0.5),
        (False, "cylinder", 5.1758),
    ):
        speeds, theirs = zip(
            *(case[1:] for case in checks.PASSES if case[0] == disk), strict=True
        )
        ours = [checks.near_flat_pass(disk, speed)[0] for speed in speeds]
        colour = BLUE if disk else ORANGE
        axes.plot(speeds, theirs, "x", color=BLACK, ms=4)
        axes.plot(speeds, ours, color=colour, label=name, **DOT)
        axes.axhline(limit, color=colour, lw=0.8)
    axes.set(
        xlabel="Speed sideways [rad/s]",
        ylabel="Turn [rad]",
        title="5  Pass near flat",
        xscale="log",
    )
    plain_log(axes, "x")
    axes.legend(loc="center left")


def losses(axes: Axes) -> None:
    """Check 6: loss of a polygon per vertex."""
    _, lost = checks.polygons()
    sides = np.array(checks.SIDES)
    axes.loglog(
        sides, lost[-1] * (sides[-1] / sides) ** 2, color=BLACK, lw=0.8, label="1/n²"
    )
    axes.loglog(sides, lost, color=BLUE, label="engine", **DOT)
    axes.set(
        xlabel="Vertices",
        ylabel="Loss per vertex [J/kg]",
        title="6  Polygons that roll",
    )
    axes.set_xticks(sides, [str(n) for n in sides])
    axes.minorticks_off()
    plain_log(axes, "y")
    axes.legend()


def fractions(axes: Axes) -> None:
    """Check 7: fractions overturned beside the plain time stepping."""
    found, expected = checks.by_stepping(8, 4, 1)
    axes.plot(
        checks.LEVELS,
        expected.mean(axis=(0, 1)),
        color=ORANGE,
        lw=2.2,
        label="plain stepping",
    )
    axes.plot(
        checks.LEVELS, found.mean(axis=(0, 1)), color=BLUE, lw=0.8, label="engine"
    )
    axes.set(
        xlabel="Peak over uplift [-]",
        ylabel="Fraction overturned",
        title="7  8 boxes × 4 pairs",
    )
    axes.legend()


def cylinders(axes: Axes) -> None:
    """Check 8: solid cylinders by slenderness and size."""
    rests, falls, peak = checks.solid_cylinders(0)
    for i, (half, colour) in enumerate(
        zip(checks.RADII, (BLACK, BLUE, ORANGE, "#999999"), strict=True)
    ):
        state = np.where(rests[i], 0, np.where(falls[i], 2, 1))
        axes.plot(
            checks.ANGLES,
            state + 0.08 * i,
            ".",
            ms=3,
            color=colour,
            label=f"{half:g} m",
        )
    axes.axvline(math.degrees(math.atan(peak)), color=BLACK, lw=0.8)
    axes.set_yticks([0.12, 1.12, 2.12], ["rests", "rocks", "falls"])
    axes.set(xlabel="Slenderness angle [°]", title="8  Solid cylinders, half diagonal")
    axes.legend(loc="upper right")


def main(paths: list[str]) -> None:
    """Draw all checks into files."""
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 8.6)
        draw = (plane, vertex, lifting, wobbles, passes, losses, fractions, cylinders)
        for one, axes in zip(draw, figure.subplots(4, 2).flat, strict=True):
            one(axes)
        save_figure(figure, *paths)


if __name__ == "__main__":
    main(sys.argv[1:])
