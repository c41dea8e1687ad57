"""Exponentials, logarithms and the normal distribution, of plain arithmetic: the same bits on every processor.

As in ``elementary`` there are only additions, multiplications and divisions, each rounded once as IEEE 754 says.
Errors are below two units in the last place, of the normal distribution below 3e-15 of the value for |x| < 8.
Kernels call these functions too (``rockfrag.assess.core.compiled``).
"""

import math

# ln 2 in a part of 32 bits, whose products with exponents are exact, and the rest
_LN_2, _LN_2_LOW = 0.6931471803691238, 1.9082149292705877e-10
_ROOT_HALF = 0.7071067811865476
_LARGEST, _LEAST = 709.782712893384, -745.1332191019411  # Beyond, exp is inf and 0
_POWERS = (
    2.0**512, 2.0**256, 2.0**128, 2.0**64, 2.0**32, 2.0**16, 2.0**8, 2.0**4, 4.0, 2.0,
)  # fmt: skip
_INVERSE = (
    2.0**-512, 2.0**-256, 2.0**-128, 2.0**-64, 2.0**-32, 2.0**-16, 2.0**-8, 2.0**-4,
    0.25, 0.5,
)  # fmt: skip

# --------------------------------------------------------------------------- exponentials


def _beyond(x: float) -> float:
    """(exp(x) - 1 - x) / x² for |x| ≤ 0.36, by its series."""
    p = 1 / 1307674368000 + x * (1 / 20922789888000)
    p = 1 / 6227020800 + x * (1 / 87178291200 + x * p)
    p = 1 / 39916800 + x * (1 / 479001600 + x * p)
    p = 1 / 362880 + x * (1 / 3628800 + x * p)
    p = 1 / 5040 + x * (1 / 40320 + x * p)
    p = 1 / 120 + x * (1 / 720 + x * p)
    return 0.5 + x * (1 / 6 + x * (1 / 24 + x * p))


def exp(x: float) -> float:
    """Exponential.

    Parameters
    ----------
    x : the exponent [-]

    Returns
    -------
    e to the power of x: inf above 709.8, 0 below -745.1.
    """
    if not x <= _LARGEST:
        return math.inf if x > 0.0 else math.nan
    if x < _LEAST:
        return 0.0
    # less the nearest multiple of ln 2, with what rounding takes
    twos = math.floor(x / (_LN_2 + _LN_2_LOW) + 0.5)
    high = x - twos * _LN_2
    rest = high - twos * _LN_2_LOW
    low = (high - rest) - twos * _LN_2_LOW
    found = 1.0 + (rest + (rest * rest * _beyond(rest) + low))
    for place in range(10):
        power = 512 >> place
        if twos >= power:
            found *= _POWERS[place]
            twos -= power
        elif -twos >= power:
            found *= _INVERSE[place]
            twos += power
    return found * 2.0 if twos > 0 else found


def expm1(x: float) -> float:
    """Exponential less one, exact to its own last digits about 0.

    Parameters
    ----------
    x : the exponent [-]

    Returns
    -------
    exp(x) - 1.
    """
    if -0.35 < x < 0.35:
        return x + x * x * _beyond(x)
    return exp(x) - 1.0


# --------------------------------------------------------------------------- logarithms


def log(x: float) -> float:
    """Natural logarithm.

    Parameters
    ----------
    x : a positive number

    Returns
    -------
    Its natural logarithm; -inf of 0 and NaN below.
    """
    if not x > 0.0:
        return -math.inf if x == 0.0 else math.nan
    if x == math.inf:
        return x
    twos = 0
    if x < 2.0**-1022:
        x *= 2.0**54
        twos = -54
    for place in range(10):
        power = 512 >> place
        if x >= _POWERS[place]:
            x *= _INVERSE[place]
            twos += power
        elif x < _INVERSE[place]:
            x *= _POWERS[place]
            twos -= power
    # from 1/2 to 2, and then about 1
    if x < _ROOT_HALF:
        x *= 2.0
        twos -= 1
    elif x > 2.0 * _ROOT_HALF:
        x *= 0.5
        twos += 1
    f = x - 1.0
    s = f / (2.0 + f)
    z = s * s
    # ln((1 + s)/(1 - s)) - 2 s, by its series
    p = 2 / 19 + z * (2 / 21 + z * (2 / 23))
    p = 2 / 13 + z * (2 / 15 + z * (2 / 17 + z * p))
    p = z * (2 / 3 + z * (2 / 5 + z * (2 / 7 + z * (2 / 9 + z * (2 / 11 + z * p)))))
    half = 0.5 * f * f
    return twos * _LN_2 + (f - (half - (s * (half + p) + twos * _LN_2_LOW)))


def log1p(x: float) -> float:
    """Logarithm of one more, exact to its own last digits about 0.

    Parameters
    ----------
    x : a number above -1

    Returns
    -------
    ln(1 + x).
    """
    total = 1.0 + x
    if total == 1.0 or total == math.inf:
        return x
    if not total > 0.0:
        return log(total)
    return log(total) + (x - (total - 1.0)) / total


# --------------------------------------------------------------------------- the normal distribution

_ROOT_TWO, _PER_ROOT_PI = math.sqrt(2.0), 1.0 / math.sqrt(math.pi)

# Quotients of polynomials by Cody (1969, Math. Comp. 23: 631), the highest power first: of erf(x)/x in x² up to
# 0.46875, of exp(x²) erfc(x) in x up to 4, and of its difference from 1/(x √π) in 1/x² beyond
_NEAR = (
    0.185777706184603153, 3.1611237438705656, 113.864154151050156, 377.485237685302021,
    3209.37758913846947,
)  # fmt: skip
_NEAR_BELOW = (
    1.0, 23.6012909523441209, 244.024637934444173, 1282.61652607737228,
    2844.23683343917062,
)  # fmt: skip
_MIDDLE = (
    2.15311535474403846e-8, 0.564188496988670089, 8.88314979438837594, 66.1191906371416295,
    298.635138197400131, 881.95222124176909, 1712.04761263407058, 2051.07837782607147,
    1230.33935479799725,
)  # fmt: skip
_MIDDLE_BELOW = (
    1.0, 15.7449261107098347, 117.693950891312499, 537.181101862009858,
    1621.38957456669019, 3290.79923573345963, 4362.61909014324716, 3439.36767414372164,
    1230.33935480374942,
)  # fmt: skip
_FAR = (
    0.0163153871373020978, 0.305326634961232344, 0.360344899949804439,
    0.125781726111229246, 0.0160837851487422766, 6.58749161529837803e-4,
)  # fmt: skip
_FAR_BELOW = (
    1.0, 2.56852019228982242, 1.87295284992346725, 0.527905102951428412,
    0.0605183413124413191, 0.00233520497626869185,
)  # fmt: skip


def _near_erf(x: float) -> float:
    """Error function for |x| ≤ 0.46875."""
    z, above, below = x * x, 0.0, 0.0
    for i in range(5):
        above = above * z + _NEAR[i]
        below = below * z + _NEAR_BELOW[i]
    return x * above / below


def _scaled_erfc(x: float) -> float:
    """Return exp(x²) erfc(x) for x > 0.46875."""
    above, below = 0.0, 0.0
    if x <= 4.0:
        for i in range(9):
            above = above * x + _MIDDLE[i]
            below = below * x + _MIDDLE_BELOW[i]
        return above / below
    z = 1.0 / (x * x)
    for i in range(6):
        above = above * z + _FAR[i]
        below = below * z + _FAR_BELOW[i]
    return (_PER_ROOT_PI - z * above / below) / x


def _bell(x: float) -> float:
    """Return exp(-x²/2) for x ≥ 0, with the square split so that nothing of it is rounded away."""
    part = math.floor(16.0 * x) / 16.0
    return exp(-0.5 * part * part) * exp(-0.5 * (x - part) * (x + part))


def normal_cdf(x: float) -> float:
    """Normal distribution function.

    Parameters
    ----------
    x : in standard deviations [-]

    Returns
    -------
    The probability of a smaller value.
    """
    z = abs(x) / _ROOT_TWO
    if z <= 0.46875:
        return 0.5 * (1.0 + _near_erf(x / _ROOT_TWO))
    tail = 0.5 * _scaled_erfc(z) * _bell(abs(x))
    return 1.0 - tail if x > 0.0 else tail


def log_normal_cdf(x: float) -> float:
    """Logarithm of the normal distribution function.

    Parameters
    ----------
    x : in standard deviations [-]

    Returns
    -------
    The logarithm of the probability of a smaller value.
    """
    z = abs(x) / _ROOT_TWO
    if z <= 0.46875:
        return log(0.5 * (1.0 + _near_erf(x / _ROOT_TWO)))
    scaled = 0.5 * _scaled_erfc(z)
    return log1p(-scaled * _bell(x)) if x > 0.0 else log(scaled) - 0.5 * x * x
