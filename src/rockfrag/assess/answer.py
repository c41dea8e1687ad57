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
from rockfrag.assess.hazard.measure import PGA, PGV, Measure
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
    FEWEST_LEVELS,
    LEVELS,
    Ladder,
    Verdicts,
    make_ladder,
    on_pad,
    share_with_sliding,
    verdicts_of,
    verdicts_of_all,
    verdicts_of_each,
)
from rockfrag.errors import InputError
from rockfrag.fragility.estimators import Fragility, fragility_of
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS, SCAN
from rockfrag.short_repr import short_repr

RECORDS = "resources/records"
"""Folder of fetched records."""


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
    counted
        What each motion as recorded does to the object as it stands.
    arrangements
        Verdicts of each way in which the object can stand, as it stands first, under motions with the velocity of
        the site.
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
        Lognormal fragility curve of the motions as recorded, with parameters that are NaN where the outcomes give
        none; None if none was fitted, or the velocity of the site is known.
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
    counted: Verdicts
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
        """Outcomes of the object as it stands."""
        return next(iter(self.arrangements.values()))

    @property
    def main(self) -> Estimate:
        """What is asked for first: the probability, else the share, else the amplitude that topples half."""
        return self.probability or self.share or self.amplitudes[0.5]


@dataclass(frozen=True, eq=False)
class Plan:
    """Under which levels of which motions objects are compared; the same for all in one place.

    Attributes
    ----------
    motions
        The motions.
    fewer
        Those under which changes are compared.
    curves
        The hazard that counts, and that of PGV beside it if there is one.
    level
        Level of shaking at the site.
    ladder, fewer_ladder
        Levels of both sets.
    brief
        Whether directions are left out, and changes compared with few motions and levels.
    """

    motions: MotionSet
    fewer: MotionSet
    curves: tuple[HazardCurve, ...]
    level: Level | None
    ladder: Ladder
    fewer_ladder: Ladder
    brief: bool

    @property
    def asked(self) -> list[float]:
        """Levels that are wanted exactly."""
        return [self.level.value] if self.level else []


@dataclass(frozen=True, eq=False)
class Shaken:
    """What motions as recorded do to an object.

    Attributes
    ----------
    arrangements
        Outcomes of each way in which it can stand, as it stands first.
    moved
        Outcomes with each property moved to both sides.
    before, changed
        Outcomes as it stands, and with each mitigation, under the same motions.
    """

    arrangements: Mapping[str, Verdicts]
    moved: Sequence[Moved[Verdicts]]
    before: Verdicts
    changed: Mapping[str, Verdicts]


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
        Leave out directions, and compare changes with few motions and levels.
    """
    plan = plan_for(request, motions, brief=brief)
    return assessed(request, plan, shake_all([request], plan)[0])


def plan_for(request: Request, motions: MotionSet, *, brief: bool) -> Plan:
    """Return under which levels of which motions an object is shaken.

    Parameters
    ----------
    request
        What is asked.
    motions
        The motions at the place.
    brief
        Compare changes with few motions and levels.
    """
    if request.objects.round:
        motions = motions.in_worst_direction()
    curves = _governing(request, motions)
    hazard = curves[0] if curves else None
    level = _site_level(request, hazard)
    measure = hazard.measure if hazard else level.measure if level else PGA
    asked = [level.value] if level else []
    few = brief or request.objects.many
    fewer = motions.thinned() if few else motions
    fewer = fewer.thinned() if brief else fewer
    return Plan(
        motions,
        fewer,
        curves,
        level,
        make_ladder(motions, measure, asked, FEW_LEVELS if few else LEVELS),
        make_ladder(fewer, measure, asked, FEWEST_LEVELS if brief else FEW_LEVELS),
        brief,
    )


def shake_all(requests: Sequence[Request], plan: Plan) -> list[Shaken]:
    """Shake objects in one place at once; of each the same results as alone, to the bit.

    Parameters
    ----------
    requests
        Objects in places that shake alike.
    plan
        Motions and levels.
    """
    objects = [one.objects for one in requests]
    ways = [dict(one.arrangements) for one in objects]
    if plan.brief:
        ways = [dict(list(bodies.items())[:1]) for bodies in ways]
    arrangements = verdicts_of_each(objects, ways, plan.motions, plan.ladder)
    # of few motions the object as it stands comes first, then with each mitigation
    changes = [{"": one.body, **remedies_of(one)} for one in objects]
    under = (plan.fewer, plan.fewer_ladder) if plan.brief else (plan.motions, plan.ladder)
    compared = verdicts_of_each(objects, changes, *under)
    moved = _moved(requests, plan)
    found = []
    for one, way, change, sides in zip(objects, arrangements, compared, moved, strict=True):
        before = change.pop("")
        if one.pad_friction is not None:
            outcomes, slip = on_pad(one, one.pad_friction, *under)
            change[_pad_words(one.pad_friction, slip, plan, under[1])] = outcomes
        found.append(Shaken(way, sides, before, change))
    return found


def _pad_words(friction: float, slip: NDArray[np.float64], plan: Plan, ladder: Ladder) -> str:
    """The pad, and how far the object slides on it at the site's level."""
    words = f"a pad of friction {friction:g}"
    if plan.level is None:
        return words
    at = min(int(ladder.levels.searchsorted(plan.level.value)), ladder.levels.size - 1)
    here = slip[ladder.allowed[:, at], at]
    if not here.size:
        return words
    return f"{words}, on which it slides up to {100 * here.max():.3g} cm at {plan.level.words},"


def assessed(request: Request, plan: Plan, shaken: Shaken) -> Assessment:
    """Say what follows from an object's outcomes.

    Parameters
    ----------
    request
        What is asked.
    plan
        Motions and levels.
    shaken
        What the motions do to it.
    """
    objects, motions, level = request.objects, plan.motions, plan.level
    hazard = plan.curves[0] if plan.curves else None
    measure = plan.ladder.measure
    counted = next(iter(shaken.arrangements.values()))
    target = _target(level, hazard, request.years)
    exact = _starts_by_statics(request, measure)
    conversion = None
    if level:
        conversion = find_conversion(
            counted,
            motions,
            request.records,
            level=level,
            curves=plan.curves,
            by_statics=exact,
            brief=plan.brief,
        )
    shaken = _at_site(shaken, plan, conversion)
    arrangements, moved = shaken.arrangements, shaken.moved
    both_sides = {one.name: one.sides for one in moved}
    shifts = {"model": MODEL_ERRORS[SCAN if objects.scan else CUT].beyond}
    if not objects.round:
        shifts["space"] = SPACE
    if conversion:
        shifts["conversion"] = conversion.shift
        if together := conversion.sides(counted):
            both_sides["together"] = together
    now = next(iter(arrangements.values()))

    def estimated(one: Target, fixed: Mapping[str, float] | None = None) -> Estimate:
        return estimate(one, now, both_sides, fixed or {}, shifts)

    probability = None
    if hazard:
        fixed = _of_quantiles(now, hazard)
        probability = estimated(risk_target(hazard, request.years), fixed)
    rocking, share = None, None
    rocks_from = _rocks_from(request, counted)
    if level:
        rocking = estimate_rocking(level.value, now, both_sides, exact=exact)
        share = _no_more_than(estimated(share_target(level.value)), rocking)
        rocking = _no_less_than(rocking, share)
    at = level.value if level else None
    brief = plan.brief
    return Assessment(
        request=request,
        motions=motions,
        level=level,
        hazard=hazard,
        counted=counted,
        arrangements=arrangements,
        rocking=rocking,
        rocks_from=rocks_from,
        share=share,
        probability=probability,
        counts=_counts(counted, level) if now is counted else None,
        amplitudes={p: estimated(amplitude_target(p)) for p in (0.1, 0.5)},
        by_arrangement={name: target.value(one) for name, one in arrangements.items()},
        curve=None if brief or now is not counted else fragility_of(now.outcomes()),
        conversion=conversion,
        directions=None
        if brief or objects.round or objects.many
        else find_directions(
            objects, motions, make_ladder(motions, measure, plan.asked, FEW_LEVELS), at
        ),
        remedies=_remedies(request, target, shaken),
        effects=tuple(one.turned(target.value) for one in moved),
        rules=() if brief or objects.round else tuple(check_rules(objects, motions, counted)),
        sliding_share=math.nan
        if brief or at is None or objects.friction is None
        else share_with_sliding(objects, motions, measure, at),
    )


def _at_site(shaken: Shaken, plan: Plan, conversion: Conversion | None) -> Shaken:
    """Outcomes under motions with the velocity of the site."""
    if conversion is None or conversion.known is None:
        return shaken
    few = conversion.of(plan.fewer)
    compared = few if plan.brief else conversion
    return Shaken(
        {name: conversion.at_site(one) for name, one in shaken.arrangements.items()},
        [one.turned(few.at_site) for one in shaken.moved],
        compared.at_site(shaken.before),
        {name: compared.at_site(one) for name, one in shaken.changed.items()},
    )


def _target(level: Level | None, hazard: HazardCurve | None, years: float) -> Target:
    if hazard:
        return risk_target(hazard, years)
    return share_target(level.value) if level else amplitude_target(0.5)


def _governing(request: Request, motions: MotionSet) -> tuple[HazardCurve, ...]:
    """The hazard curve that counts, and that of PGV where there is one beside it.

    Without PGV that one counts in whose measure the motions' capacities scatter least, or that of the level asked
    about.
    """
    asked = request.level.measure if request.level else None
    curves = [one for one in request.hazard if one.measure == asked] or request.hazard
    others = [one for one in curves if one.measure != PGV]
    velocity = [one for one in request.hazard if one.measure == PGV]
    if not others:
        return tuple(velocity)
    if len(others) == 1:
        return (*others, *velocity)
    objects = request.objects
    name, body = next(iter(objects.arrangements.items()))

    def scatter(curve: HazardCurve) -> float:
        ladder = make_ladder(motions, curve.measure)
        first = verdicts_of(objects, {name: body}, motions, ladder)[name].first_levels()
        known = np.log(first[np.isfinite(first)])
        return float(known.std()) if known.size > 1 else math.inf

    return (min(others, key=scatter), *velocity)


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


def _moved(requests: Sequence[Request], plan: Plan) -> list[list[Moved[Verdicts]]]:
    """Outcomes with every property of body and floor moved by its standard deviation, of each object."""
    variants = [one.objects.variants() for one in requests]
    sides = [side for each in variants for one in each for side in one.sides]
    shaken = iter(verdicts_of_all(sides, plan.fewer, plan.fewer_ladder))
    found = [[one.turned(lambda _: next(shaken)) for one in each] for each in variants]
    objects = [one.objects for one in requests]
    for moved in requests[0].place.variants():
        floors = moved.turned(
            lambda place: verdicts_of_all(objects, plan.fewer.at(place), plan.fewer_ladder)
        )
        for each, lower, upper in zip(found, *floors.sides, strict=True):
            each.append(Moved(moved.name, moved.spread, lower, upper))
    return found


def _of_quantiles(now: Verdicts, hazard: HazardCurve) -> dict[str, float]:
    """Standard deviation of ln rate that the quantiles of the hazard stand for."""
    logs = {q: risk_target(curve, 1.0).on_scale(now) for q, curve in hazard.quantiles.items()}
    finite = {q: value for q, value in logs.items() if math.isfinite(value)}
    if len(finite) < 2:
        return {}
    low, high = min(finite), max(finite)
    width = float(special.ndtri(high) - special.ndtri(low))
    return {"hazard": abs(finite[high] - finite[low]) / width}


def _remedies(request: Request, target: Target, shaken: Shaken) -> tuple[Remedy, ...]:
    found = compare(target, shaken.before, shaken.changed)
    # an amplitude helps by growing, a probability by shrinking
    grows = request.level is None and not request.hazard
    return tuple(reversed(found) if grows else found)
