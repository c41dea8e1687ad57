"""How sure a verdict is: the share of slightly different experiments that end otherwise.

Whether a rocking body falls depends on its motion and its dimensions without end in detail, and no number of one
history foretells how a neighbouring one ends.  So neighbours are simulated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import real_number, whole_number
from rockfrag.keywords import named_keywords
from rockfrag.rocking.ensemble import overturns
from rockfrag.rocking.inputs import STEP, MotionLike, checked_scales, listed
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag.units import GRAVITY

LARGEST_PERTURBATION = 0.1
"""Beyond this a copy is another experiment."""


@named_keywords
def verdict_sureness(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    *,
    perturbation: float,
    copies: int = 16,
    seed: int = 0,
    restitution: Sequence[Restitution] | None = None,
    vertical: MotionLike | Sequence[MotionLike] | None = None,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Share of perturbed copies of every case whose verdict is the case's own.

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
    restitution, vertical, g, step, threads
        As in :func:`rockfrag.rocking.overturns`; a measured restitution stays as it is.

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
    >>> from rockfrag import Block, Motion, verdict_sureness
    >>> time = np.arange(0, 2, 0.01)
    >>> motion = Motion(np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
    >>> verdict_sureness(Block(0.3, 1.2, 180.0), motion, None, [2.6, 5.0], perturbation=0.01)
    array([[[1., 1.]]])
    """
    size = real_number("perturbation", perturbation)
    if not 0 < size <= LARGEST_PERTURBATION:
        raise InputError(
            f"perturbation: expected a relative change above 0 and up to {LARGEST_PERTURBATION}, got {size:g}."
        )
    if whole_number("copies", copies) < 1:
        raise InputError(f"copies: expected at least one, got {copies}.")
    body_list, values, dts = listed(bodies, motions, dt, restitution)
    factors = checked_scales(scales, values)
    rng = np.random.default_rng(seed)

    def verdicts(of: Sequence[Body], scale: float) -> NDArray[np.bool_]:
        return overturns(
            of, values, dts.tolist(), scale * factors,
            restitution=restitution, vertical=vertical, g=g, step=step, threads=threads,
        ).overturned  # fmt: skip

    given = verdicts(body_list, 1.0)
    same = np.zeros(given.shape)
    for _ in range(copies):
        near = [perturbed(body, size, rng) for body in body_list]
        same += verdicts(near, 1.0 + size * float(rng.uniform(-1, 1))) == given
    return same / copies


def perturbed(body: Body, size: float, rng: np.random.Generator) -> Body:
    """Return a body whose widths and heights differ by at most ``size``, relative, drawn evenly."""
    if isinstance(body, Stack):
        pedestal, statue = (_perturbed(block, size, rng) for block in (body.pedestal, body.statue))
        return replace(body, pedestal=pedestal, statue=statue)
    return _perturbed(body, size, rng)


def _perturbed(block: Block, size: float, rng: np.random.Generator) -> Block:
    across, up = (1 + size * rng.uniform(-1, 1, 2)).tolist()
    height = None if block.cg_height is None else block.cg_height * up
    return replace(block, width=block.width * across, height=block.height * up, cg_height=height)
