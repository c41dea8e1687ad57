"""Bodies that differ a little from given ones."""

import math
from dataclasses import replace

import numpy as np

from rockfrag.system.body import Circle, Interval, Outline, Polygon, RigidBody, checked_tensor
from rockfrag.system.geometry import shape_of
from rockfrag.system.system import System


def perturbed(system: System, size: float, rng: np.random.Generator) -> System:
    """Return a system whose widths and heights differ by at most ``size``, relative, drawn evenly."""
    drawn = [(1 + size * rng.uniform(-1, 1, 2)).tolist() for _ in system.bodies]
    bodies = (_resized(body, *sizes) for body, sizes in zip(system.bodies, drawn, strict=True))
    return replace(system, bodies=tuple(bodies))


def _resized(body: RigidBody, across: float, up: float) -> RigidBody:
    x, y, z = body.centre
    base, height = _scaled(body.base, across), body.height * up
    made = replace(
        body,
        centre=(x, y, z * up),
        base=base,
        height=height,
        face=None if body.face is None else _scaled(body.face, across),
    )
    if isinstance(body.inertia, tuple):
        inertia, stretch = body.tensor, (across, across if isinstance(base, Circle) else 1.0, up)
        # I = tr(S) 1 - S of the second moments S, which grow with the product of their two axes
        second_moments = np.trace(inertia) / 2 * np.eye(3) - inertia
        second_moments *= np.outer(stretch, stretch)
        stretched = np.trace(second_moments) * np.eye(3) - second_moments
        return replace(made, inertia=checked_tensor(stretched))
    if body.inertia == _uniform(body):
        return replace(made, inertia=_uniform(made))
    return made


def _uniform(body: RigidBody) -> float:
    """Moment of inertia of a uniform rectangle of the body's size [kg m²]."""
    return shape_of(body.width, body.height, body.mass, math.nan, math.nan, 0.0, 0.0).inertia


def _scaled(outline: Outline, across: float) -> Outline:
    if isinstance(outline, Interval):
        return Interval(outline.left * across, outline.right * across)
    if isinstance(outline, Circle):
        return Circle(outline.radius * across, outline.centre)
    return Polygon(tuple((x * across, y) for x, y in outline.vertices))
