"""The worst direction: how much worse it is to be shaken along the worst direction of each record."""

import math
from dataclasses import dataclass

import numpy as np

from rockfrag.assess.motions import MotionSet, common_pair
from rockfrag.assess.objects import Objects
from rockfrag.assess.outcomes import IntensityLevels, believable_scales, fraction_at, simulated
from rockfrag.motions.rotation import rotate

STEP_DEG = 15
"""Angle between directions that are tried [degrees]."""


@dataclass(frozen=True)
class Directions:
    """Fraction of the records that topple the object, by how it stands to them."""

    # Level that topples half of the records in their worst direction over the one in any direction
    # [-]; NaN where neither reaches half
    factor: float
    # Fraction of records and directions, and of records in their worst direction, that topple the
    # object at the level asked about; NaN where none was
    fraction: float
    worst_fraction: float
    records: int  # Number of records with two components


def find_directions(
    objects: Objects, motions: MotionSet, intensity_levels: IntensityLevels, level: float | None
) -> Directions | None:
    """Turn every record of two components through all directions; None where no record has two.

    The level of a record is the geometric mean of its components, so that it does not turn with it.
    """
    if not motions.pairs:
        return None
    system = objects.system_of(objects.body)
    # opposite directions are alike to a system that is alike on both sides
    upright = all(contact.tilt == contact.offset[0] == 0 for contact in system.contacts)
    symmetric = upright and all(shape.x == 0 for shape in system.shapes)
    angles = range(0, 180 if symmetric else 360, STEP_DEG)
    values = motions.values(intensity_levels.measure)
    shaking, scales = [], []
    for pair in motions.pairs:
        first, other = common_pair(motions, pair)
        middle = float(np.sqrt(values[pair[0]] * values[pair[1]]))
        for angle in angles:
            shaking.append(rotate(first, other, angle))
            scales.append(intensity_levels.levels / middle)
    believable = np.minimum(np.array(scales), believable_scales(shaking))
    found, _ = simulated([system], shaking, believable)
    fallen = found.overturned[0]
    by_record = fallen.reshape(len(motions.pairs), len(angles), -1)
    anyhow, worst = by_record.mean(axis=(0, 1)), by_record.any(axis=1).mean(axis=0)
    x = np.log(intensity_levels.levels)
    at = (math.nan if level is None else level, intensity_levels.levels)
    return Directions(
        factor=float(np.exp(_half(x, worst) - _half(x, anyhow))),
        fraction=fraction_at(*at, anyhow),
        worst_fraction=fraction_at(*at, worst),
        records=len(motions.pairs),
    )


def _half(x: np.ndarray, fraction: np.ndarray) -> float:
    reached = np.flatnonzero(fraction >= 0.5)
    if not reached.size or reached[0] == 0:
        return float("nan")
    i = int(reached[0])
    return float(np.interp(0.5, fraction[i - 1 : i + 1], x[i - 1 : i + 1]))
