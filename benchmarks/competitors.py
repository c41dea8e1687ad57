"""Other ways to the same outcomes: scipy's solve_ivp, by itself and on the reference's mechanics, and plain numpy.

Every one stops as soon as a block has turned by a right angle or the motion is over.
"""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from rockfrag.system.blocks import Block, Body
from tests.oracle.rocking_integrator import LONGEST_TAIL, Run
from tests.oracle.rocking_model import Model, rates

G = 9.81
Array = NDArray[np.float64]

SLOWEST_IMPACT = 1e-4
"""Speed after an impact [rad/s] below which solve_ivp's block rests: following its chatter to 1e-6 rad/s
takes several times as long and changes no outcome."""


def end_of_rest(
    t: float,
    dt: float,
    values: Sequence[float] | Array,
    moves: NDArray[np.bool_],
    ground: Callable[[float], float],
    limits: tuple[float, float],
) -> float:
    """Instant after ``t`` just behind which the ground leaves ``limits``, infinite if it stays within them.

    ``moves`` are the samples outside them.
    """
    k = int(t / dt) + 1
    later = np.flatnonzero(moves[k:])
    if not later.size:
        return math.inf
    k += int(later[0])
    before, after = max(t, (k - 1) * dt), k * dt
    a0, a1 = ground(before), values[k]
    low, high = limits
    return (
        before
        + (after - before) * ((high if a1 > high else low) - a0) / (a1 - a0)
        + 1e-9
    )


def scipy_lone(
    body: Body, acceleration: Array, dt: float, *, by_sample: bool = False
) -> bool:
    """Housner's block by ``solve_ivp``, DOP853, rtol 1e-10, impacts and falls as contact events.

    Each call ends at a contact event; with ``by_sample`` at the next sample too, where the ground's acceleration
    has a kink: steps across kinks fail, and no user who does not know it would look there.
    """
    assert isinstance(body, Block)
    alpha, p2, e = body.alpha, body.frequency() ** 2, body.momentum_restitution()
    values: list[float] = [*acceleration.tolist(), 0.0]
    limit = G * math.tan(alpha)
    end = (len(values) - 1) * dt
    moves = np.abs(np.array(values)) > limit

    def ground(t: float) -> float:
        k = min(int(t / dt), len(values) - 2)
        return values[k] + (t / dt - k) * (values[k + 1] - values[k])

    def flight(side: int, start: float) -> tuple[Any, Any, Any]:
        def rates(t: float, y: Array) -> tuple[float, float]:
            psi = alpha - y[0]
            return y[1], -p2 * (math.sin(psi) + side * ground(t) / G * math.cos(psi))

        def lands(t: float, y: Array) -> float:
            return float(y[0]) if t > start or y[0] > 0.0 else 1e-300

        def falls(t: float, y: Array) -> float:
            return float(y[0]) - math.pi / 2

        lands.terminal, lands.direction, falls.terminal = True, -1, True  # type: ignore[attr-defined]
        return rates, lands, falls

    t, height, omega, side = 0.0, 0.0, 0.0, 0
    while t < end:
        if side == 0:
            now = ground(t)
            if abs(now) <= limit:
                t = end_of_rest(t, dt, values, moves, ground, (-limit, limit))
                if t == math.inf:
                    return False
                now = ground(t)
            side, omega = (-1 if now > 0 else 1), 0.0
        rates, lands, falls = flight(side, t)
        back = p2 * (math.sin(alpha) + side * ground(t) / G * math.cos(alpha))
        first = min(dt, omega / back if back > 0 and omega > 0 else dt)
        stop = min(end, (int(t / dt + 1e-7) + 1) * dt) if by_sample else end
        run = solve_ivp(
            rates, (t, stop), (height, omega), method="DOP853", rtol=1e-10, atol=1e-13,
            first_step=min(max(first, 1e-12), stop - t), max_step=dt, events=(lands, falls),
        )  # fmt: skip
        if run.t_events[1].size:
            return True
        if not run.t_events[0].size:
            t, height, omega = (
                float(run.t[-1]),
                float(run.y[0, -1]),
                float(run.y[1, -1]),
            )
            continue
        height = 0.0
        t, omega = float(run.t_events[0][0]), e * abs(float(run.y_events[0][0][1]))
        side = 0 if omega < SLOWEST_IMPACT and abs(ground(t)) <= limit else -side
    return height > alpha


def numpy_lone(
    bodies: Sequence[Block], accelerations: Sequence[Array], scales: Array, dt: float
) -> NDArray[np.bool_]:
    """Advance all cases together by Runge-Kutta steps of one sample; impacts and uplift at its end."""
    shape = (len(bodies), *scales.shape)
    i, j, k = (index.ravel() for index in np.indices(shape))
    alpha = np.array([body.alpha for body in bodies])[i]
    p2 = np.array([body.frequency() ** 2 for body in bodies])[i]
    e = np.array([body.momentum_restitution() for body in bodies])[i]
    motion = np.array(accelerations)
    factor = scales[j, k] / G
    fallen = np.zeros(i.size, dtype=bool)
    case = np.arange(i.size)
    side, phi, w = np.zeros(i.size), np.zeros(i.size), np.zeros(i.size)
    tangent = np.tan(alpha)
    for n in range(motion.shape[1] - 1):
        a0, a1 = factor * motion[j, n], factor * motion[j, n + 1]
        rest = side == 0
        side = np.where(rest & (np.abs(a0) > tangent), -np.sign(a0), side)
        middle = 0.5 * (a0 + a1)
        s0, sm, s1 = side * a0, side * middle, side * a1

        def rate(x: Array, a: Array, p2: Array = p2, alpha: Array = alpha) -> Array:
            return -p2 * (np.sin(alpha - x) + a * np.cos(alpha - x))

        k1 = rate(phi, s0)
        k2 = rate(phi + dt / 2 * w, sm)
        k3 = rate(phi + dt / 2 * w + dt * dt / 4 * k1, sm)
        k4 = rate(phi + dt * w + dt * dt / 2 * k2, s1)
        rocks = side != 0
        phi = np.where(rocks, phi + dt * w + dt * dt / 6 * (k1 + k2 + k3), 0.0)
        w = np.where(rocks, w + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4), 0.0)
        lands = rocks & (phi < 0)
        w = np.where(lands, e * np.abs(w), w)
        phi = np.where(lands, 0.0, phi)
        side = np.where(
            lands, np.where((w < 1e-3) & (np.abs(a1) < tangent), 0.0, -side), side
        )
        w = np.where(side == 0, 0.0, w)
        if n % 50 == 49:
            down = phi > math.pi / 2
            fallen[case[down]] = True
            keep = ~down
            case, j, factor = case[keep], j[keep], factor[keep]
            alpha, p2, e, tangent = alpha[keep], p2[keep], e[keep], tangent[keep]
            side, phi, w = side[keep], phi[keep], w[keep]
    fallen[case[phi > alpha]] = True
    return fallen.reshape(shape)


Watch = Callable[[float, Array], float]

SLACK = 1e-10
"""What a closed contact may pull before it opens, of weight times half width [-]: it then parts at once."""

JUST_OPEN = 1e-300
"""A gap at the start of an integration [rad]: where a contact has just opened no closing is found."""


class _WholeRun(Run):
    """A response whose time runs on through all samples."""

    samples: list[float]

    def ground(self, t: float) -> list[float]:
        """Accelerations of the ground, linear between samples and zero after the last [m/s²]."""
        x = t / self.dt
        k = int(x)
        early, late = (
            self.samples[k : k + 2] if k + 1 < len(self.samples) else (0.0, 0.0)
        )
        return [early + (x - k) * (late - early), 0.0]


def rest_interval(model: Model) -> tuple[float, float]:
    """Accelerations of the ground [m/s²] between which what is at rest stays so."""
    rest = np.zeros(model.count)
    still, pushed = (
        model.margins((0,) * rest.size, rest, rest, (a, G)) for a in (0.0, 1.0)
    )
    limits = [still[key] / (still[key] - pushed[key]) for key in still]
    return max(a for a in limits if a < 0), min(a for a in limits if a > 0)


def watches(run: Run, start: float) -> list[Watch]:
    """What must stay positive from ``start`` on: every contact, open or closed, and nothing lies."""

    def gap(t: float, y: Array, i: int) -> float:
        return (
            run.state[i] * (y[i] - (y[i - 1] if i else 0.0)) if t > start else JUST_OPEN
        )

    def hold(t: float, y: Array) -> float:
        theta, omega = y.reshape(2, -1)
        margins = run.model.margins(run.state, theta, omega, (run.ground(t)[0], G))
        return SLACK + min(margins.values())

    def falls(t: float, y: Array) -> float:
        theta = y[: run.model.count]
        return float(math.pi / 2 - max(np.abs(theta).max(), np.abs(rates(theta)).max()))

    contact_events: list[Watch] = [
        partial(gap, i=i) if c else hold for i, c in enumerate(run.state)
    ]
    for contact_event in (*contact_events, falls):
        contact_event.terminal, contact_event.direction = True, -1  # type: ignore[attr-defined]
    return [*contact_events, falls]


def scipy_stack(
    body: Body, acceleration: Array, dt: float, *, by_sample: bool = False
) -> bool:
    """Whether bodies fall, by ``solve_ivp``, DOP853, rtol 1e-10, impacts, openings and falls as contact events.

    ``by_sample`` as in ``scipy_lone``.
    """
    model = Model(body, G)
    values = np.append(acceleration, 0.0)
    run = _WholeRun(model, np.array([values, 0 * values]), dt, SLOWEST_IMPACT)
    run.samples = values.tolist()
    low, high = rest_interval(model)
    moves = (values < low) | (values > high)
    end = (values.size - 1) * dt + LONGEST_TAIL / model.frequency
    t = 0.0
    while t < end:
        if run.resting() and low <= run.ground(t)[0] <= high:
            t = end_of_rest(
                t, dt, values, moves, lambda s: run.ground(s)[0], (low, high)
            )
            if t == math.inf:
                return False
        run.apply(t, set())
        if run.resting():
            continue
        # from a contact event just before a sample on to the one after
        stop = (int(t / dt + 1e-7) + 1) * dt if by_sample else end
        found = solve_ivp(
            run.rates, (t, stop), run.y, method="DOP853", rtol=1e-10, atol=1e-13,
            first_step=min(dt, stop - t), max_step=dt, events=watches(run, t),
        )  # fmt: skip
        *contact_events, falls = found.t_events
        if falls.size:
            return True
        t = float(found.t[-1])
        run.take(found.y[:, -1])
        run.apply(
            t,
            {
                ("gap", i)
                for i, e in enumerate(contact_events)
                if e.size and run.state[i]
            },
        )
    return False
