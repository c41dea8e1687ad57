"""From a body and its friction to the records of numbers that the contact kernels read and write.

Bodies are numbered from below; interface k lies under body k.  Ends of an interface are 0 (left) and 1 (right).
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rockfrag.elementary import atan2, sin_cos
from rockfrag.engines.records import after_impact
from rockfrag.system import geometry
from rockfrag.system.contact import ROUGHEST
from rockfrag.system.system import System

F, INT = np.float64, np.int64
Array = NDArray[np.float64]

MOST = 12  # bodies of the longest column
TRIES = 1024  # modes that a search tries at most: more than three interfaces have

BODY = np.dtype(
    [
        ("count", INT),  # bodies: 1 to MOST
        ("g", F),
        ("mass", F, (MOST,)),
        ("inertia", F, (MOST,)),
        ("inverse", F, (3 * MOST,)),  # 1/m, 1/m, 1/I of each body
        ("corner", F, (MOST, 2, 2)),  # [body, end] of its base from its centre, x and y [m]
        # [interface] middle of the face below from the centre of the body below
        ("face", F, (MOST, 2)),
        ("half", F, (MOST,)),  # [interface] half width of the face below; infinite for the ground
        # [interface] tilt of face and base as all stand, coefficients of friction
        *((name, F, (MOST,)) for name in ("tilt_cos", "tilt_sin", "static", "kinetic")),
        ("law", INT, (MOST, 2)),  # [interface, corner that comes down] law of the impact ...
        ("number", F, (MOST, 2)),  # ... and its number
        # [body, side] its critical angle to the left, to the right [rad]
        ("critical", F, (MOST, 2)),
        ("standing", F, (3 * MOST,)),  # x, y, θ of each body as it stands
        ("weight", F),  # of everything [N]: unit of forces
        ("size", F),  # half width of the uppermost body [m]: unit of lengths
        ("speed", F),  # √(g size) [m/s]: unit of speeds
    ]
)

TOLD = [
    ("peak", F, (MOST,)),  # largest |θ| over the critical angle of its sign, and ...
    ("peak_speed", F, (MOST,)),  # ... largest |θ'| [rad/s] of each body
    ("peak_slip", F, (MOST,)),  # largest |slip| of each interface [m]
    ("slid", INT, (MOST,)),  # whether an interface has ever reached its limit, in impacts too
    ("flights", INT, (MOST,)),  # times that an interface opened at both ends
    ("impacts", INT),
    ("paradoxes", INT),
    ("several", INT),  # times that more than one mode was found consistent
    ("given_way", INT),  # impacts in which a law would have gained energy
    ("fallen", INT),  # 0 none, or the body that fell first, from 1 below
    ("parted", INT),  # 0 none, or the interface that is open furthest as a body falls, from 1 below
]
"""What is told of a case."""

WORK = np.dtype(
    [
        ("q", F, (3 * MOST,)),  # x, y, θ of each body relative to the ground
        ("v", F, (3 * MOST,)),
        ("a", F, (3 * MOST,)),
        ("closed", INT, (MOST, 2)),  # [interface, end] the mode: closed ends ...
        ("slides", INT, (MOST,)),  # ... and the sign of slip, 0 where an interface sticks
        # of closed ends: 1 a corner on the face, 0 the edge of the face on the base
        ("kind", INT, (MOST, 2)),
        ("normal", F, (MOST, 2)),  # forces, or impulses
        ("shear", F, (MOST,)),
        ("out", F, (3 * MOST,)),  # accelerations, or velocities after an impact
        # geometry of the configuration that was looked at last
        ("cos", F, (MOST,)),
        ("sin", F, (MOST,)),
        # one row per closed end and per interface that sticks: what it takes of the body below (3) and above (3)
        ("row", F, (3 * MOST, 6)),
        ("column", F, (3 * MOST, 6)),
        ("light", F, (6,)),
        ("matrix", F, (3 * MOST, 3 * MOST)),
        ("right", F, (3 * MOST,)),
        ("owner", INT, (3 * MOST,)),  # 3 k + end, or 3 k + 2 for shear
        ("upto", INT, (MOST + 2,)),  # number of unknowns of the interfaces up to this one
        # a step: start, end, stages
        *((name, F, (3 * MOST,)) for name in ("q0", "v0", "a0", "q1", "v1", "a1")),
        *((name, F, (3 * MOST, 7)) for name in ("kv", "ka")),
        ("early", F, (MOST, 2)),  # speeds at which open ends part at the start of a step
        ("fails", INT, (MOST, 6)),  # [interface, channel] what has become negative
        # search for a mode
        ("touching", INT, (MOST, 2)),
        ("moves", INT, (MOST,)),
        ("limit", F, (MOST,)),
        # normal and tangent of each touching end: motions along them per coordinate, bodies below and above
        ("arm", F, (4 * MOST, 6)),
        ("free", F, (4 * MOST,)),  # acceleration or velocity along these without any contact
        # ... and what a unit force along one of the interfaces below, here and above gives along it
        ("give", F, (4 * MOST, 12)),
        ("along", INT, (3 * MOST,)),  # of each unknown of a mode: its row in the three above ...
        ("rub", F, (3 * MOST,)),  # ... and the fraction of the tangent after it that friction adds
        ("old_v", F, (3 * MOST,)),
        ("old_closed", INT, (MOST, 2)),
        ("old_slides", INT, (MOST,)),
        ("flip", INT, (3,)),  # interface, what and how: the change that mends the worst of a mode
        ("tried", INT, (TRIES,)),  # numbers of the modes that a search has tried ...
        ("wrong", F, (TRIES,)),  # ... and how far each is from consistent
        # laws of an impact: fraction of an end's impulse that the other end gets too, end that leaves at a given
        # speed (-1: none), and that speed
        ("fraction", F, (MOST, 2)),
        ("drive", INT, (MOST,)),
        ("depart", F, (MOST,)),
        ("falls", INT, (MOST,)),  # end that comes down while the other is closed, -1: none
        ("goal", F, (MOST, 2)),  # speed at which the other end departs: without the law, with it
        # margins of rest, linear in the two accelerations
        ("rest", F, (4 * MOST, 3)),
        # ledgers [J] and counts
        ("work", F),
        ("rubbed", F),  # lost to friction
        ("struck", F),  # lost in impacts
        *TOLD,
        ("forced", INT),
        ("met", INT),  # contact events within the sample
        ("resting", INT),
    ]
)

OUTCOME = np.dtype([*TOLD, ("time", F), ("slip", F, (MOST,))])  # time of the fall [s]


def fill_geometry(p: np.void, system: System) -> None:
    """Fill geometry and masses of a column into its record; a base is as wide as what lies on the face below."""
    bodies, contacts, shapes = system.in_plane().bodies, system.contacts, system.shapes
    p["count"], p["weight"] = system.count, p["g"] * system.mass
    p["half"][0], p["tilt_cos"][:] = math.inf, 1.0
    middle, tilt = np.zeros(2), 0.0  # of the face under a body, from the middle of the lowest base
    for k, shape in enumerate(shapes):
        foot, base = middle, middle
        if k > 0:
            below, (stand, face) = bodies[k - 1], bodies[k - 1].ends
            lean, wide = (
                contacts[k - 1].tilt,
                shapes[k - 1]._replace(b=(face.right - face.left) / 2),
            )
            right = face.middle - stand.middle
            offset = contacts[k].offset[0] + bodies[k].ends[0].middle - (right + stand.middle)
            pile = geometry.pile_of(wide, shape, below.height, lean, offset)
            shape = pile.upper
            aside = np.array(geometry.turned(right, 0.0, lean))
            top = np.array(geometry.turned(0.0, below.height, lean)) + aside
            foot = middle + _turned(np.array(pile.right) + aside, tilt)
            p["face"][k] = _turned(top - (wide.x, wide.y), tilt)
            p["half"][k] = wide.b
            base = middle + _turned(
                np.array(geometry.turned(offset, below.height, lean)) + aside, tilt
            )
            tilt += lean
            p["tilt_sin"][k], p["tilt_cos"][k] = sin_cos(tilt)
        p["mass"][k], p["inertia"][k] = shape.mass, shape.inertia
        p["inverse"][3 * k : 3 * k + 3] = 1 / shape.mass, 1 / shape.mass, 1 / shape.inertia
        for end, pivot in enumerate((-1, 1)):
            x, y = geometry.turned(*geometry.arm(shape, pivot), tilt)
            p["corner"][k, end] = -x, -y
            p["critical"][k, end] = atan2(-pivot * x, y)
        # x, y: arm of the right end
        stands = (foot[0] + x, foot[1] + y) if k else (shape.x, shape.y)
        p["standing"][3 * k : 3 * k + 2] = stands
        middle = base
    p["size"], p["speed"] = shape.b, math.sqrt(p["g"] * shape.b)


def _turned(vector: Array, angle: float) -> Array:
    return np.array(geometry.turned(float(vector[0]), float(vector[1]), angle))


def system_record(system: System, g: float) -> np.void:
    """Return the record ``BODY`` of a planar system; a contact without friction is as rough as can be."""
    p: np.void = np.zeros(1, BODY)[0]
    p["g"] = g
    fill_geometry(p, system)
    for k, (contact, shape) in enumerate(zip(system.contacts, system.carried, strict=True)):
        p["static"][k], p["kinetic"][k] = contact.friction or (ROUGHEST, ROUGHEST)
        for end, pivot in enumerate((-1, 1)):
            p["law"][k, end], p["number"][k, end] = after_impact(contact.law, shape, pivot)
    return p


def working_memory() -> np.void:
    """Return the record ``WORK`` that the integration of a case needs."""
    work: np.void = np.zeros(1, WORK)[0]
    return work


def posed(p: np.void, theta: Sequence[float], omega: Sequence[float]) -> NDArray[np.float64]:
    """Coordinates and velocities, shape (2, 3 MOST), of bodies turned about the corners that this leaves them."""
    start = np.zeros((2, 3 * MOST))
    standing = p["standing"]

    for k in range(int(p["count"])):
        below = (theta[k - 1], omega[k - 1]) if k else (0.0, 0.0)
        end = 1 if ((theta[k] - below[0]) or (omega[k] - below[1])) >= 0 else 0
        corner = p["corner"][k, end]
        pivot = standing[3 * k : 3 * k + 2] + corner
        speed = np.zeros(2)
        if k:
            at = slice(3 * k - 3, 3 * k - 1)
            arm = _turned(pivot - standing[at], below[0])
            pivot = start[0, at] + arm
            speed = start[1, at] + below[1] * np.array([arm[1], -arm[0]])
        arm = -_turned(corner, theta[k])
        start[0, 3 * k : 3 * k + 2] = pivot + arm
        start[1, 3 * k : 3 * k + 2] = speed + omega[k] * np.array([arm[1], -arm[0]])
        start[0, 3 * k + 2], start[1, 3 * k + 2] = theta[k], omega[k]
    return start
