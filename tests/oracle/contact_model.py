"""Mechanics of the reference integrator with friction and flight, written to be read.

Every body has three coordinates, its centre of gravity (x, y) relative to the moving ground and its rotation
θ, clockwise.  Interface k lies between body k and what is below it, the ground for k = 0.  An interface has
two *ends*, left (-1) and right (+1), at which it may be closed.  A *mode* says for each interface which ends
are closed and whether it sticks (0) or slides (±1).  With the mode known, accelerations and contact forces,
or velocities after an impact and impulses, follow from one linear system each (``docs/contact.md``).
"""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.system import System

from .standing import standing, turn

Array = NDArray[np.float64]


class InterfaceMode(NamedTuple):
    """Which ends of an interface are closed, and which way it slides (0: it sticks)."""

    closed: tuple[int, ...]
    slides: int


# a corner counts as over the face until it is this fraction of the half width beyond the edge
AT_EDGE = 1e-9

OPEN = InterfaceMode((), 0)
FULL = (-1, 1)

Mode = tuple[InterfaceMode, ...]
End = tuple[int, int]  # an end of an interface: (number of the interface, side)


@dataclass(frozen=True)
class Contact:
    """One end of an interface: where it would touch, along which directions, and how far it is apart."""

    point: Array
    tangent: Array
    normal: Array
    on_face: bool  # a corner on the face below, or else the edge below against the base
    gap: float  # [m]
    beyond: float  # how far the corner is beyond the edge of the face below [m]


@dataclass(frozen=True)
class Solution:
    """Outcome of a mode: rates (accelerations, or velocities after an impact) and contact forces."""

    rates: Array
    normal: dict[End, float]
    tangential: dict[int, float]


def _perp(v: Array) -> Array:
    """Velocity of the tip of v when it turns clockwise at one radian per second."""
    return np.array([v[1], -v[0]])


class Model:
    """Planar bodies, their faces, and the friction of each interface, the ground first."""

    def __init__(self, system: System, friction: tuple[float, ...], g: float) -> None:
        self.g, self.friction = g, friction
        bodies = standing(system)
        self.count = len(bodies)
        self.tilt = [body.base for body in bodies]
        self.face = [(np.zeros(2), math.inf)]
        for body in bodies[:-1]:
            left, right = body.edges
            middle = (left + right) / 2
            self.face.append((middle, float(np.hypot(*(right - left))) / 2))
        # corners of each base, from the centre of the standing body
        self.corner = [dict(zip(FULL, body.corners, strict=True)) for body in bodies]
        self.mass = np.array([m for b in bodies for m in (b.mass, b.mass, b.inertia)])
        self.weight = g * float(self.mass[::3].sum())
        left, right = bodies[-1].corners
        self.size = float(np.hypot(*(right - left))) / 2
        self.speed = math.sqrt(g * self.size)
        self.standing = np.array([x for b in bodies for x in (*b.centre, 0.0)])

    # -------------------------------------------------------------- geometry

    def frame(self, q: Array, k: int) -> tuple[Array, Array, Array]:
        """Middle, tangent and normal of the face below interface k."""
        middle, _ = self.face[k]
        if k == 0:
            return np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, 1.0])
        angle = q[3 * k - 1]
        origin = q[3 * k - 3 : 3 * k - 1] + turn(angle) @ middle
        return origin, *turn(angle + self.tilt[k]).T

    def contact(self, q: Array, k: int, side: int, on_face: bool | None = None) -> Contact:
        """End ``side`` of interface k; ``on_face`` keeps the kind of a contact that exists."""
        origin, tangent, normal = self.frame(q, k)
        half = self.face[k][1]
        corner = q[3 * k : 3 * k + 2] + turn(q[3 * k + 2]) @ self.corner[k][side]
        beyond = side * float(tangent @ (corner - origin)) - half
        if on_face is None:
            on_face = beyond <= AT_EDGE * self.size
        if on_face:
            gap = float(normal @ (corner - origin))
            return Contact(corner, tangent, normal, True, gap, beyond)
        edge = origin + side * half * tangent
        tangent, normal = turn(q[3 * k + 2] + self.tilt[k]).T
        return Contact(edge, tangent, normal, False, float(normal @ (corner - edge)), beyond)

    def slip(self, q: Array, k: int) -> float:
        """Displacement along the face of the corner that carries, from where it stood at first [m]."""
        relative = q[3 * k + 2] - (q[3 * k - 1] if k else 0.0)
        side = 1 if relative >= 0 else -1
        here, there = self.contact(q, k, side, True), self.contact(self.standing, k, side, True)
        return side * (here.beyond - there.beyond) if k else float(here.point[0] - there.point[0])

    def row(self, q: Array, k: int, contact: Contact, direction: Array) -> Array:
        """Coefficients that give the velocity of the body above relative to what is below [-]."""
        row = np.zeros(3 * self.count)
        for body, sign in ((k, 1.0), (k - 1, -1.0)):
            if body >= 0:
                arm = contact.point - q[3 * body : 3 * body + 2]
                row[3 * body : 3 * body + 2] = sign * direction
                row[3 * body + 2] = sign * float(direction @ _perp(arm))
        return row

    def bias(self, q: Array, v: Array, k: int, contact: Contact, direction: Array) -> float:
        """Relative acceleration along ``direction`` when all accelerations vanish [m/s²]."""
        acceleration, velocity = np.zeros(2), np.zeros(2)
        for body, sign in ((k, 1.0), (k - 1, -1.0)):
            if body >= 0:
                arm = contact.point - q[3 * body : 3 * body + 2]
                turning = v[3 * body + 2]
                acceleration -= sign * turning**2 * arm
                velocity += sign * (v[3 * body : 3 * body + 2] + turning * _perp(arm))
        owner = k - 1 if contact.on_face else k  # whose face it is
        if owner >= 0:
            acceleration -= 2 * v[3 * owner + 2] * _perp(velocity)
        return float(direction @ acceleration)

    # --------------------------------------------------------------- solving

    def solve(self, q, v, mode, contacts, load, rough=True):
        """Accelerations and forces of a mode under the ground's acceleration; impulses if there is none.

        An impact has M v⁺ = M v + (impulses) and closed ends that no longer move apart; between impacts
        M q̈ = f + (forces) and closed ends that do not accelerate apart.  Without ``rough`` sliding contacts have
        no friction: the velocities nearest to v in kinetic energy that keep the mode.
        """
        n = 3 * self.count
        forces: list[Array] = []
        rows: list[Array] = []
        right: list[float] = []
        names: list[End | int] = []
        for k, (closed, slides) in enumerate(mode):
            for side in closed:
                c = contacts[k, side]
                normal, tangent = self.row(q, k, c, c.normal), self.row(q, k, c, c.tangent)
                friction = slides * self.friction[k] if rough else 0.0
                forces.append(normal - friction * tangent)
                rows.append(normal)
                right.append(0.0 if load is None else -self.bias(q, v, k, c, c.normal))
                names.append((k, side))
            if closed and not slides:
                c = contacts[k, closed[0]]
                tangent = self.row(q, k, c, c.tangent)
                forces.append(tangent)
                rows.append(tangent)
                right.append(0.0 if load is None else -self.bias(q, v, k, c, c.tangent))
                names.append(k)
        if load is None:
            known = self.mass * v
        else:
            known = -self.mass * np.tile([load[0], self.g + load[1], 0.0], self.count)
        m = len(rows)
        matrix = np.zeros((n + m, n + m))
        matrix[:n, :n] = np.diag(self.mass)
        if m:
            matrix[:n, n:] = -np.array(forces).T
            matrix[n:, :n] = np.array(rows)
        solved = np.linalg.solve(matrix, np.concatenate([known, right]))
        found = dict(zip(names, solved[n:].tolist(), strict=True))
        normal_force = {name: x for name, x in found.items() if isinstance(name, tuple)}
        tangential = {name: x for name, x in found.items() if isinstance(name, int)}
        for k, (closed, slides) in enumerate(mode):
            if slides:
                pressed = sum(normal_force[k, side] for side in closed)
                tangential[k] = -slides * self.friction[k] * pressed
        return Solution(solved[:n], normal_force, tangential)

    def modes(self, closed: list[tuple[int, ...]], moves: list[int]) -> Iterator[Mode]:
        """List the modes that closed ends allow, fewer closed ends first; ``moves`` is the sign of slip."""
        choices = []
        for k, ends in enumerate(closed):
            of_interface = []
            for number in range(len(ends) + 1):
                for subset in itertools.combinations(ends, number):
                    if not subset:
                        of_interface.append(OPEN)
                        continue
                    ways = [moves[k]] if moves[k] else [0, 1, -1]
                    of_interface += [InterfaceMode(subset, way) for way in ways]
            choices.append(of_interface)
        yield from sorted(itertools.product(*choices), key=lambda m: sum(len(i[0]) for i in m))

    def stick_margin(self, k: int, solution: Solution, closed: tuple[int, ...]) -> float:
        """µ N - |T| of an interface that sticks [N], or over µ where that is more than 1."""
        limit = self.friction[k]
        pressed = sum(solution.normal[k, side] for side in closed)
        return (limit * pressed - abs(solution.tangential[k])) / max(limit, 1.0)
