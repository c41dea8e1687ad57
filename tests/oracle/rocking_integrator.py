"""The reference integrator: slow, tight and plain, to judge the fast one by.

Dormand and Prince's 8(5,3) pair (Hairer, Nørsett & Wanner 1993, as scipy's DOP853) with relative
tolerance 1e-10 between the samples of the motion, where the acceleration is linear, and every contact event
located on the dense output.  The mechanics is that of `rocking_model`;
nothing is shared with the fast kernel but the bodies.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.system.blocks import Block, Stack
from rockfrag.units import GRAVITY

from .rocking_model import (
    NEGLIGIBLE_SPEED,
    LinearModel,
    Model,
    Pair,
    State,
)

RTOL, ATOL = 1e-10, 1e-14

# A contact that would part at less than this speed after an impact is closed, if it would fall shut
# again anyway; a fraction of the frequency parameter p [-].
CHATTER = 1e-6

# slack of the contact moments before a contact opens, of weight times half width [-]: it makes the
# acceleration at the opening strictly parting
SLACK = 1e-12

# a contact counts as closed this far below zero [rad], which is above the noise of the dense output
TOUCH = 1e-15

# longest free rocking after the motion's end, over 1/p, if no duration is given [-]
LONGEST_TAIL = 1000.0

MOST_CONTACT_EVENTS = 200_000

# where to look for contact events inside a step, as fractions of it: after a contact has just opened, while
# one is full, otherwise
_FRESH = np.concatenate([np.logspace(-10, -1, 19), np.linspace(0.15, 1.0, 18)])
_STUCK = np.array([0.25, 0.5, 0.75, 1.0])
_ENDS = np.array([1.0])

Values = NDArray[np.float64]
Watch = tuple[str, int]


@dataclass(frozen=True)
class ReferenceContactEvent:
    """One change of the contact state.

    ``kind`` is "opening", "impact", "closing" (an impact too weak to part again) or "overturning";
    angular velocities in [rad/s], columns as in the response.
    """

    time: float
    kind: str
    before: tuple[int, ...]
    after: tuple[int, ...]
    theta: tuple[float, ...]
    omega_before: tuple[float, ...]
    omega_after: tuple[float, ...]


@dataclass(frozen=True)
class ReferenceResponse:
    """Response at the samples of the motion and, if it goes on, every dt after its end.

    Parameters
    ----------
    time
        Time [s], shape (n,); the last sample before overturning is the last one.
    theta, omega
        Rotation [rad] and angular velocity [rad/s], shape (n, 1) or (n, 2): pedestal, statue.
    state
        Contact states, shape (n, 1) or (n, 2): ground, interface.
    contact_events
        Every contact event in order.
    overturned
        Whether a block passed π/2.
    overturned_body
        0 for none, 1 for the lone block or the pedestal, 2 for the statue.
    overturning_time
        When it passed π/2 [s]; NaN if none did.
    at_rest
        Whether everything stands in full contact at the end.
    given_way
        Impacts in which a measured restitution gave way, lest energy grow.
    """

    time: NDArray[np.float64]
    theta: NDArray[np.float64]
    omega: NDArray[np.float64]
    state: NDArray[np.int8]
    contact_events: tuple[ReferenceContactEvent, ...]
    overturned: bool
    overturned_body: int
    overturning_time: float
    at_rest: bool
    given_way: int


def simulate_reference(
    body: Block | Stack,
    acceleration: ArrayLike,
    dt: float,
    *,
    theta0: ArrayLike | None = None,
    omega0: ArrayLike | None = None,
    restitution: Restitution = None,
    linear: bool = False,
    vertical: ArrayLike | None = None,
    g: float = GRAVITY,
    duration: float | None = None,
    chatter: float = CHATTER,
) -> ReferenceResponse:
    """Rock a block or a stack on a shaken ground, slowly and accurately.

    Parameters
    ----------
    body
        A block or a stack.
    acceleration
        Acceleration of the ground at the samples [m/s²], shape (n,), linear in between and zero
        after the last.
    dt
        Time between samples [s].
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start: a number for a block, a pair
        (pedestal, statue) for a stack; zero if not given.
    restitution
        None conserves angular momentum about the new pivot.  A measured value instead, one number
        for a block, a pair (ground, interface) for a stack, either of which may be None, or a
        :class:`MeasuredRestitution` with its law: the lone block leaves with ω⁺ = value · ω⁻.
    linear
        Use the linearised equations 2.9 and 2.60 to 2.65.
    vertical
        Acceleration of the ground upwards [m/s²], sampled likewise.
    g
        Gravity [m/s²].
    duration
        When to stop at the latest [s]; by default when all is at rest or a block has overturned.
    chatter
        Parting speed after an impact, over p, below which a contact is closed [-].
    """
    motion = np.asarray(acceleration, dtype=float)
    up = np.zeros(motion.size) if vertical is None else np.asarray(vertical, dtype=float)
    model = (LinearModel if linear else Model)(body, g, restitution)
    theta, omega = _start(theta0), _start(omega0)
    return _Run(model, (motion, up), dt, theta, omega, chatter * model.frequency).response(duration)


def _start(value: ArrayLike | None) -> Pair:
    """Values of the lower and the upper body; a lone block is the upper one."""
    numbers = np.atleast_1d(0.0 if value is None else np.asarray(value, dtype=float))
    return (0.0 if numbers.size == 1 else float(numbers[0])), float(numbers[-1])


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


def _gaps(values: Sequence[float] | NDArray[np.float64]) -> Pair:
    """Rotation (or velocity) of each block relative to what it stands on."""
    return float(values[0]), float(values[1] - values[0])


class _Run:
    """One response as it unfolds; time inside a sample interval is counted from its start."""

    def __init__(
        self,
        model: Model,
        motion: tuple[Values, Values],
        dt: float,
        theta: Pair,
        omega: Pair,
        chatter: float,
    ) -> None:
        self.model, self.dt, self.chatter = model, dt, chatter
        self.motion, self.vertical = motion
        self.theta, self.omega = theta, omega
        gaps, rates = _gaps(theta), _gaps(omega)
        self.state: State = (_sign(gaps[0] or rates[0]), _sign(gaps[1] or rates[1]))
        self.fallen = self.given_way = 0
        self.contact_events: list[ReferenceContactEvent] = []
        self.start = 0.0
        self.early = self.late = (0.0, model.g)
        self.columns = slice(1, 2) if model.alone else slice(0, 2)

    def response(self, duration: float | None) -> ReferenceResponse:
        """Run to the end and collect the samples."""
        last = self.motion.size - 1
        end = last * self.dt + LONGEST_TAIL / self.model.frequency
        steps = math.ceil((end if duration is None else duration) / self.dt * (1 - 1e-12))
        rows = [(0.0, self.theta, self.omega, self.state)]
        for k in range(steps):
            self.start = k * self.dt
            # zero from the last sample on
            self.early, self.late = [
                (float(self.motion[j]), self.model.g + float(self.vertical[j]))
                if k < last
                else (0.0, self.model.g)
                for j in (k, min(k + 1, last))
            ]
            if k in (0, last):
                self._settle(0.0)
                if k == 0:
                    rows = [(0.0, self.theta, self.omega, self.state)]
            if k >= last and self.state == (0, 0):
                if duration is None:
                    break
            else:
                self._interval()
            if self.fallen:
                break
            rows.append(((k + 1) * self.dt, self.theta, self.omega, self.state))
        return ReferenceResponse(
            time=np.array([row[0] for row in rows]),
            theta=np.array([row[1] for row in rows])[:, self.columns],
            omega=np.array([row[2] for row in rows])[:, self.columns],
            state=np.array([row[3] for row in rows], dtype=np.int8)[:, self.columns],
            contact_events=tuple(self.contact_events),
            overturned=self.fallen > 0,
            overturned_body=self.fallen,
            overturning_time=self.contact_events[-1].time if self.fallen else math.nan,
            at_rest=self.state == (0, 0),
            given_way=self.given_way,
        )

    def _interval(self) -> None:
        """Go from one sample to the next through all the contact events between them."""
        t = 0.0
        in_place = 0
        while t < self.dt and not self.fallen:
            before = t
            t = self._stand(t) if self.state == (0, 0) else self._move(t)
            in_place = in_place + 1 if t == before else 0
            if in_place > 100 or len(self.contact_events) > MOST_CONTACT_EVENTS:
                raise ArithmeticError(f"contact events without end at {self.start + t} s")

    def _pull(self, t: float) -> Pair:
        """Acceleration of the ground, and gravity with its upward one [m/s²]."""
        x = t / self.dt
        first, other = self.early, self.late
        return first[0] + x * (other[0] - first[0]), first[1] + x * (other[1] - first[1])

    # ------------------------------------------------------- between contact events

    def _stand(self, t: float) -> float:
        """Everything is at rest: contact moments are linear in time, so the opening is exact."""
        model, rest = self.model, (0, 0)
        early = model.margins(rest, self.theta, self.omega, self._pull(t))
        late = model.margins(rest, self.theta, self.omega, self._pull(self.dt))
        crossings = [
            t + (self.dt - t) * max(early[key] + SLACK, 0.0) / (early[key] - late[key])
            for key in early
            if late[key] + SLACK < 0 and late[key] < early[key]
        ]
        if not crossings:
            return self.dt
        t = min(crossings)
        self._settle(t)
        return t

    def _move(self, t: float) -> float:
        """Integrate up to the next contact event or the end of the interval, whichever comes first."""
        model, state = self.model, self.state

        def rates(time: float, y: NDArray[np.float64]) -> list[float]:
            w1, w2 = float(y[2]), float(y[3])
            q1, q2 = model.accelerations(
                state, (float(y[0]), float(y[1])), (w1, w2), self._pull(time)
            )
            return [w1, w2, q1, q2]

        longest = 0.05 / model.frequency
        solver = DOP853(
            rates,
            t,
            np.array([*self.theta, *self.omega]),
            self.dt,
            rtol=RTOL,
            atol=ATOL,
            max_step=longest,
            first_step=min(self.dt - t, longest),
        )
        while solver.status == "running":
            t0, y0 = solver.t, solver.y.copy()
            solver.step()
            if solver.status == "failed":
                raise ArithmeticError(f"the integration failed at {self.start + solver.t} s")
            found = self._first_contact_event(t0, y0, solver)
            if found is not None:
                time, watched, y = found
                self._take(y)
                self._apply(time, watched)
                return time
        self._take(solver.y)
        return self.dt

    def _take(self, y: Values) -> None:
        theta, omega = (float(y[0]), float(y[1])), (float(y[2]), float(y[3]))
        if self.state[1] == 0:  # what is stuck turns as what it stands on, to the last bit
            theta, omega = (theta[0], theta[0]), (omega[0], omega[0])
        self.theta, self.omega = theta, omega

    # --------------------------------------------------------------- contact events

    def _watched(self, time: float, y: Values) -> dict[Watch, float]:
        """Every quantity that must stay positive until the next contact event."""
        theta, omega = (float(y[0]), float(y[1])), (float(y[2]), float(y[3]))
        gaps = _gaps(theta)
        values: dict[Watch, float] = {
            ("gap", i): c * gaps[i] + TOUCH for i, c in enumerate(self.state) if c != 0
        }
        values |= {("upright", i): math.pi / 2 - abs(theta[i]) for i in (0, 1)}
        if 0 in self.state:
            moments = self.model.margins(self.state, theta, omega, self._pull(time))
            values |= {("press", c * s): margin + SLACK for (c, s), margin in moments.items()}
        return values

    def _first_contact_event(
        self, t0: float, y0: Values, solver: DOP853
    ) -> tuple[float, list[Watch], Values] | None:
        """Earliest zero of a watched quantity in the last step, and all that vanish with it."""
        t1, y1 = solver.t, solver.y
        early, late = self._watched(t0, y0), self._watched(t1, y1)
        nodes = self._nodes(early, y0, y1)
        if nodes is None and min(late.values()) >= 0:
            return None
        dense = solver.dense_output()
        times = [t0 + (t1 - t0) * float(x) for x in (_ENDS if nodes is None else nodes)]
        times += self._nearest(dense, t0, t1, y0, y1)
        time, values = t0, early
        for node in sorted(times):
            now = late if node == t1 else self._watched(node, dense(node))
            roots = {
                key: self._root(dense, key, time, node, values[key])
                for key, value in now.items()
                if value < 0
            }
            if roots:
                when = min(roots.values())
                together = [key for key, root in roots.items() if root <= when + 1e-13]
                return when, together, y0 if when == t0 else dense(when)
            time, values = node, now
        return None

    def _nodes(self, early: dict[Watch, float], y0: Values, y1: Values) -> Values | None:
        """Where to look inside a step; None if its end tells all."""
        if any(key[0] == "gap" and value <= 2 * TOUCH for key, value in early.items()):
            return _FRESH
        rates0, rates1 = _gaps(y0[2:]), _gaps(y1[2:])
        if any(c * rates0[i] < 0 < c * rates1[i] for i, c in enumerate(self.state)):
            return _ENDS
        return _STUCK if 0 in self.state and not (self.model.alone and self.state[1]) else None

    def _nearest(
        self, dense: Callable[[float], Values], t0: float, t1: float, y0: Values, y1: Values
    ) -> list[float]:
        """Find the times inside the step at which a contact comes nearest to closing."""
        found = []
        rates0, rates1 = _gaps(y0[2:]), _gaps(y1[2:])
        for i, c in enumerate(self.state):
            if c * rates0[i] < 0 < c * rates1[i]:

                def rate(time: float, i: int = i) -> float:
                    return _gaps(dense(time)[2:])[i]

                found.append(float(brentq(rate, t0, t1, xtol=1e-15)))
        return found

    def _root(
        self, dense: Callable[[float], Values], key: Watch, t0: float, t1: float, first: float
    ) -> float:
        if first <= 0:
            return t0
        return float(brentq(lambda t: self._watched(t, dense(t))[key], t0, t1, xtol=1e-16))

    def _apply(self, time: float, watched: list[Watch]) -> None:
        """Change the state at a contact event."""
        down = [i for kind, i in watched if kind == "upright"]
        if down:
            self.fallen = 1 if self.model.alone else min(down) + 1
            self._note(time, "overturning", self.state, self.omega)
            return
        shut = [i for kind, i in watched if kind == "gap"]
        if shut:
            self._close(time, shut)
        self._settle(time)

    def _close(self, time: float, shut: list[int]) -> None:
        """Let the contacts ``shut`` close, and any other that closes at the same instant."""
        gaps, rates = _gaps(self.theta), _gaps(self.omega)
        for i, c in enumerate(self.state):
            if c != 0 and i not in shut and c * gaps[i] < 1e-13 and c * rates[i] < 0:
                shut = [*shut, i]
        theta1 = 0.0 if 0 in shut else self.theta[0]
        self.theta = (theta1, theta1 if 1 in shut else self.theta[1])
        if 0 in shut and 1 not in shut and self.state[1] == 0:
            self.theta = (0.0, 0.0)
        old, before = self.state, self.omega
        closing = (old[0] if 0 in shut else 0, old[1] if 1 in shut else 0)
        quiet = {i for i in shut if old[i] * rates[i] > -NEGLIGIBLE_SPEED * self.model.frequency}
        if quiet == set(shut):
            new, after = self._shut(old, quiet, old, before)
        else:
            new, after, gave_way = self.model.impact(old, closing, self.theta, before)
            self.given_way += gave_way
            # with one contact shut another may turn out to be as weak
            while weak := self._too_weak(time, new, after, old, closing):
                new, after = self._shut(new, weak, old, before)
                quiet |= weak
        kind = "closing" if quiet else "impact"
        self.state, self.omega = new, after
        self._note(time, kind, old, before)

    def _shut(self, new: State, weak: set[int], old: State, before: Pair) -> tuple[State, Pair]:
        """Close weak contacts for good; the velocities of the others follow from momentum."""
        new = (0 if 0 in weak else new[0], 0 if 1 in weak else new[1])
        pivots = (float(new[0] or 1), float(new[1] or 1))
        return new, self.model.projected(pivots, new, old, self.theta, before)

    def _too_weak(
        self, time: float, new: State, after: Pair, old: State, closing: State
    ) -> set[int]:
        """List contacts that part so slowly after an impact that they would only chatter."""
        parting = _gaps(after)
        pull = _gaps(self.model.accelerations(new, self.theta, after, self._pull(time)))
        return {
            i
            for i in (0, 1)
            if new[i] != 0
            and (closing[i] != 0 or old[i] == 0)
            and abs(parting[i]) < self.chatter
            and new[i] * pull[i] < 0
        }

    def _settle(self, time: float) -> None:
        """Open what cannot stay closed."""
        old = self.state
        self.state = self.model.settled(old, self.theta, self.omega, self._pull(time))
        if self.state != old:
            self._note(time, "opening", old, self.omega)

    def _note(self, time: float, kind: str, old: State, before: Pair) -> None:
        cut = self.columns
        self.contact_events.append(
            ReferenceContactEvent(
                time=self.start + time,
                kind=kind,
                before=tuple(old)[cut],
                after=tuple(self.state)[cut],
                theta=tuple(self.theta)[cut],
                omega_before=tuple(before)[cut],
                omega_after=tuple(self.omega)[cut],
            )
        )
