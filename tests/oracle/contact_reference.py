"""The reference integrator with friction and flight, written to be read.

Nothing but the bodies is shared with the fast kernels.  Every body has three coordinates, its centre of gravity
(x, y) relative to the moving ground and its rotation θ, clockwise.  Interface k lies between body k and what is
below it, the ground for k = 0.  An interface has two *ends*, left (-1) and right (+1), at which it may be closed.
A *mode* says for each interface which ends are closed and whether it sticks (0) or slides (±1).  With the mode
known, accelerations and contact forces, or velocities after an impact and impulses, follow from one linear system
each (``docs/contact.md``).  At every contact event all modes that the closed contacts allow are tried.
"""

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from rockfrag.base.units import GRAVITY
from rockfrag.system import System, as_system

from .integrator import SLACK, Array, Integrator, Key
from .standing import standing, turn


class InterfaceMode(NamedTuple):
    """Which ends of an interface are closed, and which way it slides (0: it sticks)."""

    closed: tuple[int, ...]
    slides: int


OPEN = InterfaceMode((), 0)
FULL = (-1, 1)
Mode = tuple[InterfaceMode, ...]
End = tuple[int, int]  # an end of an interface: (number of the interface, side)

# a corner counts as over the face until it is this fraction of the half width beyond the edge
AT_EDGE = 1e-9
# lengths over b and speeds over √(g b) by which what has just begun is not taken for its end [-]
TOUCH = 1e-13
# a mode that violates its inequalities by less than this is consistent [-]; less than SLACK
CONSISTENT = 2e-13
# a contact that parts at less than this fraction of √(g b) after an impact, and would fall shut again, is closed
CLOSING = 1e-6
LONGEST_TAIL = 200.0  # free motion after the last sample, over √(b/g)


def simulate_reference(
    body, acceleration, dt, *, friction, vertical=None, duration=None
):
    """Rock, slide and fly bodies on each other on a shaken ground, slowly and accurately.

    Accelerations [m/s²] are linear between samples and zero one sample after the last.  ``friction`` is of
    each contact from below, ``duration`` when to stop at the latest [s]; by default when all rests or one has
    fallen.
    """
    motion = np.append(acceleration, 0.0)
    up = np.zeros(motion.size) if vertical is None else np.append(vertical, 0.0)
    model = Model(as_system(body), tuple(friction))
    return _Run(model, np.array([motion, up]), dt).response(duration)


class Contact(NamedTuple):
    """One end of an interface: where it would touch, and how the body above moves relative to what is below."""

    on_face: bool  # a corner on the face below, or else the edge below against the base
    gap: float  # [m]
    along: float  # place of the corner along the face below [m]
    beyond: float  # how far it is beyond the edge [m]
    # velocity across and along the face per coordinate [-], and now [m/s]
    normal: Array
    tangent: Array
    parts: float
    slips: float
    # accelerations across and along it when all of bodies vanish [m/s²]
    bias: tuple[float, float]


class Solution(NamedTuple):
    """Outcome of a mode: rates (accelerations, or velocities after an impact) and contact forces."""

    rates: Array
    normal: dict[End, float]
    tangential: dict[int, float]


def _perp(v: Array) -> Array:
    """Velocity of the tip of v when it turns clockwise at one radian per second."""
    return np.array([v[1], -v[0]])


class Model:
    """Planar bodies, their faces, and the friction of each interface, the ground first."""

    def __init__(self, system: System, friction: tuple[float, ...]) -> None:
        self.friction = friction
        bodies = standing(system)
        self.count = len(bodies)
        self.tilt = [body.base for body in bodies]
        edges = [(np.zeros(2), math.inf)]
        for left, right in (body.edges for body in bodies[:-1]):
            edges.append(((left + right) / 2, float(np.hypot(*(right - left))) / 2))
        self.face = edges
        # corners of each base, from the centre of the standing body
        self.corner = [dict(zip(FULL, body.corners, strict=True)) for body in bodies]
        self.mass = np.array([m for b in bodies for m in (b.mass, b.mass, b.inertia)])
        self.weight = GRAVITY * float(self.mass[::3].sum())
        left, right = bodies[-1].corners
        self.size = float(np.hypot(*(right - left))) / 2
        self.speed = math.sqrt(GRAVITY * self.size)
        self.standing = np.array([x for b in bodies for x in (*b.centre, 0.0)])

    def contact(
        self, q: Array, v: Array, k: int, side: int, on_face: bool | None
    ) -> Contact:
        """End ``side`` of interface k; ``on_face`` keeps the kind of a contact that exists."""
        at, (middle, half) = 3 * k, self.face[k]
        corner = q[at : at + 2] + turn(q[at + 2]) @ self.corner[k][side]
        below = q[at - 3 : at] if k else np.zeros(3)
        origin = below[:2] + turn(below[2]) @ middle
        tangent, normal = turn(below[2] + self.tilt[k] if k else 0.0).T
        along = float(tangent @ (corner - origin))
        beyond = side * along - half
        if on_face is None:
            on_face = beyond <= AT_EDGE * self.size
        point = corner if on_face else origin + side * half * tangent
        if not on_face:
            tangent, normal = turn(q[at + 2] + self.tilt[k]).T
        gap = float(normal @ (corner - (origin if on_face else point)))
        rows, velocity, acceleration = np.zeros((2, q.size)), np.zeros(2), np.zeros(2)
        for i, sign in ((at, 1.0), (at - 3, -1.0)):
            if i >= 0:
                arm = point - q[i : i + 2]
                for row, direction in zip(rows, (normal, tangent), strict=True):
                    row[i : i + 3] = sign * np.append(direction, direction @ _perp(arm))
                velocity += sign * (v[i : i + 2] + v[i + 2] * _perp(arm))
                acceleration -= sign * v[i + 2] ** 2 * arm
        owner = at - 3 if on_face else at  # whose face it is
        if owner >= 0:
            acceleration -= 2 * v[owner + 2] * _perp(velocity)
        bias = float(normal @ acceleration), float(tangent @ acceleration)
        parts, slips = float(normal @ velocity), float(tangent @ velocity)
        return Contact(on_face, gap, along, beyond, *rows, parts, slips, bias)

    def slip(self, q: Array, k: int) -> float:
        """Displacement along the face of the corner that carries, from where it stood at first [m]."""
        side = 1 if q[3 * k + 2] >= (q[3 * k - 1] if k else 0.0) else -1
        here, there = (
            self.contact(x, 0 * q, k, side, True).along for x in (q, self.standing)
        )
        return here - there

    def solve(self, v, mode, contacts, load, rough=True):
        """Accelerations and forces of a mode under the ground's acceleration; impulses if there is none.

        An impact has M v⁺ = M v + (impulses) and closed ends that no longer move apart; between impacts
        M q̈ = f + (forces) and closed ends that do not accelerate apart.  Without ``rough`` sliding contacts have
        no friction: the velocities nearest to v in kinetic energy that keep the mode.
        """
        found = []  # name, row, force, right-hand side
        for k, (closed, slides) in enumerate(mode):
            friction = slides * self.friction[k] if rough else 0.0
            for side in closed:
                c = contacts[k, side]
                found.append(
                    ((k, side), c.normal, c.normal - friction * c.tangent, -c.bias[0])
                )
            if closed and not slides:
                c = contacts[k, closed[0]]
                found.append((k, c.tangent, c.tangent, -c.bias[1]))
        n, m = 3 * self.count, len(found)
        right = np.zeros(n + m)
        if load is None:
            right[:n] = self.mass * v
        else:
            right[:n] = -self.mass * np.tile(
                [load[0], GRAVITY + load[1], 0.0], self.count
            )
            right[n:] = [item[3] for item in found]
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n] = np.diag(self.mass)
        for i, (_, row, force, _) in enumerate(found):
            matrix[n + i, :n], matrix[:n, n + i] = row, -force
        solved = np.linalg.solve(matrix, right)
        normal, tangential = {}, {}
        for (name, *_), value in zip(found, solved[n:].tolist(), strict=True):
            (normal if isinstance(name, tuple) else tangential)[name] = value
        for k, (closed, slides) in enumerate(mode):
            if slides:
                pressed = sum(normal[k, side] for side in closed)
                tangential[k] = -slides * self.friction[k] * pressed
        return Solution(solved[:n], normal, tangential)

    def modes(self, closed: list[tuple[int, ...]], moves: list[int]) -> Iterator[Mode]:
        """List the modes that closed ends allow, fewer closed ends first; ``moves`` is the sign of slip."""
        choices = []
        for ends, move in zip(closed, moves, strict=True):
            some = [s for size in (1, 2) for s in itertools.combinations(ends, size)]
            ways = [move] if move else [0, 1, -1]
            choices.append(
                [OPEN, *itertools.starmap(InterfaceMode, itertools.product(some, ways))]
            )
        yield from sorted(
            itertools.product(*choices), key=lambda m: sum(len(i[0]) for i in m)
        )

    def stick_margin(
        self, k: int, solution: Solution, closed: tuple[int, ...]
    ) -> float:
        """µ N - |T| of an interface that sticks [N], or over µ where that is more than 1."""
        limit = self.friction[k]
        pressed = sum(solution.normal[k, side] for side in closed)
        return (limit * pressed - abs(solution.tangential[k])) / max(limit, 1.0)


class _Run(Integrator):
    def __init__(self, model: Model, motions: Array, dt: float) -> None:
        unit = model.size / model.speed
        super().__init__(motions, dt, 0.05 * unit, LONGEST_TAIL * unit)
        self.model = model
        self.q, self.v = model.standing.copy(), np.zeros(3 * model.count)
        self.mode: Mode = (OPEN,) * model.count
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
        v = y[self.q.size :]
        found = self.model.solve(v, self.mode, self._contacts(y), self.ground(t))
        return np.concatenate([v, found.rates])

    def approaches(self, y: Array) -> list[float]:
        return [
            c.parts for end, c in self._contacts(y).items() if not self._closed(end)
        ]

    def _stands(self) -> bool:
        return all(mode == InterfaceMode(FULL, 0) for mode in self.mode)

    def _contacts(self, y: Array | None = None) -> dict[End, Contact]:
        q, v = np.split(self.y if y is None else y, 2)
        return {
            end: self.model.contact(q, v, *end, self.kind.get(end)) for end in self.ends
        }

    def _closed(self, end: End) -> bool:
        return end[1] in self.mode[end[0]].closed

    def _set_down(self, k: int, sides: tuple[int, ...]) -> None:
        """Set the gaps of an interface at one side or both to zero, with all that stands on it."""
        if len(sides) == 2:
            self.q[3 * k + 2] = self.q[3 * k - 1] if k else 0.0
        if sides:
            c = self.model.contact(
                self.q, self.v, k, sides[0], self.kind.get((k, sides[0]))
            )
            self.q.reshape(-1, 3)[k:, :2] -= c.gap * c.normal[3 * k : 3 * k + 2]

    def _project(self) -> None:
        """Take away what rounding and integration have left at closed contacts."""
        for k, (closed, slides) in enumerate(self.mode):
            if not closed:
                continue
            self._set_down(k, closed)
            if closed == FULL:
                self.v[3 * k + 2] = self.v[3 * k - 1] if k else 0.0
            c = self._contacts()[k, closed[0]]
            wrong = c.parts * c.normal + (0.0 if slides else c.slips) * c.tangent
            self.v.reshape(-1, 3)[k:, :2] -= wrong[3 * k : 3 * k + 2]
        if self._stands():
            self.v[:] = 0.0

    def watched(self, t: float, y: Array) -> dict[Key, float]:
        model, q, v = self.model, *np.split(y, 2)
        contacts = self._contacts(y)
        found = model.solve(v, self.mode, contacts, self.ground(t))
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
                values["slide", k, 0] = (
                    slides * contacts[k, closed[0]].slips / model.speed + TOUCH
                )
            elif closed:
                margin = model.stick_margin(k, found, closed)
                values["stick", k, 0] = margin / model.weight + SLACK
            turned = q[3 * k + 2], q[3 * k + 2] - q[3 * k - 1] if k else 0.0
            values["upright", k, 0] = math.pi / 2 - max(map(abs, turned))
            if k:
                nearest = min(contacts[k, s].beyond for s in FULL)
                values["over", k, 0] = 2 * model.face[k][1] + nearest
        return values

    def apply(self, t: float, keys: set[Key]) -> None:
        old, before = self.mode, tuple(self.v[2::3].tolist())
        if any(name in ("upright", "over") for name, _, _ in keys):
            self.fallen = True
            self.note(t, "overturning", before)
            return
        leaving = set()
        for name, k, s in keys:
            if name == "edge" and self.mode[k].closed == FULL:
                self.kind[k, s] = not self.kind[k, s]
            elif name == "edge":
                # a corner of the contact is passed: it goes on in flight
                leaving.add((k, s))
                self.kind.pop((k, s), None)
            elif name == "slide":
                sticks = InterfaceMode(self.mode[k].closed, 0)
                self.mode = (*self.mode[:k], sticks, *self.mode[k + 1 :])
                self._project()
        touching = [
            end
            for end, c in self._contacts().items()
            if end not in leaving
            and (
                self._closed(end)
                or ("gap", *end) in keys
                or c.gap < 1e-11 * self.model.size
            )
        ]
        for k, sides in enumerate(self._sides(touching)):
            self._set_down(k, sides)
        contacts = self._contacts()
        self.kind.update({end: contacts[end].on_face for end in touching})
        kind = "change"
        if any(contacts[end].parts < -1e-13 * self.model.speed for end in touching):
            self._impact(t, touching)
            kind = "impact"
        fails = kind == "change" and any(key[0] in ("press", "stick") for key in keys)
        if not self._settle(t, touching, old if fails else None):
            self._impact(t, touching, push=True)
            kind = "paradox"
            self._settle(t, touching, None)
        if self.mode != old or kind != "change":
            self.note(t, kind, before)

    def _sides(self, ends: list[End]) -> list[tuple[int, ...]]:
        return [tuple(s for i, s in ends if i == k) for k in range(self.model.count)]

    def _choose(self, modes, touching, units, load):
        """Choose the first consistent mode, or the one that violates least; by how much, mode and solution.

        ``units`` are of force (or impulse) and of rates.
        """
        contacts, scored = self._contacts(), []
        for mode in modes:
            try:
                solution = self.model.solve(self.v, mode, contacts, load)
            except np.linalg.LinAlgError:
                continue
            violations = self._violations(
                mode, solution, contacts, touching, units, load
            )
            scored.append((max(0.0, *violations), mode, solution))
        return min(scored, key=lambda x: max(x[0], CONSISTENT))

    def _violations(self, mode, solution, contacts, touching, units, load):
        for k, s in touching:
            c = contacts[k, s]
            if s in mode[k].closed:
                yield -solution.normal[k, s] / units[0]
            else:
                yield (
                    -(float(c.normal @ solution.rates) + (c.bias[0] if load else 0.0))
                    / units[1]
                )
        for k, (closed, slides) in enumerate(mode):
            if closed and not slides:
                yield -self.model.stick_margin(k, solution, closed) / units[0]
            elif closed and not (load and self._sliding(contacts[k, closed[0]])):
                c = contacts[k, closed[0]]
                rate = float(c.tangent @ solution.rates) + (c.bias[1] if load else 0.0)
                yield -slides * rate / units[1]

    def _sliding(self, contact: Contact) -> float:
        """Slip velocity at a contact; zero if it is nothing but rounding [m/s]."""
        return contact.slips if abs(contact.slips) > 1e-12 * self.model.speed else 0.0

    def _impact(self, t: float, touching: list[End], push: bool = False) -> None:
        """Plastic impulses with Coulomb's law on them.

        ``push``: no mode is consistent although nothing approaches (Painlevé).  The limit of a stiff contact is
        an impulse all the same, that which a vanishing speed of approach would call forth.
        """
        model = self.model
        if push:
            self.v = self.v - 1e-7 * model.speed * np.tile([0.0, 1.0, 0.0], model.count)
        scale = max(
            float(np.abs(self.v * np.tile([1, 1, model.size], model.count)).max()),
            1e-300,
        )
        units = (float(model.mass[::3].sum()) * scale, scale)
        modes = model.modes(self._sides(touching), [0] * model.count)
        _, mode, solution = self._choose(modes, touching, units, None)
        self.v = solution.rates
        while weak := self._weak(t, touching, mode):
            also = self._sides(weak)
            mode = tuple(
                InterfaceMode(tuple(sorted({*m.closed, *sides})), m.slides)
                for m, sides in zip(mode, also, strict=True)
            )
            self.v = model.solve(
                self.v, mode, self._contacts(), None, rough=False
            ).rates
        self._turn_to(mode)

    def _weak(self, t: float, touching: list[End], mode: Mode) -> list[End]:
        """Ends that part so slowly that they would only chatter."""
        contacts = self._contacts()
        after = self.model.solve(self.v, mode, contacts, self.ground(t)).rates
        return [
            (k, s)
            for k, s in touching
            if s not in mode[k].closed
            and contacts[k, s].parts < CLOSING * self.model.speed
            and float(contacts[k, s].normal @ after) + contacts[k, s].bias[0] < 0
        ]

    def _turn_to(self, mode: Mode) -> None:
        """Go on in a mode, with the kind of closed contacts only."""
        self.mode = mode
        self.kind = {end: on for end, on in self.kind.items() if self._closed(end)}
        self._project()

    def _settle(self, t: float, touching: list[End], exclude: Mode | None) -> bool:
        """Find the mode in which the touching ends go on; False if none is consistent."""
        model, contacts = self.model, self._contacts()
        for end in touching:
            self.kind.setdefault(end, contacts[end].on_face)
        slow = [end for end in touching if contacts[end].parts < 1e-12 * model.speed]
        closed = self._sides(slow)
        moves = [
            int(np.sign(self._sliding(contacts[k, sides[0]]))) if sides else 0
            for k, sides in enumerate(closed)
        ]
        units, load = (model.weight, GRAVITY), self.ground(t)
        others = (mode for mode in model.modes(closed, moves) if mode != exclude)
        violation, mode, _ = self._choose(others, slow, units, load)
        if exclude is not None and violation > 1e-7:
            again, _, _ = self._choose([exclude], slow, units, load)
            violation, mode = min(
                (violation, mode), (again, exclude), key=lambda x: x[0]
            )
        self._turn_to(mode)
        return violation < 1e-6
