"""Every trial × every test simulated: does the object overturn?"""

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.spatial import run_in_space
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.rocking.ensemble import LightBodies, overturns
from rockfrag.rocking.inputs import checked_threads
from rockfrag.system.system import System

BATCH = 50  # motions whose outcomes are in memory at a time


def shaken(systems: Sequence[System], motions: Sequence[Motion], threads: int | None) -> Outcomes:
    """Return outcomes of planar bodies, or of bodies in space, under one component each."""
    if systems[0].planar:
        return overturns(systems, motions, threads=threads)
    shaking = [GroundMotion(motion) for motion in motions]
    return run_in_space(systems, shaking, threads=checked_threads(threads))


def simulate_tests(
    systems: Sequence[System], motions: Sequence[Motion], threads: int | None = None
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether a body overturns, and whether any rocks, shape (trials, tests)."""
    overturned, rocked = np.zeros((2, len(systems), len(motions)), dtype=bool)
    for first in range(0, len(motions), BATCH):
        batch = motions[first : first + BATCH]
        with warnings.catch_warnings():
            # a guess may be squat where the object is not
            warnings.simplefilter("ignore", LightBodies)
            result = shaken(systems, batch, threads)
        overturned[:, first : first + len(batch)] = result.overturned[:, :, 0]
        rocked[:, first : first + len(batch)] = (result.peak_rotation[:, :, 0] > 0).any(axis=-1)
    return overturned, rocked
