"""What many objects risk together: how often so many topple, and so much is lost, in one earthquake.

All objects are shaken by the same motions, so what topples together is counted and not assumed. So much or more is
lost as if it were one object: a motion topples it where it topples enough of them, and so it lifts it.

In: objects, assessed under the same motions. Out: annual rates [1/year] and probabilities in the years asked for.
Docs: ``docs/assess.md``, "A gallery".
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from rockfrag.assess.answer import Assessment
from rockfrag.assess.core.draws import FEW_MEMBERS
from rockfrag.assess.core.prediction import Shift
from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import Evidence, after_uplift, risk_target, toppling_rate
from rockfrag.base.arrays import Flags, Floats

NUMBERS = (1, 2, 3, 5, 10, 20, 30, 50, 100, 200, 300, 500, 1000, 2000, 5000, 10_000)
"""Numbers of objects of which it is said how often so many topple together."""

LOSSES = 24  # Losses of which it is said how often they are exceeded

OF_NO_BODY = ("model", "space", "conversion")
"""Sources of uncertainty that all objects share: of the model, and of the hazard's measure at the site."""

_ROUNDING = 1e-12
"""Of a sum of values, which must not take away what reaches a loss exactly."""


@dataclass(frozen=True, eq=False)
class JointRisk:
    """What an inventory risks together, in earthquakes that shake all of it."""

    # A row an object: ``name``, ``annual_rate`` of toppling, ``value``, mean ``annual_loss``, its ``contribution``
    objects: pd.DataFrame
    # A row a number of objects: ``at_least``, ``annual_rate`` of earthquakes that topple so many,
    # ``probability`` of one in the years asked for with limits (``probability_lower``,
    # ``probability_upper``), and ``at_the_site``, the fraction of motions at the site's level
    numbers: pd.DataFrame
    # A row a loss: ``loss``, and ``annual_rate`` with which one exceeds it
    losses: pd.DataFrame
    # Rate of earthquakes that topple both of two objects over the geometric mean of their rates [-]; or NaN
    correlation: pd.DataFrame


def joint_risk(found: Sequence[Assessment]) -> JointRisk | None:
    """Count what topples together, no value as 1; None without a hazard, or with objects in several measures."""
    hazard = found[0].hazard
    if hazard is None or any(
        assessment.measure != found[0].measure for assessment in found
    ):
        return None
    fell = np.array([assessment.outcomes.overturned for assessment in found])
    # with the velocity of the site a motion stands for several; all objects have the same of them
    intensity_levels = found[0].outcomes.intensity_levels
    allowed = np.logical_and.reduce(
        [assessment.outcomes.intensity_levels.allowed for assessment in found]
    )
    levels = intensity_levels.levels
    per_level = np.array(
        [toppling_rate(levels, unit, hazard) for unit in np.eye(levels.size)]
    )
    rates = np.array([annual_rate(assessment.evidence, hazard) for assessment in found])
    values = np.array([assessment.request.value for assessment in found])
    worth = np.where(np.isfinite(values), values, 1.0)
    together = replace(
        found[0].outcomes, intensity_levels=replace(intensity_levels, allowed=allowed)
    )
    lifting = np.array([assessment.outcomes.lifts_from() for assessment in found])
    order = np.argsort(lifting, axis=0, kind="stable")
    rising = np.take_along_axis(lifting, order, axis=0)
    evidence = [assessment.evidence for assessment in found]
    shared = _shared(evidence)
    weighed = [
        _Together(
            evidence=evidence,
            rates=rates,
            shared=shared,
            worth=each,
            outcomes=together,
            toppled=np.tensordot(each, fell, axes=1),
            lifting=rising,
            lifted=np.cumsum(each[order], axis=0),
        )
        for each in (np.ones(len(found)), worth)
    ]
    counted, valued = weighed
    names = [assessment.request.name for assessment in found]
    correlation = _correlation(fell, allowed, per_level)
    return JointRisk(
        _by_object(names, rates, worth),
        _numbers(counted, found[0]),
        _losses(valued, hazard),
        pd.DataFrame(correlation, index=pd.Index(names, name="name"), columns=names),
    )


@dataclass(frozen=True)
class _Together:
    """What motions do to all objects, each of which counts with its worth."""

    evidence: Sequence[Evidence]  # An entry an object
    rates: Floats  # Annual rates of toppling [1/year], shape (objects,)
    shared: Mapping[str, Shift]  # What is not known of all of them, by source
    worth: Floats  # What each counts, shape (objects,)
    outcomes: ObjectOutcomes  # Of one object, with the levels that are allowed for all
    toppled: Floats  # Worth of what a motion topples, shape (motions, levels)
    # Levels at which motions lift objects, rising, shape (objects, motions)
    lifting: Floats
    lifted: Floats  # Worth of what is lifted from there, shape (objects, motions)

    def losing(self, least: float, hazard: HazardCurve) -> tuple[Evidence, float]:
        """Evidence on so much worth toppling in one earthquake, and how often that happens [1/year].

        What is not known of one body says nothing of the others, so only what all share is drawn. An object that
        is worth so much by itself topples no oftener than so much is lost: where its own uncertainties give it
        the greater rate, as under a steep hazard, its evidence stands.
        """
        enough = least * (1.0 - _ROUNDING)
        overturned = self.toppled >= enough
        lifts = self.lifted >= enough
        first = np.argmax(lifts, axis=0)[np.newaxis]
        lifting = np.take_along_axis(self.lifting, first, axis=0)[0]
        outcomes = replace(
            self.outcomes,
            overturned=overturned,
            rocked=overturned,
            lifting=np.where(lifts.any(axis=0), lifting, np.inf),
        )
        of_all = Evidence(outcomes, self.shared, members=FEW_MEMBERS)
        rate = annual_rate(of_all, hazard)
        alone = np.where(self.worth >= enough, self.rates, 0.0)
        most = int(np.argmax(alone))
        if alone[most] > rate:
            return self.evidence[most], float(alone[most])
        return of_all, rate


def annual_rate(evidence: Evidence, hazard: HazardCurve) -> float:
    """Rate of toppling, the mean over what is not known [1/year]."""
    # not of the probability, which is 1 for all rates far above one in its years
    return evidence.drawn(risk_target(hazard, 1.0)).middle


def _shared(evidence: Sequence[Evidence]) -> dict[str, Shift]:
    """What each source that is of no body moves in all objects alike: the least of what it moves in one."""
    return {
        name: min(
            (each.shifts.get(name, after_uplift(0.0)) for each in evidence),
            key=lambda shift: abs(shift.topples),
        )
        for name in OF_NO_BODY
    }


def _by_object(names: list[str], rates: Floats, worth: Floats) -> pd.DataFrame:
    """Annual rates and losses by object, and the fraction of the loss that each adds."""
    losses = rates * worth
    table = pd.DataFrame(
        {"name": names, "annual_rate": rates, "value": worth, "annual_loss": losses}
    )
    table["contribution"] = losses / losses.sum() if losses.sum() > 0 else np.nan
    return table.sort_values(
        "annual_loss", ascending=False, kind="stable", ignore_index=True
    )


def _numbers(counted: _Together, first: Assessment) -> pd.DataFrame:
    """How often at least so many topple, with what earthquakes and the model leave open."""
    assert first.hazard is not None and first.level is not None
    target = risk_target(first.hazard, first.request.years)
    at = counted.outcomes.intensity_levels.place_of(first.level.value)
    rows = []
    for least in [n for n in NUMBERS if n <= counted.toppled.max()] or [1]:
        evidence, rate = counted.losing(least, first.hazard)
        found = evidence.estimate(target)
        reached = replace(counted.outcomes, overturned=counted.toppled >= least)
        limits = found.value, found.lower, found.upper
        rows.append((least, rate, *limits, reached.fractions()[at]))
    chances = ("probability", "probability_lower", "probability_upper")
    return pd.DataFrame(
        rows, columns=["at_least", "annual_rate", *chances, "at_the_site"]
    )


def _losses(valued: _Together, hazard: HazardCurve) -> pd.DataFrame:
    """How often losses are exceeded [1/year], from the least object to everything."""
    steps, lost = np.zeros(0), valued.toppled
    if lost.any():
        least = max(lost[lost > 0].min(), 1e-6 * lost.max())
        steps = np.geomspace(least, lost.max(), LOSSES)
    exceeded = [valued.losing(step, hazard)[1] for step in steps]
    return pd.DataFrame({"loss": steps, "annual_rate": exceeded})


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
