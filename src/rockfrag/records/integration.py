"""Velocity and displacement of an acceleration that is linear between its samples, exactly.

In an interval that starts with acceleration a₀, velocity v₀ and displacement d₀ and ends with a₁,

    a(τ) = a₀ + s τ,   s = (a₁ - a₀)/dt,
    v(τ) = v₀ + a₀ τ + s τ²/2,
    d(τ) = d₀ + v₀ τ + a₀ τ²/2 + s τ³/6,

so nothing is lost by integrating, and the peaks can be located between samples as well: that of the
velocity where a(τ) = 0, that of the displacement where v(τ) = 0.  The largest *sample* of the velocity is smaller.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def integrate(acceleration: Floats, dt: float) -> tuple[Floats, Floats]:
    """Integrate an acceleration that is linear between samples, from rest."""
    a0, a1 = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum((a0 + a1) * (dt / 2))])
    steps = velocity[:-1] * dt + (2 * a0 + a1) * (dt**2 / 6)
    return velocity, np.concatenate([[0.0], np.cumsum(steps)])


def peak_velocity(acceleration: Floats, dt: float) -> float:
    """Peak absolute velocity [m/s], at samples or where the acceleration crosses zero between them."""
    velocity, _ = integrate(acceleration, dt)
    a0, a1 = acceleration[:-1], acceleration[1:]
    turns = a0 * a1 < 0
    tau = dt * a0[turns] / (a0[turns] - a1[turns])
    between = velocity[:-1][turns] + a0[turns] * tau / 2
    return float(np.abs(np.concatenate([velocity, between])).max())


def peak_displacement(acceleration: Floats, dt: float) -> float:
    """Peak absolute displacement [m], at samples or where the velocity crosses zero between them."""
    velocity, displacement = integrate(acceleration, dt)
    # the velocity has a zero in an interval only if it changes its sign there, or turns
    changes = (velocity[:-1] * velocity[1:] < 0) | (acceleration[:-1] * acceleration[1:] < 0)
    a0, v0, d0 = acceleration[:-1][changes], velocity[:-1][changes], displacement[:-1][changes]
    slope = np.diff(acceleration)[changes] / dt
    discriminant = a0**2 - 2 * slope * v0
    # the two roots in the form that loses no digits when one of them is small; a root that does not
    # exist comes out infinite or not a number and so does not lie inside the interval
    q = -(a0 + np.copysign(np.sqrt(np.maximum(discriminant, 0.0)), a0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        roots = np.stack([q / slope, 2 * v0 / q])
    inside = (discriminant >= 0) & (roots > 0) & (roots < dt)
    tau = np.where(inside, roots, 0.0)
    between = d0 + v0 * tau + a0 * tau**2 / 2 + slope * tau**3 / 6
    return float(np.abs(np.concatenate([displacement, between[inside]])).max())
