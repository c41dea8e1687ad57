"""Velocity that topples blocks, by width and height: simulated medians, and surfaces fitted to them.

In: sizes [m], records, and levels of a measure. Out: medians and dispersions of the measure at which blocks
topple, or rock beyond a part of their critical angle, with intervals over earthquakes; coefficients of
:class:`rockfrag.fragility.toppling_velocity.Surface`. Theory and results: ``docs/toppling-velocity.md``.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.plausible import STONE
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.toppling_velocity import (
    HEIGHTS,
    LIMITS,
    WIDTHS,
    is_inside,
    terms_of,
)
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.closed_forms import kaneko_velocity
from rockfrag.simulation.ensemble import LightBodies, overturns
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.simulation.options import FrictionInput
from rockfrag.system.blocks import Block

RESAMPLES = 100  # of the earthquakes, behind intervals
NEAR = 1.5  # dispersions about the median within which levels count
LEAST_DISPERSION = 1e-3  # below which a curve is a step [-]
Pair = tuple[Motion, Motion]


@dataclass(frozen=True)
class Shaken:
    """What blocks do at levels of a measure.

    Attributes
    ----------
    sizes : width and height of each [m], shape (sizes, 2)
    levels : of the measure, shape (sizes, levels), equally spaced in the logarithm for all sizes
    reached : whether each limit is reached, shape (limits, sizes, records, levels)
    """

    sizes: Floats
    levels: Floats
    reached: Flags

    def fits(self, weights: Floats, limit: int = -1) -> tuple[Floats, Floats]:
        """Medians and dispersions by maximum likelihood, shape (replicates, sizes) each.

        ``weights`` says how often each record counts, shape (replicates, records); NaN where all outcomes agree.
        Levels further from the median than :data:`NEAR` dispersions of a first fit to all levels take no part:
        outcomes are not quite lognormal, and the median is wanted.
        """
        fell = np.einsum("rm,sml->rsl", weights, self.reached[limit].astype(float))
        replicates, sizes, levels = fell.shape
        steps = np.log(self.relative)
        trials = np.repeat(weights.sum(axis=1), sizes)[:, np.newaxis] * np.ones(levels)
        median, dispersion = _curves(steps, fell.reshape(-1, levels), trials)
        # a steep curve still needs levels on both sides
        least = float(steps[1] - steps[0]) if levels > 1 else 0.0
        near = _near(steps, median, np.maximum(dispersion, least))
        median, dispersion = _curves(
            steps, fell.reshape(-1, levels) * near, trials * near
        )
        shape = (replicates, sizes)
        medians = np.exp(median).reshape(shape) * self.levels[:, 0]
        return medians, np.maximum(dispersion, LEAST_DISPERSION).reshape(shape)

    @property
    def relative(self) -> Floats:
        """Levels over the lowest, the same for all sizes, shape (levels,)."""
        return np.asarray(self.levels[0] / self.levels[0, 0])


def _near(steps: Floats, median: Floats, dispersion: Floats) -> Flags:
    """Whether logarithms of levels are within :data:`NEAR` dispersions of medians; all are where none is known."""
    away = np.abs(steps - median[:, np.newaxis])
    return np.asarray(~(away > NEAR * dispersion[:, np.newaxis]))


def _curves(steps: Floats, fell: Floats, trials: Floats) -> tuple[Floats, Floats]:
    """Logarithms of medians, and dispersions, of counts at levels; NaN where all outcomes agree."""
    design = np.column_stack([np.ones(steps.size), steps])
    found = fit_batch(design, fell, trials).coefficients
    slope = np.where(found[:, 1] > 0, found[:, 1], np.nan)
    return -found[:, 0] / slope, 1 / slope


def grid_of_sizes(widths: int, heights: int) -> Floats:
    """Sizes at equal ratios over the range of the surface.

    Parameters
    ----------
    widths, heights : how many of each

    Returns
    -------
    Width and height of each size within the range [m], shape (sizes, 2).
    """
    each = np.meshgrid(np.geomspace(*WIDTHS, widths), np.geomspace(*HEIGHTS, heights))
    sizes = np.column_stack([side.ravel() for side in each])
    return sizes[is_inside(*sizes.T)]


def random_sizes(count: int, seed: int) -> Floats:
    """Sizes drawn from the range of the surface, which its fit has not seen.

    Parameters
    ----------
    count, seed : how many, and where the draws start

    Returns
    -------
    Width and height of each [m], shape (count, 2).
    """
    rng = np.random.default_rng(seed)
    found: list[Floats] = []
    while len(found) < count:
        size = np.exp([rng.uniform(*np.log(WIDTHS)), rng.uniform(*np.log(HEIGHTS))])
        if is_inside(*size):
            found.append(size)
    return np.array(found)


def block_of(size: Floats, standing: str = "plane") -> Block:
    """Uniform block of stone of a size [m], standing as in :data:`STANDINGS`."""
    width, height = map(float, size)
    if standing == "round":
        mass = STONE * np.pi / 4 * width**2 * height
        return Block(width, height, mass, round=True)
    depth = width * (2 if standing == "oblong" else 1)
    mass = STONE * width * depth * height
    return Block(width, height, mass, depth=None if standing == "plane" else depth)


def velocity_levels(sizes: Floats, relative: Floats) -> Floats:
    """Levels of PGV about Kaneko's curve.

    Parameters
    ----------
    sizes, relative : width and height [m], shape (sizes, 2), and levels over that curve [-], shape (levels,)

    Returns
    -------
    Levels [m/s], shape (sizes, levels).
    """
    about = np.array([kaneko_velocity(*map(float, size)) for size in sizes])
    return np.asarray(np.multiply.outer(about, relative))


def acceleration_levels(sizes: Floats, relative: Floats) -> Floats:
    """Levels of PGA about uplift, B/H.

    Parameters
    ----------
    sizes, relative : width and height [m], shape (sizes, 2), and levels over uplift [-], shape (levels,)

    Returns
    -------
    Levels [g], shape (sizes, levels).
    """
    return np.asarray(np.multiply.outer(sizes[:, 0] / sizes[:, 1], relative))


def shaken_in_plane(
    sizes: Floats,
    motions: Sequence[Motion],
    measure: Floats,
    levels: Floats,
    *,
    friction: FrictionInput | None = None,
    restitution: float = 1.0,
) -> Shaken:
    """Shake blocks in the plane, each motion at each level of its measure.

    Parameters
    ----------
    sizes, motions : width and height of each block [m], and motions
    measure, levels : of the motions as they are, (motions,), and those to shake at, (sizes, levels)
    friction : as of :func:`rockfrag.simulation.overturns`
    restitution : over that which conserves momentum [-]

    Returns
    -------
    The :class:`Shaken`.
    """
    reached = np.empty((len(LIMITS), len(sizes), len(motions), levels.shape[1]), bool)
    for i, size in enumerate(sizes):
        block = block_of(size)
        kept = None
        if restitution != 1:
            kept = [restitution * block.momentum_restitution(+1)]
        with warnings.catch_warnings():
            # squat blocks at strong levels, of which docs/toppling-velocity.md warns
            warnings.simplefilter("ignore", LightBodies)
            # levels are velocities, so that stiff motions have accelerations of many g
            warnings.simplefilter("ignore", UnitWarning)
            found = overturns(
                [block],
                motions,
                scales=levels[i] / measure[:, np.newaxis],
                friction=friction,
                restitution=kept,
                threads=1,
            )
        reached[:, i] = _limits_of(found.peak_rotation[0, ..., 0])
    return Shaken(sizes, levels, reached)


def shaken_in_space(
    sizes: Floats,
    standing: str,
    pairs: Sequence[Pair],
    measure: Floats,
    levels: Floats,
) -> Shaken:
    """Shake blocks in space under both components of each record, at each level of its measure.

    Parameters
    ----------
    sizes, standing : width and height of each block [m], and what it stands on
    pairs : both components of each record, on one time base
    measure, levels : of the records as they are, (records,), and those to shake at, (sizes, levels)

    Returns
    -------
    The :class:`Shaken`.
    """
    shaking = [GroundMotion(first, other) for first, other in pairs]
    reached = np.empty((len(LIMITS), len(sizes), len(pairs), levels.shape[1]), bool)
    for i, size in enumerate(sizes):
        scales = levels[i] / measure[:, np.newaxis]
        with warnings.catch_warnings():
            # as in the plane
            warnings.simplefilter("ignore", UnitWarning)
            found = overturns([block_of(size, standing)], shaking, scales=scales)
        reached[:, i] = _limits_of(found.peak_rotation[0, ..., 0])
    return Shaken(sizes, levels, reached)


def _limits_of(peaks: Floats) -> Flags:
    """Whether peak rotations over the critical angle reach each limit; the last is the fall itself."""
    limits = np.array([*LIMITS[:-1], np.inf]).reshape(-1, *[1] * peaks.ndim)
    return np.asarray(peaks >= limits)


def earthquake_weights(
    earthquakes: Sequence[str], resamples: int = RESAMPLES, seed: int = 0
) -> Floats:
    """How often each record counts if earthquakes are drawn anew, shape (1 + resamples, records); first all once.

    Parameters
    ----------
    earthquakes : of each record
    resamples, seed : number of draws, and where they start

    Returns
    -------
    The weights.
    """
    names, of_record = np.unique(np.asarray(earthquakes), return_inverse=True)
    rng = np.random.default_rng(seed)
    count = names.size
    drawn = rng.multinomial(count, np.full(count, 1 / count), size=resamples)
    counts = np.vstack([np.ones((1, count)), drawn])
    return np.asarray(counts[:, of_record], dtype=np.float64)


def medians_by(
    reached: Flags, levels: Floats, factors: Floats, weights: Floats
) -> tuple[Floats, Floats]:
    """Medians and dispersions of one size by another measure, ``factors`` times the level of each record.

    As in :meth:`Shaken.fits` what is far from the median takes no part.

    Parameters
    ----------
    reached : shape (records, levels)
    levels, factors : shapes (levels,) and (records,)
    weights : how often each record counts, shape (replicates, records)

    Returns
    -------
    Medians in the unit of the levels, and dispersions [-], shape (replicates,) each.
    """
    steps = np.log(np.multiply.outer(factors, levels)).ravel()
    trials = np.repeat(weights, levels.size, axis=1)
    fell = reached.ravel() * trials
    median, dispersion = _curves(steps, fell, trials)
    near = _near(steps, median, dispersion)
    median, dispersion = _curves(steps, fell * near, trials * near)
    return np.exp(median), dispersion


def surface_coefficients(sizes: Floats, values: Floats) -> Floats:
    """Coefficients of a surface through values at sizes by least squares; NaN values are left out.

    Parameters
    ----------
    sizes, values : width and height [m], shape (sizes, 2), and a value for each

    Returns
    -------
    The coefficients, shape (7,).
    """
    known = np.isfinite(values)
    terms = terms_of(*sizes[known].T)
    return np.asarray(np.linalg.lstsq(terms, values[known], rcond=None)[0])
