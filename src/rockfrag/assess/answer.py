"""The answer: one object at one place, assessed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import special

from rockfrag.assess.conversion import Conversion, find_conversion
from rockfrag.assess.direction import Directions, find_directions
from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.hazard.measure import PGA, Measure
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.moved import Moved
from rockfrag.assess.remedies import Remedy, compare, remedies_of
from rockfrag.assess.request import Level, Request
from rockfrag.assess.risk import (
    Estimate,
    Target,
    amplitude_target,
    estimate,
    estimate_rocking,
    risk_target,
    share_target,
)
from rockfrag.assess.rules import RuleCheck, check_rules
from rockfrag.assess.sources import SPACE
from rockfrag.assess.verdicts import (
    FEW_LEVELS,
    LEVELS,
    Ladder,
    Verdicts,
    make_ladder,
    share_with_sliding,
    verdicts_of,
    verdicts_of_all,
)
from rockfrag.errors import InputError
from rockfrag.fragility.curve_facts import BETA_MODEL
from rockfrag.fragility.estimators import Fragility, fragility_of
from rockfrag.short_repr import short_repr

RECORDS = "resources/records"
"""Folder of fetched records."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Assessment:
    """All that is known of one object at one place.

    Attributes
    ----------
    request
        What was asked.
    motions
        The motions.
    level
        Level of shaking at the site; None if neither level nor hazard was given.
    hazard
        The hazard curve that was used; None if none was given.
    arrangements
        Verdicts of each way in which the object can stand, as it stands first.
    rocking
        Share of the motions at the level that make it rock; None without a level.
    rocks_from
        Least level at which any motion makes it rock, in the measure's unit; infinite where none does.
    share
        Share of the motions at the level that topple it; None without a level.
    probability
        Probability of toppling in the years asked for; None without a hazard.
    counts
        Number of motions that reach the level, and of those that make it rock and topple it there; None without a
        level, and where the level is beyond what any motion may be scaled to.
    amplitudes
        Levels at which a tenth and half of the motions topple it, by share.
    by_arrangement
        What is estimated of each arrangement.
    curve
        Lognormal fragility curve, with parameters that are NaN where the verdicts give none; None if none
        was fitted.
    conversion
        What hazard in another measure than PGV leaves open; None in PGV.
    directions
        The worst direction; None where no record has two components.
    remedies
        What helps, most helpful first.
    effects
        What each assumption does to the answer: what is estimated with it smaller and larger.
    rules
        Engineers' rules held against the verdicts.
    sliding_share
        Share of the motions at the level that topple it if it may slide [-]; NaN without friction or level.
    """

    request: Request
    motions: MotionSet
    level: Level | None
    hazard: HazardCurve | None
    arrangements: Mapping[str, Verdicts]
    rocking: Estimate | None
    rocks_from: float
    share: Estimate | None
    probability: Estimate | None
    counts: tuple[int, int, int] | None
    amplitudes: Mapping[float, Estimate]
    by_arrangement: Mapping[str, float]
    curve: Fragility | None
    conversion: Conversion | None
    directions: Directions | None
    remedies: tuple[Remedy, ...]
    effects: tuple[Moved[float], ...]
    rules: tuple[RuleCheck, ...]
    sliding_share: float

    __repr__ = short_repr

    @property
    def measure(self) -> Measure:
        """Measure of the levels."""
        return self.verdicts.ladder.measure

    @property
    def verdicts(self) -> Verdicts:
        """Verdicts of the object as it stands."""
        return next(iter(self.arrangements.values()))

    @property
    def main(self) -> Estimate:
        """What is asked for first: the probability, else the share, else the amplitude that topples half."""
        return self.probability or self.share or self.amplitudes[0.5]


def assess(request: Request, records: str | Path = RECORDS, *, brief: bool = False) -> Assessment:
    """Assess one object at one place.

    Parameters
    ----------
    request
        What is asked.
    records
        Folder of fetched records.
    brief
        Leave out directions and remedies, as for one line of an inventory.

    Returns
    -------
    The :class:`Assessment`.

    Raises
    ------
    InputError
        If there are no motions.
    """
    return assess_with(
        request, motion_set(request.records, request.place, Path(records)), brief=brief
    )


def assess_with(request: Request, motions: MotionSet, *, brief: bool = False) -> Assessment:
    """Assess one object with motions that are at hand.

    Parameters
    ----------
    request
        What is asked.
    motions
        The motions at the place.
    brief
        Leave out directions and remedies.
    """
    if request.objects.round:
        motions = motions.in_worst_direction()
    hazard = _governing(request, motions)
    level = _site_level(request, hazard)
    measure = hazard.measure if hazard else level.measure if level else PGA
    asked = [level.value] if level else []
    ladder = make_ladder(
        motions, measure, asked, FEW_LEVELS if brief or request.objects.round else LEVELS
    )
    objects = request.objects
    bodies = objects.arrangements
    if brief:
        bodies = dict(list(bodies.items())[:1])
    arrangements = verdicts_of(objects, bodies, motions, ladder)
    now = next(iter(arrangements.values()))
    target = _target(level, hazard, request.years)
    conversion = find_conversion(now, motions, request.records) if level else None
    moved = _moved(
        request, motions.thinned() if brief or request.objects.round else motions, measure, asked
    )
    both_sides = {one.name: one.sides for one in moved}
    shifts = {"model": BETA_MODEL}
    if not request.objects.round:
        shifts["space"] = SPACE
    if conversion:
        shifts["conversion"] = conversion.shift

    def estimated(one: Target, fixed: Mapping[str, float] | None = None) -> Estimate:
        return estimate(one, now, both_sides, fixed or {}, shifts)

    probability = None
    if hazard:
        fixed = _of_quantiles(now, hazard)
        probability = estimated(risk_target(hazard, request.years), fixed)
    rocking, share = None, None
    rocks_from = _rocks_from(request, now)
    if level:
        exact = _starts_by_statics(request, measure)
        rocking = estimate_rocking(level.value, now, both_sides, exact=exact)
        share = _no_more_than(estimated(share_target(level.value)), rocking)
        rocking = _no_less_than(rocking, share)
    at = level.value if level else None
    return Assessment(
        request=request,
        motions=motions,
        level=level,
        hazard=hazard,
        arrangements=arrangements,
        rocking=rocking,
        rocks_from=rocks_from,
        share=share,
        probability=probability,
        counts=_counts(now, level),
        amplitudes={p: estimated(amplitude_target(p)) for p in (0.1, 0.5)},
        by_arrangement={name: target.value(one) for name, one in arrangements.items()},
        curve=None if brief else fragility_of(now.outcomes()),
        conversion=conversion,
        directions=None
        if brief or objects.round
        else find_directions(
            objects, motions, make_ladder(motions, measure, asked, FEW_LEVELS), at
        ),
        remedies=() if brief else _remedies(request, motions, ladder, target, now),
        effects=tuple(one.turned(target.value) for one in moved),
        rules=() if brief or objects.round else tuple(check_rules(objects, motions, now)),
        sliding_share=math.nan
        if brief or at is None or objects.friction is None
        else share_with_sliding(objects, motions, measure, at),
    )


def _target(level: Level | None, hazard: HazardCurve | None, years: float) -> Target:
    if hazard:
        return risk_target(hazard, years)
    return share_target(level.value) if level else amplitude_target(0.5)


def _governing(request: Request, motions: MotionSet) -> HazardCurve | None:
    """Of several hazard curves the one in whose measure the motions' capacities scatter least."""
    if not request.hazard:
        return None
    if len(request.hazard) == 1:
        return request.hazard[0]
    objects = request.objects
    name, body = next(iter(objects.arrangements.items()))

    def scatter(curve: HazardCurve) -> float:
        ladder = make_ladder(motions, curve.measure)
        first = verdicts_of(objects, {name: body}, motions, ladder)[name].first_levels()
        known = np.log(first[np.isfinite(first)])
        return float(known.std()) if known.size > 1 else math.inf

    return min(request.hazard, key=scatter)


def _site_level(request: Request, hazard: HazardCurve | None) -> Level | None:
    """The level asked about, or that of 475 years of the hazard."""
    if request.level is not None:
        if hazard is not None and request.level.measure != hazard.measure:
            raise InputError(
                f"the level is in {request.level.measure.name} and the hazard in {hazard.measure.name}; give "
                "both in one measure, or leave the level out."
            )
        return request.level
    return Level(hazard.measure, hazard.level(1 / 475)) if hazard else None


def _starts_by_statics(request: Request, measure: Measure) -> bool:
    """Whether rocking starts where the measure passes a number: a peak acceleration of what it stands on."""
    return measure == PGA and (request.place.shakes_as_ground or request.records.on_floor)


def _rocks_from(request: Request, now: Verdicts) -> float:
    """Least level that makes the object rock: by statics where it decides, else the least that was tried."""
    if _starts_by_statics(request, now.ladder.measure):
        return request.objects.least_uplift
    rocked = np.flatnonzero(now.shares(rocks=True) > 0)
    return float(now.ladder.levels[rocked[0]]) if rocked.size else math.inf


def _no_more_than(share: Estimate, rocking: Estimate) -> Estimate:
    """What does not rock cannot topple."""
    if rocking.value > 0:
        return share
    return replace(share, upper=min(share.upper, rocking.upper))


def _no_less_than(rocking: Estimate, share: Estimate) -> Estimate:
    """What topples rocks: limits of rocking are at least those of toppling."""
    return replace(
        rocking, lower=max(rocking.lower, share.lower), upper=max(rocking.upper, share.upper)
    )


def _counts(now: Verdicts, level: Level | None) -> tuple[int, int, int] | None:
    if level is None:
        return None
    at = int(now.ladder.levels.searchsorted(level.value))
    if at == now.ladder.levels.size or now.ladder.levels[at] != level.value:
        return None
    allowed = now.ladder.allowed[:, at]
    if not allowed.any():
        return None
    rocked, fell = (int(what[allowed, at].sum()) for what in (now.rocked, now.overturned))
    return int(allowed.sum()), rocked, fell


def _moved(
    request: Request, motions: MotionSet, measure: Measure, asked: Sequence[float]
) -> list[Moved[Verdicts]]:
    """Verdicts with every property of body and floor moved by its standard deviation."""
    ladder = make_ladder(motions, measure, asked, FEW_LEVELS)
    objects = request.objects
    variants = objects.variants()
    # all objects under the same motions are simulated at once
    shaken = verdicts_of_all([side for one in variants for side in one.sides], motions, ladder)
    of_object = [
        Moved(one.name, one.spread, lower, upper)
        for one, lower, upper in zip(variants, shaken[::2], shaken[1::2], strict=True)
    ]
    of_place = [
        one.turned(lambda place: verdicts_of_all([objects], motions.at(place), ladder)[0])
        for one in request.place.variants()
    ]
    return of_object + of_place


def _of_quantiles(now: Verdicts, hazard: HazardCurve) -> dict[str, float]:
    """Standard deviation of ln rate that the quantiles of the hazard stand for."""
    logs = {q: risk_target(curve, 1.0).on_scale(now) for q, curve in hazard.quantiles.items()}
    finite = {q: value for q, value in logs.items() if math.isfinite(value)}
    if len(finite) < 2:
        return {}
    low, high = min(finite), max(finite)
    width = float(special.ndtri(high) - special.ndtri(low))
    return {"hazard": abs(finite[high] - finite[low]) / width}


def _remedies(
    request: Request, motions: MotionSet, ladder: Ladder, target: Target, now: Verdicts
) -> tuple[Remedy, ...]:
    bodies = remedies_of(request.objects)
    changed = verdicts_of(request.objects, bodies, motions, ladder)
    found = compare(target, now, changed)
    # an amplitude helps by growing, a probability by shrinking
    grows = request.level is None and not request.hazard
    return tuple(reversed(found) if grows else found)
