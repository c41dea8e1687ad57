"""One body, one motion, everything about the response."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.engines.kernels.equations import STATE
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.kernels.record import (
    CHATTER,
    CLOSING,
    EVENT,
    LIFTING,
    OPENING,
    SAMPLE,
    SUMMARY,
    fill_energies,
)
from rockfrag.engines.kernels.single import Shaking, march, scratch
from rockfrag.errors import InputError
from rockfrag.keywords import named_keywords
from rockfrag.rocking.body_record import body_record
from rockfrag.rocking.contact.friction import (
    FrictionInput,
    check_impacts_follow,
    interface_frictions,
)
from rockfrag.rocking.contact.simulation import simulate_with_friction
from rockfrag.rocking.forces import centres, contact_forces
from rockfrag.rocking.inputs import (
    MOST_SAMPLES,
    STEP,
    MotionLike,
    checked_motion,
    checked_start,
    checked_switch,
    checked_vertical,
    free_samples,
    step_count,
    warn_of_unit,
)
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.rocking.response import PATTERNS, Response, mode_name
from rockfrag.system.blocks import Block, Body
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]

KINDS = {OPENING: "opening", CLOSING: "impact", CHATTER: "chatter", LIFTING: "lift-off"}
"""What the kinds of events are called."""


def initial_state(
    body: Body,
    theta0: float | Sequence[float] | None = None,
    omega0: float | Sequence[float] | None = None,
) -> np.void:
    """Return the STATE that a march begins with.

    Raises
    ------
    InputError
        If there is not one finite number for each block, or a block lies on its side already.
    """
    initial: np.void = np.zeros(1, STATE)[0]
    for name, given in (("theta", theta0), ("omega", omega0)):
        values = checked_start(body, given, name + "0")
        initial[name + "1"], initial[name + "2"] = (0.0, *values)[-2:]
    return initial


@named_keywords
def simulate(
    body: Body,
    motion: MotionLike,
    dt: float | None = None,
    *,
    theta0: float | Sequence[float] | None = None,
    omega0: float | Sequence[float] | None = None,
    restitution: Restitution = None,
    linear: bool = False,
    friction: FrictionInput | None = None,
    vertical: MotionLike | None = None,
    g: float = GRAVITY,
) -> Response:
    """Simulate a block, or a statue on its pedestal, under the motion of the ground.

    Without ``friction`` bodies rock and never slide; with it they stick, slide, rock, do both, fly and land
    (``docs/contact.md``).

    Parameters
    ----------
    body
        A :class:`Block` or a :class:`Stack`.
    motion
        A :class:`Motion`, or the acceleration of the ground or floor [m/s²], shape (n,), linear between samples,
        n ≥ 2.
    dt
        Sampling interval of an acceleration [s]; a Motion has its own.
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start: a number, or (pedestal, statue).
    restitution
        Measured ratio of angular velocities of an impact: a number, or (ground, interface), or a
        :class:`MeasuredRestitution` with its law; None, the default, conserves momentum (thesis eq. 2.14,
        2.76-2.86).
    linear
        Use the linearised equations of motion (thesis eq. 2.9; 2.60-2.65).
    friction
        Coefficient of friction of a lone block, (ground, interface) of a stack, or one number for both; a pair
        (static, kinetic) may stand in place of each number, and numbers may be infinite.  None: nothing slides
        and nothing jumps.
    vertical
        Vertical acceleration of the ground or floor, upwards [m/s²], sampled as ``motion``.
    g
        Acceleration of gravity [m/s²].

    Returns
    -------
    The :class:`Response`: arrays of shape (n, blocks) over the n samples of the motion and of the free rocking
    after it, with the table of its events and the ledger of its energy.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.

    Warns
    -----
    UnitDoubt
        If the motion looks as if it were in g or cm/s².

    Examples
    --------
    A statue under one second of a sine of 4 m/s²:

    >>> import numpy as np
    >>> from rockfrag import Block, Motion, simulate
    >>> time = np.arange(0, 2, 0.01)
    >>> motion = Motion(4.0 * np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
    >>> response = simulate(Block(width=0.3, height=1.2, mass=180.0), motion)
    >>> response.overturned, response.overturned_body
    (True, 'block')
    >>> response.theta.shape == (response.time.size, 1)
    True
    """
    values, interval = checked_motion(motion, dt)
    record = body_record(body, restitution, checked_switch("linear", linear), g)
    warn_of_unit([body], [motion], np.abs(values).max(keepdims=True), g)
    up = checked_vertical(vertical, values, interval)
    if friction is not None:
        check_impacts_follow(restitution, linear)
        limits = [one.static for one in interface_frictions(body, friction)]
    initial = initial_state(body, theta0, omega0)
    shaking = shaking_of(body, (values, up), interval, 1.0, g, STEP)
    most = values.size + shaking.free_samples
    if most > MOST_SAMPLES:
        raise InputError(
            f"motion: {most} samples, with the free rocking after it, are more than the {MOST_SAMPLES} allowed."
        )
    history = np.zeros(most, SAMPLE)
    capacity = 4096
    while True:
        events = np.zeros(capacity, EVENT)
        done, summary = run_march(record, shaking, initial, history, events)
        if summary["events"] <= capacity:
            break
        capacity = int(summary["events"])
    response = _response(
        body, record, shaking, history[:done], events[: summary["events"]], summary
    )
    if friction is None:
        return response
    if (response.friction_demand < limits).all() and (response.least_normal_force > 0).all():
        # pure rocking neither slides nor lifts off: it is the solution
        return _without_slip(response)
    return simulate_with_friction(
        body,
        values,
        interval,
        friction=friction,
        vertical=vertical,
        theta0=theta0,
        omega0=omega0,
        g=g,
    )


def _without_slip(response: Response) -> Response:
    """Give a response of pure rocking the columns of one with friction."""
    blocks = response.slip.shape[1]
    states = {name: pair[2 - blocks :] for pair, name in PATTERNS.items()}
    modes = [tuple(mode_name(state, 0) for state in states[name]) for name in response.events["to"]]
    events = response.events.copy()
    events["modes"] = pd.Series(modes, dtype=object)
    events["slip"] = pd.Series([(0.0,) * blocks] * len(modes), dtype=object)
    energy = response.energy.copy()
    energy.insert(energy.shape[1] - 1, "lost_friction", 0.0)
    return replace(response, events=events, energy=energy)


def shaking_of(
    body: Body, accelerations: tuple[Array, Array], dt: float, scale: float, g: float, step: float
) -> Shaking:
    """What a march shakes a body with, in steps that follow from the body.

    Parameters
    ----------
    accelerations
        Horizontal and vertical ones [m/s²]; of the latter none where the ground does not move so.
    """
    horizontal, vertical = accelerations
    return Shaking(
        samples=horizontal,
        vertical=vertical / g,
        scale=float(scale),
        dt=float(dt),
        substeps=int(step_count(body, dt, g, step)),
        free_samples=int(free_samples(body, dt, g)),
    )


def run_march(
    record: np.void,
    shaking: Shaking,
    initial: np.void,
    history: NDArray[np.void],
    events: NDArray[np.void],
) -> tuple[int, np.void]:
    """March one body; return the number of samples done and the summary."""
    summary: np.void = np.zeros(1, SUMMARY)[0]
    with compiling_alone(march):
        done = march(record, shaking, initial, history, events, summary, scratch())
    return int(done), summary


def _response(
    body: Body,
    record: np.void,
    shaking: Shaking,
    history: NDArray[np.void],
    events: NDArray[np.void],
    summary: np.void,
) -> Response:
    n = len(history)
    blocks = ["2"] if isinstance(body, Block) else ["1", "2"]
    theta, omega, alpha, state = (
        np.column_stack([history[name + block] for block in blocks])
        for name in ("theta", "omega", "alpha", "c")
    )
    samples, dt = shaking.samples, shaking.dt
    ground, gravity = np.zeros(n), np.full(n, float(record["gravity"]))
    ground[: min(n, samples.size)] = samples[:n]
    up = shaking.vertical[:n]
    gravity[: up.size] += gravity[: up.size] * up
    normal, friction = contact_forces(body, ground, state, theta, omega, alpha, gravity)
    time = np.arange(n, dtype=np.float64) * dt
    fallen = int(summary["fallen"])
    return Response(
        body=body,
        time=time,
        ground_acceleration=ground,
        position=centres(body, state, theta),
        theta=theta,
        omega=omega,
        alpha=alpha,
        state=state,
        slides=np.zeros_like(state),
        slip=np.zeros_like(theta),
        events=_event_table(events, blocks),
        overturned=fallen > 0,
        overturned_body=("", "pedestal", "block" if isinstance(body, Block) else "statue")[fallen],
        overturning_time=float(summary["fall_time"]),
        energy=_energy_table(record, time, history, events),
        normal_force=normal,
        friction_force=friction,
        impacts=int(summary["impacts"]),
        grazings=int(summary["grazings"]),
        paradoxes=0,
        forced=0,
        given_way=int(summary["given_way"]),
        friction_demand=np.array([summary["demand"]["friction" + block] for block in blocks]),
        least_normal_force=np.array([summary["demand"]["normal" + block] for block in blocks]),
        lost_contact=float(summary["lost_contact"]),
        closest_approach=float(summary["closest"]),
    )


def _event_table(events: NDArray[np.void], blocks: list[str]) -> pd.DataFrame:
    before, after = events["before"], events["after"]

    def each(state: NDArray[np.void], name: str) -> list[tuple[float, ...]]:
        return list(zip(*(state[name + block].tolist() for block in blocks), strict=True))

    def patterns(state: NDArray[np.void]) -> list[str]:
        return [
            PATTERNS[pair] for pair in zip(state["c1"].tolist(), state["c2"].tolist(), strict=True)
        ]

    return pd.DataFrame(
        {
            "time": events["time"],
            "kind": [KINDS[kind] for kind in events["kind"].tolist()],
            "from": patterns(before),
            "to": patterns(after),
            "omega_before": each(before, "omega"),
            "omega_after": each(after, "omega"),
            "theta": each(after, "theta"),
            "energy_before": events["energy_before"],
            "energy_after": events["energy_after"],
        }
    )


def _energy_table(
    record: np.void, time: Array, history: NDArray[np.void], events: NDArray[np.void]
) -> pd.DataFrame:
    """Ledger of energy by cause over time [J]."""
    kinetic = np.empty(len(history))
    potential = np.empty(len(history))
    with compiling_alone(fill_energies):
        fill_energies(record, history, kinetic, potential, np.zeros(1, STATE)[0])
    # an impact closes the ground if the pedestal's contact changed, the interface otherwise
    before = events["before"]["c1"]
    by_ground = (before != 0) & (before != events["after"]["c1"])
    loss = np.where(
        events["kind"] == OPENING, 0.0, events["energy_before"] - events["energy_after"]
    )
    at = np.searchsorted(time, events["time"] - 1e-12 * max(1.0, time[-1]))

    def so_far(values: Array) -> Array:
        total = np.zeros(len(time) + 1)
        np.add.at(total, at, values)
        return np.cumsum(total)[: len(time)]

    lost_ground, lost_interface = so_far(loss * by_ground), so_far(loss * ~by_ground)
    work = history["work"]
    start = kinetic[0] + potential[0]
    return pd.DataFrame(
        {
            "time": time,
            "kinetic": kinetic,
            "potential": potential,
            "input": work,
            "lost_ground": lost_ground,
            "lost_interface": lost_interface,
            "residual": kinetic + potential + lost_ground + lost_interface - work - start,
        }
    )
