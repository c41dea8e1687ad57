"""Every trial × every test simulated: does the object overturn?"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rockfrag.campaign.trials import Trials
from rockfrag.records.motion import Motion
from rockfrag.rocking.ensemble import overturns

BATCH = 50
"""Motions simulated between two reports of progress."""


def simulate_tests(
    trials: Trials,
    motions: Sequence[Motion],
    threads: int | None = None,
    done: Callable[[int], None] = lambda count: None,
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Simulate each test under each trial.

    Parameters
    ----------
    trials
        What stood on the table in each.
    motions
        Motion of the table in each test.
    threads
        Threads to use; all cores if None.
    done
        Called with the number of tests done after each batch.

    Returns
    -------
    Whether the object overturns, and whether it rocks at all, each of shape (trials, tests).
    """
    overturned, rocked = np.zeros((2, len(trials.systems), len(motions)), dtype=bool)
    for first in range(0, len(motions), BATCH):
        batch = motions[first : first + BATCH]
        result = overturns(trials.systems, batch, threads=threads)
        overturned[:, first : first + len(batch)] = result.overturned[:, :, 0]
        rocked[:, first : first + len(batch)] = result.peak_rotation[:, :, 0, 0] > 0
        done(first + len(batch))
    return overturned, rocked
