"""Bodies on each other by scipy's ``solve_ivp``, the counterpart of ``competitors.scipy_lone``.

The mechanics (contact states, impacts, what a closed contact can hold) is that of
`rocking_integrator`.
"""

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from rockfrag.system.blocks import Body

from .competitors import SLOWEST_IMPACT, Array, G
from .rocking_integrator import LONGEST_TAIL, Run
from .rocking_model import Model, rates

Watch = Callable[[float, Array], float]

SLACK = 1e-10
"""What a closed contact may pull before it opens, of weight times half width [-]: it then parts at once."""

JUST_OPEN = 1e-300
"""A gap at the start of an integration [rad]: where a contact has just opened no closing is found."""


class _WholeRun(Run):
    """A response whose time runs on through all samples."""

    def ground(self, t: float) -> list[float]:
        """Accelerations of the ground, linear between samples and zero after the last [m/s²]."""
        x = t / self.dt
        k = int(x)
        early, late = self.samples[k : k + 2] if k + 1 < len(self.samples) else (0.0, 0.0)
        return [early + (x - k) * (late - early), 0.0]


def rest_interval(model: Model) -> tuple[float, float]:
    """Accelerations of the ground [m/s²] between which what is at rest stays so."""
    rest = np.zeros(model.count)
    still, pushed = (model.margins((0,) * rest.size, rest, rest, (a, G)) for a in (0.0, 1.0))
    limits = [still[key] / (still[key] - pushed[key]) for key in still]
    return max(a for a in limits if a < 0), min(a for a in limits if a > 0)


def watches(run: Run, start: float) -> list[Watch]:
    """What must stay positive from ``start`` on: every contact, open or closed, and nothing lies."""

    def gap(t: float, y: Array, i: int) -> float:
        return run.state[i] * (y[i] - (y[i - 1] if i else 0.0)) if t > start else JUST_OPEN

    def hold(t: float, y: Array) -> float:
        margins = run.model.margins(run.state, *y.reshape(2, -1), (run.ground(t)[0], G))
        return SLACK + min(margins.values())

    def falls(t: float, y: Array) -> float:
        theta = y[: run.model.count]
        return math.pi / 2 - max(np.abs(theta).max(), np.abs(rates(theta)).max())

    contact_events: list[Watch] = [
        (lambda t, y, i=i: gap(t, y, i)) if c else hold for i, c in enumerate(run.state)
    ]
    for contact_event in (*contact_events, falls):
        contact_event.terminal, contact_event.direction = True, -1  # type: ignore[attr-defined]
    return [*contact_events, falls]


def scipy_stack(body: Body, acceleration: Array, dt: float, *, by_sample: bool = False) -> bool:
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
            k = int(t / dt) + 1
            later = np.flatnonzero(moves[k:])
            if not later.size:
                return False
            k += int(later[0])
            before, after = max(t, (k - 1) * dt), k * dt
            a0, a1 = run.ground(before)[0], values[k]
            limit = high if a1 > high else low
            t = before + (after - before) * (limit - a0) / (a1 - a0) + 1e-9
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
        run.apply(t, {("gap", i) for i, e in enumerate(contact_events) if e.size and run.state[i]})
    return False
