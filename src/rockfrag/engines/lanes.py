"""What engines that integrate many cases side by side share: motions as the lanes sample them, and the threads."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.arrays import Floats
from rockfrag.engines.contract import Cases
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.kernels.lanes.case import BLOCK, Motions
from rockfrag.engines.steps import step_count
from rockfrag.outcomes.outcomes import Outcomes


def intervals_of(cases: Cases) -> Floats:
    """Sampling interval of each motion [s], shape (motions,)."""
    return np.array([motion.dt for motion in cases.motions])


def integrate(kernel: Any, worker: Callable[[], Any], threads: int, *arguments: Any) -> None:
    """Let threads call an entry kernel, each with memory of its own, until no case is left."""
    ensemble, *others = arguments
    with compiling_alone(kernel):
        kernel(ensemble._replace(count=0), *others[:-1], worker(), others[-1])
    ensemble.counter[0] = 0

    def work(_: int) -> None:
        kernel(ensemble, *others[:-1], worker(), others[-1])

    needed = min(threads, int(ensemble.count))
    if needed <= 1:
        # starting a thread takes longer than a single short case
        work(0)
        return
    with ThreadPoolExecutor(needed) as pool:
        list(pool.map(work, range(needed)))


def sampled(cases: Cases, per_gravity: float) -> tuple[Motions, NDArray[np.int64], Floats]:
    """Sample the motions as densely as systems need; which each uses, its interval [s]; vertical over gravity."""
    values = [motion.x.acceleration for motion in cases.motions]
    dts = intervals_of(cases)
    g, step = cases.request.g, cases.request.step
    times = np.array([step_count(system, dts, g, step) for system in cases.systems])
    # the next power of two
    mantissa, exponent = np.frexp(times)
    times = 2 ** (exponent - (mantissa == 0.5))
    kinds, number = np.unique(times * len(values) + np.arange(len(values)), return_inverse=True)

    each_kind = [divmod(kind, len(values)) for kind in kinds.tolist()]
    sizes = np.array([values[motion].size * times + 1 for times, motion in each_kind])
    # whole blocks each, so that no block straddles two motions
    offsets = np.concatenate([[0], np.cumsum(sizes + -sizes % BLOCK)])

    def end_to_end(each: Sequence[Floats]) -> Floats:
        made = np.zeros(offsets[-1])
        for start, (times, motion) in zip(offsets.tolist(), each_kind, strict=False):
            dense = refined(each[motion], times)
            made[start : start + dense.size] = dense
        return made

    horizontal = end_to_end(values)
    upward = np.zeros(0)
    if cases.motions[0].z is not None:
        upward = end_to_end(
            [per_gravity * motion.z.acceleration for motion in cases.motions if motion.z]
        )
    extremes = *_extremes(horizontal, offsets), *_extremes(upward, offsets)[2:]
    motions = Motions(horizontal, upward, *extremes, offsets, lasts=offsets[:-1] + sizes - 1)
    return motions, number.reshape(times.shape), dts[np.newaxis, :] / times


def _extremes(samples: Floats, offsets: NDArray[np.int64]) -> tuple[Floats, Floats, Floats, Floats]:
    """Extremes of each BLOCK of samples, and from the beginning of each to the end of its motion."""
    blocks = samples.reshape(-1, BLOCK)
    high, low = blocks.max(axis=1, initial=-np.inf), blocks.min(axis=1, initial=np.inf)
    ahead, behind = high.copy(), low.copy()
    for start, end in pairwise((offsets // BLOCK).tolist()):
        # from the last to the first
        at = slice(start, end)
        ahead[at][::-1] = np.maximum.accumulate(high[at][::-1])
        behind[at][::-1] = np.minimum.accumulate(low[at][::-1])
    return high, low, ahead, behind


def refined(values: Floats, times: int) -> Floats:
    """Sample a piecewise linear motion that ends in zero ``times`` as densely, up to that zero at least."""
    if times == 1:
        return values
    closed = np.append(values, 0.0)
    at = np.arange((closed.size - 1) * times + 1) / times
    return np.asarray(np.interp(at, np.arange(closed.size), closed))


def write_rocking(
    into: Outcomes, rows: Sequence[int], found: NDArray[np.void], peaks: str = "peak"
) -> None:
    """Write what the kernels tell (OUTCOME, or SUMMARY with ratios as ``peaks``) of systems of as many bodies."""
    count, place = into.counts[rows[0]], np.asarray(rows, dtype=np.intp)
    # a lone body is the kernels' block 2
    fell = np.where(found["fallen"] > 0, found["fallen"] - (2 - count), 0)
    into.overturned[place] = fell > 0
    into.overturned_body[place] = fell
    for k in range(count):
        peak = found[peaks + ("2" if k == count - 1 else "1")]
        into.peak_rotation[place, ..., k] = np.where(fell == k + 1, np.inf, peak)
        into.slip[place, ..., k] = into.peak_slip[place, ..., k] = 0.0
    into.impacts[place] = found["impacts"]
    into.given_way[place] = found["given_way"]
    into.unstable_distance[place] = found["unstable_distance"]


def write_lanes(into: Outcomes, found: NDArray[np.void], interval: Floats) -> None:
    """Write what lanes tell of cases, which count time in samples of ``interval`` [s], into outcomes."""
    write_rocking(into, range(len(into.names)), found)
    into.certain_time[:] = np.where(into.overturned, found["certain"] * interval, np.nan)
    into.peak_velocity[..., -1] = found["fast"] / interval
