"""Thesis eq. 2.66 to 2.75: when full contact opens.

A criterion "left > right" is given as right - left, in the units of a moment: it must equal the contact
moment s τ(s) about the pivot s it opens on, which vanishes there.
"""

import numpy as np
from numpy import cos, sin

from .systems import Equation, System, misprinted

Array = np.ndarray


def upper(s1: int, s2: int):
    """s2 τ2(s2) of block 2 stuck to a pedestal that rocks on s1 (pattern 3)."""
    return lambda s: s2 * s.rigidly_joined().moments(s1, s2)[1]


def ground(s1: int, s2: int):
    """s1 τ1(s1) of a pedestal at rest under block 2 that rocks on s2 (pattern 4)."""
    return lambda s: s1 * s.standing().moments(s1, s2)[0]


def from_3(s: System, side: int, swirl: Array, inertia: Array) -> Array:
    """m2 R2 × (right - left) of 2.66 to 2.71; ``side`` is the pivot block 2 opens on."""
    left = -side * cos(s.tc2 - side * s.th1) * s.a
    gravity = s.g * sin(s.tc2 - side * s.th1)
    return s.m2 * s.r2 * (gravity + s.rr * swirl + inertia * s.q1 - left)


def mended_3(s: System, s1: int, side: int) -> Array:
    """2.66 and 2.69 to 2.71 as they hold, of a pedestal that rocks on s1."""
    angle = s.big + s1 * side * s.tc2
    swirl, inertia = s1 * side * cos(angle) * s.w1**2, s.rr * sin(angle) + own(s)
    return from_3(s, side, swirl, side * inertia)


def own(s: System) -> Array:
    return s.ic2 / (s.m2 * s.r2)


def printed_266(s: System) -> Array:
    swirl = cos(s.tc2 - s.th1 * s.w1**2)
    return from_3(s, 1, swirl, s.rr * sin(s.tc2 + s.big) + own(s))


def printed_269(s: System) -> Array:
    angle = 2 * s.th1 + s.tc2 + s.big
    return from_3(s, -1, cos(angle) * s.w1**2, s.rr * sin(angle) + own(s))


def printed_270(s: System) -> Array:
    angle = s.tc2 - s.big
    return from_3(s, -1, -sin(angle) * s.w1**2, own(s) - s.rr * cos(angle))


def printed_271(s: System) -> Array:
    swirl = -sin(s.tc2 - s.big) * s.w1**2
    return from_3(s, 1, swirl, s.rr * cos(s.tc2 + s.big) - own(s))


def case_from_4(s1: int, s2: int, turn: int, mended: int):
    """Right - left of 2.72 to 2.75; of the sign before 2 h1 cos in the bracket of θ2'' as printed and mended."""

    def case(s: System, printed: bool) -> Array:
        angle = s.tc2 - s2 * s.th2
        arm, sense = (s.xi, 1) if s1 == s2 else (s.xi_, -1)
        weight = s.m1 * s.g * s.b1 + (0 if printed else s.m2 * s.g * arm)
        sign = turn if printed else mended
        swirl = sense * 2 * s.h1 * sin(angle) - arm * cos(angle)
        inertia = s2 * (arm * sin(angle) + sign * 2 * s.h1 * cos(angle))
        left = -s1 * (s.m1 + 2 * s.m2) * s.h1 * s.a
        return weight + s.m2 * s.r2 * (swirl * s.w2**2 + inertia * s.q2) - left

    return case


EQUATIONS = [
    Equation("2.66", printed_266, upper(1, 1), lambda s: mended_3(s, 1, 1)),
    Equation(
        "2.67",
        lambda s: np.sqrt((2 * s.h1 + s.h2) ** 2 + s.b1**2),
        lambda s: np.hypot(*_to_centre_2(s)),
    ),
    Equation(
        "2.68",
        lambda s: np.arctan((2 * s.h1 + s.h2) / s.b1),
        lambda s: np.arctan2(_to_centre_2(s)[1], -_to_centre_2(s)[0]),
    ),
    Equation("2.69", printed_269, upper(1, -1), lambda s: mended_3(s, 1, -1)),
    Equation("2.70", printed_270, upper(-1, -1), lambda s: mended_3(s, -1, -1)),
    Equation("2.71", printed_271, upper(-1, 1), lambda s: mended_3(s, -1, 1)),
    misprinted("2.72", case_from_4(1, 1, 1, 1), ground(1, 1)),
    misprinted("2.73", case_from_4(-1, 1, 1, -1), ground(-1, 1)),
    misprinted("2.74", case_from_4(-1, -1, 1, 1), ground(-1, -1)),
    misprinted("2.75", case_from_4(1, -1, -1, -1), ground(1, -1)),
]


def _to_centre_2(s: System) -> Array:
    """Vector from block 1's right pivot to the centre of block 2 on it, as they stand."""
    still = s.with_(th1=0.0, th2=0.0)
    return still.get("centre2", 1, 1) - still.get("pivot1", 1, 1)
