"""Axis along which the ground shook most, by where stones fell and where the model lets them fall.

In: azimuths of falls, clockwise from north [degrees], and what each motion does to a stone in space at each level.
Out: :class:`ShakingAxis`. Under the motion m at the level v a stone falls at the angle d from the direction in
which the ground was fastest; how often, of stones that withstand a little more or less, is the density g(d; m, v).
All stones feel one motion, so that with the axis at Ψ the likelihood of azimuths θ is

    L(Ψ) = Σ_m Σ_v w(m, v) Π_i [(1 - c) g(θ_i - Ψ; m, v) + c / 2π],

with the part c of falls for reasons of their own: what the motion does to all does not average out.
``docs/constrain-shaking.md``, "Where falls point".
"""

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from rockfrag.assess.core.scales import AT_REST
from rockfrag.assess.hazard.curve import PGV
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import FEW_LEVELS, make_intensity_levels
from rockfrag.base.arrays import Floats
from rockfrag.motions.rotation import rotate
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.survival.shaking_posterior import INTERVAL, smoothed
from rockfrag.system.blocks import Block

STEP = 2  # Between angles of the densities [degrees]
ANGLES = np.radians(np.arange(0, 360, STEP))  # Shape (angles,)
# Of a stone to the record's first component, of which nothing is known [degrees]
FACINGS = (0.0, 45.0)
MEASURED_WITHIN = 10.0  # Standard deviation of one azimuth of like falls [degrees]; an estimate of ours
OWN_REASONS = 0.1  # Part of falls that point anywhere: struck, rolled on, turned later; an estimate of ours


@dataclass(frozen=True, eq=False)
class PredictedFalls:
    """Where a stone falls under each motion at each level.

    Attributes
    ----------
    levels : of PGV, rising, shape (levels,) [cm/s]
    angles : of falls from the direction in which the ground was fastest, NaN without a fall, shape
        (motions, levels) [rad]
    """

    levels: Floats
    angles: Floats


@dataclass(frozen=True)
class ShakingAxis:
    """Axis along which the ground was fastest, one way or the other.

    Attributes
    ----------
    azimuth : from 0 to 180, clockwise from north [degrees]
    within : half of the interval that holds it with 90 % [degrees]; up to 90, where it is open
    """

    azimuth: float
    within: float


def predicted_falls(block: Block, motions: MotionSet) -> PredictedFalls:
    """Simulate a stone on its base in space under both components of each record.

    Parameters
    ----------
    block : the stone; without a depth its base is square
    motions : the set at its base, with records of two components

    Returns
    -------
    Where it falls.
    """
    both = motions.with_both_components()
    shaking = make_intensity_levels(both, PGV, count=FEW_LEVELS)
    pairs = [record for record in both.records if len(record) == 2]
    first = [record[0] for record in pairs]
    scales = np.where(shaking.allowed[first], shaking.scales[first], AT_REST)
    solid = Block(
        block.width, block.height, block.mass, depth=block.depth or block.width
    )
    found = []
    for facing in FACINGS:
        turned = [_turned(both.components(record), facing) for record in pairs]
        with warnings.catch_warnings():
            # of one component of a scaled record, whose unit is known
            warnings.simplefilter("ignore", UnitWarning)
            outcomes = overturns([solid], turned, scales=scales)
        fastest = np.array([_fastest(motion) for motion in turned])
        found.append(outcomes.fall_direction[0, ..., 0] - fastest[:, np.newaxis])
    return PredictedFalls(shaking.levels, np.concatenate(found))


def _turned(components: Sequence[Motion], angle: float) -> GroundMotion:
    """Motion of the ground along axes that are turned by an angle [degrees] from both components."""
    first, other = components
    return GroundMotion(rotate(first, other, angle), rotate(first, other, angle + 90.0))


def _fastest(motion: GroundMotion) -> float:
    """Direction in which the ground was fastest, from the first component towards the second [rad]."""
    assert motion.y is not None
    x = np.cumsum(motion.x.acceleration)
    y = np.cumsum(motion.y.acceleration)
    at = int(np.argmax(x**2 + y**2))
    return math.atan2(y[at], x[at])


def fall_density(predicted: PredictedFalls, spread: float) -> Floats:
    """Density of the angle at which stones of a group lie, under each motion at each level.

    Parameters
    ----------
    predicted : where one of them falls
    spread : standard deviation of ln level that fells one and the next [-]

    Returns
    -------
    Densities [1/rad], of none where none falls, shape (angles, motions, levels).
    """
    fell = np.isfinite(predicted.angles)
    sharp = 1.0 / math.radians(MEASURED_WITHIN) ** 2
    away = ANGLES[:, np.newaxis, np.newaxis] - np.where(fell, predicted.angles, 0.0)
    # of von Mises, whose concentration is 1 over the variance
    density = np.exp(sharp * (np.cos(away) - 1)) / (2 * math.pi * special.ive(0, sharp))
    x, count = np.log(predicted.levels), fell.astype(np.float64)
    flat = (density * count).reshape(-1, x.size)
    near = smoothed(x, flat, spread).reshape(density.shape)
    falls = smoothed(x, count, spread)
    return np.divide(near, falls, out=np.zeros_like(near), where=falls > 1e-6)


def shaking_axis(
    falls: Sequence[tuple[Sequence[float], Floats]], weights: Floats
) -> ShakingAxis:
    """Posterior of the axis along which the ground was fastest.

    Parameters
    ----------
    falls : azimuths of each group [degrees], and the density of the angles at which its stones lie, shape
        (angles, motions, levels)
    weights : probability of each motion and level, shape (motions, levels)

    Returns
    -------
    The axis.
    """
    logs = np.zeros((ANGLES.size, *weights.shape))
    for azimuths, density in falls:
        mixed = (1 - OWN_REASONS) * density + OWN_REASONS / (2 * math.pi)
        log_density = np.log(mixed)
        for azimuth in azimuths:
            # the angle of a fall from each axis is one of the angles, turned
            away = (math.radians(azimuth) - ANGLES) % (2 * math.pi)
            place = np.rint(away / math.radians(STEP)).astype(int) % ANGLES.size
            logs += log_density[place]
    with np.errstate(divide="ignore"):
        total = special.logsumexp(logs + np.log(weights), axis=(1, 2))
    chance = np.exp(total - total.max())
    return axis_of(chance / chance.sum())


def axis_of(probability: Floats) -> ShakingAxis:
    """Mean axis of a posterior, and the interval about it.

    An axis is the same after half a turn, so that angles are doubled for the mean.

    Parameters
    ----------
    probability : of each of ``ANGLES``, of sum 1, shape (angles,)

    Returns
    -------
    The axis.
    """
    middle = np.angle(np.sum(probability * np.exp(2j * ANGLES))) / 2
    away = np.abs(np.angle(np.exp(2j * (ANGLES - middle)))) / 2
    order = np.argsort(away)
    reached = np.searchsorted(np.cumsum(probability[order]), INTERVAL)
    within = math.degrees(float(away[order][min(int(reached), away.size - 1)]))
    return ShakingAxis(math.degrees(float(middle)) % 180.0, max(within, STEP / 2))
