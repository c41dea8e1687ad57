"""Fractions of motions that topple and rock an object, under each draw of what is not known.

Errors are of two kinds. Those of statics (width, centre of gravity, floor) move the level u at which a motion
lifts the object and all after it by s of ln level; those after uplift (model, velocity of the site) move by m what
lies beyond it. With F the fraction of motions as counted,

    P(x) = E[F(x exp(-s-m)) 1(x exp(-s) ≥ u)]

motion by motion, so that what does not rock cannot topple, whatever the errors.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import Flags, Floats
from rockfrag.runtime.machine_code import cached_njit

CLASSES = 48  # Most levels of uplift that are told apart
ROUNDING = 1e-9  # Of logarithms of levels
LEAST_SPREAD = 0.1  # Least standard deviation of ln capacity of the next earthquake [-]


class Counts(NamedTuple):
    """What motions do to an object, by earthquake, level and the level at which they lift it.

    Attributes
    ----------
    log_levels : rising, shape (levels,)
    toppled : motions that topple it and lift it at one of the first c levels of uplift, shape (earthquakes,
        levels, classes + 1)
    shaken : motions that can be scaled to the level, shape (earthquakes, levels)
    lifted : motions that lift it at one of the first c levels of uplift, shape (earthquakes, classes + 1)
    motions : of each earthquake, shape (earthquakes,)
    log_uplifts : levels of uplift, rising, shape (classes,)
    topples_next, lifts_next : mean and standard deviation of ln level at which the next earthquake topples it,
        and of that at which it lifts it, shape (2,) each
    """

    log_levels: Floats
    toppled: Floats
    shaken: Floats
    lifted: Floats
    motions: Floats
    log_uplifts: Floats
    topples_next: Floats
    lifts_next: Floats


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
    log_levels = np.log(levels)
    count, known = int(earthquakes.max()) + 1, allowed.any(axis=0)
    nearest = np.maximum.accumulate(np.where(known, np.arange(levels.size), 0))
    with np.errstate(divide="ignore"):
        log_uplifts = np.log(uplifts)
    classes = _classes(log_uplifts)
    place = classes.searchsorted(log_uplifts, side="right")
    toppled = np.zeros((count, levels.size, classes.size + 1))
    shaken = np.zeros((count, levels.size))
    lifted = np.zeros((count, classes.size + 1))
    np.add.at(shaken, earthquakes, allowed[:, nearest].astype(np.float64))
    lifts = np.isfinite(log_uplifts)
    np.add.at(lifted, (earthquakes[lifts], place[lifts]), 1.0)
    fell = (overturned & allowed)[:, nearest] & lifts[:, np.newaxis]
    motion, level = np.nonzero(fell)
    np.add.at(toppled, (earthquakes[motion], level, place[motion]), 1.0)
    fell_at = _first_levels(log_levels, overturned & allowed, allowed)
    topples_next = _middle_and_spread(fell_at, log_levels[-1], LEAST_SPREAD)
    return Counts(
        log_levels,
        toppled.cumsum(axis=2),
        shaken,
        lifted.cumsum(axis=1),
        np.bincount(earthquakes, minlength=count).astype(np.float64),
        classes,
        topples_next,
        _middle_and_spread(log_uplifts[lifts], log_levels[-1], 0.0),
    )


def _classes(log_uplifts: Floats) -> Floats:
    """Levels of uplift that are told apart: all, or of groups of equally many motions the least."""
    known = np.unique(log_uplifts[np.isfinite(log_uplifts)])
    if known.size <= CLASSES:
        return known
    return known[np.linspace(0, known.size, CLASSES, endpoint=False).astype(np.intp)]


def _first_levels(log_levels: Floats, fell: Flags, allowed: Flags) -> Floats:
    """Ln level at which each motion topples it; where none does, the highest one at which it counts."""
    last = log_levels.size - 1 - allowed[:, ::-1].argmax(axis=1)
    place = np.where(fell.any(axis=1), fell.argmax(axis=1), last)
    return np.asarray(log_levels[place[allowed.any(axis=1)]])


def _middle_and_spread(logs: Floats, otherwise: float, least: float) -> Floats:
    """Mean and standard deviation of logarithms, at least ``least``; ``otherwise`` where there are none."""
    if not logs.size:
        return np.array([otherwise, max(least, LEAST_SPREAD)])
    return np.array([logs.mean(), max(float(logs.std()), least)])


@cached_njit()
def _part(value: float, middle_and_spread: Floats) -> float:
    """Normal distribution function; a step where there is no spread."""
    above = value - middle_and_spread[0]
    if middle_and_spread[1] <= 0.0:
        return 1.0 if above >= -ROUNDING else 0.0
    return 0.5 * math.erfc(-above / middle_and_spread[1] / math.sqrt(2.0))


@cached_njit()
def _weighted(counts: Counts, weights: Floats, level: int, lifted: int) -> float:
    """Fraction of the weighted motions at a level that topple the object and lift it at some of the levels."""
    fell, total = 0.0, 0.0
    for e in range(counts.shaken.shape[0]):
        total += weights[e] * counts.shaken[e, level]
        fell += weights[e] * counts.toppled[e, level, lifted]
    return fell / total if total > 0.0 else 0.0


@cached_njit()
def draw_fractions(
    counts: Counts, weights: Floats, lifts: Floats, topples: Floats
) -> tuple[Floats, Floats]:
    """Fractions of motions under each draw.

    Parameters
    ----------
    counts : what motions do to the object
    weights : of each earthquake and the next one, shape (blocks, earthquakes + 1)
    lifts, topples : error of ln level of uplift and of toppling in each draw, blocks one after the other, shape
        (draws,)

    Returns
    -------
    Fraction that topples and that rocks the object at each level, shape (draws, levels); never more topple than
    rock.
    """
    x = counts.log_levels
    size, draws = x.size, lifts.size
    members = draws // weights.shape[0]
    quakes = counts.shaken.shape[0]
    toppling = np.zeros((draws, size))
    rocking = np.zeros((draws, size))
    for d in range(draws):
        w = weights[d // members]
        own = w[quakes]
        at, lifted, total = 0, 0, 0.0
        for e in range(quakes):
            total += w[e] * counts.motions[e]
        for k in range(size):
            y, v = x[k] - lifts[d], x[k] - topples[d]
            while lifted < counts.log_uplifts.size and (
                counts.log_uplifts[lifted] <= y + ROUNDING
            ):
                lifted += 1
            while at < size - 2 and x[at + 1] <= v:
                at += 1
            along = 0.0
            if size > 1:
                along = min(max((v - x[at]) / (x[at + 1] - x[at]), 0.0), 1.0)
            fell = 0.0
            if along < 1.0:
                fell += (1.0 - along) * _weighted(counts, w, at, lifted)
            if along > 0.0:
                fell += along * _weighted(counts, w, at + 1, lifted)
            rocks = 0.0
            for e in range(quakes):
                rocks += w[e] * counts.lifted[e, lifted]
            lifts_next = _part(y, counts.lifts_next)
            falls_next = min(_part(v, counts.topples_next), lifts_next)
            rocking[d, k] = (1.0 - own) * rocks / total + own * lifts_next
            toppling[d, k] = min((1.0 - own) * fell + own * falls_next, rocking[d, k])
    return toppling, rocking
