"""Many bodies × motions × amplitudes at once."""

import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.body_record import Restitution, body_record, lone_restitution
from rockfrag.rocking.inputs import (
    STACK_STEP,
    STEP,
    checked_scales,
    free_samples,
    listed,
    step_count,
)
from rockfrag.rocking.kernels.equations import BODY
from rockfrag.rocking.kernels.jit import compiling_alone
from rockfrag.rocking.kernels.lanes import block, stack_case
from rockfrag.rocking.kernels.lanes.case import BLOCK, OUTCOME, Ensemble, Motions
from rockfrag.rocking.kernels.lanes.scheduler import march_stacks
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


@dataclass(frozen=True)
class _Setting:
    """What the bodies of an ensemble are shaken with, and how."""

    motions: list[Array]
    dts: Array
    factors: Array
    g: float
    step: float
    threads: int


_Found = tuple[NDArray[np.void], Array]
"""Outcomes, (bodies, motions, scales) of OUTCOME, and the sampling intervals they count time in [s]."""


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
    setting = _Setting(values, dts, factors, g, step, workers)
    lone = [i for i, body in enumerate(body_list) if isinstance(body, Block)]
    stacks = [i for i, body in enumerate(body_list) if isinstance(body, Stack)]
    for chosen, march in ((lone, _blocks), (stacks, _stacks)):
        if chosen and factors.size:
            found = march(setting, [body_list[i] for i in chosen], [per_body[i] for i in chosen])
            _fill(result, np.array(chosen), found)
    return result


def _march(kernel: Any, worker: Callable[[], Any], threads: int, *arguments: Any) -> None:
    """Let threads call an entry kernel, each with memory of its own, until no case is left."""
    ensemble, *others = arguments
    with compiling_alone(kernel):
        kernel(ensemble._replace(count=0), *others[:-1], worker(), others[-1])
    ensemble.counter[0] = 0

    def work(_: int) -> None:
        kernel(ensemble, *others[:-1], worker(), others[-1])

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(threads)))


def _sampled(
    bodies: list[Body], values: list[Array], dts: Array, g: float, step: float
) -> tuple[Motions, NDArray[np.int64], Array]:
    """Sample the motions as densely as the bodies need; which each body × motion uses, and its interval [s]."""
    times = np.array([step_count(body, dts, g, step) for body in bodies])
    times = 2 ** np.ceil(np.log2(times)).astype(int)
    kinds, number = np.unique(times * len(values) + np.arange(len(values)), return_inverse=True)
    sampled = [_refined(values[kind % len(values)], kind // len(values)) for kind in kinds.tolist()]
    # whole blocks each, so that no block straddles two motions
    padded = [np.append(v, np.zeros(-v.size % BLOCK)) for v in sampled]
    offsets = np.concatenate([[0], np.cumsum([v.size for v in padded])])
    samples = np.concatenate(padded)
    blocks = samples.reshape(-1, BLOCK)
    highest, lowest = blocks.max(axis=1), blocks.min(axis=1)
    parts = [slice(i // BLOCK, j // BLOCK) for i, j in zip(offsets[:-1], offsets[1:], strict=True)]
    motions = Motions(
        samples=samples,
        highest=highest,
        lowest=lowest,
        ahead_high=np.concatenate(
            [np.maximum.accumulate(highest[part][::-1])[::-1] for part in parts]
        ),
        ahead_low=np.concatenate(
            [np.minimum.accumulate(lowest[part][::-1])[::-1] for part in parts]
        ),
        offsets=offsets,
        lasts=offsets[:-1] + np.array([v.size for v in sampled]) - 1,
    )
    return motions, number.reshape(times.shape), dts[np.newaxis, :] / times


def _refined(values: Array, times: int) -> Array:
    """Sample a piecewise linear motion ``times`` as densely, and let it end in zero."""
    closed = np.append(values, 0.0)
    if times == 1:
        return closed
    at = np.arange((closed.size - 1) * times + 1) / times
    return np.asarray(np.interp(at, np.arange(closed.size), closed))


def _stacks(setting: _Setting, bodies: list[Body], restitution: list[Restitution]) -> _Found:
    """Verdicts of stacks."""
    g, step = setting.g, setting.step
    motions, rows, intervals = _sampled(bodies, setting.motions, setting.dts, g, step)
    each = list(zip(bodies, intervals, strict=True))
    count = len(bodies) * setting.factors.size
    ensemble = Ensemble(
        counter=np.array([0]),
        count=count,
        bodies=np.array(
            [body_record(body, e, g=g) for body, e in zip(bodies, restitution, strict=True)], BODY
        ),
        factors=setting.factors,
        rows=rows,
        intervals=intervals,
        parts=1.0 / np.array([step_count(body, h, g, STACK_STEP * step) for body, h in each]),
        free=np.array([free_samples(body, h, g) for body, h in each]),
    )
    outcomes = np.empty(count, OUTCOME)
    _march(march_stacks, stack_case.worker, setting.threads, ensemble, motions, outcomes)
    return outcomes.reshape(len(bodies), *setting.factors.shape), intervals[:, :, np.newaxis]


def _blocks(setting: _Setting, bodies: list[Body], restitution: list[Restitution]) -> _Found:
    """Verdicts of lone blocks."""
    g = setting.g
    motions, rows, intervals = _sampled(bodies, setting.motions, setting.dts, g, setting.step)
    poles = np.empty((*intervals.shape, 2), block.POLE)
    for i, (body, e) in enumerate(zip(bodies, restitution, strict=True)):
        assert isinstance(body, Block)
        poles[i] = _poles(body, e, g)
    poles["swing"] *= intervals[:, :, np.newaxis] ** 2
    poles["per_swing"] /= intervals[:, :, np.newaxis] ** 2
    count = len(bodies) * setting.factors.size
    ensemble = Ensemble(
        counter=np.array([0]),
        count=count,
        bodies=poles,
        factors=setting.factors / g,
        rows=rows,
        intervals=intervals,
        parts=np.ones(intervals.shape),
        free=np.zeros(intervals.shape, np.int64),
    )
    outcomes = np.empty(count, OUTCOME)
    _march(block.march_blocks, block.worker, setting.threads, ensemble, motions, outcomes)
    return outcomes.reshape(len(bodies), *setting.factors.shape), intervals[:, :, np.newaxis]


def _poles(body: Block, restitution: Restitution, g: float) -> NDArray[np.void]:
    """Constants of a block's right and left pole, with p² where p² dt² belongs."""
    poles = np.empty(2, block.POLE)
    measured = lone_restitution(body, restitution)
    for at, pole in ((0, +1), (1, -1)):
        alpha, swing = body.critical_angle(pole), body.frequency(pole, g) ** 2
        e = body.momentum_restitution(pole) if measured is None else measured
        poles[at] = (
            alpha, math.tan(alpha), math.sin(alpha), math.cos(alpha), swing, e, 1 / alpha,
            1 / (swing * alpha**2),
        )  # fmt: skip
    return poles


def _fill(result: EnsembleResult, rows: NDArray[np.intp], found: _Found) -> None:
    """Write outcomes of some bodies into the result."""
    outcome, interval = found
    fallen = outcome["fallen"]
    result.overturned[rows] = fallen > 0
    result.overturned_body[rows] = fallen
    result.overturning_time[rows] = np.where(fallen > 0, outcome["certain"] * interval, np.nan)
    result.peak_rotation[rows] = np.where(fallen == 2, np.inf, outcome["peak2"])
    result.peak_rotation_pedestal[rows] = np.where(fallen == 1, np.inf, outcome["peak1"])
    result.peak_velocity[rows] = outcome["fast"] / interval
    result.impacts[rows] = outcome["impacts"]
    result.closest_approach[rows] = outcome["closest"]
