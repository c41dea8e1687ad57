"""Response spectra and rocking spectra of ground motions side by side."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.figure_style import (
    BLACK,
    BLUE,
    GREEN,
    OKABE_ITO,
    ORANGE,
    PAGE_WIDTH,
    figure_style,
    new_figure,
)
from rockfrag.motions.spectra import response_spectrum
from rockfrag.records.motion import Motion
from rockfrag.rocking.spectra import rocking_spectrum
from rockfrag.units import GRAVITY

Floats = NDArray[np.float64]

PERIODS = np.geomspace(0.1, 10.0, 200)
"""Natural periods of the oscillators [s]."""
SIZES = np.geomspace(0.8, 10.0, 400)
"""2π/p of the blocks [s]."""
DAMPINGS = (0.02, 0.05, 0.10)
FALLEN = 1.18
"""Ordinate at which blocks that overturn are drawn, in units of the critical angle."""
COLOURS = (BLUE, ORANGE, GREEN)
DASHES: tuple[str | tuple[int, tuple[float, ...]], ...] = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)))


def _decimal(value: float, _: int) -> str:
    return f"{value:g}"


def _period_axis(axes: Axes, ticks: Sequence[float]) -> None:
    axes.set_xscale("log")
    axes.set_xticks(ticks)
    axes.xaxis.set_major_formatter(FuncFormatter(_decimal))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, axis="y")


def _ratio(alpha: float) -> str:
    return f"H/B = {1 / math.tan(alpha):.3g}"


def spectra_figure(motions: Sequence[Motion], alpha: Sequence[float]) -> Figure:
    """Draw Sd and the rocking spectrum of each motion, one row per motion.

    Parameters
    ----------
    motions
        Ground motions as recorded, up to six.
    alpha
        Critical angles of the blocks [rad], up to three.

    Raises
    ------
    InputError
        If there are no motions or no angles, or too many to be told apart.
    """
    if not 1 <= len(motions) <= 6 or not 1 <= len(alpha) <= len(COLOURS):
        raise InputError(
            "spectra figure: give one to six motions and one to three critical angles."
        )
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 0.9 + 1.55 * len(motions))
        grid = figure.subplots(len(motions), 3, sharex="col", sharey="col", squeeze=False)
        for row, motion in zip(grid, motions, strict=True):
            _displacements(row[0], motion)
            _rotations(row[1:], motion, alpha)
            row[0].set_title(motion.name.replace("_", " "), loc="left", fontweight="bold")
        for axes, title in zip(
            grid[0], ("oscillator", "blocks: rotation", "blocks: velocity"), strict=True
        ):
            axes.set_title(title, loc="right")
        for axes in grid[-1, 1:]:
            axes.set_xlabel("2π/p of the block [s]")
        grid[-1, 0].set_xlabel("natural period [s]")
        for axes in (grid[0, 0], grid[0, 2]):
            # all rows share the axis, which has seen every curve by now
            axes.set_ylim(bottom=0)
        grid[0, 0].legend(loc="upper left", handlelength=2.2, borderaxespad=0.2)
        grid[0, 1].legend(
            loc="center right", handlelength=2.2, borderaxespad=0.2, bbox_to_anchor=(1.0, 0.55)
        )
    return figure


def _displacements(axes: Axes, motion: Motion) -> None:
    for damping, colour, dash in zip(DAMPINGS, COLOURS, DASHES, strict=True):
        spectrum = response_spectrum(motion, PERIODS, damping)
        axes.plot(
            PERIODS, 100 * spectrum.displacement, color=colour, ls=dash, label=f"ξ = {damping:.0%}"
        )
    _period_axis(axes, (0.1, 0.3, 1, 3, 10))
    axes.set_ylabel("Sd [cm]")


def _rotations(pair: Sequence[Axes], motion: Motion, alpha: Sequence[float]) -> None:
    spectrum = rocking_spectrum(motion, SIZES, alpha)
    rotation, velocity = pair
    for k, angle in enumerate(alpha):
        values = spectrum.rotation[k]
        finite = np.where(np.isfinite(values) & (values > 0), values, np.nan)
        speed = np.where(np.isfinite(finite), spectrum.velocity[k] / angle, np.nan)
        style: dict[str, Any] = {"color": COLOURS[k], "ls": DASHES[k], "label": _ratio(angle)}
        rotation.plot(SIZES, finite, **style)
        velocity.plot(SIZES, speed, **style)
        fallen = SIZES[np.isinf(values)]
        height = FALLEN - 0.06 * k
        rotation.plot(
            fallen, np.full(fallen.size, height), ls="", marker="|", ms=3.5, color=COLOURS[k]
        )
    for axes in pair:
        _period_axis(axes, (1, 2, 5, 10))
    rotation.set_ylim(0, 1.28)
    rotation.axhline(1.0, color=BLACK, lw=0.6, ls=":")
    rotation.text(SIZES[-1], 1.03, "overturned", ha="right", va="bottom", fontsize=7)
    rotation.set_ylabel("max |θ|/θc")
    velocity.set_ylabel("max |dθ/dt|/(p θc)")


def comparison_figure(motions: Sequence[Motion], alpha: float, damping: float = 0.05) -> Figure:
    """Draw the motions' spectra over each other: Sd, Sv, Sa above, the rocking spectrum below.

    Parameters
    ----------
    motions
        Ground motions as recorded, up to eight.
    alpha
        Critical angle of the blocks [rad]; a second panel has blocks 10 % squatter.
    damping
        Fraction of critical damping of the oscillators [-].

    Raises
    ------
    InputError
        If there are no motions, or too many to be told apart.
    """
    if not 1 <= len(motions) <= len(OKABE_ITO):
        raise InputError(f"comparison figure: give one to {len(OKABE_ITO)} motions.")
    dashes = (*DASHES, (0, (5, 1.2, 1.2, 1.2)))
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 4.4)
        top, bottom = np.ravel(figure.subfigures(2, 1, squeeze=False))
        upper, lower = top.subplots(1, 3), bottom.subplots(1, 2, sharey=True)
        for k, motion in enumerate(motions):
            spectrum = response_spectrum(motion, PERIODS, damping)
            style: dict[str, Any] = {"color": OKABE_ITO[k], "ls": dashes[k % len(dashes)]}
            ordinates = (
                100 * spectrum.displacement,
                100 * spectrum.velocity,
                spectrum.acceleration / GRAVITY,
            )
            for axes, values in zip(upper, ordinates, strict=True):
                axes.plot(PERIODS, values, **style)
            rocking = rocking_spectrum(motion, SIZES, [alpha, 1.1 * alpha]).rotation
            for axes, values in zip(lower, rocking, strict=True):
                finite = np.where(np.isfinite(values) & (values > 0), values, np.nan)
                axes.plot(SIZES, finite, label=motion.name.replace("_", " "), **style)
                fallen = SIZES[np.isinf(values)]
                axes.plot(
                    fallen,
                    np.full(fallen.size, FALLEN - 0.045 * k),
                    ls="",
                    marker="|",
                    ms=3.5,
                    color=OKABE_ITO[k],
                )
        labels = ("Sd [cm]", "Sv [cm/s]", "Sa [g]")
        for axes, label in zip(upper, labels, strict=True):
            _period_axis(axes, (0.1, 0.3, 1, 3, 10))
            axes.set_ylim(bottom=0)
            axes.set_ylabel(label)
            axes.set_xlabel("natural period [s]")
        upper[0].set_title(f"oscillators, ξ = {damping:.0%}", loc="left")
        for axes, angle in zip(lower, (alpha, 1.1 * alpha), strict=True):
            _period_axis(axes, (1, 2, 5, 10))
            axes.set_ylim(0, 1.28)
            axes.axhline(1.0, color=BLACK, lw=0.6, ls=":")
            axes.set_xlabel("2π/p of the block [s]")
            axes.set_title(f"blocks, {_ratio(angle)}", loc="left")
        lower[0].set_ylabel("max |θ|/θc")
        lower[0].text(SIZES[-1], 1.03, "overturned", ha="right", va="bottom", fontsize=7)
        lower[1].legend(loc="upper right", bbox_to_anchor=(1.0, 0.78), handlelength=2.6)
    return figure
