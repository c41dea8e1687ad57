"""Sine, cosine, arc tangent and their like, of plain arithmetic: the same bits on every processor.

Libraries choose their ways by the processor, and differ in the last digit.  Here are only additions,
multiplications, divisions and square roots, each rounded once as IEEE 754 says, no multiply-adds, and operations
that are exact by definition.  Errors are below one unit in the last place.
Kernels call these functions too (``jit``).
"""

import math

# --------------------------------------------------------------------------- sums that keep their rounding errors

_SPLITTER = 134217729.0  # 2**27 + 1


def _sum(a: float, b: float) -> tuple[float, float]:
    """A + b and what rounding took from it (Knuth)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _product(a: float, b: float) -> tuple[float, float]:
    """Return a b and what rounding took from it (Dekker), for factors below 2**900."""
    product = a * b
    ta, tb = _SPLITTER * a, _SPLITTER * b
    a1, b1 = ta - (ta - a), tb - (tb - b)
    a2, b2 = a - a1, b - b1
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


# --------------------------------------------------------------------------- sine and cosine

QUARTER = 0.25 * math.pi
LARGEST_ANGLE = 1e6
"""Angles [rad] above which there is no sine: nothing that stands has turned so far."""

_TWO_OVER_PI = 0.6366197723675814
# π/2 in parts of 33 bits, so that their products with whole numbers below 2**20 are exact, and the rest
_HALF_PI_1, _HALF_PI_2 = 1.5707963267341256, 6.077100506303966e-11
_HALF_PI_3, _HALF_PI_4 = 2.0222662487111665e-21, 8.4784276603689e-32


def sin_cos(x: float) -> tuple[float, float]:
    """Sine and cosine of an angle [rad].

    Parameters
    ----------
    x : angle, at most 1e6 in magnitude [rad]

    Returns
    -------
    Sine and cosine [-]; NaN beyond that.
    """
    if abs(x) <= QUARTER:
        return _sine(x, 0.0), _cosine(x, 0.0)
    if not abs(x) <= LARGEST_ANGLE:
        return math.nan, math.nan
    # less the nearest multiple of π/2, with the rounding errors kept
    n = math.floor(x * _TWO_OVER_PI + 0.5)
    r, e1 = _sum(x - n * _HALF_PI_1, -n * _HALF_PI_2)
    r, e2 = _sum(r, -n * _HALF_PI_3)
    rest = (e1 + e2) - n * _HALF_PI_4
    r, low = _sum(r, rest)
    s, c = _sine(r, low), _cosine(r, low)
    quadrant = n & 3
    if quadrant == 0:
        return s, c
    if quadrant == 1:
        return c, -s
    if quadrant == 2:
        return -s, -c
    return -c, s


def sin(x: float) -> float:
    """Sine of an angle [rad].

    Parameters
    ----------
    x : angle, at most 1e6 in magnitude [rad]

    Returns
    -------
    The sine [-]; NaN beyond that.
    """
    return sin_cos(x)[0]


def cos(x: float) -> float:
    """Cosine of an angle [rad].

    Parameters
    ----------
    x : angle, at most 1e6 in magnitude [rad]

    Returns
    -------
    The cosine [-]; NaN beyond that.
    """
    return sin_cos(x)[1]


def _sine(x: float, low: float) -> float:
    """Sine of x + low for |x| ≤ π/4, by its series."""
    z = x * x
    w = z * z
    p = (1 / 120 - z * (1 / 5040)) + w * (1 / 362880 - z * (1 / 39916800))
    p += w * w * (1 / 6227020800 - z * (1 / 1307674368000) + w * (1 / 355687428096000))
    cube = z * x
    return x - ((z * (0.5 * low - cube * p) - low) + cube * (1 / 6))


def _cosine(x: float, low: float) -> float:
    """Cosine of x + low for |x| ≤ π/4, by its series."""
    z = x * x
    w = z * z
    p = (1 / 24 - z * (1 / 720)) + w * (1 / 40320 - z * (1 / 3628800))
    p += w * w * (1 / 479001600 - z * (1 / 87178291200) + w * (1 / 20922789888000))
    half = 0.5 * z
    most = 1.0 - half
    return most + (((1.0 - most) - half) + (w * p - x * low))


# --------------------------------------------------------------------------- arc tangent and arc cosine

_PI, _PI_LOW = math.pi, 1.2246467991473532e-16
_HALF_PI, _HALF_PI_LOW = 0.5 * math.pi, 6.123233995736766e-17

# arc tangents of 0, 1/8, … 1, and what rounding took from them
_ARC = (
    0.0, 0.12435499454676144, 0.24497866312686414, 0.35877067027057225, 0.4636476090008061,
    0.5585993153435624, 0.6435011087932844, 0.7188299996216245, 0.7853981633974483,
)  # fmt: skip
_ARC_LOW = (
    0.0, -3.1253241424539383e-18, 1.0698755618734451e-17, -2.4623815582638635e-17,
    2.2698777452961687e-17, -5.4556305485916264e-18, 1.5834785051444286e-17,
    -2.1478388444456983e-17, 3.061616997868383e-17,
)  # fmt: skip

_HUGE, _TINY, _NOTHING = 2.0**500, 2.0**-400, 2.0**-60
_UP, _DOWN = 2.0**600, 2.0**-600


def atan2(y: float, x: float) -> float:
    """Angle of the direction (x, y), from -π to π [rad].

    Parameters
    ----------
    y, x : of one unit, of any size

    Returns
    -------
    The angle [rad]; NaN if one of both is.
    """
    if math.isnan(x) or math.isnan(y):
        return math.nan
    return _direction(abs(y), 0.0, x, y)


def acos(x: float) -> float:
    """Angle from 0 to π with this cosine [rad].

    Parameters
    ----------
    x : cosine, from -1 to 1 [-]

    Returns
    -------
    The angle [rad]; NaN beyond that.
    """
    if not abs(x) <= 1.0:
        return math.nan
    # 1 - x² = rest + low_rest, rounded and what rounding leaves
    square, low = _product(x, x)
    rest, low_rest = _sum(1.0, -square)
    if rest <= 0.0:
        return 0.0 if x > 0.0 else _PI
    low_rest -= low
    # the sine is its root; one step of Newton's gives what rounding leaves of that
    sine = math.sqrt(rest)
    square, low = _product(sine, sine)
    low_sine = ((rest - square) - low + low_rest) / (2.0 * sine)
    return _direction(sine, low_sine, x, 1.0)


def _direction(up: float, up_low: float, x: float, side: float) -> float:
    """Angle of (x, up + up_low), with the sign of ``side``."""
    along = abs(x)
    if up > along:
        angle, low = _octant(along, 0.0, up, up_low)
        angle, e = _sum(_HALF_PI, -angle)
        low = e + (_HALF_PI_LOW - low)
    else:
        angle, low = _octant(up, up_low, along, 0.0)
    if math.copysign(1.0, x) < 0.0:
        angle, e = _sum(_PI, -angle)
        low = e + (_PI_LOW - low)
    return math.copysign(angle + low, side)


def _octant(
    small: float, small_low: float, big: float, big_low: float
) -> tuple[float, float]:
    """Arc tangent of small / big, from 0 to π/4 [rad].

    Each number is a sum: ``_low`` is what rounding leaves of it, and so the angle is returned. The quotient is
    brought near zero by the arc tangent of the nearest eighth, of which a table has both parts; its own remainder
    follows from an exact product (Dekker, 1971, Numerische Mathematik 18: 224-242), and the rest is a short
    series.

    Parameters
    ----------
    small, small_low : of one side, not larger than the other
    big, big_low : of the other side

    Returns
    -------
    The angle, and what rounding leaves of it.
    """
    if big == 0.0:
        return 0.0, 0.0
    if big == math.inf:
        return (_ARC[8], _ARC_LOW[8]) if small == math.inf else (0.0, 0.0)
    # powers of two, which change no digit and keep products from under- and overflow
    if big < _TINY:
        small, small_low, big, big_low = (
            small * _UP,
            small_low * _UP,
            big * _UP,
            big_low * _UP,
        )
    if small < big * _NOTHING:
        return small / big, 0.0
    if big > _HUGE:
        small, small_low = small * _DOWN, small_low * _DOWN
        big, big_low = big * _DOWN, big_low * _DOWN
    # less the arc tangent of the nearest eighth c: (small - c big) / (big + c small)
    k = math.floor(8.0 * (small / big) + 0.5)
    c = 0.125 * k
    product, e = _product(c, big)
    above, above_low = _sum(small, -product)
    above_low += small_low - e - c * big_low
    product, e = _product(c, small)
    below, below_low = _sum(big, product)
    below_low += big_low + e + c * small_low
    # the quotient, and its remainder over the divisor
    z = above / below
    product, e = _product(z, below)
    z_low = (((above - product) - e) + above_low - z * below_low) / below
    s = z * z
    p = 1 / 3 - s * (1 / 5 - s * (1 / 7 - s * (1 / 9 - s * (1 / 11 - s * (1 / 13)))))
    angle, e = _sum(_ARC[k], z)
    return angle, e + (_ARC_LOW[k] + (z_low - z * s * p))


# --------------------------------------------------------------------------- length


def hypot(x: float, y: float) -> float:
    """Length of (x, y), by a square root and one correction (Borges 2019).

    Parameters
    ----------
    x, y : of one unit, of any size

    Returns
    -------
    The length, in that unit.
    """
    big, small = max(abs(x), abs(y)), min(abs(x), abs(y))
    if abs(x) == math.inf or abs(y) == math.inf:
        return math.inf
    if math.isnan(x) or math.isnan(y):
        return math.nan
    if small <= big * _NOTHING:
        return big
    scale = 1.0
    if big > _HUGE:
        big, small, scale = big * _DOWN, small * _DOWN, _UP
    elif small < _TINY:
        big, small, scale = big * _UP, small * _UP, _DOWN
    length = math.sqrt(big * big + small * small)
    if length <= 2.0 * small:
        over = length - small
        excess = big * (2.0 * over - big) + (over - 2.0 * (big - small)) * over
    else:
        over = length - big
        excess = (
            2.0 * over * (big - 2.0 * small)
            + (4.0 * over - small) * small
            + over * over
        )
    return (length - excess / (2.0 * length)) * scale
