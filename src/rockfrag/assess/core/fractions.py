"""Fractions of motions that topple and rock an object, under each draw of what is not known; compiled.

Errors are of two kinds. Those of statics (width, centre of gravity, floor) move the level u at which a motion
lifts the object and all after it by s of ln level; those after uplift (model, velocity of the site) move by m what
lies beyond it. With F the fraction of motions as counted,

    P(x) = E[F(x exp(-s-m)) 1(x exp(-s) ≥ u)]

motion by motion, so that what does not rock cannot topple, whatever the errors.

In: outcomes by motion and level, the factors that lift, and draws. Out: fractions P, (draws, levels) [-].
Theory: ``docs/assess.md``, "How sure".
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.assess.core.compiled import entry_kernel, kernel
from rockfrag.assess.core.ordering import sort
from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.exponentials import log, normal_cdf

MOTION, LEVEL, FALLS = range(3)
"""Places of what is drawn of an object, by :func:`fill_deciding`."""

CLASSES = 48  # Most levels of uplift that are told apart
ROUNDING = 1e-9  # Of logarithms of levels
LEAST_SPREAD = 0.1  # Least standard deviation of ln capacity of the next earthquake [-]


class Counts(NamedTuple):
    """What motions do to an object, by earthquake, level and the level at which they lift it.

    Attributes
    ----------
    log_levels : rising, shape (levels,)
    toppled : motions that topple it and lift it at one of the first c levels of uplift, shape (earthquakes,
        levels, ``CLASSES`` + 1)
    shaken : motions that can be scaled to the level, shape (earthquakes, levels)
    lifted : motions that lift it at one of the first c levels of uplift, shape (earthquakes, ``CLASSES`` + 1)
    motions : of each earthquake, shape (earthquakes,)
    log_uplifts : levels of uplift, rising, infinite where there are fewer, shape (``CLASSES``,)
    next_one : mean and standard deviation of ln level at which the next earthquake topples it, and of that at
        which it lifts it, shape (4,)
    """

    log_levels: Floats
    toppled: Floats
    shaken: Floats
    lifted: Floats
    motions: Floats
    log_uplifts: Floats
    next_one: Floats


def count_motions(
    levels: Floats,
    overturned: Flags,
    allowed: Flags,
    uplifts: Floats,
    earthquakes: NDArray[np.intp],
) -> Counts:
    """Count outcomes.

    Parameters
    ----------
    levels : of shaking, rising, shape (levels,)
    overturned, allowed : what topples, and what counts, shape (motions, levels)
    uplifts : level at which each motion lifts the object; infinite where none does, shape (motions,)
    earthquakes : number of the earthquake of each motion, from 0, shape (motions,)

    Returns
    -------
    The counts. Where no motion counts at a level, those of the nearest level below.
    """
    count = int(earthquakes.max()) + 1
    found = Counts(
        log_levels=np.zeros(levels.size),
        toppled=np.zeros((count, levels.size, CLASSES + 1)),
        shaken=np.zeros((count, levels.size)),
        lifted=np.zeros((count, CLASSES + 1)),
        motions=np.zeros(count),
        log_uplifts=np.zeros(CLASSES),
        next_one=np.zeros(4),
    )
    fell, counts = np.ascontiguousarray(overturned), np.ascontiguousarray(allowed)
    numbers = np.asarray(earthquakes, dtype=np.int64)
    work = np.zeros((3, len(uplifts)))
    fill_counts(levels, fell, counts, uplifts, numbers, work, *found)
    return found


@entry_kernel
def fill_counts(
    levels, overturned, allowed, uplifts, earthquakes, work, log_levels, toppled,
    shaken, lifted, motions, log_uplifts, next_one,
):  # fmt: skip
    """Fill the arrays of :class:`Counts`, which are zeros, for :func:`count_motions`.

    ``work`` is memory, shape (3, motions): ln levels of uplift in order, of toppling, and class of each motion.
    """
    for k in range(levels.size):
        log_levels[k] = log(levels[k])
    finite = _sorted_logs(uplifts, work[0])
    _choose_classes(work[0], finite, log_uplifts)
    _middle_and_spread(work[0], finite, log_levels[-1], 0.0, next_one[2:])
    fell = 0
    for m in range(uplifts.size):
        quake = earthquakes[m]
        motions[quake] += 1.0
        lifts_at = _class_of(uplifts[m], log_uplifts)
        work[2, m] = lifts_at
        if lifts_at >= 0:
            lifted[quake, lifts_at] += 1.0
        first = _first_level(overturned[m], allowed[m])
        if first >= 0:
            work[1, fell] = log_levels[first]
            fell += 1
    _middle_and_spread(work[1], fell, log_levels[-1], LEAST_SPREAD, next_one[:2])
    nearest = 0
    for k in range(levels.size):
        if _any_allowed(allowed, k):
            nearest = k
        for m in range(uplifts.size):
            if not allowed[m, nearest]:
                continue
            quake = earthquakes[m]
            shaken[quake, k] += 1.0
            if overturned[m, nearest] and work[2, m] >= 0.0:
                toppled[quake, k, int(work[2, m])] += 1.0
    for quake in range(motions.size):
        _add_up(lifted[quake])
        for k in range(levels.size):
            _add_up(toppled[quake, k])


@kernel
def _sorted_logs(levels, logs):
    """Sort the logarithms of finite levels to the front, and return their count."""
    count = 0
    for m in range(levels.size):
        if levels[m] < math.inf:
            logs[count] = log(levels[m])
            count += 1
    sort(logs[:count])
    return count


@kernel
def _choose_classes(ordered, count, classes):
    """Fill levels of uplift to be told apart: all that differ, or of so many groups of motions the least of each.

    ``ordered``: ln level of uplift of the first ``count`` motions, rising; ``classes``: filled, infinite where
    there are fewer, shape (``CLASSES``,).
    """
    known = 0
    for i in range(count):
        if i == 0 or ordered[i] > ordered[i - 1]:
            known += 1
    for place in range(classes.size):
        classes[place] = math.inf
    seen, place = 0, 0
    for i in range(count):
        if i > 0 and not ordered[i] > ordered[i - 1]:
            continue
        wanted = place if known <= classes.size else place * known // classes.size
        if seen == wanted and place < classes.size:
            classes[place] = ordered[i]
            place += 1
        seen += 1


@kernel
def _class_of(uplift, classes):
    """Number of levels of uplift, whose logarithms are ``classes``, that do not exceed one; -1 where infinite."""
    if not uplift < math.inf:
        return -1
    own, place = log(uplift), 0
    while place < classes.size and classes[place] <= own:
        place += 1
    return place


@kernel
def _first_level(overturned, allowed):
    """Number of the first level at which a motion topples the object, else of the last at which it counts, or -1.

    ``overturned``, ``allowed``: of one motion, shape (levels,).
    """
    last = -1
    for k in range(allowed.size):
        if allowed[k]:
            if overturned[k]:
                return k
            last = k
    return last


@kernel
def _any_allowed(allowed, level):
    """Whether any motion may be scaled to the level of a number; ``allowed``: shape (motions, levels)."""
    for m in range(allowed.shape[0]):  # noqa: SIM110 (a kernel has no generators)
        if allowed[m, level]:
            return True
    return False


@kernel
def _add_up(row):
    """Replace each number of a row by the sum of all up to it."""
    for i in range(1, row.size):
        row[i] += row[i - 1]


@kernel
def _middle_and_spread(logs, count, otherwise, least, found):
    """Fill mean and standard deviation, at least ``least``, of the first ``count`` logarithms, shape (2,).

    Without any the mean is ``otherwise``, and the deviation ``LEAST_SPREAD`` or more.
    """
    if count == 0:
        found[0], found[1] = otherwise, max(least, LEAST_SPREAD)
        return
    total, squares = 0.0, 0.0
    for i in range(count):
        total += logs[i]
    middle = total / count
    for i in range(count):
        squares += (logs[i] - middle) * (logs[i] - middle)
    found[0], found[1] = middle, max(math.sqrt(squares / count), least)


# ---- under each draw


def draw_fractions(
    counts: Counts, weights: Floats, normals: Floats, shifts: Floats
) -> tuple[Floats, Floats]:
    """Fractions of motions under each draw.

    Parameters
    ----------
    counts : what motions do to the object
    weights : of each earthquake and the next one, shape (blocks, earthquakes + 1)
    normals : standard normal values of the sources, shape (draws, sources), blocks one after the other
    shifts : what each source moves of ln level of uplift and of toppling, shape (sources, 2)

    Returns
    -------
    Fraction that topples and that rocks the object at each level, shape (draws, levels); never more topple than
    rock.
    """
    toppling = np.zeros((len(normals), counts.log_levels.size))
    rocking = np.zeros_like(toppling)
    given = (np.ascontiguousarray(each) for each in (weights, normals, shifts))
    fill_fractions(*counts, *given, toppling, rocking)
    return toppling, rocking


@entry_kernel
def fill_fractions(
    log_levels, toppled, shaken, lifted, motions, log_uplifts, next_one, weights,
    normals, shifts, toppling, rocking,
):  # fmt: skip
    """Fill both tables of :func:`draw_fractions`, by the fields of a :class:`Counts` and the draws.

    In a draw the object rocks and topples at a level as it does, without what moves it, at one lower by ``lifts``
    and by ``topples`` in ln of the measure. Between two levels fractions are straight lines. The next earthquake
    has normal distributions of its own, and its weight.
    """
    x, size = log_levels, log_levels.size
    draws, blocks = toppling.shape[0], weights.shape[0]
    quakes = motions.size
    for d in range(draws):
        w = weights[d * blocks // draws]
        lifts, topples = 0.0, 0.0
        for j in range(shifts.shape[0]):
            lifts += normals[d, j] * shifts[j, 0]
            topples += normals[d, j] * shifts[j, 1]
        # weight of the next earthquake, and of the motions of those that are known
        own, total = w[quakes], 0.0
        for e in range(quakes):
            total += w[e] * motions[e]
        # as levels rise: number of levels of uplift that are reached, and level below that of toppling
        place, at = 0, 0
        for k in range(size):
            # ln levels at which it would rock and topple as much if nothing moved it
            y, v = x[k] - lifts, x[k] - topples
            while place < log_uplifts.size and log_uplifts[place] <= y + ROUNDING:
                place += 1
            while at < size - 2 and x[at + 1] <= v:
                at += 1
            along = 0.0
            if size > 1:
                along = min(max((v - x[at]) / (x[at + 1] - x[at]), 0.0), 1.0)
            fell, rocks = 0.0, 0.0
            if along < 1.0:
                fell += (1.0 - along) * _weighted(w, toppled, shaken, at, place)
            if along > 0.0:
                fell += along * _weighted(w, toppled, shaken, at + 1, place)
            for e in range(quakes):
                rocks += w[e] * lifted[e, place]
            lifts_next = _part(y, next_one[2], next_one[3])
            falls_next = min(_part(v, next_one[0], next_one[1]), lifts_next)
            rocking[d, k] = (1.0 - own) * rocks / total + own * lifts_next
            falls = (1.0 - own) * fell + own * falls_next
            toppling[d, k] = min(falls, rocking[d, k])


@kernel
def _part(value, middle, spread):
    """Normal distribution function of a value with a middle and a spread; a step where there is no spread."""
    if spread <= 0.0:
        return 1.0 if value - middle >= -ROUNDING else 0.0
    return normal_cdf((value - middle) / spread)


@kernel
def _weighted(weights, toppled, shaken, level, place):
    """Fraction of the motions at a level, with the weights of their earthquakes, that topple the object.

    Only those count that lift it at one of the first ``place`` levels of uplift. ``weights``: of the earthquakes;
    ``toppled`` and ``shaken`` as of :class:`Counts`.
    """
    fell, total = 0.0, 0.0
    for e in range(shaken.shape[0]):
        total += weights[e] * shaken[e, level]
        fell += weights[e] * toppled[e, level, place]
    return fell / total if total > 0.0 else 0.0


# ---- as counted


@entry_kernel
def fill_uplifts(levels, rocked, overturned, allowed, lifting, uplifts):
    """Fill the level at which each motion lifts the object: by statics, or the first at which it moves.

    What rocks was lifted, whatever rounding says; infinite where nothing lifts it.

    Parameters
    ----------
    levels : rising, shape (levels,)
    rocked, overturned, allowed : outcomes, and whether they count, shape (motions, levels)
    lifting : level by statics, shape (motions,)
    uplifts : filled, shape (motions,)
    """
    for m in range(uplifts.size):
        uplifts[m] = lifting[m]
        for k in range(levels.size):
            if allowed[m, k] and (rocked[m, k] or overturned[m, k]):
                uplifts[m] = min(levels[k], lifting[m])
                break


@entry_kernel
def fill_counts_at(levels, level, allowed, rocked, overturned, found):
    """Fill how many motions count at a level, rock and topple the object there, shape (3,).

    Zeros where it is none of the ``levels``; the others have the shape (motions, levels).
    """
    for place in range(3):
        found[place] = 0.0
    for k in range(levels.size):
        if levels[k] != level:
            continue
        for m in range(allowed.shape[0]):
            if allowed[m, k]:
                found[0] += 1.0
                found[1] += 1.0 if rocked[m, k] else 0.0
                found[2] += 1.0 if overturned[m, k] else 0.0


@entry_kernel
def fill_deciding(levels, allowed, overturned, level, found):
    """Which motion topples an object first, and at which level; at the site's level the first one where none does.

    Parameters
    ----------
    levels : rising, shape (levels,)
    allowed, overturned : of each motion and level, shape (motions, levels)
    level : of the site
    found : the motion, the level and whether it topples then, shape (3,)
    """
    found[MOTION], found[LEVEL], found[FALLS] = 0.0, level, 0.0
    for k in range(levels.size):
        for m in range(overturned.shape[0]):
            if allowed[m, k] and overturned[m, k]:
                found[MOTION], found[LEVEL], found[FALLS] = m, levels[k], 1.0
                return


@entry_kernel
def fill_counted(happened, allowed, weights, fractions):
    """Fill the fraction of the weighted motions to which something happened at each level [-], shape (levels,).

    A motion that cannot be scaled so far is left out of a level; where none can, the fraction of the nearest level
    below is kept, and nothing happens below the lowest level. ``happened``, ``allowed``: shape (motions, levels);
    ``weights``: shape (motions,).
    """
    last = 0.0
    for k in range(fractions.size):
        some, total = 0.0, 0.0
        for m in range(weights.size):
            if allowed[m, k]:
                total += weights[m]
                if happened[m, k]:
                    some += weights[m]
        if total > 0.0:
            last = some / total
        fractions[k] = last


LEAST_SPAN = 0.05
"""Span of the fractions of motions over all levels below which they say nothing of shifts [-]."""


@entry_kernel
def fill_shift(levels, lower, upper, lower_uplifts, upper_uplifts, found):
    """Fill what a property moves at its standard deviation: ln level of uplift, and of toppling, shape (2,).

    Levels of uplift move by the mean over the motions; those of toppling by the area between both fractions over
    ln level, which of a curve that is moved is the move times its height.

    Parameters
    ----------
    levels : rising, shape (levels,)
    lower, upper : fractions that topple with the property low and high, shape (levels,)
    lower_uplifts, upper_uplifts : levels of uplift then, shape (motions,)
    """
    found[0] = (_mean_log(upper_uplifts) - _mean_log(lower_uplifts)) / 2
    found[1] = found[0]
    most, area = 0.0, 0.0
    for k in range(levels.size):
        most = max(most, (lower[k] + upper[k]) / 2)
        if k > 0:
            both = lower[k - 1] - upper[k - 1] + lower[k] - upper[k]
            area += log(levels[k] / levels[k - 1]) * both / 2
    span = most - (lower[0] + upper[0]) / 2
    if span >= LEAST_SPAN:
        found[1] = area / 2 / span


@kernel
def _mean_log(levels):
    """Mean of the logarithms of the finite levels, shape (motions,); 0 if there are none."""
    total, count = 0.0, 0
    for m in range(levels.size):
        if levels[m] < math.inf:
            total += log(levels[m])
            count += 1
    return total / count if count > 0 else 0.0
