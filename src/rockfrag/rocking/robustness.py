"""How sure an outcome is: the fraction of slightly different experiments that end otherwise.

Whether a rocking body falls depends on its motion and its dimensions without end in detail, and no number of one
history predicts how a neighbouring one ends.  So neighbours are simulated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import real_number, whole_number
from rockfrag.keywords import named_keywords
from rockfrag.rocking.ensemble import Options, prepared, shaken
from rockfrag.rocking.inputs import MotionLike
from rockfrag.system.blocks import SystemLike
from rockfrag.system.perturbation import perturbed

LARGEST_PERTURBATION = 0.1  # beyond this a copy is another experiment


@named_keywords
def outcome_robustness(
    bodies: SystemLike | Sequence[SystemLike],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    *,
    perturbation: float,
    copies: int = 16,
    seed: int = 0,
    **options: Unpack[Options],
) -> NDArray[np.float64]:
    """Fraction of perturbed copies of every case whose outcome is the case's own.

    Each copy has a motion, and widths and heights of its blocks, that are larger or smaller by at most
    ``perturbation``, drawn evenly and independently; one draw serves all cases of a copy.

    Parameters
    ----------
    bodies, motions, dt, scales
        The ensemble, as in :func:`rockfrag.rocking.overturns`.
    perturbation
        Largest relative change [-], such as 1e-6.
    copies
        Number of copies.
    seed
        Seed of the draws.
    **options
        As in :func:`rockfrag.rocking.overturns`, but for ``forces``; measured restitution, friction and start stay
        as they are.

    Returns
    -------
    Shares from 0 to 1, shape (bodies, motions, scales): 1 where no copy ends otherwise.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.

    Examples
    --------
    >>> import numpy as np
    >>> from rockfrag import Block, Motion, outcome_robustness
    >>> time = np.arange(0, 2, 0.01)
    >>> motion = Motion(np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
    >>> outcome_robustness(Block(0.3, 1.2, 180.0), motion, None, [2.6, 5.0], perturbation=0.01)
    array([[[1., 1.]]])
    """
    size = real_number("perturbation", perturbation)
    if not 0 < size <= LARGEST_PERTURBATION:
        raise InputError(
            f"perturbation: expected a relative change above 0 and up to {LARGEST_PERTURBATION}, got {size:g}."
        )
    if whole_number("copies", copies) < 1:
        raise InputError(f"copies: expected at least one, got {copies}.")
    cases = prepared(bodies, motions, dt, scales, **options)
    rng = np.random.default_rng(seed)
    given = shaken(cases).overturned
    same = np.zeros(given.shape)
    for _ in range(copies):
        near = tuple(perturbed(system, size, rng) for system in cases.systems)
        scale = 1.0 + size * float(rng.uniform(-1, 1))
        found = shaken(replace(cases, systems=near, scales=scale * cases.scales))
        same += found.overturned == given
    return same / copies
