"""The reference integrator with friction and flight, on the mechanics of :mod:`contact_model`.

At every contact event all modes that the closed contacts allow are tried; nothing but the bodies is shared with
the fast kernels.
"""

import math
from collections.abc import Iterable

import numpy as np

from rockfrag.system import as_system
from rockfrag.units import GRAVITY

from .contact_model import AT_EDGE, FULL, OPEN, Contact, End, InterfaceMode, Mode, Model, Solution
from .integrator import SLACK, Array, Integrator, Key

# lengths over b and speeds over √(g b) by which what has just begun is not taken for its end [-]
TOUCH = 1e-13

# a mode that violates its inequalities by less than this is consistent [-]; less than SLACK
CONSISTENT = 2e-13

# a contact that parts at less than this fraction of √(g b) after an impact, and would fall shut again, is closed
CLOSING = 1e-6

Load = list[float]

LONGEST_TAIL = 200.0  # free motion after the last sample, over √(b/g)


def simulate_reference(body, acceleration, dt, *, friction, vertical=None, duration=None):
    """Rock, slide and fly bodies on each other on a shaken ground, slowly and accurately.

    Accelerations [m/s²] are linear between samples and zero one sample after the last.  ``friction`` is of
    each contact from below, ``duration`` when to stop at the latest [s]; by default when all rests or one has
    fallen.
    """
    motion = np.append(acceleration, 0.0)
    up = np.zeros(motion.size) if vertical is None else np.append(vertical, 0.0)
    model = Model(as_system(body), tuple(friction), GRAVITY)
    return _Run(model, np.array([motion, up]), dt).response(duration)


class _Run(Integrator):
    def __init__(self, model: Model, motions: Array, dt: float) -> None:
        unit = model.size / model.speed
        super().__init__(motions, dt, 0.05 * unit, LONGEST_TAIL * unit)
        self.model = model
        self.q, self.v = model.standing.copy(), np.zeros(3 * model.count)
        self.mode: Mode = tuple(OPEN for _ in range(model.count))
        self.kind: dict[End, bool] = {}
        self.ends = [(k, s) for k in range(model.count) for s in FULL]

    @property
    def y(self) -> Array:
        return np.concatenate([self.q, self.v])

    def take(self, y: Array) -> None:
        self.q, self.v = (part.copy() for part in np.split(y, 2))
        self._project()

    def row(self) -> tuple[list[float], list[float]]:
        slips = [self.model.slip(self.q, k) for k in range(self.model.count)]
        return self.q[2::3].tolist(), slips

    def resting(self) -> bool:
        return self._stands() and not self.v.any()

    def rates(self, t: float, y: Array) -> Array:
        q, v = np.split(y, 2)
        found = self.model.solve(q, v, self.mode, self._contacts(q), self.ground(t))
        return np.concatenate([v, found.rates])

    def approaches(self, y: Array) -> list[float]:
        q, v = np.split(y, 2)
        return [self._approach(q, v, end) for end in self.ends if not self._closed(end)]

    def _stands(self) -> bool:
        return all(mode == InterfaceMode(FULL, 0) for mode in self.mode)

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
        if self._stands():
            self.v[:] = 0.0

    def _contacts(self, q: Array) -> dict[End, Contact]:
        return {(k, s): self.model.contact(q, k, s, self.kind.get((k, s))) for k, s in self.ends}

    def _closed(self, end: End) -> bool:
        return end[1] in self.mode[end[0]].closed

    def watched(self, t: float, y: Array) -> dict[Key, float]:
        model = self.model
        q, v = np.split(y, 2)
        contacts = self._contacts(q)
        found = model.solve(q, v, self.mode, contacts, self.ground(t))
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
                margin = model.stick_margin(k, found, closed)
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

    def apply(self, t: float, keys: set[Key]) -> None:
        model, old, before = self.model, self.mode, tuple(self.v[2::3].tolist())
        if any(name in ("upright", "over") for name, _, _ in keys):
            self.fallen = True
            self.note(t, "overturning", before)
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
        kind = "change"
        if any(self._approach(self.q, self.v, end) < -1e-13 * model.speed for end in touching):
            self._impact(t, touching)
            kind = "impact"
        exclude = (
            old if kind == "change" and any(key[0] in ("press", "stick") for key in keys) else None
        )
        if not self._settle(t, touching, exclude):
            self._impact(t, touching, push=True)
            kind = "paradox"
            self._settle(t, touching, None)
        if self.mode != old or kind != "change":
            self.note(t, kind, before)

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

    def _scored(self, modes, touching, contacts, units, load):
        """How far each mode is from being consistent; ``units`` of force (or impulse) and of rates."""
        scored = []
        for mode in modes:
            try:
                solution = self.model.solve(self.q, self.v, mode, contacts, load)
            except np.linalg.LinAlgError:
                continue
            violations = self._violations(mode, solution, contacts, touching, units, load)
            scored.append((max(0.0, *violations), mode, solution))
        return scored

    def _violations(self, mode, solution, contacts, touching, units, load):
        model = self.model

        def rate(k: int, c: Contact, direction: Array) -> float:
            found = float(model.row(self.q, k, c, direction) @ solution.rates)
            return found + (model.bias(self.q, self.v, k, c, direction) if load else 0.0)

        for k, s in touching:
            if s in mode[k].closed:
                yield -solution.normal[k, s] / units[0]
            else:
                yield -rate(k, contacts[k, s], contacts[k, s].normal) / units[1]
        for k, (closed, slides) in enumerate(mode):
            if closed and not slides:
                yield -model.stick_margin(k, solution, closed) / units[0]
            elif closed and not (load and self._sliding(k, contacts, closed)):
                c = contacts[k, closed[0]]
                yield -slides * rate(k, c, c.tangent) / units[1]

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

    def _impact(self, t: float, touching: list[End], push: bool = False) -> None:
        """Plastic impulses with Coulomb's law on them.

        ``push``: no mode is consistent although nothing approaches (Painlevé).  The limit of a stiff contact is
        an impulse all the same, that which a vanishing speed of approach would call forth.
        """
        model = self.model
        contacts = self._contacts(self.q)
        if push:
            self.v = self.v - 1e-7 * model.speed * np.tile([0.0, 1.0, 0.0], model.count)
        scale = max(float(np.abs(self.v * np.tile([1, 1, model.size], model.count)).max()), 1e-300)
        units = (float(model.mass[::3].sum()) * scale, scale)
        modes = model.modes(self._ends_of(touching), [0] * model.count)
        scored = self._scored(modes, touching, contacts, units, None)
        _, mode, solution = self._choose(scored)
        while weak := self._weak(t, touching, mode, solution, contacts):
            mode = tuple(
                InterfaceMode(tuple(sorted({*m.closed, *(s for i, s in weak if i == k)})), m.slides)
                for k, m in enumerate(mode)
            )
            solution = model.solve(self.q, solution.rates, mode, contacts, None, rough=False)
        self.v = solution.rates
        self._turn_to(mode)

    def _weak(self, t, touching, mode, solution, contacts):
        """Ends that part so slowly that they would only chatter."""
        model, found = self.model, []
        parting = []
        for k, s in touching:
            if s not in mode[k].closed:
                c = contacts[k, s]
                speed = float(model.row(self.q, k, c, c.normal) @ solution.rates)
                if speed < CLOSING * model.speed:
                    parting.append((k, s))
        if parting:
            after = model.solve(self.q, solution.rates, mode, contacts, self.ground(t))
            for k, s in parting:
                c = contacts[k, s]
                pull = float(model.row(self.q, k, c, c.normal) @ after.rates)
                if pull + model.bias(self.q, solution.rates, k, c, c.normal) < 0:
                    found.append((k, s))
        return found

    def _turn_to(self, mode: Mode) -> None:
        """Go on in a mode, with the kind of closed contacts only."""
        self.mode = mode
        self.kind = {end: on for end, on in self.kind.items() if self._closed(end)}
        self._project()

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

        def scored(modes: Iterable[Mode]) -> list[tuple[float, Mode, Solution]]:
            return self._scored(modes, slow, contacts, (model.weight, model.g), self.ground(t))

        found = scored(mode for mode in model.modes(closed, moves) if mode != exclude)
        if exclude is not None and min(x[0] for x in found) > 1e-7:
            found += scored([exclude])
        violation, mode, _ = self._choose(found)
        self._turn_to(mode)
        return violation < 1e-6
