"""Thesis eq. 2.1 to 2.20: the lone block, here block 2 on a block 1 that stands still."""

import mpmath
import numpy as np
from numpy import abs as mag
from numpy import arctanh, cos, cosh, sign, sin, sqrt

from .systems import Equation, System, by_sign, impact_map, random_systems, uniform_systems

Array = np.ndarray


def one_sided(side: int) -> System:
    """Random states on one pivot."""
    s = random_systems().standing()
    return s.with_(th2=side * mag(s.th2))


def tiny() -> System:
    s = random_systems().standing()
    return s.with_(th2=1e-7 * s.th2)


def slender() -> System:
    """Blocks of slenderness 1e7, rotated in proportion."""
    s = uniform_systems().standing()
    return s.with_(
        b2=1e-7 * s.h2, th2=1e-7 * s.th2, q2=1e-7 * s.q2, a=1e-7 * s.a, ic2=s.m2 * s.h2**2 / 3
    )


def about(s: System, side: int) -> Array:
    """Motion of the lone block on a pivot."""
    return s.standing().moments(1, side)[1]


def linear_about(s: System, side: int) -> Array:
    return s.standing().get("linear_motion", 1, side)[1]


lone, lone_linear = by_sign(about, "th2"), by_sign(linear_about, "th2")


def rocking(s: System, side: Array | int) -> Array:  # 2.4 and 2.58; 2.2, 2.3, 2.56 and 2.57
    return (
        s.io2 * s.q2
        + side * moment(s) * sin(s.tc2 - side * s.th2)
        + s.m2 * s.r2 * s.a * cos(s.tc2 - side * s.th2)
    )


def moment(s: System) -> Array:
    """m g R."""
    return s.m2 * s.g * s.r2


def housner(s: System) -> Array:
    """ω⁺ / ω⁻ of the lone block."""
    rest = s.standing().with_(th2=0.0)
    return impact_map(rest, (0, 1), (0, -1))[1] / rest.w2


def momentum_loss(s: System) -> Array:
    return s.io2 * s.w2 - 2 * s.m2 * s.r2 * s.b2 * sin(s.tc2) * s.w2


def energy_ratio(s: System) -> Array:
    """Kinetic energy after the impact over that before, from the derived energy."""
    rest = s.standing().with_(th2=0.0, vg=0.0)
    after = rest.with_(w2=impact_map(rest, (0, 1), (0, -1))[1])
    return after.get("kinetic", 1, -1) / rest.get("kinetic", 1, 1)


def p(s: System) -> Array:
    return sqrt(s.m2 * s.g * s.r2 / s.io2)


def rate_of_departure(s: System) -> Array:
    """Growth rate about the unstable balance, from the derived equation: √(-∂f/∂θ / I)."""
    top = s.standing().with_(th2=s.tc2, w2=0.0, q2=0.0, a=0.0)
    step = 1e-4
    slope = (
        top.with_(th2=s.tc2 + step).moments(1, 1)[1] - top.with_(th2=s.tc2 - step).moments(1, 1)[1]
    ) / (2 * sin(step))
    inertia = top.with_(q2=1.0).moments(1, 1)[1] - top.moments(1, 1)[1]
    return sqrt(-slope / inertia)


def general_solution(s: System, order: int) -> Array:
    """Derivative of 2.18 with random constants."""

    def derivative(t: float, c1: float, c2: float, rate: float, critical: float) -> float:
        def theta(t: float) -> float:
            return c1 * mpmath.cosh(rate * t) + c2 * mpmath.sinh(rate * t) + critical

        return float(mpmath.diff(theta, t, order))

    return np.vectorize(derivative)(s.th1, s.a, s.q1, p(s), s.tc2)


def standing_pivot(theta: Array, half_width: Array) -> Array:
    """Pivot about which the block can be rotated so without its other corner sinking in."""
    other_corner = {side: 2 * half_width * side * sin(theta) for side in (1, -1)}
    return np.where(other_corner[1] > 0, 1.0, -1.0)


def _phase(s: System) -> tuple[Array, Array]:
    """θc and an amplitude below it."""
    return s.tc2, s.tc2 * (0.1 + 0.8 * mag(s.th1) / 0.6)


def _arcosh(x: Array) -> Array:
    return 2 * arctanh(sqrt((x - 1) / (x + 1)))


def quarter_2_20(s: System) -> Array:
    critical, start = _phase(s)
    return 4 / p(s) * np.arccosh(1 / (1 - start / critical)) / 4


def quarter_2_19(s: System) -> Array:
    """Root of 2.19, by the half-angle form."""
    critical, start = _phase(s)
    return _arcosh(critical / (critical - start)) / p(s)


EQUATIONS = [
    # threshold: the contact moment about the left corner vanishes at a = (b/h) g
    Equation(
        "2.1",
        lambda s: s.m2 * (s.a * s.h2 - s.g * s.b2),
        lambda s: s.with_(th2=0.0, w2=0.0, q2=0.0).standing().moments(1, -1)[1],
    ),
    Equation("2.2", lambda s: rocking(s, 1), lone, systems=lambda: one_sided(1)),
    Equation("2.3", lambda s: rocking(s, -1), lone, systems=lambda: one_sided(-1)),
    Equation("2.4", lambda s: rocking(s, sign(s.th2)), lone),
    Equation("2.5", lambda s: sign(s.th2), lambda s: standing_pivot(s.th2, s.b2)),
    Equation(
        "2.6",
        lambda s: (
            s.io2 * s.q2
            + moment(s) * (sin(s.tc2) * cos(s.th2) - cos(s.tc2) * sin(mag(s.th2))) * sign(s.th2)
            + s.m2 * s.r2 * (cos(s.tc2) * cos(s.th2) + sin(s.tc2) * sin(mag(s.th2))) * s.a
        ),
        lone,
    ),
    # sin θ = θ, cos θ = 1: exact but for θ², which is 1e-14 here
    Equation(
        "2.7",
        lambda s: (
            s.io2 * s.q2
            + moment(s) * (sin(s.tc2) - cos(s.tc2) * mag(s.th2)) * sign(s.th2)
            + s.m2 * s.r2 * (cos(s.tc2) + sin(s.tc2) * mag(s.th2)) * s.a
        ),
        lone,
        systems=tiny,
    ),
    Equation(
        "2.8",
        lambda s: (
            s.io2 * s.q2
            - moment(s) * cos(s.tc2) * s.th2
            + s.m2 * s.r2 * cos(s.tc2) * s.a
            + moment(s) * sign(s.th2) * sin(s.tc2)
        ),
        lone_linear,
    ),
    Equation(
        "2.9",
        lambda s: s.io2 * s.q2 + moment(s) * sign(s.th2) * (s.tc2 - mag(s.th2)) + s.m2 * s.r2 * s.a,
        lone_linear,
        systems=slender,
    ),
    Equation("2.10", momentum_loss, lambda s: housner(s) * s.w2 * s.io2),
    Equation("2.11", energy_ratio, lambda s: housner(s) ** 2),
    Equation(
        "2.12",
        lambda s: (1 - 2 * s.m2 * s.r2**2 / s.io2 * sin(s.tc2) ** 2) ** 2,
        lambda s: housner(s) ** 2,
    ),
    Equation("2.13", lambda s: momentum_loss(s) / s.io2 / s.w2, housner),
    Equation("2.14", lambda s: 1 - 1.5 * sin(s.tc2) ** 2, housner, systems=uniform_systems),
    Equation(
        "2.15",
        lambda s: s.io2 * s.q2 + moment(s) * (s.tc2 - mag(s.th2)),
        lambda s: lone_linear(s.with_(a=0.0)),
        # holds where θ > 0
        mended=lambda s: s.io2 * s.q2 + moment(s) * sign(s.th2) * (s.tc2 - mag(s.th2)),
        systems=slender,
    ),
    Equation("2.16", lambda s: np.sqrt(p(s)), rate_of_departure, mended=p),
    Equation(
        "2.17", lambda s: sqrt(3 * s.g / (4 * s.r2)), rate_of_departure, systems=uniform_systems
    ),
    Equation(
        "2.18",
        lambda s: general_solution(s, 2),
        lambda s: p(s) ** 2 * (general_solution(s, 0) - s.tc2),  # what 2.15 wants of θ''
    ),
    Equation(
        "2.19",
        lambda s: (
            _phase(s)[0]
            - (_phase(s)[0] - _phase(s)[1]) * cosh(p(s) * quarter_2_19(s))
            + _phase(s)[0]
        ),
        lambda s: _phase(s)[0],
    ),
    Equation("2.20", quarter_2_20, quarter_2_19),
]
