"""From a body and its friction to the records of numbers that the contact kernels read and write.

Bodies are numbered from below; interface k lies under body k.  Ends of an interface are 0 (left) and 1 (right).
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rockfrag.elementary import atan2, sin_cos
from rockfrag.rocking.contact.friction import Friction
from rockfrag.system.blocks import Block, Body

F, INT = np.float64, np.int64

BODY = np.dtype(
    [
        ("count", INT),  # bodies: 1 or 2
        ("g", F),
        ("mass", F, (2,)),
        ("inertia", F, (2,)),
        ("inverse", F, (6,)),  # 1/m, 1/m, 1/I of each body
        ("corner", F, (2, 2, 2)),  # [body, end] of its base from its centre, x and y [m]
        (
            "face",
            F,
            (2, 2),
        ),  # [interface] middle of the face below from the centre of the body below
        ("half", F, (2,)),  # [interface] half width of the face below; infinite for the ground
        ("tilt_cos", F, (2,)),  # [interface] tilt of face and base as all stand
        ("tilt_sin", F, (2,)),
        ("static", F, (2,)),
        ("kinetic", F, (2,)),
        ("critical", F, (2, 2)),  # [body, side] its critical angle to the left, to the right [rad]
        ("standing", F, (6,)),  # x, y, θ of each body as it stands
        ("weight", F),  # of everything [N]: unit of forces
        ("size", F),  # half width of the uppermost body [m]: unit of lengths
        ("speed", F),  # √(g size) [m/s]: unit of speeds
    ]
)

WORK = np.dtype(
    [
        ("q", F, (6,)),  # x, y, θ of each body relative to the ground
        ("v", F, (6,)),
        ("a", F, (6,)),
        ("closed", INT, (2, 2)),  # [interface, end] the mode: closed ends ...
        ("slides", INT, (2,)),  # ... and the sign of slip, 0 where an interface sticks
        (
            "kind",
            INT,
            (2, 2),
        ),  # of closed ends: 1 a corner on the face, 0 the edge of the face on the base
        ("normal", F, (2, 2)),  # forces, or impulses
        ("shear", F, (2,)),
        ("out", F, (6,)),  # accelerations, or velocities after an impact
        # geometry of the configuration that was looked at last
        ("cos", F, (2,)),
        ("sin", F, (2,)),
        # one row per closed end and per interface that sticks
        ("row", F, (6, 6)),
        ("column", F, (6, 6)),
        ("light", F, (6,)),
        ("matrix", F, (6, 7)),
        ("owner", INT, (6,)),  # 3 k + end, or 3 k + 2 for shear
        # a step: start, stages, interpolation
        ("q0", F, (6,)),
        ("v0", F, (6,)),
        ("a0", F, (6,)),
        ("q1", F, (6,)),
        ("v1", F, (6,)),
        ("a1", F, (6,)),
        ("kv", F, (7, 6)),
        ("ka", F, (7, 6)),
        ("fails", INT, (2, 6)),  # [interface, channel] what has become negative
        # search for a mode
        ("touching", INT, (2, 2)),
        ("moves", INT, (2,)),
        ("limit", F, (2,)),
        (
            "arm",
            F,
            (8, 6),
        ),  # normal and tangent of each touching end: motions along them per coordinate
        ("free", F, (8,)),  # acceleration or velocity along these without any contact
        ("give", F, (8, 8)),  # ... and what a unit force along one gives along the other
        ("along", INT, (6,)),  # of each unknown of a mode: its row in the three above ...
        ("rub", F, (6,)),  # ... and the share of the tangent after it that friction adds
        ("old_v", F, (6,)),
        ("old_closed", INT, (2, 2)),
        ("old_slides", INT, (2,)),
        ("best_closed", INT, (2, 2)),
        ("best_slides", INT, (2,)),
        # margins of rest, linear in the two accelerations
        ("rest", F, (8, 3)),
        # ledgers [J] and counts
        ("work", F),
        ("rubbed", F),  # lost to friction
        ("struck", F),  # lost in impacts
        ("peak", F, (2,)),  # largest |θ| over the critical angle of its sign, and ...
        ("peak_speed", F, (2,)),  # ... largest |θ'| [rad/s] of each body
        ("peak_slip", F, (2,)),  # largest |slip| of each interface [m]
        ("impacts", INT),
        ("slips", INT),  # times that an interface began to slide
        ("flights", INT),  # times that an interface opened at both ends
        ("slid", INT, (2,)),  # whether an interface has ever reached its limit, in impacts too
        ("paradoxes", INT),
        ("forced", INT),
        ("fallen", INT),
        ("resting", INT),
    ]
)

OUTCOME = np.dtype(
    [
        ("fallen", INT),  # 0 none, 1 the lone block or the pedestal, 2 the statue
        ("time", F),  # of the fall [s]
        ("impacts", INT),
        ("paradoxes", INT),
        ("forced", INT),
        ("peak", F, (2,)),
        ("peak_speed", F, (2,)),
        ("peak_slip", F, (2,)),
        ("slip", F, (2,)),
        ("slid", INT, (2,)),
        ("flights", INT),
    ]
)


def contact_body(body: Body, friction: tuple[Friction, ...], g: float) -> np.void:
    """Return the record ``BODY`` of a block or a stack with the friction of its interfaces."""
    p: np.void = np.zeros(1, BODY)[0]
    if isinstance(body, Block):
        blocks, arms = [body], [[body.arm(pole) for pole in (-1, 1)]]
    else:
        blocks = [body.pedestal, body.statue]
        arms = [[arm(pole) for pole in (-1, 1)] for arm in (body.pedestal.arm, body.statue_arm)]
    p["count"], p["g"] = len(blocks), g
    p["half"][0], p["tilt_cos"][:] = math.inf, 1.0
    for k, (block, pair) in enumerate(zip(blocks, arms, strict=True)):
        p["mass"][k], p["inertia"][k] = block.mass, block.centroidal_inertia
        p["inverse"][3 * k : 3 * k + 3] = (
            1 / block.mass,
            1 / block.mass,
            1 / block.centroidal_inertia,
        )
        for end, arm in enumerate(pair):
            p["corner"][k, end] = -arm.x, -arm.y
            p["critical"][k, end] = atan2((1 - 2 * end) * arm.x, arm.y)
        p["static"][k], p["kinetic"][k] = friction[k]
    p["standing"][:2] = blocks[0].centre
    if not isinstance(body, Block):
        pedestal = body.pedestal
        sine, cosine = sin_cos(pedestal.lean)
        top = np.array([sine, cosine]) * pedestal.height
        p["face"][1], p["half"][1] = top - pedestal.centre, pedestal.b
        p["tilt_cos"][1], p["tilt_sin"][1] = cosine, sine
        foot, own = body.interface_pole(1), body.statue_arm(1)
        p["standing"][3:5] = foot.x + own.x, foot.y + own.y
    p["weight"] = g * sum(block.mass for block in blocks)
    p["size"] = blocks[-1].b
    p["speed"] = math.sqrt(g * blocks[-1].b)
    return p


def working_memory() -> np.void:
    """Return the record ``WORK`` that a march needs."""
    work: np.void = np.zeros(1, WORK)[0]
    return work


def posed(p: np.void, theta: Sequence[float], omega: Sequence[float]) -> NDArray[np.float64]:
    """Coordinates and velocities, shape (2, 6), of bodies turned about the corners that this leaves them."""
    start = np.zeros((2, 6))
    standing = p["standing"]

    def turned(x: float, y: float, angle: float) -> NDArray[np.float64]:
        s, c = sin_cos(angle)
        return np.array([x * c + y * s, -x * s + y * c])

    for k in range(int(p["count"])):
        below = (theta[k - 1], omega[k - 1]) if k else (0.0, 0.0)
        end = 1 if ((theta[k] - below[0]) or (omega[k] - below[1])) >= 0 else 0
        corner = p["corner"][k, end]
        pole = standing[3 * k : 3 * k + 2] + corner
        speed = np.zeros(2)
        if k:
            arm = turned(pole[0] - standing[0], pole[1] - standing[1], below[0])
            pole = start[0, :2] + arm
            speed = start[1, :2] + below[1] * np.array([arm[1], -arm[0]])
        arm = -turned(corner[0], corner[1], theta[k])
        start[0, 3 * k : 3 * k + 2] = pole + arm
        start[1, 3 * k : 3 * k + 2] = speed + omega[k] * np.array([arm[1], -arm[0]])
        start[0, 3 * k + 2], start[1, 3 * k + 2] = theta[k], omega[k]
    return start
