"""What an assessment found, as findings: the first screen, and what stands behind it.

Every decision of an answer is taken here; the texts stand in the catalogues of :mod:`rockfrag.words`.

In: an answer. Out: findings, each the id of a text with its numbers. Docs: ``docs/assess.md``, "What to do".
"""

import math
from collections.abc import Callable, Mapping

import numpy as np

from rockfrag.assess.answer import Assessment
from rockfrag.assess.assumed import Assumption
from rockfrag.assess.core import choices
from rockfrag.assess.core.decisions import Action
from rockfrag.assess.core.estimates import sum_of_squares
from rockfrag.assess.core.likelihood import Likelihood
from rockfrag.assess.core.scales import LARGEST_FACTOR
from rockfrag.assess.mitigations import Mitigation
from rockfrag.assess.risk import Estimate
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.assess.standing.holders import Casters
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

MOST_SOURCES = 3  # Sources of uncertainty that are named in a line
MOST_ASSUMPTIONS = 3  # Assumptions that are named in a line; the page has all
MANY_LEAN = 0.05  # Fraction of motions that leave it leaning which is said at once
MOST_CHANGES = 3  # Changes that are named in a line

# Annual rates between which a level and a hazard fit each other [1/year]
PLAUSIBLE_RATES = (1e-6, 0.2)
PLAUSIBLE_HAZARD: Mapping[str, tuple[float, float]] = {
    "PGA": (0.01, 2.0),
    "SA": (0.01, 6.0),
    "PGV": (0.5, 250.0),
}
"""Levels of 475 years between which sites lie, by measure, in its unit."""

TEXTS: Mapping[Callable[..., int], tuple[str, ...]] = {
    choices.likelihood: tuple(step.value for step in Likelihood),
    choices.how_likely: (
        *(Text.HOW_LIKELY_FEW_EARTHQUAKES, Text.HOW_LIKELY_AT_REST),
        *(Text.HOW_LIKELY_HARDLY_ROCKS, Text.HOW_LIKELY),
    ),
    choices.chance: ("", Text.AT_MOST, Text.AT_LEAST),
    choices.how_far: (Text.HOW_FAR, Text.HOW_FAR_FROM, Text.HOW_FAR_BEYOND),
    choices.in_years: (Text.IN_YEARS, Text.IN_YEARS_AT_MOST),
    choices.advice: (
        *(Text.MEASURE_FIRST, Text.SECURE_IT, Text.LEAVE_IT),
        *(Text.LEAVE_IT_AT_REST, Text.SECURE_UNLESS, Text.LEAVE_UNLESS),
    ),
    choices.counted: (Text.COUNTED, Text.COUNTED_SOME),
    choices.between: (
        *(Text.FRACTION_OPEN, Text.FRACTION_AT_MOST),
        *(Text.FRACTION_AT_LEAST, Text.FRACTION_BETWEEN),
    ),
    choices.starts: (Text.STARTS_AT, Text.STARTS_BEYOND),
    choices.over_years: (Text.YEARS_AT_MOST, Text.YEARS_OPEN, Text.YEARS_BETWEEN),
    choices.reduces: (
        *(Text.NONE_LEFT, Text.REDUCES, Text.BEARS_MORE, Text.REDUCES_NEARLY_ALL),
    ),
    choices.change_alone: (
        *(Text.CELL_UNKNOWN, Text.CELL_BEARS_LESS, Text.CELL_INCREASES),
        *(Text.CELL_NONE_LEFT, Text.CELL_BEARS_OPEN, Text.CELL_REDUCES_OPEN),
        *(Text.CELL_BEARS_MORE, Text.CELL_REDUCES, Text.CELL_REDUCES_NEARLY_ALL),
        Text.CELL_SAME,
    ),
    choices.safest: (Text.SAFEST, Text.NO_SAFEST),
}
"""Texts among which each of :mod:`rockfrag.assess.core.choices` chooses by numbers, for the page too."""


def _text(choice: Callable[..., int], *numbers: float) -> str:
    """The text that a choice takes."""
    return TEXTS[choice][choice(*numbers)]


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
        about = finding(Text.GIVE_EARTHQUAKES, least=choices.FEWEST_EARTHQUAKES)
        return [how_likely(found), about]
    said = [how_likely(found)]
    if not (found.fraction is not None and found.does_not_move):
        said.append(how_far(found))
    if found.probability is not None:
        said.append(in_years(found, found.probability))
    return [*said, *left_leaning(found), advice(found)]


def left_leaning(found: Assessment) -> list[Finding]:
    """How many motions leave it leaning at a wall or in a tie beside those that topple it, where they are many."""
    part = many_lean(found)
    return [] if part is None else [finding(Text.LEFT_LEANING, part=percent(part))]


def many_lean(found: Assessment) -> float | None:
    """Fraction of motions that leave it leaning and do not topple it; None where that is unknown or small."""
    if found.leans is None or found.fraction is None:
        return None
    leans = found.leans.value - found.fraction.value
    return leans if leans > MANY_LEAN else None


def few_earthquakes(found: Assessment) -> bool:
    """Whether there are too few earthquakes for a verdict."""
    return choices.are_few(len(set(found.counted.earthquakes)))


def _who(found: Assessment) -> dict[str, Value]:
    return {"name": found.request.called, "where": found.request.where}


def _amount(found: Assessment, value: float) -> Finding:
    """A level of the measure with its unit, in words."""
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
    few, at_rest = few_earthquakes(found), found.does_not_move
    text = _text(choices.how_likely, few, at_rest, rocking.value)
    if text == Text.HOW_LIKELY_FEW_EARTHQUAKES:
        return _few(found, fraction, about)
    if text == Text.HOW_LIKELY_AT_REST:
        if not math.isfinite(found.rocks_from):
            return finding(Text.HOW_LIKELY_ROCKS_NOWHERE, fraction, **about)
        about["starts"] = _amount(found, found.rocks_from)
        return finding(text, fraction, **about)
    about["likelihood"] = finding(_text(choices.likelihood, fraction.value))
    return finding(text, fraction, p=_said_chance(fraction), **about)


def _few(found: Assessment, fraction: Estimate, about: dict[str, Value]) -> Finding:
    """The fraction of motions in numbers, where they are of too few earthquakes for an interval."""
    total = len(found.motions.ground)
    topple: Value = percent(fraction.value)
    if found.counts is not None:
        total, _, topple = found.counts
    number = len(set(found.counted.earthquakes))
    counts = {"topple": topple, "total": total, "n": number}
    return finding(Text.HOW_LIKELY_FEW_EARTHQUAKES, fraction, **counts, **about)


def _said_chance(estimate: Estimate) -> Value:
    """A probability, or its limit where all motions agree."""
    text = _text(choices.chance, *_numbers(estimate))
    if text == Text.AT_MOST:
        return finding(text, upper=percent(estimate.upper))
    if text == Text.AT_LEAST:
        return finding(text, lower=percent(estimate.lower))
    return percent(estimate.value)


def _numbers(estimate: Estimate) -> tuple[float, float, float]:
    """Value, lower and upper limit of an estimate."""
    return estimate.value, estimate.lower, estimate.upper


def how_far(found: Assessment) -> Finding:
    """The level at which half of the motions topple it."""
    half = found.amplitudes[0.5]
    text, unit = _text(choices.how_far, half.value, half.upper), found.measure.unit
    if text == Text.HOW_FAR_BEYOND:
        strongest = float(found.outcomes.intensity_levels.levels[-1])
        most = finding(Text.QUANTITY, value=two(strongest), unit=unit)
        return finding(text, half, most=most)
    middle = finding(Text.QUANTITY, value=two(half.value), unit=unit)
    about: dict[str, Value] = {"half": middle, "lower": two(half.lower)}
    if text == Text.HOW_FAR:
        about["upper"] = two(half.upper)
    return finding(text, half, **about)


def in_years(found: Assessment, probability: Estimate) -> Finding:
    """How likely it topples in the years asked for, by all shaking of the site."""
    years = three(found.request.years)
    text = _text(choices.in_years, *_numbers(probability))
    if text == Text.IN_YEARS_AT_MOST:
        upper = percent(probability.upper)
        return finding(text, probability, years=years, upper=upper)
    about = {"p": percent(probability.value), "years": years}
    return finding(text, probability, **about, **_limits(probability))


def _is_open(estimate: Estimate) -> bool:
    """Whether so few earthquakes leave every value possible."""
    return choices.is_open(estimate.lower, estimate.upper)


def _limits(estimate: Estimate) -> dict[str, Value]:
    return {"lower": limit(estimate.lower), "upper": limit(estimate.upper)}


def advice(found: Assessment) -> Finding:
    """What to do."""
    estimate = found.probability or found.fraction
    if estimate is None:
        return finding(Text.GIVE_LEVEL)
    decision = found.decision
    assert decision is not None
    by_hazard = found.probability is not None
    action = list(Action).index(decision.action)
    worth = estimate.value or estimate.upper
    text = _text(choices.advice, action, by_hazard, found.does_not_move, worth)
    about: dict[str, Value] = {}
    if text == Text.MEASURE_FIRST:
        what = SOURCES[decision.source].measurement
        assert what is not None
        about = {"what": what, "cases": whole(10 * decision.chance)}
    elif text == Text.LEAVE_IT:
        about = {"accepted": percent(found.request.accepted)}
        about["years"] = three(found.request.years)
    elif text in (Text.SECURE_UNLESS, Text.LEAVE_UNLESS):
        about = {"p": percent(worth)}
    return finding(text, estimate, **about)


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
        text = _text(choices.counted, total, every)
        if text == Text.COUNTED_SOME:
            about["every"] = every
        said.append(finding(text, **about))
    if found.conversion is not None and found.conversion.known is not None:
        rock, topple = percent(found.rocking.value), percent(found.fraction.value)
        said.append(finding(Text.COUNTED_MOVED, rock=rock, topple=topple))
    return said


def between(fraction: Estimate) -> Finding:
    """What of the motions could topple it with all that is not known."""
    text = _text(choices.between, *_numbers(fraction))
    about: dict[str, Value] = {}
    if text == Text.FRACTION_AT_MOST:
        about = {"upper": percent(fraction.upper)}
    elif text == Text.FRACTION_AT_LEAST:
        about = {"lower": percent(fraction.lower)}
    elif text == Text.FRACTION_BETWEEN:
        about = _limits(fraction)
    return finding(text, fraction, **about)


def starts(found: Assessment) -> Finding:
    """Where rocking starts."""
    text = _text(choices.starts, found.rocks_from)
    if text == Text.STARTS_BEYOND:
        return finding(text)
    return finding(text, starts=_amount(found, found.rocks_from))


def over_years(found: Assessment) -> list[Finding]:
    """How likely it topples in the years asked for, and what is accepted."""
    probability, years = found.probability, three(found.request.years)
    if probability is None:
        return [finding(Text.NEEDS_HAZARD)]
    accepted = percent(found.request.accepted)
    said = finding(Text.ACCEPTED, accepted=accepted, years=years)
    text = _text(choices.over_years, *_numbers(probability))
    about: dict[str, Value] = {"years": years}
    if text == Text.YEARS_AT_MOST:
        about["upper"] = percent(probability.upper)
    else:
        about["p"] = percent(probability.value)
    if text == Text.YEARS_BETWEEN:
        about |= _limits(probability)
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
        text, about = _text(choices.safest, best in found.shown_safer), {}
        if text == Text.SAFEST:
            about["way"] = finding(best)
        said.append(finding(text, ways=listed(each), **about))
    return [*said, *moves(found)]


def _grows(found: Assessment) -> bool:
    """Whether what is estimated is an amplitude, which helps by growing."""
    return found.probability is None and found.fraction is None


def moves(found: Assessment) -> list[Finding]:
    """How the object moves: in one plane or in space."""
    objects = found.request.objects
    there = [holder.called() for holder in objects.under.holders]
    held = [finding(Text.HELD_AS_IT_STANDS, holders=listed(there))] if there else []
    said: list[Finding] = []
    casters = [each for each in objects.under.holders if isinstance(each, Casters)]
    # on casters it may start to rock at no level that was tried
    rocks = not casters or math.isfinite(found.rocks_from)
    if any(not each.locked for each in casters):
        said.append(finding(Text.ROLLS_ON_CASTERS))
    elif not rocks:
        said.append(finding(Text.SLIDES_ON_CASTERS))
    if not found.motions.both:
        return [*said, *([objects.plane] if rocks else []), *held]
    if rocks:
        said.append(finding(objects.in_space_text))
    if found.planar is not None:
        said.append(finding(Text.IN_ONE_PLANE, value=value_of(found, found.planar)))
    return [*said, *held]


def helps(found: Assessment) -> list[Finding]:
    """The changes that are shown to help, the best first."""
    if not found.mitigations:
        return [finding(Text.NOTHING_TRIED)]
    by_hazard = found.probability is not None
    if not choices.needs_change(found.main.value, found.does_not_move, by_hazard):
        return [finding(Text.NO_CHANGE_NEEDED)]
    shown = [change for change in found.mitigations if change.shown][:MOST_CHANGES]
    said = [mitigation(found, change) for change in shown]
    return (said or [finding(Text.NO_CHANGE_SHOWN)]) + _holders_left_out(found)


def _holders_left_out(found: Assessment) -> list[Finding]:
    """Why what may hold it was not tried, if so: without a level nothing is asked of it, or the page tries it."""
    if found.tries_holders:
        return []
    if found.level is None:
        return [finding(Text.HOLDERS_NEED_LEVEL)]
    return [finding(Text.HOLDERS_NOT_TRIED)]


def _reduction(change: Mitigation) -> dict[str, Value]:
    """What a change takes off the risk, or adds to the shaking that the object bears, with its limits."""
    found = np.zeros(3)
    choices.tell_reduction(change.factor, change.lower, change.upper, found)
    value, lower, upper = found.tolist()
    return {"value": percent(value), "lower": limit(lower), "upper": limit(upper)}


def _nearly_all(change: Mitigation) -> dict[str, Value]:
    """The least that a change takes off that takes off nearly all."""
    return {"lower": whole(choices.whole_percent_below(1.0 - change.upper))}


def _whole_percent(part: float) -> Finding:
    return finding("whole_percent", value=whole(100 * part))


def mitigation(found: Assessment, change: Mitigation) -> Finding:
    """What a change does that is shown to help."""
    text = _text(choices.reduces, change.factor, _grows(found))
    if text == Text.NONE_LEFT:
        return finding(text, change=change.change)
    if text == Text.REDUCES_NEARLY_ALL:
        return finding(text, change=change.change, **_nearly_all(change))
    return finding(text, change=change.change, **_reduction(change))


def mitigation_cell(found: Assessment, change: Mitigation) -> Finding:
    """What any change does, for a cell of a table."""
    factor = change.factor
    text = _text(choices.change_alone, factor, _grows(found), change.shown)
    about: dict[str, Value] = {"value": percent(abs(1 - factor))}
    if text in (Text.CELL_UNKNOWN, Text.CELL_NONE_LEFT, Text.CELL_SAME):
        about = {}
    elif text == Text.CELL_REDUCES_NEARLY_ALL:
        about = _nearly_all(change)
    elif change.shown:
        about = _reduction(change)
    return finding(text, **about)


def uncertainty(found: Assessment) -> list[Finding]:
    """The sources from which most of the uncertainty comes."""
    named = [
        finding(
            Text.SOURCE_PART, source=SOURCES[name].called, part=_whole_percent(part)
        )
        for name, part in parts_of(found.main.sources).items()
        if choices.names_source(part)
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
        if choices.lists_measurement(each.chance)
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
    if found.rocks_far is None or found.rocks_far.value <= 0:
        return []
    return [finding(Text.SHORT_OF_A_FALL, part=percent(found.rocks_far.value))]


def all_assumed(found: Assessment) -> list[Assumption]:
    """What was assumed, that first which widens the interval most."""
    sources = found.main.sources
    lines = [*found.request.place.assumed, *found.request.objects.under.assumed]

    def size(assumption: Assumption) -> float:
        widened = [sources.get(name, 0.0) for name in assumption.sources]
        return float(sum_of_squares(np.array(widened, dtype=np.float64)))

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
    """What friction does: the fraction that topples with it and without it."""
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
    """What looks wrong with the hazard curve: rates and levels that no site has."""
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
    """What is wrong with the site's PGV over the measure, where the motions hold none like it."""
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
