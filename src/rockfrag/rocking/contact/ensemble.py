"""Many bodies × motions × amplitudes at once, with friction, flight and vertical motion."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.planar.integrate import Book, Cases, integrate_cases
from rockfrag.engines.planar.records import BODY, MOST, OUTCOME, posed, working_memory
from rockfrag.rocking.contact.friction import contact_record
from rockfrag.rocking.inputs import free_samples, step_count
from rockfrag.system.blocks import Body
from rockfrag.system.contact import Friction

Array = NDArray[np.float64]

COARSE_CLOSING = 1e-4
"""Parting speed over √(g b) below which a contact stays closed after an impact, where only the verdict matters."""

CHUNK = 4
"""Cases that a thread takes at once."""


class Standing(NamedTuple):
    """Bodies that may slide, and how each begins: rotations and angular velocities of its blocks."""

    bodies: Sequence[Body]
    frictions: Sequence[tuple[Friction, ...]]
    theta0: Sequence[Sequence[float]]
    omega0: Sequence[Sequence[float]]


class Moving(NamedTuple):
    """Motions of the ground.

    Attributes
    ----------
    horizontal, vertical
        Accelerations of each motion [m/s²]; no vertical ones are zero.
    dts
        Sampling intervals [s], shape (motions,).
    factors
        Scales on both, shape (motions, scales).
    """

    horizontal: Sequence[Array]
    vertical: Sequence[Array]
    dts: Array
    factors: Array


def contact_outcomes(
    standing: Standing,
    moving: Moving,
    wanted: NDArray[np.bool_],
    g: float,
    step: float,
    threads: int,
) -> NDArray[np.void]:
    """Integrate the ``wanted`` cases of bodies × motions × scales.

    Parameters
    ----------
    wanted
        Which cases to integrate, shape (bodies, motions, scales); the others are left zero.
    g, step, threads
        As in :func:`rockfrag.rocking.overturns`.

    Returns
    -------
    Outcomes, (bodies, motions, scales) of ``OUTCOME``.
    """
    bodies, dts = standing.bodies, moving.dts
    table = np.zeros(len(bodies), BODY)
    starts = np.zeros((len(bodies), 2, 3 * MOST))
    for i, (body, friction, *start) in enumerate(zip(*standing, strict=True)):
        table[i] = contact_record(body, friction, g)
        starts[i] = posed(table[i], *start)
    cases = Cases(
        bodies=table,
        starts=starts,
        horizontal=np.concatenate(moving.horizontal),
        vertical=np.concatenate(moving.vertical) if moving.vertical else np.zeros(0),
        offsets=np.concatenate([[0], np.cumsum([v.size for v in moving.horizontal])]),
        dts=dts,
        factors=moving.factors,
        substeps=np.array([step_count(body, dts, g, step) for body in bodies]),
        free_samples=np.array([free_samples(body, dts, g) for body in bodies]),
    )
    outcome = np.zeros(wanted.size, OUTCOME)
    numbers = np.flatnonzero(wanted)
    book = Book(np.zeros((0, 0)), np.zeros((0, 0)))

    def work(first: int, last: int) -> None:
        integrate_cases(numbers[first:last], cases, COARSE_CLOSING, book, working_memory(), outcome)

    work(0, 0)
    with ThreadPoolExecutor(threads) as pool:
        firsts = range(0, numbers.size, CHUNK)
        list(pool.map(work, firsts, [first + CHUNK for first in firsts]))
    return outcome.reshape(wanted.shape)
