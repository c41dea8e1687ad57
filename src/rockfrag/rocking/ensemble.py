"""Many bodies × motions × amplitudes at once."""

import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.rocking import _lanes as lanes
from rockfrag.rocking import _stack_lanes as stack_lanes
from rockfrag.rocking._compile import compiling_alone
from rockfrag.rocking._mechanics import BODY
from rockfrag.rocking._rest import BLOCK
from rockfrag.rocking._stack_cases import OUTCOME
from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.inputs import (
    COARSE_CLOSING_SPEED,
    STACK_STEP,
    STEP,
    checked_scales,
    free_samples,
    listed,
    step_count,
)
from rockfrag.rocking.parameters import Restitution, body_parameters, lone_restitution
from rockfrag.units import STANDARD_GRAVITY

Array = NDArray[np.float64]


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
        Time at which the fall was certain whatever followed [s], NaN without a fall.
    peak_rotation
        Largest rotation over the critical angle [-] of the statue or lone block; infinite if it fell.
    peak_rotation_pedestal
        Likewise of the pedestal with what stands on it; 0 for a lone block.
    peak_velocity
        Largest |θ'| of the statue or lone block until the verdict was certain [rad/s].
    impacts
        Number of impacts until the verdict was certain.
    closest_approach
        Least distance from an unstable equilibrium, as in :class:`Response`; infinite if it never rocked.
    """

    overturned: NDArray[np.bool_]
    overturned_body: NDArray[np.int8]
    overturning_time: Array
    peak_rotation: Array
    peak_rotation_pedestal: Array
    peak_velocity: Array
    impacts: NDArray[np.int64]
    closest_approach: Array


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
        Motions [m/s²], each of shape (n,), linear between samples and zero one sample after the last.
    dt
        Sampling interval [s], one or one per motion.
    scales
        Factors on the accelerations, shape (scales,) for all motions or (motions, scales).
    restitution
        One entry per body, each as in :func:`simulate`; None conserves momentum in all.
    g
        Gravity [m/s²].
    step
        Largest p h of a step, of which a stack takes 0.35 while both its blocks rotate: smaller is more accurate
        and slower.
    threads
        Threads to use; all cores if None.  Results do not depend on it.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    body_list, values, dts = listed(bodies, accelerations, dt, restitution)
    factors = checked_scales(scales, len(values))
    workers = threads or os.cpu_count() or 1
    per_body: Sequence[Restitution]
    per_body = restitution if restitution is not None else [None] * len(body_list)
    shape = (len(body_list), *factors.shape)
    result = EnsembleResult(
        overturned=np.zeros(shape, dtype=bool),
        overturned_body=np.zeros(shape, dtype=np.int8),
        overturning_time=np.full(shape, np.nan),
        peak_rotation=np.zeros(shape),
        peak_rotation_pedestal=np.zeros(shape),
        peak_velocity=np.zeros(shape),
        impacts=np.zeros(shape, dtype=np.int64),
        closest_approach=np.full(shape, np.inf),
    )
    lone = [i for i, body in enumerate(body_list) if isinstance(body, Block)]
    stacks = [i for i, body in enumerate(body_list) if isinstance(body, Stack)]
    for chosen, run in ((lone, _lone_blocks), (stacks, _stacks)):
        if chosen and factors.size:
            run(
                [body_list[i] for i in chosen],
                [per_body[i] for i in chosen],
                values, dts, factors, g, step, workers, result, np.array(chosen),
            )  # fmt: skip
    return result


def _in_parallel(
    kernel: Any,
    working_arrays: Callable[[], tuple[NDArray[Any], ...]],
    workers: int,
    count: int,
    *arguments: object,
    halves: tuple[Callable[[], None], Callable[[], None]] | None = None,
) -> None:
    """Let threads call ``kernel``, each with working arrays of its own, until no case is left."""
    with compiling_alone(kernel, halves):
        kernel(np.array([0]), 0, *arguments, *working_arrays())
    counter = np.array([0])

    def work(_: int) -> None:
        kernel(counter, count, *arguments, *working_arrays())

    with ThreadPoolExecutor(workers) as pool:
        list(pool.map(work, range(workers)))


@dataclass(frozen=True)
class _Motions:
    """All motions end to end, sampled as densely as the bodies need."""

    samples: Array
    highest: Array  # extremes of each BLOCK of samples
    lowest: Array
    offsets: NDArray[np.int64]  # where each sampled motion begins
    lasts: NDArray[np.int64]  # its last sample, which is zero
    rows: NDArray[np.int64]  # (bodies, motions) which of the sampled motions to use
    intervals: Array  # (bodies, motions) its sampling interval [s]


def _sampled(
    bodies: list[Body], values: list[Array], dts: Array, g: float, step: float
) -> _Motions:
    # a body that needs shorter steps than the samples gets the motion sampled more densely
    times = np.array([step_count(body, dts, g, step) for body in bodies])
    times = 2 ** np.ceil(np.log2(times)).astype(int)
    kinds, number = np.unique(times * len(values) + np.arange(len(values)), return_inverse=True)
    sampled = [_refined(values[kind % len(values)], kind // len(values)) for kind in kinds.tolist()]
    # whole blocks each, so that no block straddles two motions
    padded = [np.append(v, np.zeros(-v.size % BLOCK)) for v in sampled]
    offsets = np.concatenate([[0], np.cumsum([v.size for v in padded])])
    samples = np.concatenate(padded)
    blocks = samples.reshape(-1, BLOCK)
    return _Motions(
        samples=samples,
        highest=blocks.max(axis=1),
        lowest=blocks.min(axis=1),
        offsets=offsets,
        lasts=offsets[:-1] + np.array([v.size for v in sampled]) - 1,
        rows=number.reshape(times.shape),
        intervals=dts[np.newaxis, :] / times,
    )


def _refined(values: Array, times: int) -> Array:
    """Sample a piecewise linear motion ``times`` as densely, and let it end in zero."""
    closed = np.append(values, 0.0)
    if times == 1:
        return closed
    at = np.arange((closed.size - 1) * times + 1) / times
    return np.asarray(np.interp(at, np.arange(closed.size), closed))


def _stacks(
    bodies: list[Body],
    restitution: list[Restitution],
    values: list[Array],
    dts: Array,
    factors: Array,
    g: float,
    step: float,
    workers: int,
    result: EnsembleResult,
    rows: NDArray[np.intp],
) -> None:
    records = np.array(
        [body_parameters(body, e, g=g) for body, e in zip(bodies, restitution, strict=True)], BODY
    )
    motions = _sampled(bodies, values, dts, g, step)
    free = np.array(
        [free_samples(body, h, g) for body, h in zip(bodies, motions.intervals, strict=True)]
    )
    shape = (len(bodies), *factors.shape)
    shares = [
        step_count(body, h, g, STACK_STEP * step)
        for body, h in zip(bodies, motions.intervals, strict=True)
    ]
    parts = 1.0 / np.array(shares)
    outcome = np.empty(math.prod(shape), OUTCOME)

    _in_parallel(
        stack_lanes.stack_cases, stack_lanes.working_arrays, workers, len(outcome), records,
        motions.intervals, parts, free, factors, motions.rows, motions.offsets, motions.lasts, motions.samples,
        motions.highest, motions.lowest, COARSE_CLOSING_SPEED, outcome,
        halves=(stack_lanes.compile_events, stack_lanes.compile_others),
    )  # fmt: skip
    outcome = outcome.reshape(shape)
    fallen = outcome["fallen"]
    interval = motions.intervals[:, :, np.newaxis]
    result.overturned[rows] = fallen > 0
    result.overturned_body[rows] = fallen
    result.overturning_time[rows] = np.where(fallen > 0, outcome["certain"] * interval, np.nan)
    result.peak_rotation[rows] = np.where(fallen == 2, np.inf, outcome["peak2"])
    result.peak_rotation_pedestal[rows] = np.where(fallen == 1, np.inf, outcome["peak1"])
    result.peak_velocity[rows] = outcome["fast"] / interval
    result.impacts[rows] = outcome["impacts"]
    result.closest_approach[rows] = outcome["closest"]


def _lone_blocks(
    bodies: list[Body],
    restitution: list[Restitution],
    values: list[Array],
    dts: Array,
    factors: Array,
    g: float,
    step: float,
    workers: int,
    result: EnsembleResult,
    rows: NDArray[np.intp],
) -> None:
    shape = (len(bodies), *factors.shape)
    motions = _sampled(bodies, values, dts, g, step)
    intervals = motions.intervals
    bounds = zip(motions.offsets[:-1], motions.offsets[1:], strict=True)
    parts = [slice(i // BLOCK, j // BLOCK) for i, j in bounds]
    # largest and smallest sample from the beginning of a block to the end of its motion
    ahead_high = np.concatenate(
        [np.maximum.accumulate(motions.highest[part][::-1])[::-1] for part in parts]
    )
    ahead_low = np.concatenate(
        [np.minimum.accumulate(motions.lowest[part][::-1])[::-1] for part in parts]
    )
    table = np.empty((len(bodies), len(values), lanes.BODY))
    for i, (body, e) in enumerate(zip(bodies, restitution, strict=True)):
        assert isinstance(body, Block)
        table[i] = _lane_row(body, e, g)
        for pole in (0, lanes.POLE):
            table[i, :, pole + lanes.SWING] *= intervals[i] ** 2
            table[i, :, pole + lanes.PER_SWING] /= intervals[i] ** 2
    per_g = factors / g
    outcome = np.empty((math.prod(shape), lanes.RESULTS))

    _in_parallel(
        lanes.lone_blocks, lanes.working_arrays, workers, len(outcome), table.ravel(), per_g, motions.rows,
        motions.offsets, motions.lasts, motions.samples, motions.highest, motions.lowest, ahead_high,
        ahead_low, outcome.reshape(-1),
    )  # fmt: skip
    outcome = outcome.reshape(*shape, lanes.RESULTS)
    fallen = outcome[..., lanes.OVERTURNED] > 0
    interval = intervals[:, :, np.newaxis]
    result.overturned[rows] = fallen
    result.overturned_body[rows] = 2 * fallen
    result.overturning_time[rows] = np.where(fallen, outcome[..., lanes.CERTAIN] * interval, np.nan)
    result.peak_rotation[rows] = np.where(fallen, np.inf, outcome[..., lanes.RATIO])
    result.peak_velocity[rows] = outcome[..., lanes.SPEED] / interval
    result.impacts[rows] = outcome[..., lanes.IMPACTS]
    result.closest_approach[rows] = outcome[..., lanes.CLOSEST]


def _lane_row(body: Block, restitution: Restitution, g: float) -> Array:
    """Entries of the lanes' body table, with p² where p² dt² belongs."""
    row = np.empty(lanes.BODY)
    measured = lone_restitution(body, restitution)
    for pole, at in ((+1, 0), (-1, lanes.POLE)):
        alpha = body.critical_angle(pole)
        row[at + lanes.ALPHA] = alpha
        row[at + lanes.TAN] = math.tan(alpha)
        row[at + lanes.SIN] = math.sin(alpha)
        row[at + lanes.COS] = math.cos(alpha)
        row[at + lanes.SWING] = body.frequency(pole, g) ** 2
        row[at + lanes.PER_ALPHA] = 1 / alpha
        row[at + lanes.PER_SWING] = 1 / (row[at + lanes.SWING] * alpha**2)
        row[at + lanes.E_FROM] = body.momentum_restitution(pole) if measured is None else measured
    return row
