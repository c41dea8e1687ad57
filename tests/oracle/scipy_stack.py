"""A statue on a pedestal by scipy's ``solve_ivp``, the counterpart of ``competitors.scipy_lone``.

The mechanics (contact states, impacts, what a closed contact can hold) is that of
`rocking_model`.
"""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from rockfrag.system.blocks import Body, Stack

from .competitors import SLOWEST_IMPACT, Array, G
from .rocking_integrator import LONGEST_TAIL
from .rocking_model import Model, State

Ground = Callable[[float], float]
Watch = Callable[[float, Array], float]

SLACK = 1e-10
"""What a closed contact may pull before it opens, of weight times half width [-]: it then parts at once."""

JUST_OPEN = 1e-300
"""A gap at the start of an integration [rad]: where a contact has just opened no closing is found."""


def piecewise_linear(values: list[float], dt: float) -> Ground:
    """Acceleration of the ground [m/s²], zero after the last sample."""
    slopes = [b - a for a, b in pairwise(values)]

    def ground(t: float) -> float:
        x = t / dt
        k = int(x)
        return values[k] + (x - k) * slopes[k] if k < len(slopes) else 0.0

    return ground


def rest_interval(model: Model) -> tuple[float, float]:
    """Accelerations of the ground [m/s²] between which what is at rest stays so."""
    still, pushed = (model.margins((0, 0), (0.0, 0.0), (0.0, 0.0), (a, G)) for a in (0.0, 1.0))
    limits = [still[key] / (still[key] - pushed[key]) for key in still]
    return max(a for a in limits if a < 0), min(a for a in limits if a > 0)


def watches(model: Model, state: State, start: float, ground: Ground) -> list[Watch]:
    """Contact events of a contact state that starts at ``start``: at ground and interface, and a fall."""

    def gap(t: float, y: Array, i: int) -> float:
        theta = y.tolist()
        return state[i] * (theta[i] - i * theta[0]) if t > start else JUST_OPEN

    def hold(t: float, y: Array) -> float:
        th1, th2, w1, w2 = y.tolist()
        pull = ground(t), G
        return min(model.margins(state, (th1, th2), (w1, w2), pull).values()) + SLACK

    def falls(t: float, y: Array) -> float:
        th1, th2, _, _ = y.tolist()
        return math.pi / 2 - max(abs(th1), abs(th2), abs(th2 - th1))

    contact_events: list[Watch] = [
        (lambda t, y, i=i: gap(t, y, i)) if state[i] else hold for i in (0, 1)
    ]
    for contact_event in (*contact_events, falls):
        contact_event.terminal, contact_event.direction = True, -1  # type: ignore[attr-defined]
    return [*contact_events, falls]


def landed(model, state, shut, theta, omega, a):
    """Contact state and velocities after the contacts ``shut`` have closed, without chatter."""
    closing = (state[0] if 0 in shut else 0, state[1] if 1 in shut else 0)
    new, after, _ = model.impact(state, closing, theta, omega)
    while True:
        q1, q2 = model.accelerations(new, theta, after, (a, G))
        parts, pulls = (after[0], after[1] - after[0]), (q1, q2 - q1)
        weak = [
            (closing[i] or not state[i])
            and abs(parts[i]) < SLOWEST_IMPACT
            and new[i] * pulls[i] < 0
            for i in (0, 1)
        ]
        if not any(weak):
            return new, after
        new = (0 if weak[0] else new[0], 0 if weak[1] else new[1])
        after = model.projected((new[0] or 1, new[1] or 1), new, state, theta, omega)


def scipy_stack(body: Body, acceleration: Array, dt: float, *, by_sample: bool = False) -> bool:
    """Statue on pedestal by ``solve_ivp``, DOP853, rtol 1e-10, impacts, openings and falls as contact events.

    ``by_sample`` as in ``scipy_lone``.
    """
    assert isinstance(body, Stack)
    model = Model(body, G)
    values = [*acceleration.tolist(), 0.0]
    ground = piecewise_linear(values, dt)
    low, high = rest_interval(model)
    moves = (np.array(values) < low) | (np.array(values) > high)
    end = (len(values) - 1) * dt + LONGEST_TAIL / model.frequency
    t, state, theta, omega = 0.0, (0, 0), (0.0, 0.0), (0.0, 0.0)
    while t < end:
        if state == (0, 0) and low <= ground(t) <= high:
            k = int(t / dt) + 1
            later = np.flatnonzero(moves[k:])
            if not later.size:
                return False
            k += int(later[0])
            before, after = max(t, (k - 1) * dt), k * dt
            a0, a1 = ground(before), values[k]
            limit = high if a1 > high else low
            t = before + (after - before) * (limit - a0) / (a1 - a0) + 1e-9
        state = model.settled(state, theta, omega, (ground(t), G))
        if state == (0, 0):
            continue

        def rates(t: float, y: Array, state: State = state) -> tuple[float, float, float, float]:
            th1, th2, w1, w2 = y.tolist()
            pull = ground(t), G
            return w1, w2, *model.accelerations(state, (th1, th2), (w1, w2), pull)

        # from a contact event just before a sample on to the one after
        stop = (int(t / dt + 1e-7) + 1) * dt if by_sample else end
        run = solve_ivp(
            rates, (t, stop), np.array([*theta, *omega]), method="DOP853", rtol=1e-10, atol=1e-13,
            first_step=min(dt, stop - t), max_step=dt, events=watches(model, state, t, ground),
        )  # fmt: skip
        if run.t_events[2].size:
            return True
        t = float(run.t[-1])
        th1, th2, w1, w2 = run.y[:, -1].tolist()
        gaps, parts = (th1, th2 - th1), (w1, w2 - w1)
        shut = [
            i
            for i, c in enumerate(state)
            if c and (run.t_events[i].size or (c * gaps[i] < 1e-13 and c * parts[i] < 0))
        ]
        th1 = 0.0 if 0 in shut or state[0] == 0 else th1
        theta = (th1, th1 if 1 in shut or state[1] == 0 else th2)
        omega = (w1, w1 if state[1] == 0 else w2)
        if shut:
            state, omega = landed(model, state, shut, theta, omega, ground(t))
    return False
