"""From fractions under each draw to a number with its interval, and to parts of its sources; compiled.

Three kinds of numbers are estimated: a fraction of the motions at a level and the rate of toppling, both linear in
the fractions at the levels, and the level that topples a part of the motions. The interval holds the middle 90 %
of the draws. Parts are first-order sensitivity indices: the variance of the means over what a source is not, over
the variance (Sobol' 1993), from the draws that are there (Plischke, Borgonovo and Smith 2013, Eur. J. Oper. Res.
226: 536).

In: fractions, (draws, levels), and weights of levels. Out: mean, limits and parts of sources [-].
Theory: ``docs/assess.md``, "How sure".
"""

import math

import numpy as np
from scipy import special

from rockfrag.assess.core.choices import LEAVE, MEASURE, SECURE, are_few
from rockfrag.assess.core.compiled import entry_kernel, kernel
from rockfrag.assess.core.ordering import mean, quantile, sort, variance
from rockfrag.base.exponentials import exp, expm1, log, log1p

FRACTION, RATE, LEVEL = 0, 1, 2  # Kinds of what is estimated
INSIDE = 0.90  # Part of the draws that intervals hold
NONE_BELOW = 1e-3  # Fraction of motions that is none where it is a limit

BINS = 32  # Of equally many draws, by which a source is known

_EDGES = special.ndtri(np.linspace(0, 1, BINS + 1))
CENTRES = tuple(
    round(float(centre), 12)
    for centre in -BINS * np.diff(np.exp(-0.5 * _EDGES**2)) / np.sqrt(2 * np.pi)
)
"""Mean of a standard normal source in each bin, in as many digits as all machines agree on."""

_ONE_AWAY = (5, 26)
"""Bins about one standard deviation to both sides: 16 and 84 % of 32."""

VALUE, LOWER, UPPER, MOTIONS = range(4)
"""Places in what :func:`fill_estimate` leaves: the number, its limits, and the part of the motions."""


@entry_kernel
def fill_place(levels, level, weights):
    """Fill weights of rising levels that interpolate at one by the logarithm, shape (levels,).

    Below the first and above the last level the value there is kept.
    """
    at = 0
    while at < levels.size - 2 and levels[at + 1] <= level:
        at += 1
    for k in range(levels.size):
        weights[k] = 0.0
    along = log(level / levels[at]) / log(levels[at + 1] / levels[at])
    along = min(max(along, 0.0), 1.0)
    weights[at] = 1.0 - along
    weights[at + 1] = along


@entry_kernel
def fill_sums(table, weights, values):
    """Fill the sum of the weighted numbers of each row of a table, shape (rows, levels); return their mean.

    ``weights``: of the levels; ``values``: filled, shape (rows,).
    """
    for d in range(values.size):
        values[d] = 0.0
        for k in range(weights.size):
            if weights[k] != 0.0:
                values[d] += weights[k] * table[d, k]
    return mean(values)


@entry_kernel
def fill_crossings(table, levels, part, values):
    """Fill the level at which each row reaches a part [-], linear in the logarithm; infinite where it does not.

    ``table``: fractions at rising ``levels``, shape (rows, levels); ``values``: filled, in their unit, shape
    (rows,).
    """
    for d in range(values.size):
        values[d] = math.inf
        for k in range(levels.size):
            if table[d, k] < part:
                continue
            values[d] = levels[k]
            if k > 0:
                low = table[d, k - 1]
                along = (part - low) / (table[d, k] - low)
                width = log(levels[k] / levels[k - 1])
                values[d] = levels[k - 1] * exp(along * width)
            break


@entry_kernel
def fill_errors(values, normals, spreads):
    """Multiply rates by errors of ln rate, by source; the rate is a mean, and stays it.

    ``values``: rates, changed in place, shape (draws,); ``normals``: of the sources, shape (draws, sources);
    ``spreads``: standard deviations of ln rate, shape (sources,).
    """
    for d in range(values.size):
        away = 0.0
        for j in range(spreads.size):
            away += spreads[j] * normals[d, j] - spreads[j] * spreads[j] / 2
        values[d] *= exp(away)


@kernel
def shown_of(kind, value, years):
    """The number that is shown: of a rate [1/year] the probability in some ``years``, in a Poisson process.

    ``kind``: ``FRACTION``, ``RATE`` or ``LEVEL``.
    """
    return -expm1(-years * value) if kind == RATE else value


@entry_kernel
def rate_of(probability, years):
    """Annual rate of which a probability in some years follows [1/year]."""
    return -log1p(-min(probability, 1.0 - 1e-15)) / years


@entry_kernel
def sum_of_squares(deviations):
    """Sum of the squares of standard deviations, shape (n,), that widen an interval together."""
    total = 0.0
    for i in range(deviations.size):
        total += deviations[i] * deviations[i]
    return total


@entry_kernel
def fill_shown(kind, years, values, shown):
    """Fill the numbers that are shown of values (:func:`shown_of`), shape (draws,) each."""
    for d in range(values.size):
        shown[d] = shown_of(kind, values[d], years)


@entry_kernel
def fill_estimate(
    kind, years, middle, last_level, values, shown, work, bins, sets, earthquakes, found
):  # fmt: skip
    """Estimate with an interval, and the standard deviation that each source gives it.

    Parameters
    ----------
    kind : ``FRACTION``, ``RATE`` or ``LEVEL``
    years : of a probability
    middle : mean of the values without errors of the rate
    last_level : beyond which levels say nothing
    values : of each draw, shape (draws,)
    shown, work : what is shown of them, and working memory, shape (draws,) each
    bins : of each draw by each source, shape (sources, draws)
    sets : sets of weights of the earthquakes; the draws of one follow each other
    earthquakes : their number; one says nothing of others, and leaves every fraction possible
    found : number, limits, and standard deviations by the motions and by each source, shape (4 + sources,)
    """
    for d in range(values.size):
        shown[d] = shown_of(kind, values[d], years)
        work[d] = shown[d]
    sort(work)
    aside = int((1.0 - INSIDE) / 2 * values.size)
    lower, upper = work[aside], work[values.size - 1 - aside]
    if kind == FRACTION:
        lower = 0.0 if lower < NONE_BELOW else lower
        upper = 1.0 if upper > 1.0 - NONE_BELOW else upper
    value = shown_of(kind, middle, years)
    if kind == LEVEL:
        value = work[(values.size - 1) // 2]
    found[VALUE] = value
    if earthquakes < 2 and kind != LEVEL:
        lower, upper = 0.0, 1.0
    found[LOWER], found[UPPER] = min(lower, value), max(upper, value)
    _scale(kind, last_level, values, work)
    total = variance(work)
    for place in range(MOTIONS, found.size):
        found[place] = 0.0
    if not total > 0.0:
        return
    found[MOTIONS] = math.sqrt(_variance_of_sets(work, sets))
    for j in range(bins.shape[0]):
        found[MOTIONS + 1 + j] = math.sqrt(_variance_of_bins(work, bins[j]))


@kernel
def _scale(kind, last_level, values, scaled):
    """Fill values on the scale on which sources have their parts: logarithms of rates and of levels.

    Of rates no less than a thousandth of the mean: what hardly adds to it counts alike. Levels beyond
    ``last_level`` count as that. ``values``, ``scaled``: shape (draws,).
    """
    least = max(1e-3 * mean(values), 1e-300) if kind == RATE else 0.0
    for d in range(values.size):
        scaled[d] = values[d]
        if kind == RATE:
            scaled[d] = log(max(values[d], least))
        elif kind == LEVEL:
            scaled[d] = log(min(values[d], last_level))


@kernel
def _variance_of_sets(values, sets):
    """Variance of the means under each of so many ``sets`` of weights, whose draws follow each other."""
    members, total, squares = values.size // sets, 0.0, 0.0
    middle = mean(values)
    for b in range(sets):
        total = 0.0
        for i in range(b * members, (b + 1) * members):
            total += values[i]
        squares += (total / members - middle) * (total / members - middle)
    return squares / sets


@kernel
def _variance_of_bins(values, bins):
    """Variance of the means in bins of equally many draws; ``bins``: of each draw, shape (draws,)."""
    middle, squares = mean(values), 0.0
    for b in range(BINS):
        away = _mean_of_bin(values, bins, b) - middle
        squares += away * away
    return squares / BINS


@kernel
def _mean_of_bin(values, bins, wanted):
    """Mean of the values of the draws in one of the ``BINS`` bins of a source."""
    total = 0.0
    for d in range(values.size):
        if bins[d] == wanted:
            total += values[d]
    return total / (values.size // BINS)


@entry_kernel
def fill_sides(values, bins, found):
    """Mean of the values with a source one standard deviation low and high.

    Parameters
    ----------
    values : of each draw, shape (draws,)
    bins : of each draw by the source, shape (draws,)
    found : both means, each over the bin there and its two neighbours, shape (2,)
    """
    for side in range(2):
        total = 0.0
        for b in range(_ONE_AWAY[side] - 1, _ONE_AWAY[side] + 2):
            total += _mean_of_bin(values, bins, b)
        found[side] = total / 3.0


ACTION, OTHERWISE, FIRST = range(3)
"""Places in what :func:`fill_decision` leaves: what to do, the same if nothing is measured, and the place of the
measurement that comes first, -1 for none."""

LEAST_CHANCE = 0.2
"""With which a measurement must turn the decision round to be named [-]."""


@entry_kernel
def fill_decision(
    values, bins, sources, left, middle, accepted, means, turned, found
):  # fmt: skip
    """Decide what to do: leave the object, secure it, or first measure what may change that decision.

    Parameters
    ----------
    values : of each draw, shape (draws,)
    bins : of each draw by each source, shape (sources, draws)
    sources : numbers of the sources that can be measured, the cheapest first, shape (measurements,)
    left : fraction of its standard deviation that each measurement leaves [-], shape (measurements,)
    middle : mean of the values, which decides
    accepted : largest mean with which the object is left
    means : memory, shape (``BINS``,)
    turned : chance that each measurement changes the decision, and the mean where it does, shape (measurements, 2)
    found : what to do, what to do if nothing is measured, and the first measurement, shape (3,)
    """
    found[OTHERWISE] = SECURE if middle > accepted else LEAVE
    found[FIRST] = -1
    for i in range(sources.size):
        own = bins[sources[i]]
        _fill_turned(values, own, left[i], middle, accepted, means, turned[i])
        if found[FIRST] < 0 and turned[i, 0] >= LEAST_CHANCE:
            found[FIRST] = i
    found[ACTION] = MEASURE if found[FIRST] >= 0 else found[OTHERWISE]


@kernel
def _fill_turned(values, bins, left, middle, accepted, means, found):
    """Chance that measuring a source turns a decision round, and the mean where it does, shape (2,).

    ``left`` is what the measurement leaves of the source's standard deviation; what it says and what is left are
    both normal. Where it never turns it, the mean is that of today. ``means`` is memory, shape (``BINS``,).
    """
    turned, total = 0, 0.0
    for b in range(BINS):
        means[b] = _mean_of_bin(values, bins, b)
    for said in range(BINS):
        mean_then = _mean_once_said(means, left, said)
        if (mean_then > accepted) != (middle > accepted):
            turned += 1
            total += mean_then
    found[0] = turned / BINS
    found[1] = total / turned if turned > 0 else middle


@kernel
def _mean_once_said(means, left, said):
    """Mean of the values after one of ``BINS`` equally likely results of a measurement.

    The bins count by how likely each is then: normal about the result, with ``left`` of the standard deviation
    left. ``means``: of the values in each bin, shape (``BINS``,); ``said``: number of the result.
    """
    if left <= 0.0:
        return means[said]
    measured = math.sqrt(1.0 - left * left) * CENTRES[said]
    total, weights = 0.0, 0.0
    for b in range(BINS):
        z = (CENTRES[b] - measured) / left
        weight = exp(-0.5 * z * z)
        weights += weight
        total += weight * means[b]
    return total / weights


BEFORE, AFTER, FACTOR, LEAST, MOST, HELPS, SHOWN = range(7)
"""Places in what :func:`fill_comparison` leaves: both numbers, their ratio and its limits, whether the change
helps, and whether the motions show that it does, beyond what one earthquake decides."""


@entry_kernel
def fill_comparison(kind, before, after, sets, earthquakes, work, found):
    """Compare shown numbers of the same draws without and with a change.

    Parameters
    ----------
    kind
        ``FRACTION``, ``RATE`` or ``LEVEL``; levels are compared by their medians and help by growing, all else by
        means, and by shrinking
    before, after : shown numbers, shape (draws,) each
    sets : sets of weights of the earthquakes; the draws of one follow each other
    earthquakes : their number; so few as give no verdict give no limits
    work : working memory, shape (2, draws)
    found
        Filled, shape (7,): the numbers before and after, their ratio, the limits of it over the sets, whether the
        change helps and is shown to. NaN is what is not known: the ratio of infinite numbers or to zero.
    """
    _compare(kind, before, after, sets, work, found)
    if are_few(earthquakes):
        found[LEAST], found[MOST] = math.nan, math.nan
    was, now = found[BEFORE], found[AFTER]
    helps = now > was if kind == LEVEL else now < was
    shown = found[LEAST] > 1.0 if kind == LEVEL else found[MOST] < 1.0
    found[HELPS], found[SHOWN] = 1.0 if helps else 0.0, 1.0 if shown else 0.0


@kernel
def _compare(kind, before, after, sets, work, found):
    """Fill both numbers, their ratio and its limits, NaN where there are none (:func:`fill_comparison`)."""
    for place in range(7):
        found[place] = math.nan
    scratch = work[0]
    found[BEFORE] = _centre(kind, before, scratch)
    found[AFTER] = _centre(kind, after, scratch)
    if not _have_ratio(found[BEFORE], found[AFTER]):
        return
    found[FACTOR] = found[AFTER] / found[BEFORE]
    members, count = before.size // sets, 0
    for b in range(sets):
        first, end = b * members, (b + 1) * members
        without = _centre(kind, before[first:end], scratch)
        changed = _centre(kind, after[first:end], scratch)
        if _have_ratio(without, changed):
            work[1, count] = changed / without
            count += 1
    if count > 0:
        ratios = work[1, :count]
        sort(ratios)
        lower = quantile(ratios, count, (1.0 - INSIDE) / 2)
        upper = quantile(ratios, count, (1.0 + INSIDE) / 2)
        # the interval holds the factor of all draws
        found[LEAST] = min(lower, found[FACTOR])
        found[MOST] = max(upper, found[FACTOR])


@kernel
def _have_ratio(before, after):
    """Whether the second number over the first is a finite one."""
    return 0.0 < before < math.inf and after < math.inf


@kernel
def _centre(kind, values, work):
    """Mean of values; of levels the median, the lower of two. ``work`` is memory for at least as many numbers."""
    if kind != LEVEL:
        return mean(values)
    ordered = work[: values.size]
    for i in range(values.size):
        ordered[i] = values[i]
    sort(ordered)
    return ordered[(values.size - 1) // 2]


# ---- what is said first


@entry_kernel
def fill_order(first, second, falling, order):
    """Fill places by the first numbers, of equal ones by the second, of both equal as they come; NaN last.

    ``first``, ``second``, ``order``: shape (n,); ``falling`` turns all of it round.
    """
    for i in range(order.size):
        place = i
        while place > 0 and _comes_before(first, second, i, order[place - 1]):
            order[place] = order[place - 1]
            place -= 1
        order[place] = i
    if falling:
        for i in range(order.size // 2):
            other = order.size - 1 - i
            order[i], order[other] = order[other], order[i]


@kernel
def _comes_before(first, second, i, j):
    """Whether place i comes before place j in the order of :func:`fill_order`."""
    if math.isnan(first[i]) != math.isnan(first[j]):
        return math.isnan(first[j])
    if first[i] != first[j] and not math.isnan(first[i]):
        return first[i] < first[j]
    return second[i] < second[j]


@entry_kernel
def fill_parts(deviations, parts):
    """Fill the part of each source in the variance of an interval [-], shape (sources,).

    ``deviations``: standard deviation by each; zeros where the variance has no bound.
    """
    total = 0.0
    for j in range(deviations.size):
        total += deviations[j] * deviations[j]
    for j in range(parts.size):
        parts[j] = 0.0
        if 0.0 < total < math.inf:
            parts[j] = deviations[j] * deviations[j] / total
