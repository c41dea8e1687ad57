"""Bodies that differ a little from given ones."""

import math
from dataclasses import replace

import numpy as np

from rockfrag.system.body import Circle, Interval, Outline, Polygon, RigidBody, Tensor
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
        deep = across if isinstance(base, Circle) else 1.0
        return replace(made, inertia=_scaled_tensor(body.inertia, (across, deep, up)))
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


def _scaled_tensor(tensor: Tensor, factors: tuple[float, float, float]) -> Tensor:
    """Tensor of a body of the same mass that is stretched along its axes."""
    inertia, stretch = np.array(tensor), np.array(factors)
    # I = tr(S) 1 - S of the second moments S, which grow with the product of their two axes
    second_moments = np.trace(inertia) / 2 * np.eye(3) - inertia
    second_moments *= np.outer(stretch, stretch)
    rows = (np.trace(second_moments) * np.eye(3) - second_moments).tolist()
    return (tuple(rows[0]), tuple(rows[1]), tuple(rows[2]))
