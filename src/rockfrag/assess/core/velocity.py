"""How much a motion's velocity counts beside the measure that is given, by its outcomes; compiled.

P(topples) = Φ(c0 + c1 ln IM + c2 ln PGV/IM) is fitted to the outcomes by the likelihood with Jeffreys's prior,
whose maximum is finite even where a plane parts what falls from what stands (Firth 1993, Biometrika 80: 27). The
weight of ln PGV/IM is c2/c1; its error is that of a jackknife over earthquakes (Tukey 1958).

In: outcomes, levels of IM and PGV/IM by motion. Out: the weight c2/c1 and its error [-].
Theory: ``docs/assess.md``, "Two measures".
"""

import math

from rockfrag.assess.core.compiled import entry_kernel, kernel
from rockfrag.base.exponentials import exp, log, log_normal_cdf

OF_DISPLACEMENT = 2.0
"""Largest weight of ln PGV/IM [-]: a motion stretched in time by r at a given PGA has a PGV larger by r and a
displacement larger by r²."""

MOST_LEVELS = (
    8  # Levels of a motion that are fitted; tests under one motion depend on each other
)

MEMORY = 8  # Numbers of working memory a fitted test, beside ``STATE`` numbers in all
STATE = 32
_STEEPEST = 30.0  # Most standard deviations that a test is taken from the plane
_PASSES = 100
_SETTLED = 1e-11  # Change of coefficients at which a fit has ended
_LOG_ROOT_TWO_PI = 0.5 * math.log(2.0 * math.pi)

WEIGHT, ERROR, FIRST = range(3)
"""Places in what :func:`fill_weight` leaves: weight, standard error, and the first of three coefficients."""

# Columns of the memory of a test: ln IM, ln PGV/IM, whether it fell, number of its earthquake, linear predictor,
# density over the chance of falling and over that of standing, and weight
_X1, _X2, _FELL, _QUAKE, _ETA, _UP, _DOWN, _HERE = range(8)
# Places in the state: coefficients, step and trial, three each, slope of the goal, and the six different entries
# of Fisher's matrix and of its inverse
_C, _STEP, _TRIAL, _SCORE, _FISHER, _INVERSE = 0, 3, 6, 9, 12, 18


@entry_kernel
def fill_weight(
    levels, allowed, overturned, logs, earthquakes, jackknifes, tests, state, found
):
    """Fit the outcomes of motions, and leave what their velocity counts; a weight of NaN where nothing follows.

    Parameters
    ----------
    levels : of shaking, shape (levels,)
    allowed, overturned : what counts, and what topples, shape (motions, levels)
    logs : ln (PGV over the measure [s]) of each motion, shape (motions,)
    earthquakes : number of the earthquake of each motion, shape (motions,)
    jackknifes : whether the error is wanted
    tests : memory, shape (motions × ``MOST_LEVELS``, ``MEMORY``)
    state : memory, shape (``STATE``,)
    found : weight, error and coefficients, shape (5,)
    """
    for place in range(5):
        found[place] = math.nan if place == WEIGHT else 0.0
    count, fell = _gather(levels, allowed, overturned, logs, earthquakes, tests)
    if fell == 0 or fell == count:
        return
    replicates, total, squares = 0, 0.0, 0.0
    for quake in range(-1, _last_quake(tests[:count]) + 1 if jackknifes else 0):
        # all of them first, then without an earthquake each, from the coefficients of all
        for i in range(3):
            state[_C + i] = found[FIRST + i]
        weight = math.nan
        if _fit(tests[:count], float(quake), state) and state[_C + 1] > 0.0:
            weight = state[_C + 2] / state[_C + 1]
        if quake < 0:
            found[WEIGHT] = min(max(weight, 0.0), OF_DISPLACEMENT)
            for i in range(3):
                found[FIRST + i] = state[_C + i]
            if math.isnan(weight):
                found[WEIGHT] = weight
                return
        elif not math.isnan(weight):
            total += weight
            squares += weight * weight
            replicates += 1
    if replicates > 1:
        spread = max(squares - total * total / replicates, 0.0)
        found[ERROR] = math.sqrt((replicates - 1) / replicates * spread)


@kernel
def _last_quake(tests):
    """Largest number of an earthquake among the tests."""
    last = 0.0
    for r in range(tests.shape[0]):
        last = max(last, tests[r, _QUAKE])
    return int(last)


@kernel
def _gather(levels, allowed, overturned, logs, earthquakes, tests):
    """Put every so many tests into memory, at most ``MOST_LEVELS`` a motion; parameters as of :func:`fill_weight`.

    Returned are how many they are, and how many fell.
    """
    step = (levels.size + MOST_LEVELS - 1) // MOST_LEVELS
    count, fell = 0, 0
    for m in range(logs.size):
        for k in range(0, levels.size, step):
            if not allowed[m, k]:
                continue
            test = tests[count]
            test[_X1], test[_X2] = log(levels[k]), logs[m]
            test[_FELL] = 1.0 if overturned[m, k] else 0.0
            test[_QUAKE] = earthquakes[m]
            fell += 1 if overturned[m, k] else 0
            count += 1
    return count, fell


@kernel
def _fit(tests, without, state):
    """Climb from the coefficients of the state to the maximum by Fisher scoring; return whether it was reached.

    ``tests``: memory of the tests, shape (tests, ``MEMORY``); ``without``: number of the earthquake that is left
    out, -1 for none. A step that makes it worse is halved.
    """
    best = -math.inf
    for i in range(3):
        state[_STEP + i] = 0.0
    for _ in range(_PASSES):
        for i in range(3):
            state[_TRIAL + i] = state[_C + i] + state[_STEP + i]
        goal = _likelihood(tests, without, state)
        if not goal > -math.inf:
            return False
        size = 0.0
        for i in range(3):
            size = max(size, abs(state[_STEP + i]))
        if goal < best - 1e-10:
            if size < 1e-14:
                return False
            for i in range(3):
                state[_STEP + i] /= 2.0
            continue
        settled = size < _SETTLED and best > -math.inf
        for i in range(3):
            state[_C + i] = state[_TRIAL + i]
        best = goal
        if settled:
            return True
        _take_step(tests, without, state)
    return False


@kernel
def _likelihood(tests, without, state):
    """Penalised logarithm of the likelihood of the trial; leaves Fisher's matrix and its inverse in the state.

    Parameters as of :func:`_fit`.
    """
    for i in range(6):
        state[_FISHER + i] = 0.0
    goal = 0.0
    for r in range(tests.shape[0]):
        test = tests[r]
        if test[_QUAKE] == without:
            continue
        eta = (
            state[_TRIAL]
            + state[_TRIAL + 1] * test[_X1]
            + state[_TRIAL + 2] * test[_X2]
        )
        eta = min(max(eta, -_STEEPEST), _STEEPEST)
        density = -0.5 * eta * eta - _LOG_ROOT_TWO_PI
        test[_ETA] = eta
        for side in range(2):
            part = log_normal_cdf(eta if side == 0 else -eta)
            test[_UP + side] = exp(density - part)
            if (test[_FELL] > 0.0) == (side == 0):
                goal += part
        test[_HERE] = test[_UP] * test[_DOWN]
        _add_square(state, test[_HERE], test[_X1], test[_X2])
    determinant = _invert(state)
    return goal + 0.5 * log(determinant) if determinant > 0.0 else -math.inf


@kernel
def _add_square(state, weight, x1, x2):
    """Add the weighted square of (1, x1, x2) to Fisher's matrix, whose rows are 11, 12, 13, 22, 23, 33."""
    state[_FISHER] += weight
    state[_FISHER + 1] += weight * x1
    state[_FISHER + 2] += weight * x2
    state[_FISHER + 3] += weight * x1 * x1
    state[_FISHER + 4] += weight * x1 * x2
    state[_FISHER + 5] += weight * x2 * x2


@kernel
def _invert(state):
    """Invert Fisher's matrix by its adjugate, and return its determinant; below 0 where it is singular."""
    a, b, c = state[_FISHER], state[_FISHER + 1], state[_FISHER + 2]
    d, e, f = state[_FISHER + 3], state[_FISHER + 4], state[_FISHER + 5]
    determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)
    if not determinant > 1e-14 * a * d * f:
        return -1.0
    state[_INVERSE] = (d * f - e * e) / determinant
    state[_INVERSE + 1] = (c * e - b * f) / determinant
    state[_INVERSE + 2] = (b * e - c * d) / determinant
    state[_INVERSE + 3] = (a * f - c * c) / determinant
    state[_INVERSE + 4] = (b * c - a * e) / determinant
    state[_INVERSE + 5] = (a * d - b * b) / determinant
    return determinant


@kernel
def _take_step(tests, without, state):
    """Leave in the state the step from the coefficients to where Fisher's matrix expects the maximum.

    The slope of each test has half its leverage times the slope of ln weight added (Firth 1993). Parameters as of
    :func:`_fit`.
    """
    for i in range(3):
        state[_SCORE + i] = 0.0
    # places of the inverse in 11, 12, 13, 22, 23 and 33
    p, q, r = _INVERSE, _INVERSE + 1, _INVERSE + 2
    s, t, u = _INVERSE + 3, _INVERSE + 4, _INVERSE + 5
    for row in range(tests.shape[0]):
        test = tests[row]
        if test[_QUAKE] == without:
            continue
        x1, x2 = test[_X1], test[_X2]
        lever = state[p] + state[q] * x1 + state[r] * x2
        lever += (state[q] + state[s] * x1 + state[t] * x2) * x1
        lever += (state[r] + state[t] * x1 + state[u] * x2) * x2
        value = test[_UP] if test[_FELL] > 0.0 else -test[_DOWN]
        bend = test[_DOWN] - test[_UP] - 2.0 * test[_ETA]
        value += 0.5 * test[_HERE] * lever * bend
        state[_SCORE] += value
        state[_SCORE + 1] += value * x1
        state[_SCORE + 2] += value * x2
    at, by1, by2 = state[_SCORE], state[_SCORE + 1], state[_SCORE + 2]
    state[_STEP] = state[p] * at + state[q] * by1 + state[r] * by2
    state[_STEP + 1] = state[q] * at + state[s] * by1 + state[t] * by2
    state[_STEP + 2] = state[r] * at + state[t] * by1 + state[u] * by2


# ---- the velocity of a site


@entry_kernel
def fill_wanted(levels, lines, wanted):
    """Fill ln (PGV over the measure [s]) expected at levels, shape (levels,).

    ``lines``: of the site, intercept and slope in ln level, shape (facts + 1, 2), of which the first is the mean.
    """
    for k in range(levels.size):
        wanted[k] = lines[0, 0] + lines[0, 1] * log(levels[k])


@entry_kernel
def spread_of_mean(level, rest, lines):
    """Standard deviation of the mean of ln (PGV over the measure) at a level [-].

    By how much it differs where one fact of the site is a standard deviation off is a line in ln level too, one
    for each fact: rows 1 and up of ``lines``, shape (facts + 1, 2). ``rest`` is what remains [-].
    """
    squares = rest * rest
    for i in range(1, lines.shape[0]):
        away = lines[i, 0] + lines[i, 1] * log(level)
        squares += away * away
    return math.sqrt(squares)


@entry_kernel
def shift_by_velocity(weight, spread, error, wanted, middle):
    """Standard deviation of ln level that follows from that of the velocity, and from that of the weight [-].

    The second counts as far as the site's velocity lies from that of the motions.

    Parameters
    ----------
    weight, error : of the velocity, which says how far levels move, and its standard deviation [-]
    spread : standard deviation of ln (PGV over the measure) at the site [-]
    wanted : mean of the same at the site, at each level, shape (levels,)
    middle : median of the same over the motions
    """
    away = 0.0
    for k in range(wanted.size):
        away += abs(wanted[k] - middle)
    away *= error / wanted.size
    return math.sqrt(weight * spread * weight * spread + away * away)


@entry_kernel
def fill_moved(
    levels, allowed, overturned, rocked, logs, wanted, nodes, weight, by_statics, work,
    places, now_allowed, now_overturned, now_rocked,
):  # fmt: skip
    """Take each motion at the level at which it is as strong for the object as with the velocity of the site.

    Parameters
    ----------
    levels : of shaking, rising, shape (levels,)
    allowed, overturned, rocked : outcomes of motions as recorded, shape (motions, levels)
    logs : ln (PGV over the measure [s]) of each motion, shape (motions,)
    wanted : mean of the same at the site, at each level, shape (levels,)
    nodes : values that stand for how it differs about the mean, shape (nodes,)
    weight : of the velocity
    by_statics : whether the level alone decides what rocks
    work : memory, shape (levels,)
    places : levels at which outcomes were taken, shape (motions × nodes, levels)
    now_allowed, now_overturned, now_rocked : outcomes at the site, of the same shape
    """
    size = levels.size
    for k in range(size):
        work[k] = log(levels[k])
    first, last = work[0], work[size - 1]
    for m in range(logs.size):
        for n in range(nodes.size):
            row = m * nodes.size + n
            for k in range(size):
                moved = work[k] + weight * (wanted[k] + nodes[n] - logs[m])
                at = _nearest(work, moved)
                places[row, k] = at
                falls, rocks = overturned[m, at], rocked[m, k]
                inside = allowed[m, at] and first <= moved <= last
                if by_statics:
                    # at a level where it does not rock a motion says nothing of one that makes it rock
                    falls = falls and rocks
                    inside = inside and (rocked[m, at] or not rocks)
                now_allowed[row, k] = inside
                now_overturned[row, k] = falls
                now_rocked[row, k] = rocks or falls


@kernel
def _nearest(logs, moved):
    """Place of the number nearest to ``moved`` among rising ones, shape (levels,)."""
    low, high = 0, logs.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if logs[middle] <= moved:
            low = middle
        else:
            high = middle
    return high if moved - logs[low] > logs[high] - moved else low
