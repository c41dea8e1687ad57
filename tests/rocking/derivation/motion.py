"""Thesis eq. 2.21 to 2.65: start of motion, equations of motion, their linearised form."""

import numpy as np
from numpy import cos, sign, sin

from . import single_block as upper
from .systems import Equation, Quantity, System, by_sign, misprinted, random_systems

Array = np.ndarray


def rest(s: System) -> System:
    return s.with_(th1=0.0, th2=0.0, w1=0.0, w2=0.0, q1=0.0, q2=0.0)


def rocking_mode(opposite: int, equations: str = "motion") -> Quantity:
    """Both equations of pattern 1 (``opposite`` = 1) or 2 (-1) with the pivot of block 1 by S_θ1."""
    return by_sign(lambda s, side: s.get(equations, side, side * opposite))


def gamma(s: System, side: Array | int, opposite: int) -> Array:
    """γ1 of 2.36, 2.41 and 2.44, or γ2 of 2.47, 2.50 and 2.52."""
    beta = s.beta if opposite == 1 else -s.beta_
    return s.tc2 - beta + opposite * side * (s.th1 - s.th2)


def positions(i: int, s1: int, s2: int):
    """Displaced centre, its height counted from where it stands."""

    def truth(s: System) -> Array:
        return s.get(f"centre{i}", s1, s2) - s.with_(th1=0.0, th2=0.0, xg=0.0).get(
            f"centre{i}", s1, s2
        ) * np.array([[0.0], [1.0]])

    return truth


def centre_1(s: System, side: int) -> Array:  # 2.29, 2.38
    x = s.xg + side * (s.b1 - s.r1 * sin(s.tc1 - side * s.th1))
    return np.array([x, s.r1 * cos(s.tc1 - side * s.th1) - s.h1])


def centre_2(s: System, s1: int, s2: int, turn: Array | None = None) -> Array:
    """Displacements of 2.30, 2.39, 2.45 and 2.48; ``turn`` is θ2 as the height has it."""
    reach, beta = (s.length, s.beta) if s1 == s2 else (s.length_, s.beta_)
    arm = s.th1 - s1 * beta
    x = s.xg + s2 * (s.b2 - s.r2 * sin(s.tc2 - s2 * s.th2)) + reach * (s1 * sin(beta) + sin(arm))
    lifted = s.r2 * cos(s.tc2 - s2 * (s.th2 if turn is None else turn))
    return np.array([x, lifted + reach * cos(arm) - 2 * s.h1 - s.h2])


def first(s: System, side: Array | int, length: Array, beta: Array, swirl: Array) -> Array:
    """First row of 2.43 and 2.51 without the terms that couple the blocks."""
    return (
        (s.io1 + s.m2 * length**2) * s.q1
        + swirl
        + side * s.m1 * s.g * s.r1 * sin(s.tc1 - side * s.th1)
        + side * s.m2 * s.g * length * sin(beta - side * s.th1)
        + (s.m1 * s.r1 * cos(s.tc1 - side * s.th1) + s.m2 * length * cos(beta - side * s.th1)) * s.a
    )


def patterns(
    s: System,
    side: Array | int,
    opposite: int,
    weight: int | None = None,
    label: Array | None = None,
) -> Array:
    """2.43 with 2.37 and 2.40 of pattern 1, 2.51 with 2.46 and 2.49 of pattern 2 (``opposite`` = -1)."""
    angle, turn = gamma(s, side, opposite), opposite * side
    reach, beta = (s.length, s.beta) if opposite == 1 else (s.length_, s.beta_)
    mr = s.m2 * s.r2 * reach
    swirl = mr * cos(angle if label is None else label) * s.q2 + turn * mr * sin(angle) * s.w2**2
    second = (
        s.io2 * s.q2
        + mr * cos(angle) * s.q1
        - turn * mr * sin(angle) * s.w1**2
        + (weight or opposite) * side * s.m2 * s.g * s.r2 * sin(s.tc2 - turn * s.th2)
        + s.m2 * s.r2 * s.a * cos(s.tc2 - turn * s.th2)
    )
    return np.array([first(s, side, reach, beta, swirl), second])


def whole(s: System, side: Array | int) -> Array:  # 2.55; 2.53 and 2.54
    radius, critical = np.hypot(s.b1, s.h), np.arctan2(s.b1, s.h)
    return (
        s.io * s.q1
        + side * s.m * s.g * radius * sin(critical - side * s.th1)
        + s.m * radius * s.a * cos(critical - side * s.th1)
    )


def glued(s: System, side: int) -> Array:
    return s.rigidly_joined().moments(side, 1).sum(axis=0)


def speed_squared(s: System, cross: float) -> Array:  # 2.33
    return (
        s.vg**2
        + s.r2**2 * s.w2**2
        + s.length**2 * s.w1**2
        + 2 * s.r2 * s.w2 * s.vg * cos(s.tc2 - s.th2)
        + 2 * s.length * s.w1 * s.vg * cos(s.th1 - s.beta)
        + cross * 2 * s.r2 * s.length * s.w1 * s.w2 * cos(s.th1 - s.th2 + s.tc2 - s.beta)
    )


def block_1_speed_squared(s: System) -> Array:  # 2.32
    return s.vg**2 + s.r1**2 * s.w1**2 + 2 * s.r1 * s.w1 * s.vg * cos(s.tc1 - s.th1)


def linear(s: System, opposite: int, reach: Array, mass: Array) -> Array:
    """Both rows of 2.60 and 2.62, with what is printed for l² and for the mass of the second row."""
    side, arm = sign(s.th1), s.xi if opposite == 1 else s.xi_
    m12 = s.m2 * (2 * s.h1 * s.h2 + opposite * s.b2 * arm)
    return np.array(
        [
            (s.io1 + s.m2 * reach) * s.q1
            + m12 * s.q2
            - (s.m1 + 2 * s.m2) * s.h1 * s.g * s.th1
            + side * (s.m1 * s.b1 + s.m2 * arm) * s.g
            + (s.m1 + 2 * s.m2) * s.h1 * s.a,
            m12 * s.q1
            + s.io2 * s.q2
            - s.m2 * s.h2 * s.g * s.th2
            + opposite * side * mass * s.b2 * s.g
            + s.m2 * s.h2 * s.a,
        ]
    )


def linear_3(s: System, half_width: Array) -> Array:  # 2.64
    return (
        s.io * s.q1
        - s.m * s.g * s.h * s.th1
        + sign(s.th1) * s.m * half_width * s.g
        + s.m * s.h * s.a
    )


def linear_glued(s: System, side: int) -> Array:
    return s.rigidly_joined().get("linear_motion", side, 1).sum(0)


def lagrange_by_newton(s: System) -> Array:
    """Moments of inertial and gravity forces about the pivots: Newton and Euler, no Lagrange."""
    force = [
        mass * (s.get(f"acceleration{i}", 1, -1) + np.array([0 * s.g, s.g]))
        for i, mass in ((1, s.m1), (2, s.m2))
    ]
    pivot1, pivot2 = s.get("pivot1", 1, -1), s.get("pivot2", 1, -1)

    def about(pivot: Array, i: int) -> Array:
        arm = s.get(f"centre{i}", 1, -1) - pivot
        return arm[1] * force[i - 1][0] - arm[0] * force[i - 1][1]

    block2 = about(pivot2, 2) + s.ic2 * s.q2
    all_about_1 = about(pivot1, 1) + s.ic1 * s.q1 + about(pivot1, 2) + s.ic2 * s.q2
    return np.array([all_about_1 - block2, block2])


def start(mode: int, side: int):
    """Contact moment s τ(s) at rest: mode 3 of the whole, mode 4 of block 2."""

    def truth(s: System) -> Array:
        tau = rest(s).moments(side, side)
        return side * (tau.sum(axis=0) if mode == 3 else tau[1])

    return truth


EQUATIONS = [
    # s τ(s) = right-hand side less left-hand side: the contact opens when it falls below zero
    Equation("2.21", lambda s: s.m * (s.b1 * s.g + s.h * s.a), start(3, 1)),
    Equation(
        "2.22",
        lambda s: s.h,
        lambda s: (s.m1 * s.get("centre1", 1, 1)[1] + s.m2 * s.get("centre2", 1, 1)[1]) / s.m,
        systems=lambda: rest(random_systems()),
    ),
    Equation("2.23", lambda s: s.m * (s.b1 * s.g - s.h * s.a), start(3, -1)),
    Equation("2.24", lambda s: s.m2 * (s.b2 * s.g + s.h2 * s.a), start(4, 1)),
    Equation("2.25", lambda s: s.m2 * (s.b2 * s.g - s.h2 * s.a), start(4, -1)),
    Equation("2.26", lambda s: s.moments(1, -1), lagrange_by_newton),
    Equation(
        "2.27",
        lambda s: (
            (
                s.ic1 * s.w1**2
                + s.ic2 * s.w2**2
                + s.m1 * (s.get("velocity1", 1, 1) ** 2).sum(0)
                + s.m2 * (s.get("velocity2", 1, 1) ** 2).sum(0)
            )
            / 2
        ),
        lambda s: s.get("kinetic", 1, 1),
    ),
    Equation(
        "2.28",
        lambda s: s.g * (s.m1 * s.get("centre1", 1, 1)[1] + s.m2 * s.get("centre2", 1, 1)[1]),
        lambda s: s.get("potential", 1, 1),
    ),
    Equation("2.29", lambda s: centre_1(s, 1), positions(1, 1, 1)),
    Equation("2.30", lambda s: centre_2(s, 1, 1), positions(2, 1, 1)),
    Equation(
        "2.31",
        lambda s: np.array(
            [
                s.vg + s.r1 * s.w1 * cos(s.tc1 - s.th1),
                s.r1 * s.w1 * sin(s.tc1 - s.th1),
                s.vg + s.r2 * s.w2 * cos(s.tc2 - s.th2) + s.length * s.w1 * cos(s.th1 - s.beta),
                s.r2 * s.w2 * sin(s.tc2 - s.th2) - s.length * s.w1 * sin(s.th1 - s.beta),
            ]
        ),
        lambda s: np.concatenate([s.get("velocity1", 1, 1), s.get("velocity2", 1, 1)]),
    ),
    Equation("2.32", block_1_speed_squared, lambda s: (s.get("velocity1", 1, 1) ** 2).sum(0)),
    misprinted(
        "2.33",
        lambda s, printed: speed_squared(s, 1.0 - printed),
        lambda s: (s.get("velocity2", 1, 1) ** 2).sum(0),
    ),
    Equation(
        "2.34",
        lambda s: (
            s.m1 / 2 * block_1_speed_squared(s)
            + s.ic1 * s.w1**2 / 2
            + s.m2 / 2 * speed_squared(s, 1.0)
            + s.ic2 * s.w2**2 / 2
        ),
        lambda s: s.get("kinetic", 1, 1),
    ),
    Equation(
        "2.35",
        lambda s: (
            s.m1 * s.g * (s.r1 * cos(s.tc1 - s.th1) - s.h1)
            + s.m2
            * s.g
            * (s.r2 * cos(s.tc2 - s.th2) + s.length * cos(s.th1 - s.beta) - 2 * s.h1 - s.h2)
        ),
        lambda s: s.get("potential", 1, 1) - rest(s).get("potential", 1, 1),
    ),
    # γ is what turns M12 = m2 R2 l cos γ: read off ∂²T/∂ω1∂ω2
    Equation("2.36", lambda s: cos(gamma(s, 1, 1)), lambda s: _cosine(s, 1, 1)),
    Equation("2.37", lambda s: patterns(s, 1, 1), lambda s: s.moments(1, 1)),
    Equation("2.38", lambda s: centre_1(s, -1), positions(1, -1, -1)),
    Equation(
        "2.39",
        lambda s: centre_2(s, -1, -1, turn=-s.th2),
        positions(2, -1, -1),
        mended=lambda s: centre_2(s, -1, -1),
    ),
    Equation("2.40", lambda s: patterns(s, -1, 1), lambda s: s.moments(-1, -1)),
    Equation("2.41", lambda s: cos(gamma(s, -1, 1)), lambda s: _cosine(s, -1, -1)),
    Equation("2.42", lambda s: sign(s.th1), lambda s: upper.standing_pivot(s.th1, s.b1)),
    Equation("2.43", lambda s: patterns(s, sign(s.th1), 1), rocking_mode(1)),
    Equation(
        "2.44",
        lambda s: cos(gamma(s, sign(s.th1), 1)),
        by_sign(lambda s, side: _cosine(s, side, side)),
    ),
    Equation("2.45", lambda s: centre_2(s, 1, -1), positions(2, 1, -1)),
    misprinted(
        "2.46",
        lambda s, printed: patterns(s, 1, -1, weight=1 if printed else -1),
        lambda s: s.moments(1, -1),
    ),
    # printed as γ2b, which 2.50 defines and 2.49 uses; it is γ2a
    Equation(
        "2.47",
        lambda s: cos(s.tc2 + s.beta_ - s.th1 + s.th2),
        lambda s: _cosine(s, -1, 1),
        mended=lambda s: cos(gamma(s, -1, -1)),
    ),
    Equation("2.48", lambda s: centre_2(s, -1, 1), positions(2, -1, 1)),
    Equation("2.49", lambda s: patterns(s, -1, -1), lambda s: s.moments(-1, 1)),
    Equation("2.50", lambda s: cos(gamma(s, -1, -1)), lambda s: _cosine(s, -1, 1)),
    # the first row names γ2a where it means γ2
    Equation(
        "2.51",
        lambda s: patterns(s, sign(s.th1), -1, label=gamma(s, 1, -1)),
        rocking_mode(-1),
        mended=lambda s: patterns(s, sign(s.th1), -1),
    ),
    Equation(
        "2.52",
        lambda s: cos(gamma(s, sign(s.th1), -1)),
        by_sign(lambda s, side: _cosine(s, side, -side)),
    ),
    Equation("2.53", lambda s: whole(s, 1), lambda s: glued(s, 1)),
    Equation("2.54", lambda s: whole(s, -1), lambda s: glued(s, -1)),
    Equation("2.55", lambda s: whole(s, sign(s.th1)), by_sign(glued)),
    Equation("2.56", lambda s: upper.rocking(s, 1), lambda s: upper.about(s, 1)),
    Equation("2.57", lambda s: upper.rocking(s, -1), lambda s: upper.about(s, -1)),
    Equation("2.58", lambda s: upper.rocking(s, sign(s.th2)), upper.lone),
    Equation("2.59", lambda s: sign(s.th2), lambda s: upper.standing_pivot(s.th2, s.b2)),
    Equation(
        "2.60",
        lambda s: linear(s, 1, s.length, 1.0),
        rocking_mode(1, "linear_motion"),
        mended=lambda s: linear(s, 1, s.length**2, s.m2),
    ),
    Equation("2.61", lambda s: s.xi, lambda s: _between(s, 1, 1)),
    Equation(
        "2.62",
        lambda s: linear(s, -1, s.length_, 1.0),
        rocking_mode(-1, "linear_motion"),
        mended=lambda s: linear(s, -1, s.length_**2, s.m2),
    ),
    Equation("2.63", lambda s: s.xi_, lambda s: _between(s, 1, -1)),
    Equation(
        "2.64",
        lambda s: linear_3(s, s.b2),
        by_sign(linear_glued),
        mended=lambda s: linear_3(s, s.b1),
    ),
    Equation(
        "2.65",
        lambda s: (
            s.io2 * s.q2
            - s.m2 * s.g * s.h2 * s.th2
            + sign(s.th2) * s.m2 * s.b2 * s.g
            + s.m2 * s.h2 * s.a
        ),
        upper.lone_linear,
    ),
]


def _cosine(s: System, s1: int, s2: int) -> Array:
    """cos γ from the coupling of the derived kinetic energy."""
    still = s.with_(w1=0.0, w2=0.0, q1=0.0, a=0.0, vg=0.0)
    coupling = (still.with_(q2=1.0).moments(s1, s2) - still.with_(q2=0.0).moments(s1, s2))[0]
    reach = s.length if s1 == s2 else s.length_
    return coupling / (s.m2 * s.r2 * reach)


def _between(s: System, s1: int, s2: int) -> Array:
    """Horizontal distance of the pivots of the standing blocks."""
    still = s.with_(th1=0.0, th2=0.0)
    return np.abs(still.get("pivot2", s1, s2) - still.get("pivot1", s1, s2))[0]
