"""Thesis eq. 2.66 to 2.86: when full contact opens, and angular velocities after an impact.

A criterion "left > right" is given as right - left, in the units of a moment: it must equal the contact
moment s τ(s) about the pivot s it opens on, which vanishes there. Velocities are held against conserved angular
momentum.
"""

import numpy as np
from numpy import cos, sin

from .systems import Equation, System, impact_map, misprinted, random_systems

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


def truth(old: tuple[int, int], new: tuple[int, int]):
    """Return the conserved-momentum velocities after the impact."""
    return lambda s: np.array(impact_map(s, old, new))


def solved(s: System, row: tuple[Array, ...], row2: tuple[Array, ...]) -> Array:
    """Solve P ω1⁺ + Q ω2⁺ = U ω1⁻ + V ω2⁻ for two rows (P, Q, U, V), as the thesis's quotients do."""
    (p, q, u, v), (p2, q2, u2, v2) = row, row2
    det = p * q2 - q * p2
    first, two = u * s.w1 + v * s.w2, u2 * s.w1 + v2 * s.w2
    return np.array([(first * q2 - q * two) / det, (p * two - p2 * first) / det])


def case_276(s: System, printed: bool) -> Array:
    c1 = s.io2
    if printed:  # the bracket closes too late
        inner = s.r2 * cos(s.tc2 - s.beta - s.th2 + 2 * s.h1 * cos(s.beta) - s.xi_ * sin(s.beta))
    else:
        inner = s.r2 * cos(s.tc2 - s.beta - s.th2) + 2 * s.h1 * cos(s.beta) - s.xi_ * sin(s.beta)
    c2 = s.io1 - 2 * s.m1 * s.b1**2 + s.m2 * s.length * inner
    c3 = s.io2 + s.m2 * s.r2 * (2 * s.h1 * cos(s.tc2 - s.th2) - s.xi_ * sin(s.tc2 - s.th2))
    c4 = s.m2 * s.r2 * s.length * cos(s.tc2 - s.beta - s.th2)
    c5 = s.io1 + s.m2 * s.length_ * (
        s.r2 * cos(s.tc2 + s.beta_ - s.th2) + 2 * s.h1 * cos(s.beta_) + s.xi_ * sin(s.beta_)
    )
    c6 = s.m2 * s.r2 * s.length_ * cos(s.tc2 + s.beta_ - s.th2)
    return solved(s, (c5, c3, c2, c3), (c6, c1, c4, c1))


def case_278(s: System, printed: bool) -> Array:
    f, first, two = (cos, s.big - s.beta, s.tc2 + s.big) if printed else (
        sin, s.big + s.beta, s.big - s.tc2
    )  # fmt: skip
    five, seven = (s.big - s.beta_, s.tc2 - s.big) if printed else (
        s.big + s.beta_, s.big + s.tc2
    )  # fmt: skip
    e1 = s.io2
    e2 = s.io1 + s.m2 * s.length * s.rr * f(first)
    e3 = s.ic2 + s.m2 * s.r2 * s.rr * f(two)
    e4 = s.m2 * s.r2 * s.length * cos(s.tc2 + s.beta)
    e5 = s.io1 + s.m2 * s.length_ * s.rr * f(five)
    e6 = s.m2 * s.r2 * s.length_ * cos(s.tc2 + s.beta_)
    e7 = s.ic2 + s.m2 * s.r2 * s.rr * f(seven)
    e8 = s.ic2 + s.m2 * s.r2**2 * cos(2 * s.tc2)
    return solved(s, (e5, e3, e2, e7), (e6, e1, e4, e8))


def together(s: System, a1: Array, a2: Array) -> Array:
    both = (a1 * s.w1 + a2 * s.w2) / s.io
    return np.array([both, both])


def case_279(s: System, printed: bool) -> Array:
    first, two = (
        (cos(s.big - s.beta), cos(s.tc2 - s.big))
        if printed
        else (sin(s.big + s.beta), sin(s.big + s.tc2))
    )
    return together(s, s.io1 + s.m2 * s.length * s.rr * first, s.ic2 + s.m2 * s.r2 * s.rr * two)


def case_280(s: System, printed: bool) -> Array:
    e1 = s.io2
    inertia, beta = (s.ic2, s.beta_) if printed else (s.io2, s.beta)
    arc = s.tc2 + s.th2
    e2 = (
        s.io1
        - 2 * s.m1 * s.b1**2
        + s.m2
        * s.length_
        * (s.r2 * cos(arc + s.beta_) + 2 * s.h1 * cos(s.beta_) - s.xi * sin(s.beta_))
    )
    e3 = inertia + s.m2 * s.r2 * (2 * s.h1 * cos(arc) + s.xi * sin(arc))
    e4 = s.m2 * s.r2 * s.length_ * cos(arc + s.beta_)
    e5 = s.io1 + s.m2 * s.length * (
        s.r2 * cos(arc - beta) + 2 * s.h1 * cos(s.beta) + s.xi * sin(s.beta)
    )
    e6 = s.m2 * s.r2 * s.length * cos(arc - beta)
    back = s.tc2 - s.th2
    e7 = s.ic2 + s.m2 * s.r2 * (2 * s.h1 * cos(back) - s.xi * sin(back)) if printed else e3
    return solved(s, (e5, e3, e2, e7), (e6, e1, e4, e1))


def case_281(s: System, printed: bool) -> Array:
    th1, th2 = (s.th1, s.th2) if printed else (0.0, 0.0)
    f6, f7 = (
        (s.tc2 + s.big + th2, s.tc2 + s.beta_ - s.th1 - th2)
        if printed
        else (s.big - s.tc2, 2 * s.tc2)
    )
    turn = -1 if printed else 1
    e1 = s.io2
    e2 = s.io1 + s.m2 * s.length_ * s.rr * sin(s.big + turn * s.beta_ + th1)
    e3 = s.m2 * s.r2 * s.length_ * cos(s.tc2 - s.beta_ + th1 - th2)
    e4 = s.io1 + s.m2 * s.length * s.rr * sin(s.big + turn * s.beta + th1)
    e5 = s.m2 * s.r2 * s.length * cos(s.tc2 - s.beta + th1 - th2)
    e6 = s.ic2 + s.m2 * s.r2 * s.rr * sin(f6)
    e7 = s.ic2 + s.m2 * s.r2**2 * cos(f7)
    lever = e1 if printed else s.ic2 + s.m2 * s.r2 * s.rr * sin(s.big + s.tc2)
    return solved(s, (e4, lever, e2, e6), (e5, e1, e3, e7))


def case_282(s: System, printed: bool) -> Array:
    first, two = (
        (sin(s.big - s.beta_ + s.th1), sin(s.tc2 + s.big + s.th2))
        if printed
        else (sin(s.big + s.beta_), sin(s.big - s.tc2))
    )
    return together(s, s.io1 + s.m2 * s.length_ * s.rr * first, s.ic2 + s.m2 * s.r2 * s.rr * two)


def case_283(s: System, printed: bool) -> Array:
    top = 2 * s.h1 + s.h2
    lever = s.m2 * s.r2 * (s.b1 * sin(s.tc2) + top * cos(s.tc2))
    c1 = s.io2
    c2 = (s.io1 if printed else s.io) - 2 * s.m * s.b1**2
    c3 = (s.ic1 if printed else s.ic2) + lever
    c4 = (s.io1 if printed else s.io2) + s.m2 * s.length_ * (
        s.h2 * cos(s.beta_) - s.b2 * sin(s.beta_)
    )
    c5 = s.io1 + s.m2 * s.length * (top * cos(s.beta) + s.b1 * sin(s.beta))
    c6 = s.m2 * s.length * (s.h2 * cos(s.beta) + s.b2 * sin(s.beta))
    return solved(s, (c5, c3, c2, 0), (c6, c1, c4, 0))


def case_284(s: System, printed: bool) -> Array:
    inertia = s.io1 if printed else s.io
    both = (inertia - 2 * s.m * s.b1**2) / inertia * s.w1
    return np.array([both, both])


def case_285(s: System, printed: bool) -> Array:
    top = 2 * s.h1 + s.h2
    c1 = s.io2
    c2 = s.ic2 + s.m2 * s.r2 * (top * cos(s.tc2) - s.b1 * sin(s.tc2))
    c3 = s.ic2 + s.m2 * s.r2 * (top * cos(s.tc2) + s.b1 * sin(s.tc2))
    c4 = s.io2 - 2 * s.m2 * s.b2**2
    c5 = s.io1 + s.m2 * s.length * (top * cos(s.beta) + s.b1 * sin(s.beta))
    c6 = s.m2 * s.length * (s.h2 * cos(s.beta) + s.b2 * sin(s.beta))
    if printed:
        return solved(s, (c5, c3, c2, c3), (c6, c1, c4, c1))
    return solved(s, (c5, c3, 0, c2), (c6, c1, 0, c4))


def glued_at_rest() -> System:
    return random_systems().rigidly_joined().with_(th1=0.0, th2=0.0)


def four_a() -> System:
    return random_systems().standing().with_(th2=0.0)


def ground_systems() -> System:
    return random_systems().with_(th1=0.0)


def interface_systems() -> System:
    s = random_systems()
    return s.with_(th2=s.th1)


def closing_sign(s: System) -> Array:
    """Whether the gap between the blocks of pattern 1a shrinks: rate of the left corner's height."""
    s = s.with_(vg=0.0)
    left = s.get("velocity2", 1, 1)[1]  # of the centre; the corner is -2 b2 along the base from O2
    arm = s.get("pivot2", 1, 1) - s.get("centre2", 1, 1)
    corner = np.array([-2 * s.b2 * cos(s.th2), 2 * s.b2 * sin(s.th2)]) + arm
    corner_speed = left - s.w2 * corner[0]
    # the same material point if it belonged to block 1 (its pivot moves with block 1)
    pivot_speed = -s.w1 * (s.get("pivot2", 1, 1) - s.get("pivot1", 1, 1))[0]
    under = pivot_speed - s.w1 * (-2 * s.b2 * cos(s.th2))
    return np.sign(corner_speed - under)


EQUATIONS += [
    misprinted("2.76", case_276, truth((1, 1), (-1, 1)), systems=ground_systems),
    Equation("2.77", lambda s: np.sign(s.w2 - s.w1), closing_sign, systems=interface_systems),
    misprinted("2.78", case_278, truth((1, 1), (1, -1)), systems=interface_systems),
    misprinted("2.79", case_279, truth((1, 1), (1, 0)), systems=interface_systems),
    misprinted("2.80", case_280, truth((1, -1), (-1, -1)), systems=ground_systems),
    misprinted("2.81", case_281, truth((1, -1), (1, 1)), systems=interface_systems),
    misprinted("2.82", case_282, truth((1, -1), (1, 0)), systems=interface_systems),
    misprinted("2.83", case_283, truth((1, 0), (-1, -1)), systems=glued_at_rest),
    misprinted("2.84", case_284, truth((1, 0), (-1, 0)), systems=glued_at_rest),
    misprinted("2.85", case_285, truth((0, 1), (-1, -1)), systems=four_a),
    Equation(
        "2.86",
        lambda s: np.array([0 * s.w2, (s.io2 - 2 * s.m2 * s.b2**2) / s.io2 * s.w2]),
        truth((0, 1), (0, -1)),
        systems=four_a,
    ),
]
