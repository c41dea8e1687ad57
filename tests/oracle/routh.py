"""Routh's impact of one contact (E. J. Routh, Dynamics of a System of Rigid Bodies, 1905; Keller 1986).

The normal impulse p is time: the slip u_t and the approach u_n change with it at rates that are constant between
the instants at which the slip stops.  Nothing is shared with the package.
"""

import math
from typing import NamedTuple

import numpy as np

from .witness import Column, End


class Contact(NamedTuple):
    """Inverse masses that a contact feels: along its normal, across, and along its tangent [1/kg]."""

    normal: float
    both: float
    tangent: float


def felt(column: Column, q: np.ndarray, k: int, end: End) -> Contact:
    """Inverse masses at an end of contact k where nothing else is touched."""
    total = np.zeros((2, 2))
    axes = np.array([end.normal, end.tangent])
    for number in (k, k - 1) if k else (k,):
        body = column.bodies[number]
        arm = end.point - q[number, :2]
        turns = axes @ [arm[1], -arm[0]]
        total += axes @ axes.T / body.mass + np.outer(turns, turns) / body.inertia
    return Contact(total[0, 0], total[0, 1], total[1, 1])


def integrate(
    contact: Contact, friction: tuple[float, float], approach: float, slip: float
) -> tuple[float, float]:
    """Impulses along normal and tangent of a plastic impact, by the (static, kinetic) coefficients.

    ``approach`` is the normal velocity before, below zero, and ``slip`` the tangential one [m/s].
    """
    static, kinetic = friction
    u_n, u_t, normal, shear = approach, slip, 0.0, 0.0
    ratio = abs(contact.both) / contact.tangent
    sticks = slip == 0.0 and ratio <= static
    way = math.copysign(1.0, slip if slip else contact.both)
    while True:
        push = -contact.both / contact.tangent if sticks else -way * kinetic
        rate_n = contact.normal + push * contact.both
        rate_t = contact.both + push * contact.tangent
        to_end = -u_n / rate_n if rate_n > 0.0 else math.inf
        stops = not sticks and way * rate_t < 0.0 and u_t != 0.0
        to_stop = -u_t / rate_t if stops else math.inf
        step = min(to_end, to_stop)
        if not math.isfinite(step):
            raise ValueError("the impact does not end")
        normal, shear = normal + step, shear + push * step
        u_n, u_t = u_n + step * rate_n, u_t + step * rate_t
        if step == to_end:
            return normal, shear
        u_t = 0.0
        sticks, way = ratio <= static, math.copysign(1.0, contact.both)
