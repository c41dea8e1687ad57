"""The answer: one object at one place, assessed.

In: a request and motions. Out: :class:`Assessment`, from which findings, page and files are made.
Docs: ``docs/assess.md``.
"""

import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from rockfrag.assess import outcomes, risk
from rockfrag.assess.assumed import Moved
from rockfrag.assess.conversion import Conversion, Site, find_conversion
from rockfrag.assess.core import choices
from rockfrag.assess.core.decisions import Decision, decide
from rockfrag.assess.core.draws import FEW_MEMBERS
from rockfrag.assess.core.estimates import (
    fill_estimate,
    fill_order,
    fill_sides,
    rate_of,
)
from rockfrag.assess.core.fractions import fill_counts_at
from rockfrag.assess.core.hazards import spread_of_quantiles
from rockfrag.assess.hazard.curve import PGA, PGV, HazardCurve
from rockfrag.assess.holding import (
    Trial,
    can_be_simulated,
    seconds_of_a_holder,
    try_holders,
)
from rockfrag.assess.mitigations import Mitigation, compare
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import Directions, ObjectOutcomes, Shaking
from rockfrag.assess.request import Level, Request
from rockfrag.assess.risk import Estimate, PredictedCurve
from rockfrag.assess.rules import RuleCheck, check_rules
from rockfrag.assess.sources import MEASUREMENTS, SPACE
from rockfrag.assess.standing import Standing
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.engines.compile import jit
from rockfrag.engines.pure_rocking.kernels.lanes.block import integrate_blocks
from rockfrag.engines.pure_rocking.kernels.lanes.scheduler import integrate_stacks
from rockfrag.engines.spatial._integrate import integrate_scales
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.outcomes.limit_states import LEANS, OVERTURNS, ROCKS
from rockfrag.runtime.machine_code import is_kept
from rockfrag.runtime.progress import LONG, Meter, in_words
from rockfrag.system.blocks import Body
from rockfrag.words.findings import Finding, finding, two

if TYPE_CHECKING:
    from rockfrag.fragility.estimators import Fragility

RECORDS = "resources/records"  # Folder of fetched records


@dataclass(frozen=True, eq=False)
class Assessment:
    """All that is known of one object at one place.

    Attributes
    ----------
    request : what was asked
    motions : the motions
    plan : under which levels of which motions it was shaken
    counted : what each motion as recorded does to the object as it stands
    arrangements : outcomes of each way to stand, its own first, under motions with the velocity of the site
    rocking : fraction of the motions at the level that make it rock; None without a level
    rocks_from : least level at which any motion makes it rock, in the measure's unit; infinite where none does
    fraction : fraction of the motions at the level that topple it; None without a level
    probability : probability of toppling in the years asked for; None without a hazard
    counts : motions that can be scaled to the level, that rock and that topple it there; None without any
    amplitudes : levels at which a tenth and half of the motions topple it, by fraction
    by_arrangement : what is estimated of each arrangement
    shown_safer : arrangements that the motions show to be safer than the others
    evidence : what estimates rest on
    decision : what to do by an accepted risk; None without a level
    conversion : what hazard in another measure than PGV leaves open; None in PGV
    planar : what is estimated in one plane, beside the answer in space, which counts; None where there is none
    changes : what each change of the object itself does
    spreads : relative standard deviation of each property that was moved
    """

    request: Request
    motions: MotionSet
    plan: "Plan"
    counted: ObjectOutcomes
    arrangements: Mapping[str, ObjectOutcomes]
    rocking: Estimate | None
    rocks_from: float
    fraction: Estimate | None
    probability: Estimate | None
    counts: tuple[int, int, int] | None
    amplitudes: Mapping[float, Estimate]
    by_arrangement: Mapping[str, float]
    shown_safer: frozenset[str]
    evidence: risk.Evidence
    decision: Decision | None
    conversion: Conversion | None
    planar: float | None
    changes: tuple[Mitigation, ...]
    spreads: Mapping[str, float]

    __repr__ = short_repr

    @property
    def level(self) -> Level | None:
        """Level of shaking at the site; None if neither level nor hazard was given."""
        return self.plan.level

    @property
    def hazard(self) -> HazardCurve | None:
        """The hazard curve that was used; None if none was given."""
        return self.plan.hazard

    @property
    def shaking(self) -> Shaking:
        """Motions at the levels that were tried."""
        return self.plan.shaking

    @property
    def brief(self) -> bool:
        """Whether directions, arrangements and what only a page shows are left out."""
        return self.plan.brief

    @property
    def measure(self) -> IntensityMeasure:
        """Measure of the levels."""
        return self.outcomes.intensity_levels.measure

    @property
    def outcomes(self) -> ObjectOutcomes:
        """Outcomes of the object as it stands."""
        return next(iter(self.arrangements.values()))

    @property
    def does_not_move(self) -> bool:
        """Whether it is exceptionally unlikely that it rocks at the level, limits included."""
        limit = self.rocking.upper if self.rocking else 1.0
        return choices.stays(limit)

    # ---- what no line says is computed where a page or a file shows it

    @property
    def tries_holders(self) -> bool:
        """Whether what may hold it is tried."""
        return self.plan.holds and self.level is not None

    @cached_property
    def mitigations(self) -> tuple[Mitigation, ...]:
        """What helps, the most helpful first; what may hold it is tried for it, which takes the longest."""
        found = list(self.changes)
        compared = _compared(self.evidence)
        for trial in self._trials():
            tried = compare(
                self.target, compared, trial.before, {trial.change: trial.after}
            )
            cost = self.request.costs.get(trial.key, math.nan)
            found += [replace(each, cost=cost) for each in tried]
        return _most_helpful_first(found, self.target)

    def _trials(self) -> list[Trial]:
        """What may hold it, tried, under motions with the velocity of the site."""
        plan = self.plan
        if not self.tries_holders:
            return []
        few = _few_levels(plan)
        trials = try_holders(self.request.objects, plan.shaking, few, plan.level)
        if self.conversion is None or self.conversion.known is None:
            return trials
        return [trial.turned(_at_site_of(self.conversion)) for trial in trials]

    @cached_property
    def predicted(self) -> PredictedCurve:
        """Fraction at each level, the mean over what is not known, with its median and its two spreads."""
        return self.evidence.curve()

    @cached_property
    def rocks_far(self) -> Estimate | None:
        """Fraction that rocks it a third of the way or topples it, as :attr:`fraction`; None without a level."""
        return self._reaches(outcomes.STEPS)

    @cached_property
    def leans(self) -> Estimate | None:
        """Fraction that topples it or leaves it leaning, as :attr:`fraction`; None without a level or a lean."""
        return self._reaches(LEANS)

    def _reaches(self, state: str) -> Estimate | None:
        """Fraction that brings it into a limit state or topples it; None without a level, or if no case does."""
        reached = self.outcomes.others.get(state)
        if self.level is None or reached is None:
            return None
        either = replace(self.outcomes, overturned=reached | self.outcomes.overturned)
        found = self.evidence.of(either)
        return self.evidence.drawn(_fraction_at(self.level), found).estimate()

    @cached_property
    def curve(self) -> "Fragility | None":
        """Lognormal curve of the motions as recorded, NaN where there is none; None where it is left out."""
        # the page alone shows it, and what fits it takes half a second to load
        from rockfrag.fragility.estimators import fragility_of

        return None if self.brief else fragility_of(self.counted.outcomes())

    @cached_property
    def directions(self) -> Directions | None:
        """The worst direction; None where no record has two components, or where it is left out."""
        objects, motions = self.request.objects, self.motions
        if self.brief or motions.both or objects.many:
            return None
        level = self.level.value if self.level else None
        return outcomes.find_directions(objects, motions, self.measure, level)

    @cached_property
    def rules(self) -> tuple[RuleCheck, ...]:
        """Engineers' rules held against the outcomes."""
        if self.brief or self.motions.both:
            return ()
        checks = check_rules(self.request.objects, self.motions, self.counted)
        return tuple(checks)

    @cached_property
    def sliding_fraction(self) -> float:
        """Fraction of motions at the level that topple it if it may slide [-]; or NaN."""
        objects = self.request.objects
        if self._here is None or objects.friction is None:
            return math.nan
        return self._here.fraction_with_sliding(objects)

    @cached_property
    def flip_rate(self) -> float:
        """Fraction of outcomes in space at the level that differ if the base does by 1e-6 [-]; or NaN."""
        if self._here is None or not self.motions.both:
            return math.nan
        return self._here.flip_rate(self.request.objects)

    @cached_property
    def effects(self) -> tuple[Moved[float], ...]:
        """What is estimated with each property smaller and larger."""
        return tuple(
            _effect(self.target, self.evidence, name, spread)
            for name, spread in self.spreads.items()
        )

    @property
    def target(self) -> risk.Target:
        """What is asked for first, as it is estimated."""
        if self.hazard is not None:
            return risk.risk_target(self.hazard, self.request.years)
        if self.level is not None:
            return _fraction_at(self.level)
        return risk.amplitude_target(0.5)

    @cached_property
    def _here(self) -> Shaking | None:
        """The motions at the site's level alone; None without one, or where that is left out."""
        if self.brief or self.level is None:
            return None
        level = np.array([self.level.value])
        return outcomes.scaled_to(level, self.motions, self.measure)

    @property
    def main(self) -> Estimate:
        """What is asked for first: the probability, else the fraction, else the amplitude that topples half."""
        return self.probability or self.fraction or self.amplitudes[0.5]


@dataclass(frozen=True, eq=False)
class Plan:
    """Under which levels of which motions objects are compared; the same for all in one place."""

    # The hazard that counts, and that of PGV beside it, if any
    curves: tuple[HazardCurve, ...]
    level: Level | None  # Level of shaking at the site
    # The motions at their levels, those under which changes are compared, and those for moved properties
    shaking: Shaking
    fewer: Shaking
    fewest: Shaking
    # Whether directions, and ways to stand other than its own, are left out
    brief: bool
    # Whether changes are compared by few motions: briefly, of columns, in space
    compares_few: bool
    # Whether what may hold objects is tried
    holds: bool = True

    @property
    def hazard(self) -> HazardCurve | None:
        """The hazard curve that counts."""
        return self.curves[0] if self.curves else None

    @property
    def comparing(self) -> Shaking:
        """Motions and levels under which changes are compared."""
        return self.fewer if self.compares_few else self.shaking


@dataclass(frozen=True, eq=False)
class Shaken:
    """What motions as recorded do to an object."""

    # Outcomes of each way to stand, its own first
    arrangements: Mapping[str, ObjectOutcomes]
    # Outcomes with each property moved to both sides
    moved: Sequence[Moved[ObjectOutcomes]]
    # Outcomes as it stands under the motions by which changes are compared
    before: ObjectOutcomes
    # Outcomes in one plane; None where those are the answer
    planar: ObjectOutcomes | None
    # Outcomes with each mitigation under the same motions
    changed: Mapping[Finding, ObjectOutcomes]
    # Mitigations that give one of the arrangements, and its name
    alike: Mapping[Finding, str]
    # Whether the object slides off what it stands on, on the pad that is tried
    slides_off: bool = False
    # Outcomes with less and more spread of velocities at a given level; None where that is not open
    together: tuple[ObjectOutcomes, ObjectOutcomes] | None = None


def assess(
    request: Request,
    records: str | Path = RECORDS,
    *,
    brief: bool = False,
    announce: Callable[[str], None] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Assessment:
    """Assess one object at one place.

    Parameters
    ----------
    request : what is asked
    records : folder of fetched records
    brief : leave out directions and mitigations, as for one line of an inventory
    announce : called with what a first or a long answer waits for, before it does
    progress : called with the part of the simulations that is done [-]

    Returns
    -------
    The :class:`Assessment`.
    """
    motions = motion_set(request.records, request.place, Path(records))
    return assess_with(
        request, motions, brief=brief, announce=announce, progress=progress
    )


LEVELS_OF_HOLDERS = 8
"""Levels of shaking at which what may hold an object is compared with the object as it stands."""

COMPILING_S = {"blocks": 3, "stacks": 8, "contacts": 30, "space": 40, "core": 20}
"""About how long kernels compile once on a machine, by what they are for [s]; a block's are 54 s together."""

_CONTACTS = "rockfrag.engines.planar.integrate.integrate_cases"


def _kernels(request: Request, plan: Plan) -> dict[str, Any]:
    """A kernel that Python calls of each kind that an answer needs, by what it is for."""
    objects = request.objects
    found = {"core": fill_estimate, "blocks": integrate_blocks}
    if objects.pedestals:
        found["stacks"] = integrate_stacks
    if objects.in_space:
        found["space"] = integrate_scales
    tried = plan.holds and plan.level is not None
    if tried or objects.many or objects.friction is not None:
        # loaded where it is needed, as the engine does
        found["contacts"] = resolve_name(_CONTACTS)
    return found


def waiting_for(request: Request, plan: Plan) -> list[str]:
    """Say what a first answer on a machine waits for, and how long one takes that takes long.

    Parameters
    ----------
    request, plan : what is asked, and under which motions

    Returns
    -------
    Sentences; none where the kernels are compiled and the answer comes soon.
    """
    said = []
    kernels = _kernels(request, plan)
    new = [name for name, entry in kernels.items() if not is_kept(entry)]
    if new:
        compiling = sum(map(COMPILING_S.__getitem__, new))
        words = f"compiling once on this machine, about {in_words(compiling)}"
        if not jit.KNOWN:
            # without its private parts (docs/kernels.md)
            known = f"numba {jit.TESTED_NUMBA[-1]}x"
            words += f" with {known}, with this one many times as long"
        said.append(words)
    seconds = seconds_of([request], plan) + seconds_of_holders(request, plan)
    seconds /= os.cpu_count() or 1
    if seconds > LONG:
        said.append(
            f"this takes about {in_words(seconds)}; fewer records or fewer pedestals take less"
        )
    return said


def assess_with(
    request: Request,
    motions: MotionSet,
    *,
    brief: bool = False,
    holders: bool = True,
    announce: Callable[[str], None] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Assessment:
    """Assess one object with motions that are at hand.

    Parameters
    ----------
    request, motions : what is asked, and by what
    brief, announce, progress : as :func:`assess` takes them
    holders : try what may hold the object, as the one-file page cannot

    Returns
    -------
    The :class:`Assessment`.
    """
    plan = plan_for(request, motions, brief=brief, holds=holders and not brief)
    if announce is not None:
        for words in waiting_for(request, plan):
            announce(words)
    return assessed(request, plan, shake_all([request], plan, progress)[0])


def check_motions(objects: Standing, motions: MotionSet) -> None:
    """Refuse an object that is not simulated under these motions as it stands and as it is held."""
    if _moves_in_space(objects, motions):
        objects.check_in_space()
    elif objects.matters_in_space:
        raise InputError(
            f"key {objects.matters_in_space[0]}: no record has two components, so the object is answered in "
            "one plane, which has no use for it; leave it out, or give records of two components."
        )


def _moves_in_space(objects: Standing, motions: MotionSet) -> bool:
    """Whether an object is shaken by both components of the records at once."""
    return objects.from_all_sides or (objects.in_space and bool(motions.pairs))


def plan_for(
    request: Request, motions: MotionSet, *, brief: bool, holds: bool = True
) -> Plan:
    """Return under which levels of which motions an object is shaken.

    ``brief`` takes few motions and levels; ``holds`` tries what may hold it.
    """
    objects = request.objects
    check_motions(objects, motions)
    if _moves_in_space(objects, motions):
        motions = motions.with_both_components()
    curves = _governing(request, motions)
    hazard = curves[0] if curves else None
    level = _site_level(request, hazard)
    measure = hazard.measure if hazard else level.measure if level else PGA
    asked = [level.value] if level else []
    # simulations of columns and in space take milliseconds: every second motion compares changes, or every fourth
    coarse = brief or objects.many
    few = coarse or motions.both
    fewer = motions.thinned() if few else motions
    fewer = fewer.thinned() if coarse else fewer
    count = outcomes.FEW_LEVELS if few else outcomes.LEVELS
    least = outcomes.FEWEST_LEVELS if coarse else outcomes.FEW_LEVELS
    shaking = outcomes.make_intensity_levels(motions, measure, asked, count)
    compared = outcomes.make_intensity_levels(fewer, measure, asked, least)
    moved = compared
    if motions.both:
        # of outcomes with a property moved the median alone counts, for which the fewest levels do
        moved = outcomes.make_intensity_levels(
            fewer, measure, asked, outcomes.FEWEST_LEVELS
        )
    return Plan(
        curves,
        level,
        shaking,
        compared,
        moved,
        brief=brief,
        compares_few=few,
        holds=holds,
    )


def seconds_of(requests: Sequence[Request], plan: Plan) -> float:
    """About how long a core simulates what is asked.

    Parameters
    ----------
    requests, plan : as :func:`shake_all` takes them

    Returns
    -------
    The time, within a factor of about two [s].
    """
    total = 0.0
    places = 2 * len(requests[0].place.variants())
    for request in requests:
        object_ = request.objects
        arranged = _arrangements(object_, plan)
        alike = _changes_alike(object_, arranged)
        compared = _bodies_to_compare(object_, alike, plan)
        moved = 2 * len(_variants(request, plan)) + places
        total += plan.shaking.seconds_of(object_) * len(arranged)
        total += plan.comparing.seconds_of(object_) * len(compared)
        total += plan.fewest.seconds_of(object_) * moved
    return total


def seconds_of_holders(request: Request, plan: Plan) -> float:
    """About how long a core tries what may hold an object.

    Parameters
    ----------
    request, plan : what is asked, and under which motions

    Returns
    -------
    The time, within a factor of about two; 0 where nothing is tried [s].
    """
    if not plan.holds or plan.level is None:
        return 0.0
    objects = request.objects
    each = seconds_of_a_holder(objects, plan.shaking, _few_levels(plan))
    return len(objects.holders_to_try()) * each


def shake_all(
    requests: Sequence[Request],
    plan: Plan,
    progress: Callable[[float], None] | None = None,
) -> list[Shaken]:
    """Shake objects in one place at once; of each the same results as alone, to the bit.

    Parameters
    ----------
    requests : an object each
    plan : motions and levels of that place
    progress : called with the part of the simulations that is done [-]

    Returns
    -------
    What became of each object: in its arrangements, with its changes, on its pad and in one plane.
    """
    meter = None
    if progress is not None:
        meter = Meter(seconds_of(requests, plan), progress)
    objects = [request.objects for request in requests]
    arranged = [_arrangements(object_, plan) for object_ in objects]
    alike = [
        _changes_alike(object_, bodies)
        for object_, bodies in zip(objects, arranged, strict=True)
    ]
    changed = [
        _bodies_to_compare(object_, known, plan)
        for object_, known in zip(objects, alike, strict=True)
    ]
    arrangements = plan.shaking.outcomes_of_each(objects, arranged, meter)
    compared = plan.comparing.outcomes_of_each(objects, changed, meter)
    moved = _moved(requests, plan, meter)
    found = []
    each = zip(objects, arrangements, compared, moved, alike, strict=True)
    for object_, arrangement, change, sides, known in each:
        before = next(iter(arrangement.values()))
        if plan.compares_few:
            before = change.pop(_AS_IT_STANDS)
        slides_off = _add_pad(change, object_, plan)
        planar = _in_one_plane(object_, plan)
        found.append(
            Shaken(arrangement, sides, before, planar, change, known, slides_off)
        )
    if progress is not None:
        progress(1.0)
    return found


def _arrangements(object_: Standing, plan: Plan) -> dict[str, Body]:
    """Bodies of the arrangements that are shaken: the first one alone if the answer is to be brief."""
    bodies = list(object_.arrangements().items())
    return dict(bodies[:1] if plan.brief else bodies)


def _changes_alike(
    object_: Standing, arranged: Mapping[str, Body]
) -> dict[Finding, str]:
    """Changes after which the object stands as one of its arrangements does, with that arrangement's name."""
    return {
        name: arrangement
        for name, body in object_.changes().items()
        for arrangement, other in arranged.items()
        if other == body
    }


def _bodies_to_compare(
    object_: Standing, alike: Mapping[Finding, str], plan: Plan
) -> dict[Finding, Body]:
    """Bodies with each change that no arrangement shows; under few motions first the object as it stands."""
    first = {_AS_IT_STANDS: object_.body} if plan.compares_few else {}
    changes = object_.changes().items()
    return first | {name: body for name, body in changes if name not in alike}


def _add_pad(
    change: dict[Finding, ObjectOutcomes], object_: Standing, plan: Plan
) -> bool:
    """Add the outcomes on the pad, if there is one, to those of the changes; return whether it slides off."""
    friction = object_.under.pad_friction
    if friction is None:
        return False
    on_it, slip = plan.comparing.on_pad(object_, friction)
    far = _slip_at(slip, plan.level, plan.comparing)
    change[_pad(friction, far, plan.level)] = on_it
    return far > object_.block.width / 2


def _in_one_plane(objects: Standing, plan: Plan) -> ObjectOutcomes | None:
    """The outcomes in one plane beside those in space; None where no engine simulates it in a plane."""
    if plan.brief or not plan.shaking.motions.both:
        return None
    flat = objects.in_plane()
    if not can_be_simulated(flat.held(flat.system_of(flat.body)), plan.shaking):
        return None
    return plan.shaking.outcomes_of([flat])[0]


def _few_levels(plan: Plan) -> Shaking:
    """Few motions at few levels, by which holders are compared, as each simulation takes milliseconds."""
    assert plan.level is not None
    motions = plan.fewer.motions
    if not plan.compares_few:
        motions = motions.thinned().thinned()
    return outcomes.make_intensity_levels(
        motions, plan.shaking.measure, [plan.level.value], LEVELS_OF_HOLDERS
    )


_AS_IT_STANDS = finding("as_it_stands")
"""The object without a change, among its changes."""


def _slip_at(slip: Floats, level: Level | None, shaking: Shaking) -> float:
    """How far the object slides at the site's level at most [m], NaN without one.

    ``slip``: under each motion at each level [m], shape (motions, levels) of ``shaking``.
    """
    if level is None:
        return math.nan
    at = shaking.place_of(level.value)
    here = slip[shaking.allowed[:, at], at]
    return float(here.max()) if here.size else math.nan


def _pad(friction: float, slip: float, level: Level | None) -> Finding:
    """The pad, and how far the object slides on it at the site's level [m]."""
    if level is None or math.isnan(slip):
        return finding(Text.PAD, friction=two(friction))
    about = {"friction": two(friction), "slip": two(100 * slip)}
    return finding(Text.PAD_SLIDES, level=level.amount, **about)


def assessed(request: Request, plan: Plan, shaken: Shaken) -> Assessment:
    """Say what follows from what the motions of a plan do to an object.

    Outcomes are turned into those with the velocity of the site, and with all that is not known they give
    estimates, a decision and what each change does.

    Parameters
    ----------
    request : the object and what is asked
    plan : motions and levels
    shaken : outcomes of the object, its arrangements and changes

    Returns
    -------
    The answer.
    """
    objects, motions, level = request.objects, plan.shaking.motions, plan.level
    hazard = plan.hazard
    counted = next(iter(shaken.arrangements.values()))
    target = _fraction_at(level) if level else risk.amplitude_target(0.5)
    if hazard:
        target = risk.risk_target(hazard, request.years)
    by_statics = _rocks_by_statics(request, plan)
    conversion = None
    if level:
        site = Site(request.records, level, plan.curves)
        conversion = find_conversion(counted, motions, site, by_statics=by_statics)
    shaken = _at_site(shaken, plan, conversion)
    arrangements = shaken.arrangements
    evidence = _evidence(objects, shaken, plan, conversion)
    probability, rocking, fraction, decision = None, None, None, None
    if level:
        rocking = evidence.estimate(_fraction_at(level, state=ROCKS))
        fraction = evidence.estimate(_fraction_at(level))
    if hazard:
        probability = evidence.estimate(risk.risk_target(hazard, request.years))
    main = probability or fraction
    if main:
        decision = _decision(main.value, evidence, target, request)
    values = {
        name: evidence.mean(target, arrangement)
        for name, arrangement in arrangements.items()
    }
    changes = _changes(target, _compared(evidence), shaken)
    lifts_from = objects.least_uplift if by_statics else counted.lifts_from().min()
    return Assessment(
        request=request,
        motions=motions,
        plan=plan,
        counted=counted,
        arrangements=arrangements,
        rocking=rocking,
        rocks_from=float(lifts_from),
        fraction=fraction,
        probability=probability,
        counts=_counts(counted, level),
        amplitudes={p: evidence.estimate(risk.amplitude_target(p)) for p in (0.1, 0.5)},
        by_arrangement=values,
        shown_safer=_shown_safer(shaken, changes),
        evidence=evidence,
        decision=decision,
        conversion=conversion,
        planar=None if shaken.planar is None else evidence.mean(target, shaken.planar),
        changes=changes,
        spreads={change.name: change.spread for change in shaken.moved},
    )


def _rocks_by_statics(request: Request, plan: Plan) -> bool:
    """Whether rocking starts where the measure passes a number: a peak acceleration of what it stands on."""
    on_ground = request.place.shakes_as_ground or request.records.on_floor
    in_plane = not plan.shaking.motions.both
    is_free = not request.objects.under.holders
    return plan.shaking.measure == PGA and on_ground and in_plane and is_free


def _fraction_at(level: Level, *, state: str = OVERTURNS) -> risk.Target:
    """The fraction of motions at a level, over all that it may be where it is not known exactly."""
    spread = level.spread.value if level.spread else 0.0
    return risk.fraction_target(level.value, state=state, spread=spread)


def _evidence(
    objects: Standing, shaken: Shaken, plan: Plan, conversion: Conversion | None
) -> risk.Evidence:
    """What estimates rest on: outcomes, and all that is not known, as shifts of ln level and of ln rate.

    Parameters
    ----------
    objects : the object and how it may stand
    shaken : what became of it, as it stands and otherwise
    plan : motions and levels of its place
    conversion : what is known of the velocity at the site, if anything
    """
    counted = next(iter(shaken.arrangements.values()))
    error = MODEL_ERRORS[objects.measured_as].beyond
    shifts = {change.name: risk.shift_of(*change.sides) for change in shaken.moved}
    shifts["model"] = risk.after_uplift(error)
    if not plan.shaking.motions.both:
        shifts["space"] = risk.after_uplift(SPACE)
    if conversion:
        shifts["conversion"] = risk.after_uplift(conversion.shift)
        if shaken.together is not None:
            shifts["together"] = risk.shift_of(*shaken.together)
    rates = _of_quantiles(counted, plan.hazard) if plan.hazard else {}
    return risk.Evidence(counted, shifts, rates)


def _decision(
    value: float, evidence: risk.Evidence, target: risk.Target, request: Request
) -> Decision:
    """Decide by a value against the probability that is accepted.

    If the target is a rate both are annual rates, as means over what is not known are taken of rates.

    Parameters
    ----------
    value : mean of what is estimated
    evidence, target : by which it is drawn
    request : with the accepted probability and its years
    """
    drawn, accepted = evidence.drawn(target), request.accepted
    if target.is_rate:
        value, accepted = drawn.middle, rate_of(accepted, request.years)
    # part of each source that is left when it has been measured
    left = {name: source.left for name, source in MEASUREMENTS.items()}
    return decide(value, drawn.values, drawn.prediction, left, accepted)


def _effect(
    target: risk.Target, evidence: risk.Evidence, name: str, spread: float
) -> Moved[float]:
    """What is estimated with a property one standard deviation smaller and larger.

    ``name``: of the source; ``spread``: its relative standard deviation [-].
    """
    prediction, sides = evidence.prediction, np.zeros(2)
    place = prediction.sources.index(name)
    shown = evidence.drawn(target).shown
    fill_sides(shown, prediction.draws.bins[place], sides)
    return Moved(name, spread, *sides.tolist())


def _at_site(shaken: Shaken, plan: Plan, conversion: Conversion | None) -> Shaken:
    """Outcomes under motions with the velocity of the site."""
    if conversion is None or conversion.known is None:
        return shaken
    few = conversion.of(plan.fewer.motions)
    compared = few if plan.compares_few else conversion
    counted = next(iter(shaken.arrangements.values()))
    return replace(
        shaken,
        together=conversion.sides(counted),
        arrangements={
            name: conversion.at_site(arrangement)
            for name, arrangement in shaken.arrangements.items()
        },
        moved=[change.turned(few.at_site) for change in shaken.moved],
        before=compared.at_site(shaken.before),
        planar=None if shaken.planar is None else conversion.at_site(shaken.planar),
        changed={
            name: compared.at_site(changed) for name, changed in shaken.changed.items()
        },
    )


def _at_site_of(
    conversion: Conversion,
) -> Callable[[ObjectOutcomes], ObjectOutcomes]:
    """Turn outcomes under any motions of a set into those with the velocity of the site."""

    def turn(found: ObjectOutcomes) -> ObjectOutcomes:
        """Outcomes of the same motions with the velocity of the site."""
        shaking = found.intensity_levels
        assert isinstance(shaking, Shaking)
        return conversion.of(shaking.motions).at_site(found)

    return turn


def _governing(request: Request, motions: MotionSet) -> tuple[HazardCurve, ...]:
    """The hazard curve that governs, and that of PGV beside it, if there is one.

    The first is of the measure of the level, or of the one in which capacities of the object scatter least.
    """
    asked = request.level.measure if request.level else None
    curves = [
        curve for curve in request.hazard if curve.measure == asked
    ] or request.hazard
    others = [curve for curve in curves if curve.measure != PGV]
    velocity = [curve for curve in request.hazard if curve.measure == PGV]
    if not others:
        return tuple(velocity)
    if len(others) == 1:
        return (*others, *velocity)

    def scatter(curve: HazardCurve) -> float:
        """Standard deviation of ln of the levels that first topple the object, in the measure of a curve."""
        shaking = outcomes.make_intensity_levels(motions, curve.measure)
        (found,) = shaking.outcomes_of([request.objects])
        first = found.first_levels()
        known = np.log(first[np.isfinite(first)])
        return float(known.std()) if known.size > 1 else math.inf

    return (min(others, key=scatter), *velocity)


def _site_level(request: Request, hazard: HazardCurve | None) -> Level | None:
    """The level asked about, or that of 475 years of the hazard."""
    if request.level is not None:
        if hazard is not None and request.level.measure != hazard.measure:
            raise InputError(
                f"the level is in {request.level.measure.imt} and the hazard in {hazard.measure.imt}; give "
                "both in one measure, or leave the level out."
            )
        return request.level
    return Level(hazard.measure, hazard.level(1 / 475)) if hazard else None


def _counts(now: ObjectOutcomes, level: Level | None) -> tuple[int, int, int] | None:
    """Numbers of motions at the level, of those that lift the object, and of those that topple it.

    None without a level, or if none was simulated there.
    """
    if level is None:
        return None
    levels, found = now.intensity_levels, np.zeros(3)
    tables = map(np.ascontiguousarray, (levels.allowed, now.rocked, now.overturned))
    fill_counts_at(levels.levels, level.value, *tables, found)
    total, rocked, fell = map(int, found)
    return (total, rocked, fell) if total else None


def _variants(request: Request, plan: Plan) -> list[Moved[Standing]]:
    """The object with every property moved to both sides; not all enter in a plane, or in space."""
    objects, in_space = request.objects, plan.shaking.motions.both
    idle = {"restitution"} if in_space else objects.idle_in_plane
    return [each for each in objects.variants() if each.name not in idle]


def _moved(
    requests: Sequence[Request], plan: Plan, meter: Meter | None
) -> list[list[Moved[ObjectOutcomes]]]:
    """Outcomes with every property of body and floor moved by its standard deviation, of each object.

    One place is common to all objects.
    """
    variants = [_variants(request, plan) for request in requests]
    sides = [side for each in variants for variant in each for side in variant.sides]
    shaken = iter(plan.fewest.outcomes_of(sides, meter))
    found = [
        [variant.turned(lambda _: next(shaken)) for variant in each]
        for each in variants
    ]
    objects = [request.objects for request in requests]
    for moved in requests[0].place.variants():
        floors = moved.turned(
            lambda place: plan.fewest.at(place).outcomes_of(objects, meter)
        )
        for each, lower, upper in zip(found, *floors.sides, strict=True):
            each.append(Moved(moved.name, moved.spread, lower, upper))
    return found


def _of_quantiles(now: ObjectOutcomes, hazard: HazardCurve) -> dict[str, float]:
    """Standard deviation of ln rate that the quantiles of the hazard stand for."""
    scores = special.ndtri(np.array(list(hazard.quantiles)))
    levels, fractions = now.intensity_levels.levels, now.fractions()
    curves = hazard.quantiles.values()
    rates = [risk.toppling_rate(levels, fractions, curve) for curve in curves]
    spread = spread_of_quantiles(scores, np.array(rates))
    return {} if math.isnan(spread) else {"hazard": float(spread)}


def _compared(evidence: risk.Evidence) -> risk.Evidence:
    """What comparisons rest on: the same, by fewer draws."""
    return replace(evidence, members=FEW_MEMBERS)


def _changes(
    target: risk.Target, evidence: risk.Evidence, shaken: Shaken
) -> tuple[Mitigation, ...]:
    """What each change of the object itself does; one onto a pad that it slides off is not shown to help."""
    known = {change: shaken.arrangements[own] for change, own in shaken.alike.items()}
    found = [
        *compare(target, evidence, shaken.before, shaken.changed),
        *compare(target, evidence, evidence.outcomes, known),
    ]
    if shaken.slides_off:
        pads = (Text.PAD, Text.PAD_SLIDES)
        found = [
            replace(each, shown=False) if each.change.id in pads else each
            for each in found
        ]
    return tuple(found)


def _most_helpful_first(
    found: list[Mitigation], target: risk.Target
) -> tuple[Mitigation, ...]:
    """Sort changes by what they do to the same motions, and by what is left where none topples the object."""
    factors = np.array([each.factor for each in found])
    values = np.array([each.value for each in found])
    order = np.zeros(len(found), dtype=np.int64)
    # a level helps by growing, a probability by shrinking
    fill_order(factors, values, target.is_level, order)
    return tuple(found[place] for place in order)


def _shown_safer(shaken: Shaken, changes: Sequence[Mitigation]) -> frozenset[str]:
    """Arrangements that the motions show to be safer than its own, or its own if safer than all others."""
    by_arrangement = {
        shaken.alike[change.change]: change
        for change in changes
        if change.change in shaken.alike
    }
    safer = {name for name, change in by_arrangement.items() if change.shown}
    are_worse = [
        choices.is_worse(change.lower, change.helps)
        for change in by_arrangement.values()
    ]
    if are_worse and all(are_worse):
        own = next(iter(shaken.arrangements))
        safer.add(own)
    return frozenset(safer)
