"""Records that shake blocks of many sizes, each at levels of its own peaks.

In: both components of records, and sizes [m]. Out: :class:`rockfrag.effects.toppling_velocity.Shaken`. Theory and
results: ``docs/toppling-velocity.md``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.effects.toppling_velocity import (
    Pair,
    Shaken,
    acceleration_levels,
    earthquake_weights,
    shaken_in_plane,
    shaken_in_space,
    velocity_levels,
)
from rockfrag.fragility.toppling_velocity import MEASURES
from rockfrag.motions.intensity import pgv
from rockfrag.records.motion import Motion

VELOCITIES = np.geomspace(0.06, 6.0, 45)  # levels over Kaneko's velocity
ACCELERATIONS = np.geomspace(0.8, 40.0, 45)  # levels over uplift
FEWER = np.geomspace(0.15, 3.5, 16)  # velocities in space and with friction
FEWER_ACCELERATIONS = np.geomspace(0.4, 30.0, 20)  # accelerations in space
SEED = 55


@dataclass(frozen=True)
class Records:
    """Both components of records, and their earthquakes.

    Attributes
    ----------
    pairs : both components of each record, on one time base
    earthquakes : of each record
    """

    pairs: Sequence[Pair]
    earthquakes: Sequence[str]

    @cached_property
    def motions(self) -> list[Motion]:
        """Components one after the other, shape (2 × records,)."""
        return [motion for pair in self.pairs for motion in pair]

    @cached_property
    def velocities(self) -> Floats:
        """PGV of both components of each record, shape (records, 2) [m/s]."""
        return np.array([[pgv(motion) for motion in pair] for pair in self.pairs])

    @cached_property
    def accelerations(self) -> Floats:
        """PGA likewise [g]."""
        peaks = [[motion.pga for motion in pair] for pair in self.pairs]
        return np.array(peaks) / GRAVITY

    def peaks(self, measure: str) -> Floats:
        """Peaks of both components in a measure, shape (records, 2)."""
        return self.velocities if measure == MEASURES[0] else self.accelerations

    def weights(self, standing: str) -> Floats:
        """How often each motion, or each record of bodies in space, counts if earthquakes are drawn anew."""
        of_records = earthquake_weights(self.earthquakes, seed=SEED)
        return np.repeat(of_records, 2, axis=1) if standing == "plane" else of_records

    def shake(self, sizes: Floats, standing: str, measure: str) -> Shaken:
        """Shake blocks of sizes at levels of a measure."""
        peaks = self.peaks(measure)
        is_velocity = measure == MEASURES[0]
        if standing != "plane":
            mean = np.sqrt(peaks.prod(axis=1))
            levels = acceleration_levels(sizes, FEWER_ACCELERATIONS)
            if is_velocity:
                levels = velocity_levels(sizes, FEWER)
            return shaken_in_space(sizes, standing, self.pairs, mean, levels)
        levels = acceleration_levels(sizes, ACCELERATIONS)
        if is_velocity:
            levels = velocity_levels(sizes, VELOCITIES)
        return shaken_in_plane(sizes, self.motions, peaks.ravel(), levels)
