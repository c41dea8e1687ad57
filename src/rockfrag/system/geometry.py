"""Blocks and stacks as numbers: where their parts are as they stand, and what the kernels are told of them.

Ordinary Python that kernels may call too (see ``jit``), so that a body has the same bits wherever it is
described.  Lengths [m] are from the middle of a base, x to the right and y up; pivots are +1 (right) and -1.
"""

import math
from typing import Any, NamedTuple

from rockfrag.base.elementary import atan2, hypot, sin_cos


class Shape(NamedTuple):
    """A block as it stands."""

    b: float  # half the width of its base [m]
    mass: float  # [kg]
    inertia: float  # about the centre of gravity [kg m²]
    # x, y: centre of gravity, from the middle of its base [m]
    x: float
    y: float


class Face(NamedTuple):
    """What a body carries another one on."""

    half: float  # half its width [m]
    height: float  # over the body's base [m]
    lean: float  # of the body, clockwise [rad]
    right: float  # of its middle from that of the body's base [m]
    offset: float  # of the middle of the base that it carries from its own [m]


class Pile(NamedTuple):
    """A statue as it stands on its pedestal."""

    # the two blocks, each as it stands by itself
    lower: Shape
    above: Shape
    # as if its base were no wider than the part of it that lies on the pedestal
    upper: Shape
    lean: float  # of the pedestal [rad]
    # of the middle of the statue's base from that of the face it stands on [m]
    offset: float
    # left and right end of the contact, likewise
    low: float
    high: float
    # the same points from the middle of the pedestal's base, x and y [m]
    left: tuple[float, float]
    right: tuple[float, float]


STANDS, FALLS_ALONE, BESIDE, OFF_CONTACT, TILTED_OFF, REACHES_GROUND = 0, 1, 2, 3, 4, 5
"""Whether a body can stand, or why not: a block's centre of gravity is not above its base; the statue's base
does not lie on the pedestal; its centre of gravity is not above the part that does; one is not above its base
once the pedestal's lean is counted; the statue could touch the ground before anything has fallen."""


def turned(x: float, y: float, angle: float) -> tuple[float, float]:
    """Turn a vector clockwise by ``angle`` [rad].

    Parameters
    ----------
    x, y : of one unit, to the right and up
    angle : clockwise [rad]

    Returns
    -------
    Both components, in that unit.
    """
    s, c = sin_cos(angle)
    return x * c + y * s, -x * s + y * c


def turned_in_plan(
    x: float, y: float, sine: float, cosine: float
) -> tuple[float, float]:
    """Turn a vector about the vertical, from x towards y.

    Parameters
    ----------
    x, y : of one unit
    sine, cosine : of the angle from x towards y [-]

    Returns
    -------
    Both components, in that unit.
    """
    return cosine * x - sine * y, sine * x + cosine * y


def turned_moments(
    xx: float, xy: float, yy: float, sine: float, cosine: float
) -> tuple[float, float, float]:
    """Components of a symmetric tensor in the plan, such as moments of inertia, of a body that was turned.

    These are those of R T Rᵀ, with R the rotation of :func:`turned_in_plan`.

    Parameters
    ----------
    xx, xy, yy : components of T before, of one unit
    sine, cosine : of the angle by which the body turns, from x towards y [-]

    Returns
    -------
    xx, xy and yy after, in that unit.
    """
    mixed = 2 * cosine * sine * xy
    new_xx = cosine * cosine * xx - mixed + sine * sine * yy
    new_xy = cosine * sine * (xx - yy) + (cosine * cosine - sine * sine) * xy
    new_yy = sine * sine * xx + mixed + cosine * cosine * yy
    return new_xx, new_xy, new_yy


def shape_of(
    width: float, height: float, mass: float, inertia: float, cg_height: float, cg_offset: float, lean: float
) -> Shape:  # fmt: skip
    """Return a block as it stands; NaN stands for an inertia or a height of the centre that is not given.

    Parameters
    ----------
    width, height : of the block [m]
    mass : [kg]
    inertia : about the centre of gravity [kg m²]
    cg_height, cg_offset : of the centre of gravity over the base, and to the right of its middle [m]
    lean : of the base, clockwise [rad]

    Returns
    -------
    The :class:`Shape`.
    """
    own = (
        mass * (width * width + height * height) / 12
        if math.isnan(inertia)
        else inertia
    )
    h = height / 2 if math.isnan(cg_height) else cg_height
    x, y = turned(cg_offset, h, lean)
    return Shape(width / 2, mass, own, x, y)


def arm(shape: Shape, pivot: int) -> tuple[float, float]:
    """Vector from the pivot to the centre of gravity [m].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    Both components [m].
    """
    return shape.x - pivot * shape.b, shape.y


def critical_angle(shape: Shape, pivot: int) -> float:
    """Rotation about the pivot at which the block balances on it [rad].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    The angle [rad], not above 0 where the block cannot stand.
    """
    x, y = arm(shape, pivot)
    return atan2(-pivot * x, y)


def radius(shape: Shape, pivot: int) -> float:
    """Distance from the pivot to the centre of gravity [m].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    The distance R [m].
    """
    x, y = arm(shape, pivot)
    return hypot(x, y)


def pivot_inertia(shape: Shape, pivot: int) -> float:
    """Moment of inertia about the pivot [kg m²].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    The moment of inertia [kg m²].
    """
    x, y = arm(shape, pivot)
    return shape.inertia + shape.mass * (x * x + y * y)


def frequency(shape: Shape, pivot: int, g: float) -> float:
    """Frequency parameter p [1/s].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The parameter p = √(m g R / I) [1/s] (Housner 1963).
    """
    return math.sqrt(
        shape.mass * g * radius(shape, pivot) / pivot_inertia(shape, pivot)
    )


def can_stand(shape: Shape) -> bool:
    """Whether the centre of gravity is above the base.

    Parameters
    ----------
    shape : a block as it stands

    Returns
    -------
    Whether it is to both sides.
    """
    return critical_angle(shape, 1) > 0.0 and critical_angle(shape, -1) > 0.0


def _product(shape: Shape, pivot: int) -> float:
    """Moment of inertia in the angular momentum about the other pivot of what turns about this one."""
    x, y = arm(shape, pivot)
    return shape.inertia + shape.mass * (shape.x * x + shape.y * y)


def momentum_restitution(shape: Shape, pivot: int) -> float:
    """Ratio of the rates after and before an impact on this pivot that conserves momentum [-].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    The ratio, which is below 0 where the block is squat (Housner 1963).
    """
    (x1, y1), (x2, y2) = arm(shape, -pivot), arm(shape, pivot)
    return (shape.inertia + shape.mass * (x1 * x2 + y1 * y2)) / pivot_inertia(
        shape, pivot
    )


STANDS_FLAT = 1e-12  # rotation below which a block stands on its base [rad]


def kicked(
    shape: Shape, pivot: int, theta: float, omega: float, jump: tuple[float, float]
) -> float:
    """Rate about a pivot after a jump of the base's velocity (``docs/velocity-steps.md``) [rad/s].

    Parameters
    ----------
    shape, pivot : a block as it stands, and +1 right or -1 left
    theta, omega : rotation [rad] and rate before the jump [rad/s], clockwise
    jump : of the base's velocity, to the right and up [m/s]

    Returns
    -------
    The rate; angular momentum about the pivot is kept.
    """
    x, z = arm(shape, pivot)
    x, z = turned(x, z, theta)
    right, up = jump
    return omega + shape.mass * (x * up - z * right) / pivot_inertia(shape, pivot)


def jumped(
    shape: Shape, theta: float, omega: float, jump: tuple[float, float]
) -> tuple[int, float]:
    """Pivot and rate after a jump of the base's velocity; pivot 0 if the block stays on its base.

    Parameters
    ----------
    shape : a block as it stands
    theta, omega : rotation [rad] and rate before the jump [rad/s], clockwise
    jump : of the base's velocity, to the right and up [m/s]

    Returns
    -------
    Pivot +1 or -1, and the rate [rad/s].
    """
    if abs(theta) > STANDS_FLAT:
        pivot = 1 if theta > 0.0 else -1
        return pivot, kicked(shape, pivot, theta, omega, jump)
    if omega != 0.0:
        pivot = 1 if omega > 0.0 else -1
        after = kicked(shape, pivot, theta, omega, jump)
        if pivot * after > 0.0:
            return pivot, after
        # the base takes it over to the other pivot, which is an impact
        left = momentum_restitution(shape, -pivot) * omega
        after = kicked(shape, -pivot, theta, left, jump)
        return (-pivot, after) if -pivot * after > 0.0 else (0, 0.0)
    clockwise = kicked(shape, 1, theta, 0.0, jump)
    other = kicked(shape, -1, theta, 0.0, jump)
    if clockwise > 0.0 and clockwise >= -other:
        return 1, clockwise
    return (-1, other) if other < 0.0 else (0, 0.0)


def largest_restitution(shape: Shape, pivot: int) -> float:
    """Largest ratio with which no impact on this pivot gains energy [-].

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left

    Returns
    -------
    The ratio.
    """
    return math.sqrt(pivot_inertia(shape, -pivot) / pivot_inertia(shape, pivot))


def scaled_restitution(
    shape: Shape, pivot: int, measured: float, factor: float
) -> float:
    """Ratio of an impact on this pivot, measured or else of momentum, times a factor [-]; none gains energy.

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left
    measured : ratio of the rates [-]; NaN where there is none
    factor : of either [-]

    Returns
    -------
    The ratio, from 0 to the largest.
    """
    e = momentum_restitution(shape, pivot) if math.isnan(measured) else measured
    return min(max(e, 0.0) * factor, largest_restitution(shape, pivot))


def impulse_position(shape: Shape, restitution: float, pivot: int) -> float:
    """Where the impulse acts if the block comes off with this ratio, from the middle (0) to the new pivot (1).

    Parameters
    ----------
    shape : a block as it stands
    restitution : ratio of the rates after and before the impact [-]
    pivot : +1 right, -1 left, on which it comes down

    Returns
    -------
    The place over half the width [-] (``docs/restitution.md``, eq. 4).
    """
    old, new = arm(shape, -pivot)[0], arm(shape, pivot)[0]
    excess = _product(shape, -pivot) - restitution * _product(shape, pivot)
    return excess / (shape.mass * pivot * shape.b * (old - restitution * new))


def pile_of(lower: Shape, upper: Shape, face: Face) -> Pile:
    """Return a statue as it stands on a pedestal.

    Parameters
    ----------
    lower, upper : each as it stands by itself
    face : what the lower one carries the upper one on

    Returns
    -------
    The :class:`Pile`.
    """
    offset = face.offset
    # ends of what the base shares with the face, from the middle of the face [m]
    low = max(-face.half, offset - upper.b)
    high = min(face.half, offset + upper.b)
    middle, on_contact = offset, upper
    # a base that overhangs stands on what it shares
    if abs(offset) + upper.b > face.half * (1 + 1e-12):
        middle = (low + high) / 2
        on_contact = Shape(
            (high - low) / 2,
            upper.mass,
            upper.inertia,
            upper.x - (middle - offset),
            upper.y,
        )
    middle += face.right
    left = turned(middle - on_contact.b, face.height, face.lean)
    right = turned(middle + on_contact.b, face.height, face.lean)
    return Pile(lower, upper, on_contact, face.lean, offset, low, high, left, right)


def reach(pile: Pile, ground_pivot: int, upper_pivot: int) -> tuple[float, float]:
    """Vector from the pedestal's pivot to the statue's pivot [m].

    Parameters
    ----------
    pile : a statue on a pedestal
    ground_pivot, upper_pivot : of the pedestal and of the statue, +1 right, -1 left

    Returns
    -------
    Both components [m].
    """
    x, y = pile.right if upper_pivot > 0 else pile.left
    return x - ground_pivot * pile.lower.b, y


def upper_arm(pile: Pile, pivot: int) -> tuple[float, float]:
    """Vector from the statue's pivot to its centre of gravity, as it stands on the pedestal [m].

    Parameters
    ----------
    pile : a statue on a pedestal
    pivot : of the statue, +1 right, -1 left

    Returns
    -------
    Both components [m].
    """
    x, y = arm(pile.upper, pivot)
    return turned(x, y, pile.lean)


def common_arm(pile: Pile, pivot: int) -> tuple[float, float]:
    """Vector from the pedestal's pivot to the common centre of gravity [m].

    Parameters
    ----------
    pile : a statue on a pedestal
    pivot : of the pedestal, +1 right, -1 left

    Returns
    -------
    Both components [m].
    """
    m1, m2 = pile.lower.mass, pile.upper.mass
    x1, y1 = arm(pile.lower, pivot)
    dx, dy = reach(pile, pivot, 1)
    x2, y2 = upper_arm(pile, 1)
    return (m1 * x1 + m2 * (dx + x2)) / (m1 + m2), (m1 * y1 + m2 * (dy + y2)) / (
        m1 + m2
    )


def joined(pile: Pile) -> Shape:
    """Return the two as one rigid block, which is what rocks in pattern 3.

    Parameters
    ----------
    pile : a statue on a pedestal

    Returns
    -------
    The :class:`Shape` of both, on the pedestal's base.
    """
    first, two = pile.lower, pile.upper
    m1, m2 = first.mass, two.mass
    dx, dy = reach(pile, 1, 1)
    ax, ay = upper_arm(pile, 1)
    x2, y2 = first.b + dx + ax, dy + ay
    x = (m1 * first.x + m2 * x2) / (m1 + m2)
    y = (m1 * first.y + m2 * y2) / (m1 + m2)
    apart_x, apart_y = first.x - x2, first.y - y2
    spread = m1 * m2 / (m1 + m2) * (apart_x * apart_x + apart_y * apart_y)
    return Shape(first.b, m1 + m2, first.inertia + two.inertia + spread, x, y)


def overhang(pile: Pile, pivot: int) -> float:
    """What the statue's base reaches beyond the pedestal [m]."""
    end = pile.high if pivot > 0 else pile.low
    return pivot * (pile.offset - end) + pile.above.b


def lowest_edge(pile: Pile, pivot: int) -> float:
    """How low the pedestal's upper edge comes where it, or both as one, balance on their pivot [m]."""
    x, y = reach(pile, pivot, pivot)
    wx, wy = common_arm(pile, pivot)
    furthest = max(critical_angle(pile.lower, pivot), atan2(-pivot * wx, wy))
    return min(y, turned(x, y, pivot * furthest)[1])


def failed_stability_check(pile: Pile) -> int:
    """Whether a statue stands on its pedestal, or why not; each is known to stand by itself.

    Parameters
    ----------
    pile : a statue on a pedestal

    Returns
    -------
    ``STANDS``, or the number of the check that fails first.
    """
    if pile.low >= pile.high:
        return BESIDE
    if not pile.low < pile.offset + pile.above.x < pile.high:
        return OFF_CONTACT
    for pivot in (1, -1):
        if (
            pivot * upper_arm(pile, pivot)[0] >= 0.0
            or pivot * common_arm(pile, pivot)[0] >= 0.0
        ):
            return TILTED_OFF
        beyond = overhang(pile, pivot)
        # the statue may have turned by a right angle on that edge by then
        if beyond > 1e-12 * pile.lower.b and beyond >= lowest_edge(pile, pivot):
            return REACHES_GROUND
    return STANDS


def fill_block(body: Any, block: Shape) -> None:
    """Fill the geometry of a lone block into its record: block 2, on a support that cannot move.

    Parameters
    ----------
    body : record ``pure_rocking.kernels.equations.BODY``, changed in place
    block : as it stands
    """
    # the support's numbers never matter
    body.m1, body.i1, body.b1, body.c1x, body.c1y = 1.0, 1.0, 1.0, 0.0, 0.0
    body.tx, body.ty, body.ex, body.ey = 0.0, 0.0, 1.0, 0.0
    body.m2, body.i2, body.b2 = block.mass, block.inertia, block.b
    body.c2x, body.c2y = block.x, block.y
    body.fixed = True


def pivot_constants(
    shape: Shape, pivot: int, restitution: float, g: float
) -> tuple[float, float, float, float, float, float, float, float]:
    """Constants of a block on a pivot for lanes (``kernels.lanes.block.PIVOT``), with p² in place of p² dt².

    Parameters
    ----------
    shape : a block as it stands
    pivot : +1 right, -1 left
    restitution : of the impact that ends rocking on this pivot and begins it on the other [-]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    Eight numbers, in the order of the record ``PIVOT``: angles [rad], ratios [-] and p² [1/s²].
    """
    alpha, length = critical_angle(shape, pivot), radius(shape, pivot)
    x, y = arm(shape, pivot)
    aside = -pivot * x
    p = frequency(shape, pivot, g)
    p_squared = p * p
    return (
        alpha,
        aside / y,
        aside / length,
        y / length,
        p_squared,
        restitution,
        1 / alpha,
        1 / (p_squared * alpha * alpha),
    )


def fill_pile(body: Any, pile: Pile) -> None:
    """Fill the geometry of a stack into its record.

    Parameters
    ----------
    body : record ``pure_rocking.kernels.equations.BODY``, changed in place
    pile : a statue on a pedestal
    """
    first, two = pile.lower, pile.upper
    body.m1, body.i1, body.b1 = first.mass, first.inertia, first.b
    body.c1x, body.c1y = first.x, first.y
    (rx, ry), (lx, ly) = pile.right, pile.left
    width = 2 * two.b
    body.tx, body.ty = (rx + lx) / 2, (ry + ly) / 2
    body.ex, body.ey = (rx - lx) / width, (ry - ly) / width
    body.m2, body.i2, body.b2 = two.mass, two.inertia, two.b
    body.c2x, body.c2y = turned(two.x, two.y, pile.lean)
    body.fixed = False
