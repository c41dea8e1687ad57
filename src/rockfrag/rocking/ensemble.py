"""Many bodies × motions × amplitudes at once."""

import math
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking import _march as kmarch
from rockfrag.rocking._ensemble import march_cases
from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.parameters import Restitution, body_parameters
from rockfrag.rocking.simulation import (
    CLOSING_SPEED,
    FREE_TIME,
    STEP,
    checked_acceleration,
    slowest_frequency,
    step_count,
)
from rockfrag.units import STANDARD_GRAVITY

CHUNK = 256
"""Cases a thread takes at a time."""


@dataclass(frozen=True)
class EnsembleResult:
    """Verdicts and peak responses; every array has shape (bodies, motions, scales).

    Attributes
    ----------
    overturned
        Whether a block fell.
    overturned_body
        0 none, 1 the pedestal, 2 the statue or the lone block.
    overturning_time
        When it lay down [s], NaN if it did not.
    peak_rotation
        Largest rotation over the critical angle [-] of the statue or lone block.
    peak_rotation_pedestal
        Likewise of the pedestal with what stands on it; 0 for a lone block.
    peak_velocity
        Largest |θ'| of the statue or lone block [rad/s].
    impacts
        Number of impacts.
    closest_approach
        Least distance from an unstable equilibrium, as in :class:`Response`; infinite if it never rocked.
    """

    overturned: NDArray[np.bool_]
    overturned_body: NDArray[np.int8]
    overturning_time: NDArray[np.float64]
    peak_rotation: NDArray[np.float64]
    peak_rotation_pedestal: NDArray[np.float64]
    peak_velocity: NDArray[np.float64]
    impacts: NDArray[np.int64]
    closest_approach: NDArray[np.float64]


def _listed(accelerations: ArrayLike | Sequence[ArrayLike]) -> list[ArrayLike]:
    if isinstance(accelerations, np.ndarray) and accelerations.ndim == 1:
        return [accelerations]
    return list(accelerations)  # type: ignore[arg-type]


def overturns(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    scales: ArrayLike,
    *,
    restitution: Sequence[Restitution] | None = None,
    g: float = STANDARD_GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> EnsembleResult:
    """Say for every body × motion × scale whether it overturns.

    Parameters
    ----------
    bodies
        Blocks and stacks.
    accelerations
        Motions [m/s²], each of shape (n,).
    dt
        Sampling interval [s], one or one per motion.
    scales
        Factors on the accelerations, shape (scales,) for all motions or (motions, scales).
    restitution
        One entry per body, each as in :func:`simulate`; None conserves momentum in all.
    step
        Largest p h of a step: smaller is more accurate and slower.
    threads
        Threads to use; all cores if None.  Results do not depend on it.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    body_list = [bodies] if isinstance(bodies, (Block, Stack)) else list(bodies)
    motions = _listed(accelerations)
    dts = np.broadcast_to(np.asarray(dt, dtype=float), (len(motions),)).copy()
    values = [
        checked_acceleration(motion, float(step_), f"accelerations[{i}]")
        for i, (motion, step_) in enumerate(zip(motions, dts, strict=True))
    ]
    factors = np.asarray(scales, dtype=float)
    if factors.ndim == 1:
        factors = np.broadcast_to(factors, (len(motions), factors.size))
    if factors.ndim != 2 or factors.shape[0] != len(motions) or not np.isfinite(factors).all():
        raise InputError(
            f"scales: expected finite numbers of shape (scales,) or ({len(motions)}, scales), "
            f"got shape {np.shape(scales)}."
        )
    if restitution is not None and len(restitution) != len(body_list):
        raise InputError(
            f"restitution: expected {len(body_list)} entries, one per body, got {len(restitution)}."
        )
    if not (math.isfinite(step) and step > 0):
        raise InputError(f"step: expected a positive number, got {step}.")
    per_body = restitution if restitution is not None else [None] * len(body_list)
    parameters = np.array(
        [body_parameters(body, e, g=g) for body, e in zip(body_list, per_body, strict=True)]
    )
    substeps = np.array([[step_count(body, d, g, step) for d in dts] for body in body_list])
    free = np.array(
        [[math.ceil(FREE_TIME / slowest_frequency(body, g) / d) for d in dts] for body in body_list]
    )
    samples = np.concatenate(values)
    offsets = np.concatenate([[0], np.cumsum([v.size for v in values])])
    shape = (len(body_list), *factors.shape)
    results = np.empty((math.prod(shape), kmarch.SUMMARY))
    factors = np.ascontiguousarray(factors)

    def work(first: int) -> None:
        last = min(first + CHUNK, len(results))
        march_cases(
            first, last, parameters, substeps, free, samples, offsets, dts, factors,
            CLOSING_SPEED, results[first:last],
        )  # fmt: skip

    starts = range(0, len(results), CHUNK)
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        list(pool.map(work, starts))
    table = results.reshape(*shape, kmarch.SUMMARY)
    return EnsembleResult(
        overturned=table[..., kmarch.FALLEN] > 0,
        overturned_body=table[..., kmarch.FALLEN].astype(np.int8),
        overturning_time=table[..., kmarch.FALL_TIME].copy(),
        peak_rotation=table[..., kmarch.RATIO2].copy(),
        peak_rotation_pedestal=table[..., kmarch.RATIO1].copy(),
        peak_velocity=table[..., kmarch.SPEED2].copy(),
        impacts=table[..., kmarch.IMPACTS].astype(np.int64),
        closest_approach=table[..., kmarch.CLOSEST].copy(),
    )
