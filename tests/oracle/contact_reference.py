"""The reference integrator with friction and flight: slow, tight and plain, to judge the fast one by.

Dormand and Prince's 8(5,3) pair from sample to sample, every contact event located on its dense output, and at
every contact event an enumeration of all modes that the closed contacts allow.  The mechanics is that of
:mod:`contact_model`; nothing but the bodies is shared with the fast kernels.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from rockfrag.errors import InputError
from rockfrag.system import Block, Column, Stack, System, as_system
from rockfrag.system.contact import Friction
from rockfrag.units import GRAVITY

from .contact_model import (
    AT_EDGE,
    FULL,
    OPEN,
    Contact,
    End,
    InterfaceMode,
    Mode,
    Model,
    Solution,
)

Array = NDArray[np.float64]
Key = tuple[str, int, int]

RTOL, ATOL = 1e-10, 1e-13

# slack before a contact event is seen, so that what has just begun is not taken for its end: forces over the
# weight, speeds over √(g b), lengths over b [-]
SLACK = 1e-12
TOUCH = 1e-13

# a mode that violates its inequalities by less than this is consistent [-]; less than SLACK
CONSISTENT = 2e-13

# a contact that parts at less than this fraction of √(g b) after an impact, and would fall shut again, is closed
CLOSING = 1e-6

LONGEST_TAIL = 60.0  # free motion after the last sample, over 1/p
MOST_CONTACT_EVENTS = 20_000

_NODES = np.linspace(0.0, 1.0, 7)[1:]
_FRESH = np.concatenate([np.logspace(-9, -1, 17), np.linspace(0.2, 1.0, 9)])


@dataclass(frozen=True)
class ContactEvent:
    """One change of the mode: ``kind`` is "impact", "change", "paradox" or "fall"."""

    time: float
    kind: str
    before: Mode
    after: Mode
    loss: float  # kinetic energy [J]


@dataclass(frozen=True)
class ContactResponse:
    """Response at the samples.

    Parameters
    ----------
    time
        Shape (n,) [s].
    position, velocity
        x, y, θ of each body relative to the moving ground, shape (n, 3 bodies) [m, rad].
    slip
        Displacement along each interface of the corner that carries, shape (n, bodies) [m].
    contact_events
        In their order.
    overturned, overturned_body, overturning_time
        Whether, which (1 the lone block or the pedestal, 2 the statue) and when [s].
    energy
        Kinetic, potential, input by the ground, lost in impacts, lost to friction, shape (n, 5) [J].
    """

    time: Array
    position: Array
    velocity: Array
    slip: Array
    contact_events: tuple[ContactEvent, ...]
    overturned: bool
    overturned_body: int
    overturning_time: float
    energy: Array

    @property
    def theta(self) -> Array:
        """Rotations, shape (n, bodies) [rad]."""
        return self.position[:, 2::3]


def simulate_reference(
    body: Block | Stack | Column | System,
    acceleration: ArrayLike,
    dt: float,
    *,
    friction: Sequence[float],
    vertical: ArrayLike | None = None,
    theta0: ArrayLike | None = None,
    omega0: ArrayLike | None = None,
    g: float = GRAVITY,
    duration: float | None = None,
    closing: float = CLOSING,
) -> ContactResponse:
    """Rock, slide and fly a block or a stack on a shaken ground, slowly and accurately.

    Parameters
    ----------
    body
        What stands.
    acceleration, vertical
        Horizontal and vertical acceleration of the ground [m/s²], shape (n,), linear between samples and
        zero one sample after the last.
    dt
        Time between samples [s].
    friction
        Of each contact from below, static and kinetic.
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start, of bodies that touch at the corners which
        these leave.
    duration
        When to stop at the latest [s]; by default when all is at rest or a block has fallen.
    closing
        Parting speed after an impact, over √(g b), below which a contact is closed [-].

    Raises
    ------
    InputError
        If a motion is not a finite sequence of two samples or more, or friction does not fit.
    """
    motions = [np.asarray(acceleration, dtype=float)]
    motions.append(np.zeros_like(motions[0]) if vertical is None else np.asarray(vertical, float))
    if motions[0].ndim != 1 or motions[0].size < 2 or motions[1].shape != motions[0].shape:
        raise InputError("acceleration: needs two or more samples, and vertical as many.")
    if not all(np.isfinite(motion).all() for motion in motions):
        raise InputError("acceleration: every sample must be a finite number of m/s².")
    system = as_system(body)
    model = Model(system, tuple(Friction(mu, mu) for mu in friction), g)
    slowest = 0.3 * model.speed / model.size
    theta, omega = (
        [0.0] * model.count if x is None else np.atleast_1d(np.asarray(x, float)).tolist()
        for x in (theta0, omega0)
    )
    closed = np.array([np.append(motion, 0.0) for motion in motions])
    run = _Run(model, closed, dt, theta, omega, closing)
    return run.response(duration, LONGEST_TAIL / slowest, 0.05 / model.speed * model.size)


class _Run:
    def __init__(
        self,
        model: Model,
        motions: Array,
        dt: float,
        theta: list[float],
        omega: list[float],
        closing: float,
    ) -> None:
        self.model, self.motions, self.dt, self.closing = model, motions, dt, closing * model.speed
        self.q, self.v = model.posed(theta, omega)
        self.work = self.friction_loss = self.impact_loss = 0.0
        self.mode: Mode = tuple(OPEN for _ in range(model.count))
        self.kind: dict[End, bool] = {}
        self.ends = [(k, s) for k in range(model.count) for s in FULL]
        self.contact_events: list[ContactEvent] = []
        self.fallen = 0
        self.start, self.now = 0.0, np.zeros(2)
        self.slope = np.zeros(2)

    def response(self, duration: float | None, tail: float, longest: float) -> ContactResponse:
        self.longest = longest
        last = self.motions.shape[1] - 1
        end = last * self.dt + tail if duration is None else duration
        rows = []
        for i in range(math.ceil(end / self.dt * (1 - 1e-12)) + 1):
            self.start = i * self.dt
            self.now = self.motions[:, i] if i < last else np.zeros(2)
            self.slope = (
                np.diff(self.motions[:, i : i + 2])[:, 0] / self.dt if i < last else np.zeros(2)
            )
            if i in (0, last):
                self._handle(0.0, set())
            rows.append(self._row())
            if self._done() or (duration is None and i >= last and self._resting()):
                break
            self._interval()
            if self._done():
                break
        values = np.array(rows)
        n = 3 * self.model.count
        return ContactResponse(
            time=np.arange(len(rows), dtype=np.float64) * self.dt,
            position=values[:, :n],
            velocity=values[:, n : 2 * n],
            slip=values[:, 2 * n : 2 * n + self.model.count],
            contact_events=tuple(self.contact_events),
            overturned=self.fallen > 0,
            overturned_body=self.fallen,
            overturning_time=self.contact_events[-1].time if self.fallen else math.nan,
            energy=values[:, -5:],
        )

    def _done(self) -> bool:
        return self.fallen > 0

    def _row(self) -> list[float]:
        m, n = self.model, self.model.count
        kinetic = 0.5 * float(self.v @ (m.mass * self.v))
        potential = m.g * sum(float(m.mass[3 * k] * self.q[3 * k + 1]) for k in range(n))
        slips = [m.slip(self.q, k) for k in range(n)]
        return [
            *self.q, *self.v, *slips, kinetic, potential, self.work, self.impact_loss, self.friction_loss,
        ]  # fmt: skip

    def _resting(self) -> bool:
        return all(mode == InterfaceMode(FULL, 0) for mode in self.mode) and not self.v.any()

    def _load(self, t: float) -> tuple[float, float]:
        a = self.now + self.slope * t
        return float(a[0]), float(a[1])

    # ------------------------------------------------------- between contact events

    def _interval(self) -> None:
        t, stalled = 0.0, 0
        while t < self.dt and not self.fallen:
            before = t
            t = self._stand(t) if self._resting() else self._move(t)
            stalled = stalled + 1 if t == before else 0
            if stalled > 50 or len(self.contact_events) > MOST_CONTACT_EVENTS:
                raise ArithmeticError(
                    f"contact events without end at {self.start + t} s: {self.mode}"
                )

    def _stand(self, t: float) -> float:
        """At rest every margin is linear in time."""
        early, late = self._margins(t, self.q, self.v), self._margins(self.dt, self.q, self.v)
        crossing = [
            (t + (self.dt - t) * max(early[key], 0.0) / (early[key] - late[key]), key)
            for key in early
            if late[key] < 0 and late[key] < early[key]
        ]
        if not crossing:
            return self.dt
        when = min(crossing)[0]
        self._handle(when, {key for time, key in crossing if time <= when + 1e-13})
        return when

    def _rates(self, t: float, y: Array) -> Array:
        n = 3 * self.model.count
        q, v = y[:n], y[n : 2 * n]
        load = self._load(t)
        contacts = self._contacts(q)
        found = self.model.solve(q, v, self.mode, contacts, load)
        mass = self.model.mass
        work = -sum(
            mass[3 * k] * (load[0] * v[3 * k] + load[1] * v[3 * k + 1])
            for k in range(self.model.count)
        )
        lost = 0.0
        for k, (closed, slides) in enumerate(self.mode):
            if slides:
                c = contacts[k, closed[0]]
                lost -= found.tangential[k] * float(self.model.row(q, k, c, c.tangent) @ v)
        return np.concatenate([v, found.rates, [work, lost]])

    def _move(self, t: float) -> float:
        y = np.concatenate([self.q, self.v, [self.work, self.friction_loss]])
        solver = DOP853(
            self._rates, t, y, self.dt, rtol=RTOL, atol=ATOL, max_step=self.longest,
            first_step=min(self.dt - t, self.longest),
        )  # fmt: skip
        fresh = True
        while solver.status == "running":
            t0, y0 = solver.t, solver.y.copy()
            solver.step()
            if solver.status == "failed":
                raise ArithmeticError(f"the integration failed at {self.start + solver.t} s")
            found = self._first_contact_event(t0, y0, solver, fresh)
            fresh = False
            if found is not None:
                time, keys, y = found
                self._take(y)
                self._project()
                self._handle(time, keys)
                return time
        self._take(solver.y)
        self._project()
        return self.dt

    def _take(self, y: Array) -> None:
        n = 3 * self.model.count
        self.q, self.v = y[:n].copy(), y[n : 2 * n].copy()
        self.work, self.friction_loss = float(y[-2]), float(y[-1])

    def _project(self) -> None:
        """Take away what rounding and integration have left at closed contacts."""
        model, n = self.model, self.model.count
        for k, (closed, slides) in enumerate(self.mode):
            if not closed:
                continue
            if closed == FULL:
                self.q[3 * k + 2] = self.q[3 * k - 1] if k else 0.0
                self.v[3 * k + 2] = self.v[3 * k - 1] if k else 0.0
            side = closed[0]
            c = model.contact(self.q, k, side, self.kind[k, side])
            for body in range(k, n):
                self.q[3 * body : 3 * body + 2] -= c.gap * c.normal
            c = model.contact(self.q, k, side, self.kind[k, side])
            wrong = float(model.row(self.q, k, c, c.normal) @ self.v) * c.normal
            if not slides:
                wrong = wrong + float(model.row(self.q, k, c, c.tangent) @ self.v) * c.tangent
            for body in range(k, n):
                self.v[3 * body : 3 * body + 2] -= wrong
        if all(mode == InterfaceMode(FULL, 0) for mode in self.mode):
            self.v[:] = 0.0

    # --------------------------------------------------------------- watching

    def _contacts(self, q: Array) -> dict[End, Contact]:
        return {(k, s): self.model.contact(q, k, s, self.kind.get((k, s))) for k, s in self.ends}

    def _closed(self, end: End) -> bool:
        return end[1] in self.mode[end[0]].closed

    def _margins(self, t: float, q: Array, v: Array) -> dict[Key, float]:
        """Everything that must stay positive until the next contact event."""
        model = self.model
        contacts = self._contacts(q)
        found = model.solve(q, v, self.mode, contacts, self._load(t))
        values: dict[Key, float] = {}
        for (k, s), c in contacts.items():
            if self._closed((k, s)):
                values["press", k, s] = found.normal[k, s] / model.weight + SLACK
                if k and self.mode[k].slides:
                    inside = AT_EDGE - c.beyond / model.size
                    values["edge", k, s] = (inside if c.on_face else -inside) + TOUCH
            else:
                values["gap", k, s] = c.gap / model.size + TOUCH
        for k, (closed, slides) in enumerate(self.mode):
            if closed and slides:
                c = contacts[k, closed[0]]
                speed = slides * float(model.row(q, k, c, c.tangent) @ v)
                values["slide", k, 0] = speed / model.speed + TOUCH
            elif closed:
                margin = model.stick_margin(k, found, closed, model.friction[k].static)
                values["stick", k, 0] = margin / model.weight + SLACK
        for k in range(model.count):
            turned = [q[3 * k + 2]] + ([q[3 * k + 2] - q[3 * k - 1]] if k else [])
            values["upright", k, 0] = math.pi / 2 - max(abs(x) for x in turned)
            if k:
                half = model.face[k][1]
                values["over", k, 0] = 2 * half + min(contacts[k, s].beyond for s in FULL)
        return values

    def _approach(self, q: Array, v: Array, end: End) -> float:
        c = self.model.contact(q, *end, self.kind.get(end))
        return float(self.model.row(q, end[0], c, c.normal) @ v)

    def _first_contact_event(
        self, t0: float, y0: Array, solver: DOP853, fresh: bool
    ) -> tuple[float, set[Key], Array] | None:
        n = 3 * self.model.count
        t1 = solver.t
        dense = solver.dense_output()

        def watched(t: float) -> dict[Key, float]:
            y = dense(t)
            return self._margins(t, y[:n], y[n : 2 * n])

        time, values, y = t0, self._margins(t0, y0[:n], y0[n : 2 * n]), y0
        opens = [end for end in self.ends if not self._closed(end)]
        for x in _FRESH if fresh else _NODES:
            node = t0 + (t1 - t0) * float(x)
            later = dense(node)
            stops = [node]
            for end in opens:
                # a contact that comes near and leaves again between two nodes
                rates = [self._approach(u[:n], u[n : 2 * n], end) for u in (y, later)]
                if rates[0] < 0 < rates[1]:
                    stops.append(self._nearest(dense, end, time, node))
            for stop in sorted(stops):
                now = watched(stop)
                failing = [key for key, value in now.items() if value < 0]
                if failing:
                    roots = {
                        key: time
                        if values[key] <= 0
                        else float(
                            brentq(lambda t, key=key: watched(t)[key], time, stop, xtol=1e-16)
                        )
                        for key in failing
                    }
                    when = min(roots.values())
                    keys = {key for key, root in roots.items() if root <= when + 1e-13}
                    return when, keys, y0 if when == t0 else dense(when)
                time, values = stop, now
            y = later
        return None

    def _nearest(self, dense: Callable[[float], Array], end: End, t0: float, t1: float) -> float:
        n = 3 * self.model.count

        def rate(t: float) -> float:
            y = dense(t)
            return self._approach(y[:n], y[n : 2 * n], end)

        return float(brentq(rate, t0, t1, xtol=1e-15))

    # --------------------------------------------------------------- contact events

    def _handle(self, t: float, keys: set[Key]) -> None:
        """Find the mode after a contact event (or at the start, where there are no keys)."""
        model, old = self.model, self.mode
        for name, k, _ in keys:
            if name in ("upright", "over"):
                self.fallen = k + 1
                self._note(t, "fall", old, 0.0)
                return
        leaving = set()
        for name, k, s in keys:
            if name == "edge":
                if self.mode[k].closed == FULL:
                    self.kind[k, s] = not self.kind[k, s]
                else:
                    leaving.add((k, s))  # a corner of the contact is passed: it goes on in flight
            if name == "slide":
                self.mode = tuple(
                    InterfaceMode(m.closed, 0) if i == k else m for i, m in enumerate(self.mode)
                )
                self._project()
        for end in leaving:
            self.kind.pop(end, None)
        touching = [
            end
            for end in self.ends
            if end not in leaving
            and (
                self._closed(end)
                or ("gap", *end) in keys
                or self._contacts(self.q)[end].gap < 1e-11 * model.size
            )
        ]
        self._shut(touching)
        kind, loss = "change", 0.0
        if any(self._approach(self.q, self.v, end) < -1e-13 * model.speed for end in touching):
            loss = self._impact(t, touching)
            kind = "impact"
        exclude = (
            old if kind == "change" and any(key[0] in ("press", "stick") for key in keys) else None
        )
        if not self._settle(t, touching, exclude):
            loss += self._impact(t, touching, push=True)
            kind = "paradox"
            self._settle(t, touching, None)
        if self.mode != old or kind != "change":
            self._note(t, kind, old, loss)

    def _shut(self, touching: list[End]) -> None:
        """Set the gaps of touching ends to zero."""
        model = self.model
        for k in range(model.count):
            sides = [s for i, s in touching if i == k]
            if len(sides) == 2:
                self.q[3 * k + 2] = self.q[3 * k - 1] if k else 0.0
            for s in sides[:1]:
                c = model.contact(self.q, k, s, self.kind.get((k, s)))
                for body in range(k, model.count):
                    self.q[3 * body : 3 * body + 2] -= c.gap * c.normal
        for end in touching:
            self.kind.setdefault(end, model.contact(self.q, *end).on_face)

    def _violation(
        self,
        mode: Mode,
        solution: Solution,
        contacts: dict[End, Contact],
        touching: list[End],
        units: tuple[float, float],
        load: tuple[float, float] | None,
        limits: list[float],
    ) -> float:
        """How far a mode is from being consistent; ``units`` of force (or impulse) and of rates."""
        model, worst = self.model, 0.0
        for k, s in touching:
            if s in mode[k].closed:
                worst = max(worst, -solution.normal[k, s] / units[0])
            else:
                c = contacts[k, s]
                apart = float(model.row(self.q, k, c, c.normal) @ solution.rates)
                if load is not None:
                    apart += model.bias(self.q, self.v, k, c, c.normal)
                worst = max(worst, -apart / units[1])
        for k, (closed, slides) in enumerate(mode):
            if closed and not slides:
                worst = max(worst, -model.stick_margin(k, solution, closed, limits[k]) / units[0])
            elif closed:
                c = contacts[k, closed[0]]
                along = float(model.row(self.q, k, c, c.tangent) @ solution.rates)
                if load is not None:
                    along += model.bias(self.q, self.v, k, c, c.tangent)
                    if abs(self._sliding(k, contacts, closed)) > 0:
                        continue
                worst = max(worst, -slides * along / units[1])
        return worst

    def _sliding(self, k: int, contacts: dict[End, Contact], closed: tuple[int, ...]) -> float:
        """Slip velocity of an interface; zero if it is nothing but rounding [m/s]."""
        c = contacts[k, closed[0]]
        speed = float(self.model.row(self.q, k, c, c.tangent) @ self.v)
        return speed if abs(speed) > 1e-12 * self.model.speed else 0.0

    def _ends_of(self, touching: list[End]) -> list[tuple[int, ...]]:
        return [tuple(s for i, s in touching if i == k) for k in range(self.model.count)]

    def _choose(self, scored: list[tuple[float, Mode, Solution]]) -> tuple[float, Mode, Solution]:
        """Choose the first consistent mode, or the one that violates least."""
        return min(scored, key=lambda x: max(x[0], CONSISTENT))

    def _impact(self, t: float, touching: list[End], push: bool = False) -> float:
        """Plastic impulses with Coulomb's law on them; the kinetic energy that they take [J].

        ``push``: no mode is consistent although nothing approaches (Painlevé).  The limit of a stiff contact is
        an impulse all the same, that which a vanishing speed of approach would call forth.
        """
        model = self.model
        contacts = self._contacts(self.q)
        before = self.v.copy()
        limits = []
        for k, ends in enumerate(self._ends_of(touching)):
            slipping = bool(ends) and self._sliding(k, contacts, ends) != 0
            limits.append(model.friction[k].kinetic if slipping else model.friction[k].static)
        if push:
            self.v = self.v - 1e-7 * model.speed * np.tile([0.0, 1.0, 0.0], model.count)
        scale = max(float(np.abs(self.v * np.tile([1, 1, model.size], model.count)).max()), 1e-300)
        units = (float(model.mass[::3].sum()) * scale, scale)
        moves = [0] * model.count
        scored = []
        for mode in model.modes(self._ends_of(touching), moves):
            try:
                solution = model.solve(self.q, self.v, mode, contacts, None)
            except np.linalg.LinAlgError:
                continue
            scored.append(
                (
                    self._violation(mode, solution, contacts, touching, units, None, limits),
                    mode,
                    solution,
                )
            )
        _, mode, solution = self._choose(scored)
        while weak := self._weak(t, touching, mode, solution, contacts):
            mode = tuple(
                InterfaceMode(tuple(sorted({*m.closed, *(s for i, s in weak if i == k)})), m.slides)
                for k, m in enumerate(mode)
            )
            solution = model.solve(self.q, solution.rates, mode, contacts, None, rough=False)
        self.v = solution.rates
        self.mode = mode
        self._forget()
        self._project()
        loss = 0.5 * float(before @ (model.mass * before) - self.v @ (model.mass * self.v))
        self.impact_loss += loss
        return loss

    def _weak(
        self,
        t: float,
        touching: list[End],
        mode: Mode,
        solution: Solution,
        contacts: dict[End, Contact],
    ) -> list[End]:
        """Ends that part so slowly that they would only chatter."""
        model, found = self.model, []
        parting = []
        for k, s in touching:
            if s not in mode[k].closed:
                c = contacts[k, s]
                speed = float(model.row(self.q, k, c, c.normal) @ solution.rates)
                if speed < self.closing:
                    parting.append((k, s))
        if parting:
            after = model.solve(self.q, solution.rates, mode, contacts, self._load(t))
            for k, s in parting:
                c = contacts[k, s]
                pull = float(model.row(self.q, k, c, c.normal) @ after.rates)
                if pull + model.bias(self.q, solution.rates, k, c, c.normal) < 0:
                    found.append((k, s))
        return found

    def _forget(self) -> None:
        """Keep the kind of closed contacts only."""
        self.kind = {end: on for end, on in self.kind.items() if self._closed(end)}

    def _settle(self, t: float, touching: list[End], exclude: Mode | None) -> bool:
        """Find the mode in which the touching ends go on; False if none is consistent."""
        model = self.model
        for end in touching:
            self.kind.setdefault(end, model.contact(self.q, *end).on_face)
        slow = [e for e in touching if self._approach(self.q, self.v, e) < 1e-12 * model.speed]
        contacts = self._contacts(self.q)
        closed = self._ends_of(slow)
        moves = [
            int(np.sign(self._sliding(k, contacts, ends))) if ends else 0
            for k, ends in enumerate(closed)
        ]
        units = (model.weight, model.g)
        limits = [friction.static for friction in model.friction]
        scored = []
        load = self._load(t)
        for mode in model.modes(closed, moves):
            if mode == exclude:
                continue
            solution = model.solve(self.q, self.v, mode, contacts, load)
            violation = self._violation(mode, solution, contacts, slow, units, load, limits)
            scored.append((violation, mode, solution))
        if exclude is not None and min(x[0] for x in scored) > 1e-7:
            solution = model.solve(self.q, self.v, exclude, contacts, load)
            scored.append(
                (
                    self._violation(exclude, solution, contacts, slow, units, load, limits),
                    exclude,
                    solution,
                )
            )
        violation, self.mode, _ = self._choose(scored)
        self._forget()
        self._project()
        return violation < 1e-6

    def _note(self, t: float, kind: str, old: Mode, loss: float) -> None:
        self.contact_events.append(ContactEvent(self.start + t, kind, old, self.mode, loss))
