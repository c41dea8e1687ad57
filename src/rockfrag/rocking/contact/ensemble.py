"""Many bodies × motions × amplitudes at once, with friction, flight and vertical motion."""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Body
from rockfrag.rocking.contact._body import BODY, OUTCOME, contact_body, posed, working_memory
from rockfrag.rocking.contact._march import EVENT, HISTORY, march_cases
from rockfrag.rocking.contact.friction import FrictionInput, interface_frictions
from rockfrag.rocking.inputs import STEP, checked_scales, free_samples, listed, step_count
from rockfrag.rocking.kernels.jit import compiling_alone
from rockfrag.units import STANDARD_GRAVITY

Array = NDArray[np.float64]

COARSE_CLOSING = 1e-4
"""Parting speed over √(g b) below which a contact stays closed after an impact, where only the verdict matters."""

CHUNK = 16  # cases that a thread takes at once


@dataclass(frozen=True)
class ContactEnsemble:
    """Verdicts and peak responses; arrays have shape (bodies, motions, scales), those of slip (…, 2).

    Attributes
    ----------
    overturned
        Whether a block fell, over a corner or over the edge.
    overturned_body
        0 none, 1 the pedestal, 2 the statue or the lone block.
    overturning_time
        When it lay down or left the edge [s], NaN if it did not.
    peak_rotation
        Largest rotation over the critical angle [-] of the statue or lone block; infinite if it fell.
    slip, peak_slip
        Displacement at the end, and the largest, along (ground, interface) [m]; of a lone block (ground, 0).
    impacts
        Number of impacts.
    paradoxes
        Times that no mode was consistent (``docs/contact.md``, 7).
    """

    overturned: NDArray[np.bool_]
    overturned_body: NDArray[np.int8]
    overturning_time: Array
    peak_rotation: Array
    slip: Array
    peak_slip: Array
    impacts: NDArray[np.int64]
    paradoxes: NDArray[np.int64]


def overturns_with_friction(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    scales: ArrayLike,
    *,
    friction: Sequence[FrictionInput],
    vertical: Sequence[ArrayLike] | None = None,
    g: float = STANDARD_GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> ContactEnsemble:
    """Say for every body × motion × scale whether it falls when it may slide, rock and fly.

    Parameters
    ----------
    bodies
        Blocks and stacks.
    accelerations
        Horizontal motions [m/s²], each of shape (n,), linear between samples and zero one sample after the last.
    dt
        Sampling interval [s], one or one per motion.
    scales
        Factors on the accelerations, vertical ones too, shape (scales,) or (motions, scales).
    friction
        One entry per body, each as in :func:`simulate_with_friction`.
    vertical
        Vertical motions [m/s²], one per horizontal one and as long.
    g
        Acceleration of gravity [m/s²].
    step
        Largest product of the frequency parameter and the step [-].
    threads
        Threads to use; all cores if None.  Results do not depend on it.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    body_list, values, dts = listed(bodies, accelerations, dt, None)
    factors = checked_scales(scales, values)
    if len(friction) != len(body_list):
        raise InputError(f"friction: expected {len(body_list)} entries, one per body.")
    up = np.zeros(0)
    if vertical is not None:
        _, upward, _ = listed(body_list, list(vertical), dts.tolist(), None)
        for i, (one, other) in enumerate(zip(values, upward, strict=True)):
            if one.size != other.size:
                raise InputError(
                    f"vertical[{i}]: {other.size} samples for {one.size} horizontal ones."
                )
        up = np.concatenate(upward)
    table = np.zeros(len(body_list), BODY)
    starts = np.zeros((len(body_list), 2, 6))
    for i, (body, coefficients) in enumerate(zip(body_list, friction, strict=True)):
        table[i] = contact_body(body, interface_frictions(body, coefficients), g)
        starts[i] = posed(table[i], np.zeros(2), np.zeros(2))
    steps = np.array([step_count(body, dts, g, step) for body in body_list])
    free = np.array([free_samples(body, dts, g) for body in body_list])
    shape = (len(body_list), *factors.shape)
    outcome = np.zeros(int(np.prod(shape)), OUTCOME)
    offsets = np.concatenate([[0], np.cumsum([v.size for v in values])])
    arguments = (
        table, np.concatenate(values), up, offsets, dts, factors, steps, free, COARSE_CLOSING, starts,
        outcome, np.zeros((0, HISTORY)), np.zeros((0, EVENT)),
    )  # fmt: skip
    with compiling_alone(march_cases):
        march_cases(0, 0, *arguments, working_memory())

    def work(first: int) -> None:
        march_cases(first, min(first + CHUNK, outcome.size), *arguments, working_memory())

    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        list(pool.map(work, range(0, outcome.size, CHUNK)))
    found = outcome.reshape(shape)
    lone = (table["count"] == 1)[:, np.newaxis, np.newaxis]
    fallen = found["fallen"] > 0
    upper = np.where(lone, found["peak"][..., 0], found["peak"][..., 1])
    return ContactEnsemble(
        overturned=fallen,
        overturned_body=np.where(lone & fallen, 2, found["fallen"]).astype(np.int8),
        overturning_time=np.where(fallen, found["time"], np.nan),
        peak_rotation=np.where(fallen, np.inf, upper),
        slip=found["slip"].copy(),
        peak_slip=found["peak_slip"].copy(),
        impacts=found["impacts"].copy(),
        paradoxes=found["paradoxes"].copy(),
    )
