"""Many objects under the same motions: how many topple in one earthquake, what is lost, and which belong together.

All objects are shaken by the same ground motions, scaled to the same level, so that what topples together in an
earthquake is counted and not assumed.  Rates follow from fractions of motions and the hazard as those of one
object do (:mod:`rockfrag.assess.risk`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.arrays import Flags, Floats
from rockfrag.assess.answer import Assessment
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import Evidence, probability_in, risk_target, toppling_rate
from rockfrag.assess.sources import SPACE
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS

NUMBERS = (1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 300, 500, 1000, 2000, 5000, 10_000)
"""Numbers of objects of which it is said how often so many topple together."""

LOSSES = 24  # Losses of which it is said how often they are exceeded


@dataclass(frozen=True, eq=False)
class JointRisk:
    """What an inventory risks together, in earthquakes that shake all of it."""

    # A row an object: ``name``, ``annual_rate`` of toppling, ``value``, ``annual_loss`` (mean) and
    # ``contribution`` to that of all
    objects: pd.DataFrame
    # A row a number of objects: ``at_least``, ``annual_rate`` of earthquakes that topple so many,
    # ``probability`` of one in the years asked for with limits (``probability_lower``,
    # ``probability_upper``), and ``at_the_site``, the fraction of motions at the site's level
    numbers: pd.DataFrame
    # A row a loss: ``loss`` and ``annual_rate`` with which an earthquake exceeds it
    losses: pd.DataFrame
    # Correlation of the toppling of each two objects in time: the rate of earthquakes that topple
    # both over the geometric mean of the rates of each [-].  NaN where one never topples
    correlation: pd.DataFrame


def joint_risk(found: Sequence[Assessment]) -> JointRisk | None:
    """Count what topples together; an object of no given value counts as 1.

    None without a hazard, or where objects are counted in different measures.
    """
    hazard = found[0].hazard
    if hazard is None or any(assessment.measure != found[0].measure for assessment in found):
        return None
    outcomes = [assessment.outcomes for assessment in found]
    # with the velocity of the site a motion stands for several; all objects have the same of them
    intensity_levels = outcomes[0].intensity_levels
    fell = np.array([outcome.overturned for outcome in outcomes])
    allowed = np.logical_and.reduce([outcome.intensity_levels.allowed for outcome in outcomes])
    together = replace(outcomes[0], intensity_levels=replace(intensity_levels, allowed=allowed))
    values = np.array([assessment.request.value for assessment in found])
    worth = np.where(np.isfinite(values), values, 1.0)
    levels = intensity_levels.levels
    per_level = np.array([toppling_rate(levels, unit, hazard) for unit in np.eye(levels.size)])
    rates = np.array([toppling_rate(levels, each.fractions(), hazard) for each in outcomes])
    names = [assessment.request.name for assessment in found]
    correlation = _correlation(fell, allowed, per_level)
    return JointRisk(
        _by_object(names, rates, worth),
        _numbers(found[0], together, fell.sum(axis=0)),
        _losses(together, fell, worth, per_level),
        pd.DataFrame(correlation, index=pd.Index(names, name="name"), columns=names),
    )


def _by_object(names: list[str], rates: Floats, worth: Floats) -> pd.DataFrame:
    losses = rates * worth
    table = pd.DataFrame(
        {"name": names, "annual_rate": rates, "value": worth, "annual_loss": losses}
    )
    table["contribution"] = losses / losses.sum() if losses.sum() > 0 else np.nan
    return table.sort_values("annual_loss", ascending=False, kind="stable", ignore_index=True)


def _numbers(first: Assessment, together: ObjectOutcomes, count: NDArray[np.int64]) -> pd.DataFrame:
    """How often at least so many topple, with what earthquakes and the model leave open."""
    assert first.hazard is not None and first.level is not None
    years = first.request.years
    target = risk_target(first.hazard, years)
    # what is not known of one body says nothing about the others; these two are common to all
    shifts = {"model": MODEL_ERRORS[CUT].blind, "space": SPACE}
    at = together.intensity_levels.place_of(first.level.value)
    rows = []
    for least in [n for n in NUMBERS if n <= count.max()] or [1]:
        many = replace(together, overturned=count >= least, rocked=np.ones_like(together.rocked))
        fractions = many.fractions()
        found = Evidence(many, shifts=shifts).estimate(target)
        rate = toppling_rate(many.intensity_levels.levels, fractions, first.hazard)
        rows.append(
            {
                "at_least": least,
                "annual_rate": rate,
                "probability": probability_in(rate, years),
                "probability_lower": found.lower,
                "probability_upper": found.upper,
                "at_the_site": fractions[at],
            }
        )
    return pd.DataFrame(rows)


def _losses(
    together: ObjectOutcomes, fell: Flags, worth: Floats, per_level: Floats
) -> pd.DataFrame:
    """How often losses are exceeded, from the least object to everything."""
    lost = np.tensordot(worth, fell, axes=1)
    if not lost.any():
        return pd.DataFrame({"loss": [], "annual_rate": []})
    steps = np.geomspace(max(lost[lost > 0].min(), 1e-6 * lost.max()), lost.max(), LOSSES)
    # rounding must not take away what reaches a step exactly
    rates = [
        float(replace(together, overturned=lost >= step * (1 - 1e-12)).fractions() @ per_level)
        for step in steps
    ]
    return pd.DataFrame({"loss": steps, "annual_rate": rates})


def _correlation(fell: Flags, allowed: Flags, per_level: Floats) -> Floats:
    """Rates of toppling together over the geometric mean of those of each, shape (objects, objects)."""
    known = allowed.any(axis=0)
    at = np.maximum.accumulate(np.where(known, np.arange(known.size), 0))
    weight = np.bincount(at, per_level, minlength=known.size)
    both = np.zeros((len(fell), len(fell)))
    for level in np.flatnonzero(known & (weight != 0)):
        here = fell[:, allowed[:, level], level].astype(np.float64)
        both += weight[level] / here.shape[1] * (here @ here.T)
    alone = np.diag(both)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(both / np.sqrt(np.outer(alone, alone)))
