"""A hazard curve, a power law between points, and the rate of what happens at its levels; compiled.

The rate is λ = ∫ P(x) |dH(x)|, with P the fraction of motions that topple the object at level x, linear in ln x
between levels, and H the annual rate at which x is exceeded. It is linear in P at the levels, so that weights of
levels say all of it.

In: levels and annual rates of a curve. Out: weights of levels [1/a].
Theory: ``docs/assess.md``, "How likely, and what to do".
"""

import math

from rockfrag.assess.core.compiled import entry_kernel, kernel
from rockfrag.base.exponentials import exp, expm1, log


@kernel
def _slope(levels, rates, i):
    """Slope of ln rate over ln level from point i to the next; ``levels``, ``rates``: of a curve, shape (n,)."""
    return log(rates[i + 1] / rates[i]) / log(levels[i + 1] / levels[i])


@kernel
def rate_at(levels, rates, level):
    """Annual rate with which a level is exceeded [1/year]; the ends are continued as they slope.

    ``levels``, ``rates``: points of the curve, levels rising, shape (n,).
    """
    i = 0
    while i < levels.size - 2 and levels[i + 1] < level:
        i += 1
    return rates[i] * exp(_slope(levels, rates, i) * log(level / levels[i]))


@entry_kernel
def fill_level(levels, rates, rate, found):
    """Fill the level that is exceeded with an annual rate [1/year], shape (1,).

    ``levels``, ``rates``: points of the curve, levels rising, shape (n,).
    """
    i = 0
    while i < levels.size - 2 and rates[i + 1] > rate:
        i += 1
    found[0] = levels[i] * exp(log(rate / rates[i]) / _slope(levels, rates, i))


@entry_kernel
def fill_power_law(level, years, exponent, levels, rates):
    """Fill a curve through one level with its return period [years]: a tenth, the level and ten times it.

    ``exponent``: k of rates in proportion to level^-k; ``levels``, ``rates`` [1/year]: filled, shape (3,).
    """
    for i in range(3):
        factor = 10.0 if i == 2 else 1.0 if i == 1 else 0.1
        levels[i] = level * factor
        rates[i] = exp(-exponent * log(factor)) / years


@entry_kernel
def fill_rate_weights(levels, shift, curve_levels, curve_rates, weights):
    """Weights with which fractions at rising levels add up to the rate of toppling [1/year], shape (levels,).

    Nothing topples below the first level, and above the last one the last fraction stays. ``shift`` is the
    logarithm of a factor on all levels: the object bears so much more. ``curve_levels``, ``curve_rates`` are the
    points of the hazard curve, ``weights`` are filled.

    Over a piece in which the fraction is a straight line in ln level and the rate a power law, the integral of
    each is the rate that falls on either side of its mean (:func:`_mean_rate`).
    """
    last, factor = levels.size - 1, exp(shift)
    for k in range(last + 1):
        weights[k] = 0.0
    for k in range(last):
        low, high = levels[k] * factor, levels[k + 1] * factor
        width = log(high / low)
        start, before = 0.0, rate_at(curve_levels, curve_rates, low)
        for i in range(curve_levels.size + 1):
            # pieces end at points of the curve, where its slope changes, and at the next level
            end = high
            if i < curve_levels.size:
                end = curve_levels[i]
                if not low < end < high:
                    continue
            # between two levels the fraction is a straight line in ln of the level, the rate one in logarithms
            along = 1.0 if end == high else log(end / low) / width
            after = rate_at(curve_levels, curve_rates, end)
            mean = _mean_rate(before, after)
            here, there = before - mean, mean - after
            weights[k] += here * (1.0 - start) + there * (1.0 - along)
            weights[k + 1] += here * start + there * along
            start, before = along, after
    top = levels[last] * factor
    weights[last] += rate_at(curve_levels, curve_rates, top)


@kernel
def _mean_rate(before, after):
    """Mean over ln level of a rate that falls as a power law, from ν0 ``before`` to ν1 ``after``."""
    # (ν0 - ν1) / ln(ν0/ν1)
    fall = log(before / after)
    if fall <= 1e-12:
        return before
    return before * -expm1(-fall) / fall


@entry_kernel
def spread_of_quantiles(scores, rates):
    """Standard deviation of ln rate that quantiles stand for; NaN of less than two with a rate.

    ``scores``: normal scores of the quantiles; ``rates``: theirs [1/year], 0 where not known; shape (quantiles,)
    each.
    """
    low, high = -1, -1
    for i in range(rates.size):
        if rates[i] > 0.0:
            if low < 0 or scores[i] < scores[low]:
                low = i
            if high < 0 or scores[i] > scores[high]:
                high = i
    if low == high:
        return math.nan
    return abs(log(rates[high] / rates[low])) / (scores[high] - scores[low])
