"""A witness of impacts: what contacts have given, from the whole change of momentum alone.

A column is statically determinate: what is above contact k has been pushed by contact k, and by nothing else.
So its change of momentum, and of angular momentum, is the resultant of contact k and where it acts, whatever a
solver has thought of it.  Impulses on bodies from outside the column (a wall, a tie) are taken away first.
"""

from dataclasses import dataclass

import numpy as np

from rockfrag.system import System

from .standing import StandingBody, standing, turn

TOUCHES = 1e-12  # gap over the size below which an end touches [-]


@dataclass(frozen=True)
class Column:
    """A standing column: its bodies, the coefficients of its contacts, and the units of the witness."""

    bodies: list[StandingBody]
    static: np.ndarray
    kinetic: np.ndarray
    size: float  # half the width of the uppermost base [m]
    speed: float  # √(g size) [m/s]

    @classmethod
    def of(cls, system: System, g: float) -> "Column":
        bodies = standing(system)
        frictions = [contact.friction or (1e6, 1e6) for contact in system.contacts]
        static, kinetic = np.array(frictions, dtype=float).T
        left, right = bodies[-1].corners
        size = float(np.hypot(*(right - left))) / 2
        return cls(bodies, static, kinetic, size, float(np.sqrt(g * size)))

    @property
    def mass(self) -> float:
        return sum(body.mass for body in self.bodies)


@dataclass(frozen=True)
class Impact:
    """Coordinates of the bodies (n, 3), velocities before and after, and impulses from outside (n, 3)."""

    q: np.ndarray
    before: np.ndarray
    after: np.ndarray
    outside: np.ndarray | float = 0.0


@dataclass(frozen=True)
class End:
    """A place where a body may touch what is below: point, normal and tangent of the face, and gap."""

    point: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    gap: float


def ends_of(column: Column, q: np.ndarray, k: int) -> list[End]:
    """Left and right end of contact k: a corner over the face, or the face's edge under the base."""
    body, at, turned = column.bodies[k], q[k, :2], turn(q[k, 2])
    corners = [at + turned @ corner for corner in body.corners]
    if k == 0:
        up, along = np.array([0.0, 1.0]), np.array([1.0, 0.0])
        return [End(corner, up, along, float(corner[1])) for corner in corners]
    below = column.bodies[k - 1]
    edges = [q[k - 1, :2] + turn(q[k - 1, 2]) @ edge for edge in below.edges]
    face = turn(q[k - 1, 2] + below.face) @ np.eye(2)
    base = turn(q[k, 2] + body.base) @ np.eye(2)
    found = []
    for side, corner, edge in zip((-1, 1), corners, edges, strict=True):
        beyond = side * float((corner - edge) @ face[:, 0])
        over = beyond <= 1e-9 * column.size
        tangent, normal = (face if over else base).T
        point = corner if over else edge
        gap = float((corner - edge) @ normal)
        found.append(End(point, normal, tangent, gap))
    return found


def relative(column: Column, q, v, k: int, point: np.ndarray) -> np.ndarray:
    """Velocity of body k relative to what is below, at a point."""

    def at(body: int) -> np.ndarray:
        arm = point - q[body, :2]
        return v[body, :2] + v[body, 2] * np.array([arm[1], -arm[0]])

    return at(k) - (at(k - 1) if k else 0.0)


def kinetic_energy(column: Column, v: np.ndarray) -> float:
    """Kinetic energy relative to the ground [J]."""
    return sum(
        0.5 * body.mass * float(u[:2] @ u[:2]) + 0.5 * body.inertia * float(u[2] ** 2)
        for body, u in zip(column.bodies, v, strict=True)
    )


def violations(column: Column, impact: Impact, kept: bool = True) -> dict[str, float]:
    """By how much an impact breaks each law: impulses over mass and speed, speeds over √(g b) [-].

    ``pull``: a normal impulse below zero; ``friction``: |P_t| above µ ΣP_n, kinetic where it brakes what slid;
    ``direction``: what slides is not pushed against its slip with all of µ_k ΣP_n; ``sinks``: an end goes on into
    what it touches; ``complementarity``: an end is pushed and parts all the same; ``elsewhere``: a resultant where
    nothing touches; ``gain``: kinetic energy, over mass and speed squared.  ``kept`` is False where laws of
    restitution act, whose impulses are no longer plastic: then an end may be pushed and part.
    """
    q, before, after = impact.q, impact.before, impact.after
    masses = np.array([body.mass for body in column.bodies])
    inertias = np.array([body.inertia for body in column.bodies])
    change = np.column_stack([masses, masses, inertias]) * (after - before)
    change = change - impact.outside
    unit = column.mass * column.speed
    found = dict.fromkeys(
        ("pull", "friction", "direction", "sinks", "complementarity", "elsewhere"), 0.0
    )

    def note(name: str, value: float) -> None:
        found[name] = max(found[name], value)

    for k in range(len(column.bodies)):
        push = change[k:, :2].sum(axis=0)

        def moment_about(point: np.ndarray, k: int = k) -> float:
            arms = q[k:, :2] - point
            turned = change[k:, 0] * arms[:, 1] - change[k:, 1] * arms[:, 0]
            return float((turned + change[k:, 2]).sum())

        ends = ends_of(column, q, k)
        touching = [end for end in ends if abs(end.gap) < TOUCHES * column.size]
        if not touching:
            note("elsewhere", float(np.hypot(*push)) / unit)
            continue
        first, last = touching[0], touching[-1]
        pressed, along = float(push @ first.normal), float(push @ first.tangent)
        parts = [pressed]
        if len(touching) == 2:
            arm = last.point - first.point
            lever = first.normal[0] * arm[1] - first.normal[1] * arm[0]
            far = moment_about(first.point) / lever
            parts = [pressed - far, far]
        else:
            note("elsewhere", abs(moment_about(first.point)) / (unit * column.size))
        for end, part in zip(touching, parts, strict=True):
            speed = relative(column, q, after, k, end.point) @ end.normal
            note("pull", -part / unit)
            note("sinks", -float(speed) / column.speed)
            if kept:
                note("complementarity", min(part / unit, float(speed) / column.speed))
        slid = float(relative(column, q, before, k, first.point) @ first.tangent)
        slips = float(relative(column, q, after, k, first.point) @ first.tangent)
        static, kinetic = column.static[k], column.kinetic[k]
        brakes = slid * along < 0 and abs(slid) > 1e-9 * column.speed
        limit = kinetic if brakes else max(static, kinetic)
        note("friction", (abs(along) - limit * max(0.0, pressed)) / unit)
        way = 1.0 if slips > 0 else -1.0
        missing = abs(along + way * kinetic * max(0.0, pressed)) / unit
        if slid * slips < 0:
            # a slip that has turned round was braked first
            missing = (abs(along) - kinetic * max(0.0, pressed)) / unit
        note("direction", min(missing, abs(slips) / column.speed))
    gain = kinetic_energy(column, after) - kinetic_energy(column, before)
    found["gain"] = gain / (column.mass * column.speed**2)
    return found
