"""Many bodies × motions × amplitudes at once."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.engines.kernels.equations import BODY
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.kernels.lanes import block, stack_case
from rockfrag.engines.kernels.lanes.case import BLOCK, OUTCOME, Ensemble, Motions
from rockfrag.engines.kernels.lanes.scheduler import march_stacks
from rockfrag.engines.kernels.record import EVENT, SAMPLE, SUMMARY
from rockfrag.errors import InputError
from rockfrag.keywords import named_keywords
from rockfrag.rocking.body_record import body_record
from rockfrag.rocking.contact.ensemble import Moving, Standing, contact_outcomes
from rockfrag.rocking.contact.friction import (
    FrictionInput,
    check_impacts_follow,
    listed_frictions,
)
from rockfrag.rocking.inputs import (
    STACK_STEP,
    STEP,
    MotionLike,
    check_case_count,
    check_one_per_body,
    checked_scales,
    checked_start,
    checked_switch,
    checked_threads,
    free_samples,
    listed,
    listed_motions,
    listed_vertical,
    step_count,
    warn_of_unit,
)
from rockfrag.rocking.measured_restitution import Restitution, lone_restitution
from rockfrag.rocking.simulation import initial_state, run_march, shaking_of
from rockfrag.short_repr import short_repr
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]


LIGHT = 0.5
"""Share of its weight below which a body that the ground drops may leave it, so that pure rocking is no answer:
64 of 3000 random verdicts of pure rocking are wrong below, and 1 of 5000 above (``docs/contact.md``) [-]."""


@dataclass(frozen=True)
class EnsembleResult:
    """Verdicts and peak responses; every array but the last has shape (bodies, motions, scales).

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
    given_way
        Number of them in which the law of a measured restitution had to give way, lest energy grow.
    closest_approach
        Least distance from an unstable equilibrium, as in :class:`Response`; infinite if it never rocked.
    slip_ground, slip_interface
        Displacement along the ground and along the pedestal's top at the end [m], positive to the right; zero
        without friction.
    peak_slip_ground, peak_slip_interface
        Largest displacement either way [m].
    flights
        Number of times that a body left what it stood on with all of its base; zero without friction.
    lightest
        Least weight of the body while the ground moves, over that on a ground at rest [-]: 1 without vertical
        motion.  Pure rocking holds every contact shut, so below ``LIGHT`` its verdict may be wrong, and where no
        weight is left it is a guess: ``forces`` says whether contact is lost, ``friction`` lets bodies fly.
    lost_contact
        With ``forces``, as in :class:`Response` [s]; NaN otherwise.
    friction_demand, least_normal_force
        With ``forces``, as in :class:`Response` [-] and [N], shape (bodies, motions, scales, 2): of (ground,
        interface), of a lone block of the ground alone; NaN otherwise.
    scales
        Factors on the motions, shape (motions, scales).
    """

    overturned: NDArray[np.bool_]
    overturned_body: NDArray[np.int8]
    overturning_time: Array
    peak_rotation: Array
    peak_rotation_pedestal: Array
    peak_velocity: Array
    impacts: NDArray[np.int64]
    given_way: NDArray[np.int64]
    closest_approach: Array
    slip_ground: Array
    slip_interface: Array
    peak_slip_ground: Array
    peak_slip_interface: Array
    flights: NDArray[np.int64]
    lightest: Array
    lost_contact: Array
    friction_demand: Array
    least_normal_force: Array
    scales: Array

    __repr__ = short_repr

    def table(self) -> pd.DataFrame:
        """Return the results as a table, a row per case, the scale running fastest.

        Columns: ``body``, ``motion`` (positions in the lists given), ``scale`` and every attribute of that
        shape, with its unit in the name: ``overturning_time_s``, ``peak_velocity_rad_s``,
        ``slip_ground_m``; with ``forces`` also ``friction_demand_ground``, ``friction_demand_interface``,
        ``least_normal_force_ground_n`` and ``least_normal_force_interface_n``.
        """
        shape = self.overturned.shape
        body = np.arange(shape[0])[:, np.newaxis, np.newaxis]
        motion = np.arange(shape[1])[:, np.newaxis]
        units = {"overturning_time": "_s", "peak_velocity": "_rad_s"}
        units |= {name: "_m" for name in vars(self) if "slip" in name}
        columns: dict[str, Any] = {"body": body, "motion": motion, "scale": self.scales}
        columns |= {
            name + units.get(name, ""): values
            for name, values in vars(self).items()
            if name != "scales" and values.ndim == len(shape)
        }
        if not np.isnan(self.friction_demand).all():
            for k, place in enumerate(("ground", "interface")):
                columns[f"friction_demand_{place}"] = self.friction_demand[..., k]
                columns[f"least_normal_force_{place}_n"] = self.least_normal_force[..., k]
        return pd.DataFrame(
            {name: np.broadcast_to(values, shape).ravel() for name, values in columns.items()}
        )


@dataclass(frozen=True)
class _Setting:
    """What the bodies of an ensemble are shaken with, and how."""

    motions: list[Array]
    vertical: list[Array]  # none, or one for each motion
    dts: Array
    factors: Array
    g: float
    step: float
    threads: int


@dataclass(frozen=True)
class _Bodies:
    """Bodies of one kind, with what is given for each."""

    bodies: list[Body]
    restitution: list[Restitution]


_Found = tuple[NDArray[np.void], Array]
"""Outcomes, (bodies, motions, scales) of OUTCOME, and the sampling intervals they count time in [s]."""

Start = float | Sequence[float] | None
"""Rotation or angular velocity of one body at the start, as in :func:`simulate`."""


@named_keywords
def overturns(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None = None,
    scales: ArrayLike = (1.0,),
    *,
    theta0: Sequence[Start] | None = None,
    omega0: Sequence[Start] | None = None,
    restitution: Sequence[Restitution] | None = None,
    linear: bool = False,
    friction: float | Sequence[FrictionInput] | None = None,
    vertical: MotionLike | Sequence[MotionLike] | None = None,
    forces: bool = False,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> EnsembleResult:
    """Say for every body × motion × scale whether it overturns.

    Parameters
    ----------
    bodies
        Blocks and stacks.
    motions
        Motions, or their accelerations [m/s²], each of shape (n,), linear between samples and zero one sample
        after the last.
    dt
        Sampling interval of accelerations [s], one or one per motion; a Motion has its own.
    scales
        Factors on the accelerations, shape (scales,) for all motions or (motions, scales).
    theta0, omega0
        One entry per body: rotations [rad] and angular velocities [rad/s] at the start, as in
        :func:`simulate`; None starts all at rest.
    restitution
        One entry per body, each as in :func:`simulate`; None conserves momentum in all.
    linear
        Use the linearised equations of motion (thesis eq. 2.9; 2.60-2.65).
    friction
        One entry per body, each as in :func:`simulate`, or one number for all; None: nothing slides.
    vertical
        Vertical accelerations, upwards [m/s²], one for each motion and sampled as it; they are scaled with it.
    forces
        Also tell the friction that the responses asked, and least normal forces; not with friction.
    g
        Acceleration of gravity [m/s²].
    step
        Largest p h of a step, of which a stack takes 0.35 while both its blocks rotate: smaller is more accurate
        and slower.
    threads
        Threads to use; all cores if None.  Results do not depend on it.

    Returns
    -------
    The :class:`EnsembleResult`, whose arrays have the shape (bodies, motions, scales); its ``table()`` has a row
    per case.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.

    Warns
    -----
    UnitDoubt
        If the strongest motion looks as if it were in g or cm/s².
    LightBodies
        If the ground takes more than half of its weight from a body, with neither ``friction`` nor ``forces``.

    Notes
    -----
    Cases with a start of their own, with linearised equations or with ``forces`` are marched one by one as
    :func:`simulate` does, which follows every impact and takes some ten times as long; a fall is then certain
    when a block lies down.  With friction a block has also fallen when it has left the edge of its pedestal.

    Examples
    --------
    A statue alone and on a pedestal, under a sine of one second at three amplitudes [m/s²]:

    >>> import numpy as np
    >>> from rockfrag import Block, Motion, Stack, overturns
    >>> time = np.arange(0, 2, 0.01)
    >>> motion = Motion(np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
    >>> statue = Block(width=0.3, height=1.2, mass=180.0)
    >>> stack = Stack(Block(width=0.6, height=0.4, mass=300.0), statue)
    >>> overturns([statue, stack], motion, scales=[2.0, 3.0, 5.0]).overturned.shape
    (2, 1, 3)
    """
    body_list, values, dts = listed(bodies, motions, dt, restitution)
    factors = checked_scales(scales, values)
    largest = np.abs(factors).max(axis=1, initial=0.0)
    peaks = np.array([np.abs(one).max() * s for one, s in zip(values, largest, strict=True)])
    warn_of_unit(body_list, listed_motions(motions), peaks, g)
    up = listed_vertical(vertical, values, dts)
    if up:
        checked_scales(factors, up)
    setting = _Setting(values, up, dts, factors, g, step, checked_threads(threads))
    given = _Bodies(body_list, list(restitution or [None] * len(body_list)))
    check_case_count(len(body_list) * factors.size)
    for name, start in (("theta0", theta0), ("omega0", omega0)):
        check_one_per_body(name, start, len(body_list))
    result = _empty_result(factors, len(body_list))
    if friction is not None:
        check_impacts_follow(restitution, checked_switch("linear", linear))
        frictions = listed_frictions(body_list, friction)
    if not result.overturned.size:
        return result
    if up:
        result.lightest[:] = _lightest_of(up, factors, g)
        if friction is None and not forces:
            _warn_of_weight(result.lightest)
    alone = checked_switch("linear", linear) or checked_switch("forces", forces)
    if alone or theta0 is not None or omega0 is not None:
        starts = [
            initial_state(body, *start)
            for body, *start in zip(
                body_list,
                theta0 if theta0 is not None else [None] * len(body_list),
                omega0 if omega0 is not None else [None] * len(body_list),
                strict=True,
            )
        ]
        found, marched = _one_by_one(setting, given, starts, linear)
        _fill(result, np.arange(len(body_list)), found)
        if forces and friction is None:
            _fill_forces(result, body_list, marched)
    else:
        _fill_by_lanes(result, setting, given)
    if friction is not None:
        angles = _starts(body_list, theta0, "theta0")
        speeds = _starts(body_list, omega0, "omega0")
        _fill_with_friction(result, setting, Standing(body_list, frictions, angles, speeds))
    return result


class LightBodies(UserWarning):
    """Bodies are nearly weightless at times, and pure rocking holds them on the ground."""


def _lightest_of(up: Sequence[Array], factors: Array, g: float) -> Array:
    """Least weight under each vertical motion at each scale, over that on a ground at rest, (motions, scales)."""
    ends = np.array([(motion.min(initial=0.0), motion.max(initial=0.0)) for motion in up])
    return np.asarray(1.0 + np.min(ends[:, np.newaxis, :] * factors[..., np.newaxis], axis=2) / g)


def _warn_of_weight(lightest: Array) -> None:
    """Warn of cases in which bodies may leave the ground."""
    light, none = int((lightest < LIGHT).sum()), int((lightest <= 0).sum())
    if light:
        warnings.warn(
            f"vertical: in {light} of {lightest.size} cases the ground drops so fast that a body keeps less than "
            f"half of its weight, in {none} of them none at all; pure rocking holds it on the ground there. "
            "Give friction= to let it fly, or forces=True to see when contact is lost.",
            LightBodies,
            stacklevel=4,
        )


def _fill_by_lanes(result: EnsembleResult, setting: _Setting, given: _Bodies) -> None:
    """Write what becomes of bodies that rock from rest into the result."""
    for kind, march in ((Block, _blocks), (Stack, _stacks)):
        rows = [i for i, body in enumerate(given.bodies) if isinstance(body, kind)]
        if rows:
            chosen = _Bodies([given.bodies[i] for i in rows], [given.restitution[i] for i in rows])
            _fill(result, np.array(rows), march(setting, chosen))


def _empty_result(factors: Array, n_bodies: int) -> EnsembleResult:
    shape = (n_bodies, *factors.shape)
    return EnsembleResult(
        overturned=np.zeros(shape, dtype=bool),
        overturned_body=np.zeros(shape, dtype=np.int8),
        overturning_time=np.full(shape, np.nan),
        peak_rotation=np.zeros(shape),
        peak_rotation_pedestal=np.zeros(shape),
        peak_velocity=np.zeros(shape),
        impacts=np.zeros(shape, dtype=np.int64),
        given_way=np.zeros(shape, dtype=np.int64),
        closest_approach=np.full(shape, np.inf),
        slip_ground=np.zeros(shape),
        slip_interface=np.zeros(shape),
        peak_slip_ground=np.zeros(shape),
        peak_slip_interface=np.zeros(shape),
        flights=np.zeros(shape, dtype=np.int64),
        lightest=np.ones(shape),
        lost_contact=np.full(shape, np.nan),
        friction_demand=np.full((*shape, 2), np.nan),
        least_normal_force=np.full((*shape, 2), np.nan),
        scales=factors,
    )


def _starts(
    bodies: list[Body], given: Sequence[Start] | None, name: str
) -> list[tuple[float, ...]]:
    """Rotations or angular velocities at the start of each body."""
    each = given if given is not None else [None] * len(bodies)
    return [checked_start(body, one, name) for body, one in zip(bodies, each, strict=True)]


def _fill_with_friction(result: EnsembleResult, setting: _Setting, standing: Standing) -> None:
    """Write what becomes of bodies that may slide and fly over what pure rocking has found.

    Where nothing slides nor flies, pure rocking is the solution, and what it has found stays.
    """
    moving = Moving(setting.motions, setting.vertical, setting.dts, setting.factors)
    wanted = np.ones(result.overturned.shape, dtype=bool)
    found = contact_outcomes(standing, moving, wanted, setting.g, setting.step, setting.threads)
    other = (
        (found["slid"].max(axis=-1) > 0)
        | (found["flights"].sum(axis=-1) > 0)
        | (found["paradoxes"] > 0)
    )
    for i, body in enumerate(standing.bodies):
        _fill_contact(result, (i, *np.nonzero(other[i])), found[i][other[i]], body)


def _fill_contact(
    result: EnsembleResult, place: tuple[Any, ...], found: NDArray[np.void], body: Body
) -> None:
    """Write outcomes of one body in contact into the result."""
    lone = isinstance(body, Block)
    top = 0 if lone else 1
    fell = np.where(lone & (found["fallen"] > 0), 2, found["fallen"])
    result.overturned[place] = fell > 0
    result.overturned_body[place] = fell
    result.overturning_time[place] = np.where(fell > 0, found["time"], np.nan)
    result.peak_rotation[place] = np.where(fell == 2, np.inf, found["peak"][:, top])
    below = 0.0 if lone else found["peak"][:, 0]
    result.peak_rotation_pedestal[place] = np.where(fell == 1, np.inf, below)
    result.peak_velocity[place] = found["peak_speed"][:, top]
    result.impacts[place] = found["impacts"]
    result.flights[place] = found["flights"].sum(axis=-1)
    result.closest_approach[place] = np.nan
    for k, name in enumerate(("ground", "interface")):
        getattr(result, f"slip_{name}")[place] = found["slip"][:, k]
        getattr(result, f"peak_slip_{name}")[place] = found["peak_slip"][:, k]


def _one_by_one(
    setting: _Setting, given: _Bodies, starts: list[np.void], linear: bool
) -> tuple[_Found, NDArray[np.void]]:
    """Verdicts and summaries of bodies as single histories give them, of which nothing else is kept."""
    g, dts, factors = setting.g, setting.dts, setting.factors
    records = [
        body_record(body, e, linear, g)
        for body, e in zip(given.bodies, given.restitution, strict=True)
    ]
    outcomes = np.zeros((len(records), *factors.shape), OUTCOME)
    summaries = np.zeros(outcomes.shape, SUMMARY)
    nothing = np.empty(0, SAMPLE), np.empty(0, EVENT)

    def work(place: tuple[int, int, int]) -> None:
        i, j, k = place
        body, dt = given.bodies[i], float(dts[j])
        scale = float(factors[j, k])
        up = setting.vertical[j] if setting.vertical else np.zeros(0)
        shaking = shaking_of(body, (setting.motions[j], up), dt, scale, g, setting.step)
        done, summary = run_march(records[i], shaking, starts[i], *nothing)
        outcomes[place] = (
            summary["fallen"], done - 1, summary["ratio1"], summary["ratio2"],
            summary["speed2"] * dt, summary["closest"], summary["impacts"],
            summary["given_way"],
        )  # fmt: skip
        summaries[place] = summary

    with ThreadPoolExecutor(setting.threads) as pool:
        list(pool.map(work, np.ndindex(*outcomes.shape)))
    return (outcomes, np.broadcast_to(dts[:, np.newaxis], (len(records), len(dts), 1))), summaries


def _fill_forces(result: EnsembleResult, bodies: list[Body], summaries: NDArray[np.void]) -> None:
    """Write what cases have asked of their contacts into the result."""
    result.lost_contact[:] = summaries["lost_contact"]
    asked = summaries["demand"]
    for i, body in enumerate(bodies):
        # a lone block is the kernels' block 2
        numbers = ("2",) if isinstance(body, Block) else ("1", "2")
        for k, number in enumerate(numbers):
            result.friction_demand[i, ..., k] = asked[i]["friction" + number]
            result.least_normal_force[i, ..., k] = asked[i]["normal" + number]


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
    bodies: list[Body], setting: _Setting, per_gravity: float
) -> tuple[Motions, NDArray[np.int64], Array]:
    """Sample the motions as densely as the bodies need; which each body × motion uses, and its interval [s].

    ``per_gravity`` makes of vertical accelerations what factors make parts of gravity of.
    """
    values, dts = setting.motions, setting.dts
    times = np.array([step_count(body, dts, setting.g, setting.step) for body in bodies])
    # the next power of two
    mantissa, exponent = np.frexp(times)
    times = 2 ** (exponent - (mantissa == 0.5))
    kinds, number = np.unique(times * len(values) + np.arange(len(values)), return_inverse=True)

    each_kind = [divmod(kind, len(values)) for kind in kinds.tolist()]
    sizes = np.array([values[motion].size * times + 1 for times, motion in each_kind])
    # whole blocks each, so that no block straddles two motions
    offsets = np.concatenate([[0], np.cumsum(sizes + -sizes % BLOCK)])

    def end_to_end(each: list[Array]) -> Array:
        made = np.zeros(offsets[-1])
        for start, (times, motion) in zip(offsets.tolist(), each_kind, strict=False):
            dense = _refined(each[motion], times)
            made[start : start + dense.size] = dense
        return made

    horizontal = end_to_end(values)
    upward = np.zeros(0)
    if setting.vertical:
        upward = end_to_end([per_gravity * up for up in setting.vertical])
    highest, lowest, ahead_high, ahead_low = _extremes(horizontal, offsets)
    _, _, upward_high, upward_low = _extremes(upward, offsets)
    motions = Motions(
        samples=horizontal,
        vertical=upward,
        highest=highest,
        lowest=lowest,
        ahead_high=ahead_high,
        ahead_low=ahead_low,
        upward_high=upward_high,
        upward_low=upward_low,
        offsets=offsets,
        lasts=offsets[:-1] + sizes - 1,
    )
    return motions, number.reshape(times.shape), dts[np.newaxis, :] / times


def _extremes(samples: Array, offsets: NDArray[np.int64]) -> tuple[Array, Array, Array, Array]:
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


def _refined(values: Array, times: int) -> Array:
    """Sample a piecewise linear motion that ends in zero ``times`` as densely, up to that zero at least."""
    if times == 1:
        return values
    closed = np.append(values, 0.0)
    at = np.arange((closed.size - 1) * times + 1) / times
    return np.asarray(np.interp(at, np.arange(closed.size), closed))


def _stacks(setting: _Setting, given: _Bodies) -> _Found:
    """Verdicts of stacks."""
    g, step, bodies = setting.g, setting.step, given.bodies
    motions, rows, intervals = _sampled(bodies, setting, 1.0 / g)
    each = list(zip(bodies, intervals, strict=True))
    count = len(bodies) * setting.factors.size
    ensemble = Ensemble(
        counter=np.array([0]),
        count=count,
        bodies=np.array(
            [body_record(body, e, g=g) for body, e in zip(bodies, given.restitution, strict=True)],
            BODY,
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


def _blocks(setting: _Setting, given: _Bodies) -> _Found:
    """Verdicts of lone blocks."""
    g, bodies = setting.g, given.bodies
    motions, rows, intervals = _sampled(bodies, setting, 1.0)
    poles = np.empty((*intervals.shape, 2), block.POLE)
    for i, (body, e) in enumerate(zip(bodies, given.restitution, strict=True)):
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
        alpha, frequency, arm = body.critical_angle(pole), body.frequency(pole, g), body.arm(pole)
        swing, aside, radius = frequency * frequency, -pole * arm.x, body.radius(pole)
        if not swing * alpha * alpha > 0:
            raise InputError(
                "body: lengths, mass and inertia are too far apart; check their units."
            )
        # of the impact that ends rocking on this pole and comes down on the other
        e = body.momentum_restitution(pole) if measured is None else measured[1 - at]
        poles[at] = (
            alpha, aside / arm.y, aside / radius, arm.y / radius, swing, e, 1 / alpha,
            1 / (swing * alpha * alpha),
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
    result.given_way[rows] = outcome["given_way"]
    result.closest_approach[rows] = outcome["closest"]
