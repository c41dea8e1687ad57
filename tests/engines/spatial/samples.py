"""Bodies and synthetic motions for the tests of bodies in space."""

import math

import numpy as np
from scipy.signal import butter, sosfilt

from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.system.body import Circle, Polygon, RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import System

DT = 0.01


def turned(vectors, angle):
    """Turn plane vectors anticlockwise."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(vectors) @ np.array([[c, s], [-s, c]])


def solid(base, inertia, height, friction, g=GRAVITY):
    """A body of a unit of mass, whose centre is above the origin; its friction may be any."""
    bodies = (RigidBody(1.0, inertia, (0.0, 0.0, height), base, 1.0),)
    body = kernel_body(System(bodies, (Contact(),)), g)
    body["static"] = body["kinetic"] = friction
    return body


def box(width, depth, height, friction=20.0):
    """A uniform box."""
    x, y = width / 2, depth / 2
    base = Polygon(((-x, -y), (x, -y), (x, y), (-x, y)))
    inertia = (
        np.diag([depth**2 + height**2, width**2 + height**2, width**2 + depth**2]) / 12
    )
    return solid(base, inertia, height / 2, friction)


def cylinder(radius, height, friction=20.0, sides=0):
    """A uniform cylinder, on its rim or on a regular polygon in it."""
    base = Circle(radius)
    if sides:
        angle = 2 * math.pi * np.arange(sides) / sides
        base = Polygon(
            tuple(zip(radius * np.cos(angle), radius * np.sin(angle), strict=True))
        )
    across = (3 * radius**2 + height**2) / 12
    inertia = np.diag([across, across, radius**2 / 2])
    return solid(base, inertia, height / 2, friction)


def synthetic_motion(rng, components=2, seconds=20.0, dt=DT):
    """Filtered noise under an envelope (synthetic), largest horizontal acceleration 1 g, shape (n, 3) [m/s²]."""
    n = round(seconds / dt)
    noise = rng.standard_normal((n, 3))
    low = rng.uniform(0.2, 0.5)
    sections = butter(2, [low, rng.uniform(2.0, 5.0)], "band", fs=1 / dt, output="sos")
    time = np.arange(n) * dt
    envelope = np.exp(-(((time - 0.35 * seconds) / (0.18 * seconds)) ** 2))
    motion = sosfilt(sections, noise, axis=0) * envelope[:, None]
    motion[:, components:] = 0.0
    if components == 3:
        motion[:, 2] *= 0.5
    peaks = np.abs(motion[:, : min(components, 2)]).max(axis=0)
    return motion * (GRAVITY / np.exp(np.log(peaks).mean()))
