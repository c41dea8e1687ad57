"""Engines of ensembles in pure rocking, from rest, and what all engines of pure rocking share.

In: :class:`rockfrag.engines.contract.Cases`. Out: :class:`rockfrag.outcomes.Outcomes`. Theory:
``docs/rocking.md``; the kernels: ``docs/kernels.md``.
"""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.engines.built_in import LONE_BLOCKS, TWO_BLOCKS
from rockfrag.engines.compile.jit import compiling_alone
from rockfrag.engines.contract import Cases
from rockfrag.engines.pure_rocking.kernels.equations import BODY
from rockfrag.engines.pure_rocking.kernels.lanes import block, stack_case
from rockfrag.engines.pure_rocking.kernels.lanes.case import (
    BLOCK,
    OUTCOME,
    Ensemble,
    Motions,
)
from rockfrag.engines.pure_rocking.kernels.lanes.scheduler import integrate_stacks
from rockfrag.engines.steps import STACK_STEP, free_samples, step_count
from rockfrag.laws import ForKernels, law_named, momentum, ratio
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.system import geometry
from rockfrag.system.contact import ImpactLaw
from rockfrag.system.system import System

BY_MOMENTUM: ForKernels = (momentum.NUMBER, 1.0)
FIELDS = ("after1r", "after1l", "after2r", "after2l")


def body_record(system: System, linear: bool = False, g: float = GRAVITY) -> np.void:
    """Return the record of a system of one or two bodies that the kernels read (``kernels.equations.BODY``).

    ``linear`` uses the linearised equations: eq. 2.9 for one body, eq. 2.60-2.65 for two.
    """
    record, found = np.zeros(1, BODY), afters(system)
    # its fields are attributes, as those of records are in kernels
    p: Any = record.view(np.recarray)[0]
    if system.count == 1:
        geometry.fill_block(p, system.shapes[0])
        p.linear = 2 if linear else 0
    else:
        geometry.fill_pile(p, system.pile)
        p.linear = 1 if linear else 0
    for name, after in zip(FIELDS, found, strict=True):
        p[name] = after
    p.gravity = g
    p.measured = any(after != BY_MOMENTUM for after in found)
    filled: np.void = record[0]
    return filled


def afters(system: System) -> tuple[ForKernels, ...]:
    """Return by which law, as a number and a value, ground and interface come off impacts.

    In order: impacts of the ground that end on the right and on the left pivot, then those of the interface. A
    lone body stands on the interface, so that the ground's laws, here those of momentum, are never asked.
    """
    if system.count == 1:
        law = system.contacts[0].law
        if law.name == "momentum":
            return (BY_MOMENTUM,) * 4
        return (
            BY_MOMENTUM,
            BY_MOMENTUM,
            (ratio.NUMBER, law.right),
            (ratio.NUMBER, law.left),
        )
    return tuple(
        after_impact(contact.law, shape, pivot)
        for contact, shape in zip(system.contacts, system.carried, strict=True)
        for pivot in (+1, -1)
    )


def after_impact(law: ImpactLaw, shape: geometry.Shape, pivot: int) -> ForKernels:
    """Return the law, as a number and a value, of the impacts of a contact that end on a pivot of the body above.

    ``shape``: of that body; ``pivot``: +1 right, -1 left.
    """
    return law_named(law.name).tell(shape, law.right if pivot > 0 else law.left, pivot)


class Lanes(NamedTuple):
    """An engine of lanes."""

    name: str  # of the engine
    kernel: Any  # entry kernel of (ensemble, motions, memory of a thread, outcomes)
    worker: Callable[[], Any]  # makes the memory of one thread


def integrate(
    lanes: Lanes,
    threads: int,
    ensemble: Ensemble,
    motions: Motions,
    outcomes: NDArray[np.void],
) -> None:
    """Let threads call an entry kernel, each with memory of its own, until no case is left.

    Parameters
    ----------
    lanes : the kernel, and what makes its memory
    threads : number of threads
    ensemble, motions : the cases, and what they are shaken with
    outcomes : records ``OUTCOME`` to fill, shape (cases,)
    """
    with compiling_alone(lanes.kernel):
        # no case yet: it is compiled before threads begin
        lanes.kernel(ensemble._replace(count=0), motions, lanes.worker(), outcomes)
    # threads take cases by this counter
    ensemble.counter[0] = 0

    def work(_: int) -> None:
        """Integrate cases on one thread until none is left."""
        lanes.kernel(ensemble, motions, lanes.worker(), outcomes)

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(min(threads, int(ensemble.count)))))


class Sampled(NamedTuple):
    """Motions as lanes take them."""

    motions: Motions
    rows: NDArray[np.int64]  # which of them each system takes under each motion
    intervals: Floats  # sampling interval of that [s], shape (systems, motions) as well


def sampled(cases: Cases, per_gravity: float) -> Sampled:
    """Sample all motions end to end, each as densely as the systems need.

    Parameters
    ----------
    cases : systems × motions × scales
    per_gravity : factor on the vertical acceleration

    Returns
    -------
    The samples, and which of them each system takes.
    """
    values = [motion.x.acceleration for motion in cases.motions]
    dts = np.array([motion.dt for motion in cases.motions])
    g, step = cases.request.g, cases.request.step
    times = np.array([step_count(system, dts, g, step) for system in cases.systems])
    # systems that need as many samples share a motion: the next power of two
    mantissa, exponent = np.frexp(times)
    times = 2 ** (exponent - (mantissa == 0.5))
    # a kind is a motion sampled so many times as densely
    kinds, number = np.unique(
        times * len(values) + np.arange(len(values)), return_inverse=True
    )

    each_kind = [divmod(kind, len(values)) for kind in kinds.tolist()]
    sizes = np.array([values[motion].size * times + 1 for times, motion in each_kind])
    # whole blocks each, so that no block straddles two motions
    offsets = np.concatenate([[0], np.cumsum(sizes + -sizes % BLOCK)])

    def end_to_end(each: Sequence[Floats]) -> Floats:
        """Samples of all motions behind each other, each as dense as its systems need."""
        made = np.zeros(offsets[-1])
        for start, (times, motion) in zip(offsets.tolist(), each_kind, strict=False):
            dense = refined(each[motion], times)
            made[start : start + dense.size] = dense
        return made

    horizontal = end_to_end(values)
    upward = np.zeros(0)
    if cases.motions[0].z is not None:
        upward = end_to_end(
            [
                per_gravity * motion.z.acceleration
                for motion in cases.motions
                if motion.z
            ]
        )
    high, low, ahead, behind = _extremes(horizontal, offsets)
    _, _, ahead_upward, behind_upward = _extremes(upward, offsets)
    motions = Motions(
        horizontal,
        upward,
        high,
        low,
        ahead,
        behind,
        ahead_upward,
        behind_upward,
        offsets,
        lasts=offsets[:-1] + sizes - 1,
    )
    return Sampled(motions, number.reshape(times.shape), dts[np.newaxis, :] / times)


def _extremes(
    samples: Floats, offsets: NDArray[np.int64]
) -> tuple[Floats, Floats, Floats, Floats]:
    """Highest and lowest sample of each BLOCK, and both from the beginning of each BLOCK to the end of its motion.

    Parameters
    ----------
    samples : of all motions end to end, whole blocks each
    offsets : where each motion begins, shape (motions + 1,)
    """
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
    """Sample a piecewise linear motion that ends in zero ``times`` as densely, up to that zero at least.

    Parameters
    ----------
    values : samples [any unit], shape (n,)
    times : by how much denser, at least 1

    Returns
    -------
    The samples, shape (n times + 1,).
    """
    closed = np.append(values, 0.0)
    at = np.arange((closed.size - 1) * times + 1) / times
    return np.asarray(np.interp(at, np.arange(closed.size), closed))


BLOCKS = ("1", "2")  # what the kernels call the two bodies; a lone one is the second


def blocks_of(outcomes: Outcomes) -> Iterator[tuple[NDArray[np.intp], int, str]]:
    """Yield the systems that have a body, its place among theirs, and what the kernels call it."""
    counts = np.array(outcomes.counts)
    for count in np.unique(counts).tolist():
        for k, number in enumerate(BLOCKS[-count:]):
            yield np.flatnonzero(counts == count), k, number


def write_rocking(into: Outcomes, found: NDArray[np.void], peaks: str = "peak") -> None:
    """Write what the kernels tell of cases into outcomes.

    Parameters
    ----------
    into : outcomes, shape (systems, motions, scales)
    found : records ``OUTCOME``, or ``SUMMARY``, of that shape
    peaks : beginning of the fields with θ/θcritical: ``peak``, or ``ratio`` of a SUMMARY
    """
    lone = np.array(into.counts)[:, np.newaxis, np.newaxis] == 1
    fell = np.where(found["fallen"] > 0, found["fallen"] - lone, 0)
    into.overturned[:] = fell > 0
    into.overturned_body[:] = fell
    for rows, k, number in blocks_of(into):
        peak = found[peaks + number][rows]
        into.peak_rotation[rows, ..., k] = np.where(fell[rows] == k + 1, np.inf, peak)
        into.slip[rows, ..., k] = into.peak_slip[rows, ..., k] = 0.0
    for name in ("impacts", "given_way", "unstable_distance"):
        getattr(into, name)[:] = found[name]


# --------------------------------------------------------------------------- the two engines


def run_blocks(cases: Cases) -> Outcomes:
    """Return the outcomes of lone bodies."""
    g, made = cases.request.g, sampled(cases, 1.0)
    intervals = made.intervals
    pivots = np.empty((*intervals.shape, 2), block.PIVOT)
    for i, system in enumerate(cases.systems):
        pivots[i] = _pivots(system, g)
    # from seconds to samples
    pivots["swing"] *= intervals[:, :, np.newaxis] ** 2
    pivots["per_swing"] /= intervals[:, :, np.newaxis] ** 2
    parts, free = np.ones(intervals.shape), np.zeros(intervals.shape, np.int64)
    given = {
        "bodies": pivots,
        "factors": cases.scales / g,
        "parts": parts,
        "free": free,
    }
    lanes = Lanes(LONE_BLOCKS.name, block.integrate_blocks, block.worker)
    return _by_lanes(lanes, cases, made, **given)


def _pivots(system: System, g: float) -> NDArray[np.void]:
    """Constants of a lone body's right and left pivot, records PIVOT, shape (2,), with p² where p² dt² belongs."""
    pivots = np.empty(2, block.PIVOT)
    shape, law = system.shapes[0], system.contacts[0].law
    # of the impact that ends rocking on a pivot and comes down on the other
    for at, pivot, measured in ((0, +1, law.left), (1, -1, law.right)):
        p = geometry.frequency(shape, pivot, g)
        alpha = geometry.critical_angle(shape, pivot)
        if not p * p * alpha * alpha > 0:
            raise InputError(
                "body: lengths, mass and inertia are too far apart; check their units."
            )
        by_momentum = geometry.momentum_restitution(shape, -pivot)
        e = by_momentum if law.name == "momentum" else measured
        pivots[at] = geometry.pivot_constants(shape, pivot, e, g)
    return pivots


def run_stacks(cases: Cases) -> Outcomes:
    """Return the outcomes of two bodies on each other."""
    g, step = cases.request.g, STACK_STEP * cases.request.step
    made = sampled(cases, 1.0 / g)
    each = list(zip(cases.systems, made.intervals, strict=True))
    return _by_lanes(
        Lanes(TWO_BLOCKS.name, integrate_stacks, stack_case.worker),
        cases,
        made,
        bodies=np.array([body_record(system, g=g) for system in cases.systems], BODY),
        factors=cases.scales,
        parts=1.0 / np.array([step_count(system, h, g, step) for system, h in each]),
        free=np.array([free_samples(system, h, g) for system, h in each]),
    )


def _by_lanes(lanes: Lanes, cases: Cases, made: Sampled, **given: Any) -> Outcomes:
    """Return what lanes make of an ensemble.

    Parameters
    ----------
    lanes : kernel and memory, with the name of their engine
    cases : systems × motions × scales
    made : their motions as lanes take them
    given : fields of the :class:`Ensemble` besides those of the sampled motions

    Returns
    -------
    The outcomes, shape (systems, motions, scales).
    """
    count = len(cases.systems) * cases.scales.size
    ensemble = Ensemble(
        counter=np.array([0]),
        count=count,
        rows=made.rows,
        intervals=made.intervals,
        **given,
    )
    found = np.empty(count, OUTCOME)
    integrate(lanes, cases.threads, ensemble, made.motions, found)
    outcomes = empty_outcomes(cases.names, cases.scales, (lanes.name,))
    found, interval = found.reshape(cases.shape), made.intervals[:, :, np.newaxis]
    # lanes count time in samples
    write_rocking(outcomes, found)
    outcomes.certain_time[:] = np.where(
        outcomes.overturned, found["certain"] * interval, np.nan
    )
    outcomes.peak_velocity[..., -1] = found["fast"] / interval
    return outcomes
