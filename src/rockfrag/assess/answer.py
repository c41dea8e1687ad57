"""The answer: one object at one place, assessed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
    risk_target,
    share_target,
)
from rockfrag.assess.rules import RuleCheck, check_rules
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
    rocking_share
        Share of the motions at the level that make it rock [-]; NaN without a level.
    share
        Share of the motions at the level that topple it; None without a level.
    probability
        Probability of toppling in the years asked for; None without a hazard.
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
    rocking_share: float
    share: Estimate | None
    probability: Estimate | None
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
    hazard = _governing(request, motions)
    level = _site_level(request, hazard)
    measure = hazard.measure if hazard else level.measure if level else PGA
    asked = [level.value] if level else []
    ladder = make_ladder(motions, measure, asked, FEW_LEVELS if brief else LEVELS)
    objects = request.objects
    bodies = objects.arrangements
    if brief:
        bodies = dict(list(bodies.items())[:1])
    arrangements = verdicts_of(objects, bodies, motions, ladder)
    now = next(iter(arrangements.values()))
    target = _target(level, hazard, request.years)
    conversion = find_conversion(now, motions) if level else None
    moved = _moved(request, motions.thinned() if brief else motions, measure, asked)
    both_sides = {one.name: one.sides for one in moved}
    shifts = {"model": BETA_MODEL} | ({"conversion": conversion.shift} if conversion else {})

    def estimated(one: Target, fixed: Mapping[str, float] | None = None) -> Estimate:
        return estimate(one, now, both_sides, fixed or {}, shifts)

    probability = None
    if hazard:
        fixed = _of_quantiles(now, hazard)
        probability = estimated(risk_target(hazard, request.years), fixed)
    share = estimated(share_target(level.value)) if level else None
    at = level.value if level else None
    return Assessment(
        request=request,
        motions=motions,
        level=level,
        hazard=hazard,
        arrangements=arrangements,
        rocking_share=_rocking_share(now, level),
        share=share,
        probability=probability,
        amplitudes={p: estimated(amplitude_target(p)) for p in (0.1, 0.5)},
        by_arrangement={
            name: target.back(target.on_scale(one)) for name, one in arrangements.items()
        },
        curve=None if brief else fragility_of(now.outcomes()),
        conversion=conversion,
        directions=None
        if brief
        else find_directions(
            objects, motions, make_ladder(motions, measure, asked, FEW_LEVELS), at
        ),
        remedies=() if brief else _remedies(request, motions, ladder, target, now),
        effects=tuple(one.turned(lambda v: target.back(target.on_scale(v))) for one in moved),
        rules=() if brief else tuple(check_rules(objects, motions, now)),
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


def _rocking_share(now: Verdicts, level: Level | None) -> float:
    if level is None:
        return math.nan
    shares = now.shares(rocks=True)
    return float(np.interp(math.log(level.value), np.log(now.ladder.levels), shares))


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
