"""What an assessment found, as findings: the first screen, and what stands behind it.

Every decision of an answer is taken here; the texts stand in the catalogues of :mod:`rockfrag.words`.

In: an answer. Out: findings, each the id of a text with its numbers. Docs: ``docs/assess.md``, "What to do".
"""

import math
from collections.abc import Mapping

from rockfrag.assess.answer import Assessment
from rockfrag.assess.assumed import Assumption
from rockfrag.assess.core.decisions import Action
from rockfrag.assess.core.likelihood import likelihood_of
from rockfrag.assess.mitigations import Mitigation
from rockfrag.assess.motions import FEWEST_EARTHQUAKES
from rockfrag.assess.outcomes import LARGEST_FACTOR, STEPS, fraction_at
from rockfrag.assess.risk import Estimate
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.assess.texts import Text
from rockfrag.words.catalogue import FIRST, catalogue
from rockfrag.words.findings import (
    Finding,
    Number,
    Value,
    finding,
    limit,
    listed,
    percent,
    three,
    two,
    whole,
)

HARDLY = 0.1  # Fraction of the motions up to which an object hardly rocks
MOST_SOURCES = 3  # Sources of uncertainty that are named in a line
LEAST_PART = 0.05  # Part of the variance from which a source is worth naming [-]
MOST_ASSUMPTIONS = 3  # Assumptions that are named in a line; the page has all
LEAST_WORTH = 0.05  # Chance of deciding from which a measurement is listed [-]
MOST_CHANGES = 3  # Changes that are named in a line

# Annual rates between which a level and a hazard fit each other [1/year]
PLAUSIBLE_RATES = (1e-6, 0.2)
PLAUSIBLE_HAZARD: Mapping[str, tuple[float, float]] = {
    "PGA": (0.01, 2.0),
    "SA": (0.01, 6.0),
    "PGV": (0.5, 250.0),
}
"""Levels of 475 years between which sites lie, by measure, in its unit."""

Titled = dict[Finding, list[Finding]]
"""Findings by the title above them."""


def lines_of(found: Assessment, language: str = FIRST) -> list[str]:
    """Return the first screen of an answer in a language, a sentence each.

    Parameters
    ----------
    found : the answer
    language : of the texts

    Returns
    -------
    The lines.
    """
    return catalogue(language).lines(first_screen(found))


def details_of(found: Assessment, language: str = FIRST) -> list[str]:
    """Return what stands behind the first screen in a language, a line for each title.

    Parameters
    ----------
    found : the answer
    language : of the texts

    Returns
    -------
    The lines.
    """
    texts = catalogue(language)
    return [
        f"{texts.sentence(title)}: {texts.paragraph(findings)}"
        for title, findings in details(found).items()
    ]


# ---- the first screen


def first_screen(found: Assessment) -> list[Finding]:
    """How likely it topples, how far that is away, how likely in some years, and what to do."""
    if few_earthquakes(found):
        about = finding(Text.GIVE_EARTHQUAKES, least=FEWEST_EARTHQUAKES)
        return [how_likely(found), about]
    said = [how_likely(found)]
    if not (found.fraction is not None and found.does_not_move):
        said.append(how_far(found))
    if found.probability is not None:
        said.append(in_years(found, found.probability))
    return [*said, advice(found)]


def few_earthquakes(found: Assessment) -> bool:
    """Whether there are too few earthquakes for a verdict."""
    return len(set(found.counted.earthquakes)) < FEWEST_EARTHQUAKES


def _who(found: Assessment) -> dict[str, Value]:
    return {"name": found.request.called, "where": found.request.place.where}


def _amount(found: Assessment, value: float) -> Finding:
    measure = found.measure
    about = {"measure": measure.imt, "unit": measure.unit}
    return finding(Text.AMOUNT, value=two(value), **about)


def how_likely(found: Assessment) -> Finding:
    """How likely the object topples at the level, or where it starts to rock without one."""
    level, rocking, fraction = found.level, found.rocking, found.fraction
    if level is None or rocking is None or fraction is None:
        if not math.isfinite(found.rocks_from):
            return finding(Text.HOW_LIKELY_NEVER_ROCKS, **_who(found))
        starts = _amount(found, found.rocks_from)
        return finding(Text.HOW_LIKELY_NO_LEVEL, starts=starts, **_who(found))
    about = {**_who(found), "level": level.amount}
    if few_earthquakes(found):
        return _few(found, fraction, about)
    if found.does_not_move:
        about["starts"] = _amount(found, found.rocks_from)
        return finding(Text.HOW_LIKELY_AT_REST, fraction, **about)
    text = Text.HOW_LIKELY_HARDLY_ROCKS if rocking.value <= HARDLY else Text.HOW_LIKELY
    about["likelihood"] = finding(likelihood_of(fraction.value).value)
    return finding(text, fraction, p=_said_chance(fraction), **about)


def _few(found: Assessment, fraction: Estimate, about: dict[str, Value]) -> Finding:
    total = len(found.motions.ground)
    topple: Value = percent(fraction.value)
    if found.counts is not None:
        total, _, topple = found.counts
    number = len(set(found.counted.earthquakes))
    counts = {"topple": topple, "total": total, "n": number}
    return finding(Text.HOW_LIKELY_FEW_EARTHQUAKES, fraction, **counts, **about)


def _said_chance(estimate: Estimate) -> Value:
    """A probability, or its limit where all motions agree."""
    if estimate.value == 0 and estimate.upper > 0:
        return finding(Text.AT_MOST, upper=percent(estimate.upper))
    if estimate.value == 1 and estimate.lower < 1:
        return finding(Text.AT_LEAST, lower=percent(estimate.lower))
    return percent(estimate.value)


def how_far(found: Assessment) -> Finding:
    """The level at which half of the motions topple it."""
    half = found.amplitudes[0.5]
    if not math.isfinite(half.value):
        strongest = float(found.outcomes.intensity_levels.levels[-1])
        most = finding(Text.QUANTITY, value=two(strongest), unit=found.measure.unit)
        return finding(Text.HOW_FAR_BEYOND, half, most=most)
    unit, lower = found.measure.unit, two(half.lower)
    middle = finding(Text.QUANTITY, value=two(half.value), unit=unit)
    if not math.isfinite(half.upper):
        return finding(Text.HOW_FAR_FROM, half, half=middle, lower=lower)
    upper = two(half.upper)
    return finding(Text.HOW_FAR, half, half=middle, lower=lower, upper=upper)


def in_years(found: Assessment, probability: Estimate) -> Finding:
    """How likely it topples in the years asked for, by all shaking of the site."""
    years = three(found.request.years)
    if probability.value == 0 or _is_open(probability):
        upper = percent(probability.upper)
        return finding(Text.IN_YEARS_AT_MOST, probability, years=years, upper=upper)
    about = {"p": percent(probability.value), "years": years}
    return finding(Text.IN_YEARS, probability, **about, **_limits(probability))


def _is_open(estimate: Estimate) -> bool:
    """Whether so few earthquakes leave every value possible."""
    return estimate.lower <= 0 and estimate.upper >= 1


def _limits(estimate: Estimate) -> dict[str, Value]:
    return {"lower": limit(estimate.lower), "upper": limit(estimate.upper)}


def advice(found: Assessment) -> Finding:
    """What to do."""
    estimate = found.probability or found.fraction
    if estimate is None:
        return finding(Text.GIVE_LEVEL)
    decision = found.decision
    assert decision is not None
    if decision.action is Action.MEASURE:
        what = SOURCES[decision.source].measurement
        assert what is not None
        cases = whole(10 * decision.chance)
        return finding(Text.MEASURE_FIRST, estimate, what=what, cases=cases)
    secure = decision.action is Action.SECURE
    if found.probability is None:
        return _by_cost(found, estimate, secure=secure)
    if secure:
        return finding(Text.SECURE_IT, estimate)
    accepted = percent(found.request.accepted)
    years = three(found.request.years)
    return finding(Text.LEAVE_IT, estimate, accepted=accepted, years=years)


def _by_cost(found: Assessment, fraction: Estimate, *, secure: bool) -> Finding:
    """What to do without a hazard, where costs decide."""
    if found.does_not_move:
        return finding(Text.LEAVE_IT_AT_REST, fraction)
    text = Text.SECURE_UNLESS if secure else Text.LEAVE_UNLESS
    worth = fraction.value or fraction.upper
    return finding(text, fraction, p=percent(worth))


# ---- behind it


def details(found: Assessment) -> Titled:
    """What stands behind the first screen, by its titles."""
    years = three(found.request.years)
    said = {
        finding(Text.TITLE_LEVEL): at_level(found),
        finding(Text.TITLE_YEARS, years=years): over_years(found),
        finding(Text.TITLE_POSITION): position(found),
        finding(Text.TITLE_HELPS): helps(found),
        finding(Text.TITLE_SURE): how_sure(found),
    }
    return {title: findings for title, findings in said.items() if findings}


def at_level(found: Assessment) -> list[Finding]:
    """What the motions do at the level, and where rocking starts."""
    said = []
    if found.fraction is not None and found.rocking is not None:
        said += counted(found)
        if not found.does_not_move:
            said.append(between(found.fraction))
    said.append(starts(found))
    if found.level is not None and found.request.level is None:
        said.append(finding(Text.EXCEEDED_IN_475, level=found.level.amount))
    tenth = found.amplitudes[0.1]
    if found.fraction is None:
        if math.isfinite(tenth.value):
            said.append(finding(Text.TENTH_AT, tenth=_amount(found, tenth.value)))
        else:
            said.append(finding(Text.TENTH_BEYOND))
    return said


def counted(found: Assessment) -> list[Finding]:
    """How many motions rock and topple it at the level as recorded, and with the velocity of the site."""
    assert found.fraction is not None and found.rocking is not None
    said = []
    if found.counts is not None:
        (total, rocked, fell), every = found.counts, len(found.motions.ground)
        about = {"total": total, "rock": rocked, "topple": fell}
        text = Text.COUNTED
        if total < every:
            text, about["every"] = Text.COUNTED_SOME, every
        said.append(finding(text, **about))
    if found.conversion is not None and found.conversion.known is not None:
        rock, topple = percent(found.rocking.value), percent(found.fraction.value)
        said.append(finding(Text.COUNTED_MOVED, rock=rock, topple=topple))
    return said


def between(fraction: Estimate) -> Finding:
    """What of the motions could topple it with all that is not known."""
    if _is_open(fraction):
        return finding(Text.FRACTION_OPEN, fraction)
    if fraction.value == 0:
        upper = percent(fraction.upper)
        return finding(Text.FRACTION_AT_MOST, fraction, upper=upper)
    if fraction.value == 1:
        lower = percent(fraction.lower)
        return finding(Text.FRACTION_AT_LEAST, fraction, lower=lower)
    return finding(Text.FRACTION_BETWEEN, fraction, **_limits(fraction))


def starts(found: Assessment) -> Finding:
    """Where rocking starts."""
    if not math.isfinite(found.rocks_from):
        return finding(Text.STARTS_BEYOND)
    return finding(Text.STARTS_AT, starts=_amount(found, found.rocks_from))


def over_years(found: Assessment) -> list[Finding]:
    """How likely it topples in the years asked for, and what is accepted."""
    probability, years = found.probability, three(found.request.years)
    if probability is None:
        return [finding(Text.NEEDS_HAZARD)]
    accepted = percent(found.request.accepted)
    said = finding(Text.ACCEPTED, accepted=accepted, years=years)
    if probability.value == 0:
        upper = percent(probability.upper)
        none = finding(Text.YEARS_AT_MOST, probability, years=years, upper=upper)
        return [none, said]
    about: dict[str, Value] = {"p": percent(probability.value), "years": years}
    text = Text.YEARS_OPEN
    if not _is_open(probability):
        text, about = Text.YEARS_BETWEEN, {**about, **_limits(probability)}
    return [finding(text, probability, **about), said]


def value_of(found: Assessment, value: float) -> Value:
    """What is estimated: a fraction or probability, or an amplitude with its unit."""
    if found.probability is not None or found.fraction is not None:
        return percent(value)
    if math.isfinite(value):
        return finding(Text.QUANTITY, value=two(value), unit=found.measure.unit)
    return finding(Text.NOT_REACHED)


def position(found: Assessment) -> list[Finding]:
    """How it stands best, and how it moves."""
    said = []
    arrangements = found.by_arrangement
    if len(set(arrangements.values())) > 1:
        ranked = sorted(
            arrangements, key=lambda way: arrangements[way], reverse=_grows(found)
        )
        each = [
            finding(
                Text.WAY, way=finding(way), value=value_of(found, arrangements[way])
            )
            for way in ranked
        ]
        best = ranked[0]
        if best in found.shown_safer:
            said.append(finding(Text.SAFEST, way=finding(best), ways=listed(each)))
        else:
            said.append(finding(Text.NO_SAFEST, ways=listed(each)))
    return [*said, *moves(found)]


def _grows(found: Assessment) -> bool:
    """Whether what is estimated is an amplitude, which helps by growing."""
    return found.probability is None and found.fraction is None


def moves(found: Assessment) -> list[Finding]:
    """How the object moves: in one plane or in space."""
    objects = found.request.objects
    there = [holder.called() for holder in objects.under.holders]
    held = [finding(Text.HELD_AS_IT_STANDS, holders=listed(there))] if there else []
    if not found.motions.both:
        return [objects.plane, *held]
    said = [finding(objects.in_space_text)]
    if found.planar is not None:
        said.append(finding(Text.IN_ONE_PLANE, value=value_of(found, found.planar)))
    return [*said, *held]


def helps(found: Assessment) -> list[Finding]:
    """The changes that are shown to help, the best first."""
    if not found.mitigations:
        return [finding(Text.NOTHING_TRIED)]
    at_rest = found.does_not_move and found.probability is None
    if found.main.value == 0 or at_rest:
        return [finding(Text.NO_CHANGE_NEEDED)]
    shown = [change for change in found.mitigations if change.shown][:MOST_CHANGES]
    said = [mitigation(found, change) for change in shown]
    left_out = [] if found.holders_tried else [finding(Text.HOLDERS_NOT_TRIED)]
    return (said or [finding(Text.NO_CHANGE_SHOWN)]) + left_out


def _reduction(change: Mitigation) -> dict[str, Value]:
    """What a change takes off the risk, or adds to the shaking that the object bears, with its limits."""
    sign = -1.0 if change.factor > 1 else 1.0
    ends = sorted(sign * (1 - factor) for factor in (change.lower, change.upper))
    return {
        "value": _whole_percent(sign * (1 - change.factor)),
        "lower": whole(100 * ends[0]),
        "upper": whole(100 * ends[1]),
    }


def _whole_percent(part: float) -> Finding:
    return finding("whole_percent", value=whole(100 * part))


def mitigation(found: Assessment, change: Mitigation) -> Finding:
    """What a change does that is shown to help."""
    if change.factor == 0:
        return finding(Text.NONE_LEFT, change=change.change)
    text = Text.BEARS_MORE if _grows(found) else Text.REDUCES
    return finding(text, change=change.change, **_reduction(change))


def mitigation_cell(found: Assessment, change: Mitigation) -> Finding:
    """What any change does, for a cell of a table."""
    factor = change.factor
    if math.isnan(factor):
        return finding(Text.CELL_UNKNOWN)
    if _grows(found) and factor < 1:
        return finding(Text.CELL_BEARS_LESS, value=_whole_percent(1 - factor))
    if not _grows(found) and factor > 1:
        return finding(Text.CELL_INCREASES, times=two(factor))
    if factor == 0 and change.shown:
        return finding(Text.CELL_NONE_LEFT)
    if not change.shown:
        text = Text.CELL_BEARS_OPEN if _grows(found) else Text.CELL_REDUCES_OPEN
        return finding(text, value=_whole_percent(abs(1 - factor)))
    text = Text.CELL_BEARS_MORE if _grows(found) else Text.CELL_REDUCES
    return finding(text, **_reduction(change))


def uncertainty(found: Assessment) -> list[Finding]:
    """The sources from which most of the uncertainty comes."""
    named = [
        finding(
            Text.SOURCE_PART, source=SOURCES[name].called, part=_whole_percent(part)
        )
        for name, part in parts_of(found.main.sources).items()
        if part >= LEAST_PART
    ]
    if not named:
        return []
    return [finding(Text.UNCERTAINTY, sources=listed(named[:MOST_SOURCES]))]


def worth_measuring(found: Assessment) -> list[Finding]:
    """What each measurement would buy: in how many cases it decides, of those that may."""
    if found.decision is None or few_earthquakes(found):
        return []
    said = [
        finding(
            Text.WORTH_MEASURING,
            what=finding(f"measurement_{each.source}"),
            cases=whole(10 * each.chance),
        )
        for each in found.decision.measurements
        if each.chance >= LEAST_WORTH
    ]
    return [finding(Text.WORTH, measurements=listed(said))] if said else []


def how_sure(found: Assessment) -> list[Finding]:
    """What the answer rests on: the motions, the largest sources of uncertainty, and what was assumed."""
    short = [said.short for said in all_assumed(found) if said.short is not None]
    named, more = short[:MOST_ASSUMPTIONS], len(short[MOST_ASSUMPTIONS:])
    said = [finding(Text.SENTENCE, words=found.motions.about_set), *uncertainty(found)]
    said += worth_measuring(found)
    said += short_of_a_fall(found)
    if named:
        said.append(finding(Text.ASSUMED, assumptions=listed(named)))
    if more:
        said.append(finding(Text.MORE_ASSUMED, n=more))
    return said


def short_of_a_fall(found: Assessment) -> list[Finding]:
    """How many motions rock it so far that its edges chip and it steps aside, those that topple it included."""
    if found.level is None or STEPS not in found.outcomes.others:
        return []
    levels = found.outcomes.intensity_levels.levels
    parts = found.outcomes.fractions(state=STEPS)
    part = fraction_at(found.level.value, levels, parts)
    return [finding(Text.SHORT_OF_A_FALL, part=percent(part))] if part > 0 else []


def all_assumed(found: Assessment) -> list[Assumption]:
    """What was assumed, that first which widens the interval most."""
    sources = found.main.sources
    lines = [*found.request.place.assumed, *found.request.objects.under.assumed]

    def size(assumption: Assumption) -> float:
        return sum(sources.get(name, 0.0) ** 2 for name in assumption.sources)

    return sorted(lines, key=size, reverse=True)


def assumptions(found: Assessment) -> list[Finding]:
    """All that was assumed, and what the model leaves out."""
    request = found.request
    said = [assumption.why for assumption in all_assumed(found)]
    if request.place.building is not None:
        said.append(finding(Text.STAYS_ELASTIC))
    if not found.motions.both:
        said.append(finding(Text.ROCKS_IN_PLANE))
    if _has_worst_direction(found):
        said.append(finding(Text.DIRECTION_AT_RANDOM))
    if math.isfinite(found.flip_rate):
        said.append(finding(Text.FLIPS, part=percent(found.flip_rate)))
    said.append(_sliding(found))
    if found.outcomes.light:
        strongest = float(found.outcomes.intensity_levels.levels[-1])
        said.append(finding(Text.STAYS_ON_GROUND, level=_amount(found, strongest)))
    if found.conversion:
        said += _velocity(found)
    if found.hazard:
        source, measure = found.hazard.source, found.hazard.measure.imt
        said.append(finding(Text.HAZARD_OF, source=source, measure=measure))
    admitted = percent(found.counted.intensity_levels.allowed.mean())
    ends = {"least": two(1 / LARGEST_FACTOR), "most": two(LARGEST_FACTOR)}
    return [*said, finding(Text.SCALED_BY, part=admitted, **ends)]


def _has_worst_direction(found: Assessment) -> bool:
    directions = found.directions
    return directions is not None and math.isfinite(directions.factor)


def _sliding(found: Assessment) -> Finding:
    friction = found.request.objects.friction
    if friction is None or found.fraction is None or math.isnan(found.sliding_fraction):
        return finding(Text.DOES_NOT_SLIDE)
    parts = {"part": found.sliding_fraction, "without": found.fraction.value}
    said = {name: percent(part) for name, part in parts.items()}
    return finding(Text.MAY_SLIDE, friction=three(friction), **said)


def _velocity(found: Assessment) -> list[Finding]:
    """What is known of the ground velocity at the site, and how much it counts."""
    about, level = found.conversion, found.level
    assert about is not None and level is not None
    shared: dict[str, Value] = {
        "measure": about.measure.imt,
        "unit": about.measure.unit,
        "weight": two(about.weight),
        "of_set": three(about.of_set),
    }
    factor = three(math.exp(about.spread))
    if about.known is None:
        return [finding(Text.VELOCITY_UNKNOWN, factor=factor, **shared)]
    here, published = three(about.at_level(level)), about.known.published
    said = [finding(Text.VELOCITY_KNOWN, here=here, **shared)]
    if published is not None:
        facts = {
            "magnitude": three(published.magnitude),
            "distance": three(published.distance(level.value)),
            "vs30": three(published.vs30),
        }
        said.append(finding(Text.VELOCITY_PUBLISHED, **facts))
    if about.known.spread > 0:
        between_earthquakes = three(math.exp(about.known.spread))
        said.append(finding(Text.VELOCITY_SCATTERS, factor=between_earthquakes))
    if about.spread > 0:
        said.append(finding(Text.VELOCITY_MEAN_OPEN, factor=factor))
    return said


# ---- what looks wrong


def quality_flags(found: Assessment) -> list[Value]:
    """What a reader should check.

    Parameters
    ----------
    found : the answer

    Returns
    -------
    Findings, and texts that stand as they are.
    """
    said: list[Value] = [*found.request.objects.under.quality_flags]
    said += found.motions.warnings
    said += [*_hazard_flags(found), *_velocity_flags(found)]
    if found.request.objects.in_space and not found.motions.pairs:
        said.append(finding(Text.FLAG_ONE_COMPONENT))
    return [*said, *_influential(found)]


def _hazard_flags(found: Assessment) -> list[Finding]:
    hazard, asked = found.hazard, found.request.level
    if hazard is None:
        return []
    said = []
    if asked is not None:
        rate = float(hazard.rate(asked.value))
        if not PLAUSIBLE_RATES[0] <= rate <= PLAUSIBLE_RATES[1]:
            said.append(finding(Text.FLAG_RATE, level=asked.amount, rate=two(rate)))
    strong = hazard.level(1 / 475)
    least, most = PLAUSIBLE_HAZARD[found.measure.openquake]
    if not least <= strong <= most:
        said.append(finding(Text.FLAG_HAZARD, level=_amount(found, strong)))
    return said


def _velocity_flags(found: Assessment) -> list[Finding]:
    about = found.conversion
    if about is None or about.known is None or found.level is None:
        return []
    (least, most), here = about.ends, about.at_level(found.level)
    if least <= here <= most:
        return []
    numbers = {"here": here, "least": least, "most": most}
    said: dict[str, Number] = {name: three(value) for name, value in numbers.items()}
    return [finding(Text.FLAG_VELOCITY, unit=found.measure.unit, **said)]


FEWEST_FALLS = (
    4  # Of fewer motions that topple it none is said to come from one earthquake
)
MOST_OF_THEM = (
    0.5  # Part of the motions from which one earthquake is said to decide [-]
)


def _influential(found: Assessment) -> list[Finding]:
    """Earthquakes of which most of the motions are that topple the object at the level asked about."""
    if found.level is None:
        return []
    outcomes = found.outcomes
    fell = outcomes.overturned[:, outcomes.intensity_levels.place_of(found.level.value)]
    if fell.sum() < FEWEST_FALLS:
        return []
    names = outcomes.earthquakes[fell]
    parts = {str(name): float((names == name).mean()) for name in dict.fromkeys(names)}
    return [
        finding(Text.FLAG_INFLUENTIAL, part=_whole_percent(part), earthquake=name)
        for name, part in parts.items()
        if part > MOST_OF_THEM
    ]


# ---- in a cell or a line


def estimate_of(estimate: Estimate) -> Finding:
    """A probability with its interval, such as ``4.2 % (1.3 to 18 %)``, or with its bound where all agree."""
    if estimate.value == 0 and estimate.upper == 0:
        return finding(Text.ESTIMATE_ZERO, estimate)
    if estimate.value == 0:
        upper = percent(estimate.upper)
        return finding(Text.ESTIMATE_AT_MOST, estimate, upper=upper)
    if estimate.value == 1:
        lower = percent(estimate.lower)
        return finding(Text.ESTIMATE_AT_LEAST, estimate, lower=lower)
    if _is_open(estimate):
        return finding(Text.ESTIMATE_ALONE, estimate, p=percent(estimate.value))
    p = percent(estimate.value)
    return finding(Text.ESTIMATE_BETWEEN, estimate, p=p, **_limits(estimate))
