"""Bodies, states and memory for kernels of the engine in space, called one by one as plain Python."""

import math

import numpy as np

from ...mutants.plain import plain_library

with plain_library():
    from rockfrag.engines.algebra.vectors import rotation
    from rockfrag.engines.spatial import _at_rest as at_rest
    from rockfrag.engines.spatial import _body as solid
    from rockfrag.engines.spatial import _case as case
    from rockfrag.engines.spatial import _cone as cone
    from rockfrag.engines.spatial import _contacts as contacts
    from rockfrag.engines.spatial import _delassus as delassus
    from rockfrag.engines.spatial import _events as events
    from rockfrag.engines.spatial import _face as face
    from rockfrag.engines.spatial import _forces as forces
    from rockfrag.engines.spatial import _gaps as gaps
    from rockfrag.engines.spatial import _ground as ground
    from rockfrag.engines.spatial import _holders as holders
    from rockfrag.engines.spatial import _hops as hops
    from rockfrag.engines.spatial import _impacts as impacts
    from rockfrag.engines.spatial import _integrate as whole
    from rockfrag.engines.spatial import _limits as limits
    from rockfrag.engines.spatial import _modes as modes
    from rockfrag.engines.spatial import _outcome as outcome
    from rockfrag.engines.spatial import _points as points
    from rockfrag.engines.spatial import _problem as problem
    from rockfrag.engines.spatial import _rest as rest
    from rockfrag.engines.spatial import _rim as rim
    from rockfrag.engines.spatial import _step as step
    from rockfrag.engines.spatial import _stick as stick
    from rockfrag.engines.spatial import _ties as ties
    from rockfrag.engines.spatial import engine
    from rockfrag.engines.spatial.body import kernel_body
    from rockfrag.system import Tie, Wall
    from rockfrag.system.body import Circle, Polygon, RigidBody
    from rockfrag.system.contact import Contact
    from rockfrag.system.system import System

# what is imported plain is so once: modules of tests take it from here
__all__ = [
    "Circle",
    "Contact",
    "Polygon",
    "RigidBody",
    "System",
    "Tie",
    "Wall",
    "at_rest",
    "case",
    "cone",
    "contacts",
    "delassus",
    "engine",
    "events",
    "face",
    "forces",
    "gaps",
    "ground",
    "holders",
    "hops",
    "impacts",
    "kernel_body",
    "limits",
    "modes",
    "outcome",
    "points",
    "problem",
    "rest",
    "rim",
    "rotation",
    "solid",
    "step",
    "stick",
    "ties",
    "whole",
]

G = 9.81
OUTLINE = (
    (-0.3, -0.2),
    (0.25, -0.25),
    (0.35, 0.1),
    (0.1, 0.3),
    (-0.2, 0.25),
    (-0.4, 0),
)


def plain(record):
    """A record whose fields are attributes."""
    return np.array([record]).view(np.recarray)[0]


def uneven(rng, *holders):
    """A body of no symmetry on a hexagon, as the kernels know it."""
    moments = rng.uniform(0.2, 0.3, 3)
    tensor = np.diag(moments) + 0.02 * np.ones((3, 3))
    centre = (0.03, -0.02, 0.6)
    solid_body = RigidBody(1.0, tensor, centre, Polygon(OUTLINE), 1.3, Polygon(OUTLINE))
    system = System((solid_body,), (Contact(),), constraints=tuple(holders))
    body = kernel_body(system)
    body["static"], body["kinetic"] = 0.5, 0.3
    return plain(body)


def state(rng, body):
    """Any position, attitude and velocities."""
    y = rng.normal(0, 0.5, solid.SIZE)
    y[2] = body.height + 0.1
    y[3:7] = np.array([1.0, *rng.normal(0, 0.2, 3)])
    y[3:7] /= np.linalg.norm(y[3:7])
    return y


def memory():
    """Memory of an analysis on ground at rest."""
    s = plain(np.zeros(1, case.CASE)[0])
    s.field[2], s.field[case.GRAVITY] = -G, G
    return s


def shaken(rng, size=2.0):
    """Memory of an analysis on ground that moves, with accelerations and rises of a size."""
    s = memory()
    s.field[:6] = rng.normal(0, size, 6)
    s.field[2] -= G
    s.close = limits.CLOSE
    return s


def attitude(y):
    """Rotation matrix, world from body, of the quaternion."""
    w, v = y[3], y[4:7]
    skew = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * skew + 2 * skew @ skew


def jacobian(y, p):
    """What C's velocity (world) and the angular velocity (body) give to the velocity of the body's point p."""
    skew = np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
    return np.hstack([np.eye(3), -attitude(y) @ skew])


def point(body, i):
    """Arm of vertex i."""
    return np.array(body.points[i])


def inverse_mass(body):
    """Inverse of the mass matrix, for a unit of mass."""
    found = np.eye(6)
    found[3:, 3:] = np.linalg.inv(body.inertia)
    return found


def set_down(y, body):
    """Put a state flat on the ground, turned about the vertical alone."""
    y[2] = body.height
    y[4] = y[5] = 0.0
    y[3:7] /= np.linalg.norm(y[3:7])


def mode(s, *closed, slides=0):
    """Close points, all sticking or all sliding."""
    s.count, s.rests = len(closed), 0
    for k, i in enumerate(closed):
        s.closed[k], s.slides[k] = i, slides


def leaning(body, tilt, towards):
    """State of a body at rest that leans by a tilt towards a direction of the plan."""
    y = np.zeros(solid.SIZE)
    axis = np.array([-math.sin(towards), math.cos(towards), 0.0])
    y[3], y[4:7] = math.cos(tilt / 2), math.sin(tilt / 2) * axis
    y[2] = body.height
    return y
