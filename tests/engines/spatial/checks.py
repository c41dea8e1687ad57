"""What the checks of bodies in space measure, for their tests and their figure."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial._body import SIZE
from rockfrag.engines.spatial.engine import history_table, run_case
from rockfrag.system.body import Circle

from ...oracle.space_stepping import falls
from .samples import DT, box, cylinder, solid, synthetic_motion

ANGLES = np.arange(0.9, 44.2, 0.9)
# slendernesses [degrees] and half diagonals [m] of solid cylinders
RADII = (1.0, 3.0, 10.0, 30.0)
SIDES = (12, 24, 48)
PASSES = [
    (True, 0.3, 7.501), (True, 0.1, 7.251), (True, 0.03, 7.115),
    (False, 0.3, 5.570), (False, 0.1, 5.379), (False, 0.03, 5.261),
]  # fmt: skip
"""Whether it is a thin disk or a cylinder, speed sideways [rad/s], and turn by another program [rad]."""
LEVELS = np.geomspace(0.6, 2.2, 10)
"""Peaks of the components over that which uplifts the box along its shorter side [-]."""


def turned_by(vector):
    """State of a body turned by a rotation vector [rad], and its attitude."""
    y, turned_so = np.zeros(SIZE), Rotation.from_rotvec(vector)
    y[3:7] = np.roll(turned_so.as_quat(), 1)
    return y, turned_so.as_matrix()


def tilted_on_rim(body, tilt, spin):
    """State of a round body tilted about y, lowest at +x, rolling with body-frame angular velocity ``spin``."""
    y, attitude = turned_by([0.0, tilt, 0.0])
    arm = np.array([body["rim"], 0.0, -body["height"]])
    y[0:3] = -attitude @ arm
    y[7:10] = attitude @ np.cross(arm, spin)
    y[10:13] = spin
    return y


def ground_at_rest(seconds, dt=DT):
    return np.zeros((round(seconds / dt), 3))


def planar_case(rng):
    """Width, depth and height of a box, and a motion in one plane."""
    width = rng.uniform(0.15, 0.8)
    height = width * rng.uniform(2.5, 6)
    motion = synthetic_motion(rng, 1) * rng.uniform(1.0, 2.5) * width / height
    return width, width * rng.uniform(0.5, 2), height, motion


def uplift(direction_deg, depth=0.6):
    """Accelerations before and after a box lifts, the formula's, and the vertices that then touch.

    Along a face it is g b/h, in between where the larger component of a growing push reaches its own limit.
    """
    angle, sides, height = math.radians(direction_deg), (0.4, depth), 1.5
    ways = math.cos(angle), math.sin(angle)
    ramp = np.linspace(0, 6, 601)
    motion = np.column_stack([ramp * ways[0], ramp * ways[1], 0 * ramp])
    _, history = run_case(box(*sides, height), motion, DT, samples=700)
    closed = history_table(history, DT, height / 2).contacts
    moving = closed.notna().to_numpy().argmax()
    limit = min(
        GRAVITY * b / height / max(way, 1e-12)
        for b, way in zip(sides, ways, strict=True)
    )
    return ramp[moving - 1], ramp[moving], limit, closed[moving]


def wobbling(tilt, radius=0.3, height=1.4, g=9.81):
    """A cylinder that wobbles with its centre at rest: the body, its state, and its rate.

    Ω² = g (ρ cos θ - h sin θ) / {sin θ [A cos θ - (C h/ρ) sin θ]} for a unit of mass.
    """
    body = cylinder(radius, height)
    across, along = body["inertia"][0, 0], body["inertia"][2, 2]
    s, c, h = math.sin(tilt), math.cos(tilt), height / 2
    rate = math.sqrt(
        g * (radius * c - h * s) / (s * (across * c - along * h / radius * s))
    )
    # the centre at rest: ω lies along the arm to the contact, and the axis goes round at Ω
    arm = np.array([radius, 0.0, -h])
    up = np.array([-s, 0.0, c])
    axis = np.array([0.0, 0.0, 1.0])
    # ω = λ arm with dd/dt = ω × d = Ω k × d
    spin = arm * (rate * np.cross(up, axis)[1] / np.cross(arm, axis)[1])
    return body, tilted_on_rim(body, tilt, spin), rate


def wobble(tilt):
    """Outcome, table and measured rate of three periods of a wobble, and the formula's rate."""
    body, start, rate = wobbling(tilt)
    period = 2 * math.pi / rate
    dt = period / 40
    still = ground_at_rest(3 * period, dt)
    outcome, history = run_case(
        body, still, dt, start=start, samples=122, g=9.81, tolerance=1e-11
    )
    table = history_table(history, dt, float(body["height"]))
    turn = np.unwrap(np.arctan2(table.axis_y, table.axis_x))
    return outcome, table, abs(turn[-1] - turn[0]) / table.time_s.iloc[-1], rate


def near_flat_pass(disk, speed):
    """Turn of the contact in a pass near flat from a tilt at rest, and the tilt that is regained."""
    turn, regained = signed_pass(disk, speed)
    return abs(turn), regained


def signed_pass(disk, speed, tilt=0.05, radius=0.3, g=9.81):
    """Turn of the contact in a pass near flat, with its sign, and the tilt that is regained."""
    if disk:
        inertia = np.diag([radius**2 / 4, radius**2 / 4, radius**2 / 2])
        body = solid(Circle(radius), inertia, 1e-12, 1e6, g)
    else:
        body = cylinder(radius, radius, friction=1e6)
    # sideways: the lowest point goes round at this speed times the tilt
    start = tilted_on_rim(body, tilt, np.array([speed, 0.0, 0.0]))
    dt = 1e-4
    _, history = run_case(
        body, ground_at_rest(1.0, dt), dt, start=start, samples=10001, g=g
    )
    table = history_table(history, dt, float(body["height"]))
    rising = np.diff(table.tilt_rad)
    low = int((rising > 0).argmax())
    top = low + int((rising[low:] < 0).argmax())
    turn = np.unwrap(np.arctan2(table.axis_y, table.axis_x))
    return turn[top] - turn[0], table.tilt_rad[top]


def about_a_vertex():
    """Energies and vertical angular momenta of a box while it pivots, and what its balance does not close by."""
    body = box(0.4, 0.6, 1.2)
    start, attitude = turned_by(0.15 * np.array([1.0, 0.8, 0.0]) / math.hypot(1, 0.8))
    start[10:13] = [-0.4, -0.5, 0.3]
    corners = body["points"][: body["count"]]
    lowest = corners[np.argmin((corners @ attitude.T)[:, 2])]
    start[0:3] = -attitude @ lowest
    start[7:10] = attitude @ np.cross(lowest, start[10:13])
    outcome, history = run_case(body, ground_at_rest(0.3), DT, start=start, samples=20)
    same = (history[:, 14] == 1) & (history[:, 15] == history[0, 15])
    while_pivoting = history[: int((~same).argmax())]
    assert len(while_pivoting) > 5
    about = body["inertia"] + lowest @ lowest * np.eye(3) - np.outer(lowest, lowest)
    momenta, energies = [], []
    for row in while_pivoting:
        up = Rotation.from_quat(np.roll(row[3:7], -1)).as_matrix()[2]
        momenta.append(up @ about @ row[10:13])
        energies.append(row[10:13] @ about @ row[10:13] / 2 + GRAVITY * row[2])
    return np.array(energies), np.array(momenta), outcome.residual


def polygons():
    """Largest change of tilt, and loss per vertex, of polygons that roll as the circle wobbles at rest."""
    _, start, rate = wobbling(0.2, g=GRAVITY)
    changes, losses = [], []
    for sides in SIDES:
        body = cylinder(0.3, 1.4, sides=sides)
        # half a turn of the contact
        outcome, history = run_case(
            body, ground_at_rest(3.1 / rate), DT, start=start, samples=60
        )
        losses.append(outcome.dissipated[0] / outcome.impacts)
        tilts = history_table(history, DT, float(body["height"])).tilt_rad
        changes.append(float(np.abs(tilts - 0.2).max()))
    return changes, losses


def solid_cylinders(seed):
    """Which solid cylinders rest, and fall, under a pair of components, (radii, angles), and its peak [g]."""
    motion = synthetic_motion(np.random.default_rng(seed), 2, 15.0) * 0.4
    rests, falls = np.zeros((2, len(RADII), len(ANGLES)), bool)
    for i, half in enumerate(RADII):
        for j, angle in enumerate(np.radians(ANGLES)):
            body = cylinder(half * math.sin(angle), 2 * half * math.cos(angle))
            found, _ = run_case(body, motion, DT)
            rests[i, j], falls[i, j] = found.peak_velocity == 0, found.overturned
    return rests, falls, np.hypot(*motion[:, :2].T).max() / GRAVITY


def by_stepping(boxes, pairs, seed):
    """Outcomes of the engine and of a plain time stepping, shape (boxes, pairs, levels)."""
    rng = np.random.default_rng(seed)
    shape = (boxes, pairs, len(LEVELS))
    found, expected = np.zeros(shape, bool), np.zeros(shape, bool)
    for i in range(boxes):
        width = rng.uniform(0.2, 0.6)
        depth = width * rng.uniform(0.7, 1.5)
        height = min(width, depth) * rng.uniform(2.5, 5)
        body = box(width, depth, height)
        corners = np.ascontiguousarray(body["points"][:4])
        inertia = np.ascontiguousarray(body["inertia"])
        for j in range(pairs):
            motion = synthetic_motion(rng, 2, 15.0)
            for k, level in enumerate(LEVELS):
                ground = motion * (level * min(width, depth) / height)
                found[i, j, k] = run_case(body, ground, DT)[0].overturned
                expected[i, j, k] = falls(
                    corners, inertia, 20.0, ground, DT, 9.81, 5e-4
                )
    return found, expected
