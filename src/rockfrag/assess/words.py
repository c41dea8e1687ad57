"""The answer in words: five lines for a terminal, and what they rest on."""

import math
from collections.abc import Mapping

from rockfrag.assess.answer import Assessment
from rockfrag.assess.assumed import Assumption
from rockfrag.assess.mitigations import Mitigation
from rockfrag.assess.narrowing import MEASUREMENTS, is_wide, narrowed
from rockfrag.assess.outcomes import LARGEST_FACTOR
from rockfrag.assess.risk import LEVEL, Estimate
from rockfrag.assess.scale import SCALE_WORDS, classes
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.report.wording import counted, listed, sentence

NAMES: Mapping[str, str] = {name: source.words for name, source in SOURCES.items()}
"""Sources of uncertainty and assumptions as a reader may know them."""

MOST_SOURCES = 3
"""Sources of uncertainty that are named in a line."""

LEAST_PART = 0.05
"""Part of the variance from which a source is worth naming [-]."""

MANY = 0.5
"""Fraction of motions from which an object is said to topple."""

FEW = 0.01
"""Fraction of motions up to which it is said to be unlikely to topple."""

ROCK, TOPPLE = 1, 2
"""Places of what motions do in the counts of an assessment."""

MOST_ASSUMPTIONS = 3
"""Assumptions that are named in a line; the page has all."""


def fraction_words(value: float) -> str:
    """A probability or share in per cent, to two digits."""
    if not math.isfinite(value):
        return "unknown"
    if value <= 0 or value >= 1:
        return f"{100 * value:.0f} %"
    if value < 1e-5:
        return "less than 0.001 %"
    if value > 0.995:
        return "more than 99 %"
    return f"{100 * value:.2g} %"


def estimate_words(estimate: Estimate) -> str:
    """A probability with its interval, such as ``4.2 % (1.3 to 18 %)``, or with its bound where all agree."""
    if estimate.value == 0:
        if estimate.upper == 0:
            return "0 %"
        return f"0 % (upper limit {fraction_words(estimate.upper)})"
    if estimate.value == 1:
        return f"100 % (lower limit {fraction_words(estimate.lower)})"
    if not _has_interval(estimate):
        return fraction_words(estimate.value)
    return f"{fraction_words(estimate.value)} ({_range(estimate)})"


def _range(estimate: Estimate) -> str:
    """The limits of an interval, such as ``1.3 to 18 %``."""
    return range_words(estimate.lower, estimate.upper)


def range_words(lower: float, upper: float) -> str:
    """Two limits in per cent, such as ``1.3 to 18 %``."""
    return f"{_limit(lower)} to {_limit(upper)} %"


def _limit(fraction: float) -> str:
    """A limit in per cent: whole numbers from 10 on, two digits from 1 on, one below and as near to 100."""
    percent = 100 * fraction
    if percent < 5e-4:
        return "0"
    if 99.5 <= percent <= 100 - 5e-4:
        return f"{percent:.{-math.floor(math.log10(100 - percent))}f}"
    if percent >= 10:
        return f"{percent:.0f}"
    return f"{percent:.2g}" if percent >= 1 else f"{percent:.1g}"


def _has_interval(estimate: Estimate) -> bool:
    """Whether the interval says anything: one earthquake alone gives none."""
    return not (estimate.lower <= 0 and estimate.upper >= 1)


def value_words(found: Assessment, value: float) -> str:
    """What is estimated, as a fraction in per cent or as an amplitude with its unit."""
    if found.probability or found.fraction:
        return fraction_words(value)
    if not math.isfinite(value):
        return "not reached"
    return f"{value:.2g} {found.measure.unit}"


def five_lines(found: Assessment) -> list[str]:
    """Return the answer in five lines."""
    return [
        f"Result: {at_the_site(found)}",
        f"Risk: {risk(found)}",
        f"Position: {positions(found)}",
        f"What helps: {helps(found)}",
        f"How sure: {sure(found)}",
    ]


def headline(found: Assessment) -> str:
    """Say in a few words whether the object rocks and topples; the heading of the page."""
    name = _subject(found)
    if found.fraction is None or found.level is None or found.rocking is None:
        half = found.amplitudes[0.5].value
        if not math.isfinite(half):
            return f"{name}: no shaking that was tried topples it in half of the motions"
        return f"{name}: half of the motions topple it at {found.measure.imt} {half:.2g} {found.measure.unit}"
    at = found.level.words
    if does_not_move(found):
        return f"{name} does not move at {at}"
    if found.rocking.value == 0:
        return f"{name} is not expected to move at {at}"
    if not_decidable(found):
        return f"{name} rocks at {at}; whether it topples is open"
    if found.fraction.value >= MANY:
        return f"{name} is likely to topple at {at}"
    if found.fraction.value > FEW:
        return f"{name} may topple at {at}"
    return f"{name} may rock at {at} but is unlikely to topple"


def does_not_move(found: Assessment) -> bool:
    """Whether even what is not known leaves the object at rest at the level."""
    return found.rocking is not None and found.rocking.upper == 0


def not_decidable(found: Assessment) -> bool:
    """Whether the interval reaches from unlikely to likely toppling."""
    return found.fraction is not None and is_wide(found.fraction)


def _subject(found: Assessment) -> str:
    return sentence(found.request.name)


def _where(found: Assessment) -> str:
    place = found.request.place
    return place.words + (f" ({place.floor_name})" if place.floor_name else "")


def at_the_site(found: Assessment) -> str:
    """What happens at the level asked about, or which levels topple the object."""
    who = f"{_subject(found)} {_where(found)}"
    if found.level is None or found.fraction is None or found.rocking is None:
        return f"{who}: {_amplitudes(found)}"
    period = " (exceeded once in 475 years on average)" if found.request.level is None else ""
    at = f"at {found.level.words}{period}"
    if found.rocking.value == 0:
        return f"{who} {_at_rest(found, at)}"
    rocks = f"{_counted(found, ROCK)} it rock"
    said = f"{_counted(found, TOPPLE)} it{_interval(found.fraction)}; {rocks}."
    if not_decidable(found):
        whether = f"Whether {found.request.name} {_where(found)} topples {at}"
        return (
            f"{whether} is not decidable with what was given: {said} {_would_narrow(found)}".strip()
        )
    may = "may topple"
    if found.fraction.value >= MANY:
        may = "is likely to topple"
    elif found.fraction.value == 0:
        may = "is unlikely to topple"
    return f"{who} {may} {at}: {said}"


def _at_rest(found: Assessment, at: str) -> str:
    """What is said of an object that no motion makes rock."""
    assert found.fraction is not None and found.level is not None
    starts = _starts(found)
    if does_not_move(found):
        return f"does not move {at}; it starts to rock at {starts}."
    limit = f"upper limit of toppling {fraction_words(found.fraction.upper)}"
    if found.rocks_from > found.level.value:
        return (
            f"is not expected to move {at}: it starts to rock at {starts}, which what is not known of it could "
            f"lower ({limit})."
        )
    return f"is not expected to move {at}: {_counted(found, ROCK)} it rock ({limit})."


def _starts(found: Assessment) -> str:
    if not math.isfinite(found.rocks_from):
        return "more than was tried"
    return f"{found.measure.imt} {found.rocks_from:.2g} {found.measure.unit}"


def _total(found: Assessment) -> int:
    return found.counts[0] if found.counts else len(found.motions.ground)


def _counted(found: Assessment, what: int) -> str:
    """How many motions do it, such as ``1 of 100 motions topples``."""
    single, many = {ROCK: ("makes", "make"), TOPPLE: ("topples", "topple")}[what]
    fraction = found.rocking if what == ROCK else found.fraction
    assert fraction is not None
    if fraction.value == 0:
        return f"none of {_total(found)} motions {single}"
    if found.counts is None:
        return f"{fraction_words(fraction.value)} of the motions {many}"
    number, total = found.counts[what], found.counts[0]
    if number == total:
        return f"all {total} motions {many}"
    return f"{number} of {total} motions {single if number == 1 else many}"


def _interval(estimate: Estimate) -> str:
    if estimate.value == 1:
        return f" (lower limit {fraction_words(estimate.lower)})"
    if estimate.value == 0:
        return f" (upper limit {fraction_words(estimate.upper)})"
    if not _has_interval(estimate):
        return " (no interval can be given)"
    return f" ({100 * LEVEL:.0f} % interval {_range(estimate)})"


def _would_narrow(found: Assessment) -> str:
    return _narrowing(found.fraction) if found.fraction else ""


def _narrowing(estimate: Estimate) -> str:
    """``Knowing the ground velocity (PGV) of the site would narrow the interval to 2 to 19 %.`` or nothing."""
    better = narrowed(estimate)
    if better is None or _range(better.estimate) == _range(estimate):
        return ""
    words = " and ".join(MEASUREMENTS[name].words for name in better.known)
    return f"Knowing {words} would narrow the interval to {_range(better.estimate)}."


def _amplitudes(found: Assessment) -> str:
    tenth, half = (found.amplitudes[p] for p in (0.1, 0.5))
    name, unit = found.measure.imt, found.measure.unit
    starts = f"it starts to rock at {_starts(found)}; "
    if not math.isfinite(tenth.value):
        return f"{starts}even the strongest shaking that was tried topples it in fewer than one in ten motions."
    more = f", half of them at {half.value:.2g} {unit}" if math.isfinite(half.value) else ""
    limits = (
        f" ({tenth.lower:.2g} to {tenth.upper:.2g} {unit})"
        if math.isfinite(tenth.upper) and tenth.lower > 0
        else ""
    )
    return (
        f"{starts}one in ten motions topples it at {name} {tenth.value:.2g} {unit}{limits}{more}."
    )


def risk(found: Assessment) -> str:
    """The probability, whether that is much, and what to do."""
    if found.probability is None:
        return (
            "It is not computed without a hazard; add a hazard curve (--hazard FILE) or the return period of "
            "the level (--return-period 475)."
        )
    years = found.request.years
    step = classes(found.probability, years)
    if found.probability.value == 0:
        first = (
            "None of the motions topples it at any level that was tried; the probability in "
            f"{years:g} years is at most {fraction_words(found.probability.upper)}"
        )
    else:
        first = (
            f"It topples with a probability of {fraction_words(found.probability.value)} in {years:g} years"
            f"{_interval(found.probability)}"
        )
    weaker = (
        f" All shaking of the site is counted, weaker and stronger than {found.level.words}."
        if found.level is not None
        else ""
    )
    return f"{first}. That is {step.name} on our scale ({SCALE_WORDS}). {step.advice}{weaker}"


def positions(found: Assessment) -> str:
    """The ways in which it can stand, the best one, and the direction that it faces."""
    ranked = _ranked(found)
    direction = worst_direction(found)
    if len(ranked) == 1:
        return direction
    words = ", ".join(f"{name} {_position_value(found, value)}" for name, value in ranked)
    if len({value for _, value in ranked}) == 1:
        return f"All positions are equally safe ({words}). {direction}"
    return f"It is safest {ranked[0][0]} ({words}). {direction}"


def _position_value(found: Assessment, value: float) -> str:
    return "none of the motions" if value == 0 else value_words(found, value)


def _ranked(found: Assessment) -> list[tuple[str, float]]:
    """Arrangements with what is estimated, the safest first."""
    grows = found.probability is None and found.fraction is None
    return sorted(found.by_arrangement.items(), key=lambda item: -item[1] if grows else item[1])


def safest(found: Assessment) -> str:
    """The arrangement in which the object is safest."""
    return _ranked(found)[0][0]


def worst_direction(found: Assessment) -> str:
    """In which plane it rocks, and whether the worst direction is counted."""
    if found.motions.both:
        return _in_space(found)
    plane = f"It rocks {found.request.objects.plane}."
    directions = found.directions
    if directions is None or not math.isfinite(directions.factor):
        return f"{plane} Motions come in the direction in which they were recorded; the worst one is not counted."
    return (
        f"{plane} Motions come in the direction in which they were recorded, at random; in the worst one "
        f"{100 * directions.factor:.0f} % of the shaking is enough, which is not counted in these figures."
    )


def _in_space(found: Assessment) -> str:
    """That it is simulated in space, and what one plane would say beside it."""
    is_round = found.request.objects.round
    words = "The base is round; it rolls" if is_round else "It rocks, turns and walks"
    words += " in space under both components of each record"
    if found.planar is None:
        return f"{words}."
    return (
        f"{words}, which counts; in one plane, along one component, it would be "
        f"{_position_value(found, found.planar)}."
    )


def helps(found: Assessment) -> str:
    """Changes that help, most helpful first."""
    if not found.mitigations:
        return "Nothing was tried."
    target = found.main
    if target.value == 0:
        if not_decidable(found):
            return "None of the motions topples it as it stands, so none can show what a change is worth."
        return "No change is needed for this: none of the motions topples it as it stands."
    best = [mitigation for mitigation in found.mitigations if mitigation.helps][:3]
    if not best and all(math.isnan(mitigation.factor) for mitigation in found.mitigations):
        return "Too few of the motions by which changes are compared topple it to show what a change is worth."
    if not best:
        return "None of the changes that were tried helps."
    return sentence("; ".join(mitigation_words(found, mitigation) for mitigation in best)) + "."


def mitigation_words(found: Assessment, mitigation: Mitigation) -> str:
    """A change and what it does to the risk, or to the shaking that the object bears."""
    of_amplitude = found.probability is None and found.fraction is None
    if math.isnan(mitigation.factor):
        return f"{mitigation.name}: {value_words(found, mitigation.value)}"
    if of_amplitude:
        change = 100 * (mitigation.factor - 1)
        more = "more" if change >= 0 else "less"
        return f"{mitigation.name} lets it bear {abs(change):.0f} % {more} shaking{_limits(mitigation, -1)}"
    if mitigation.factor == 0:
        return f"{mitigation.name} leaves no motion that topples it"
    change = 100 * (1 - mitigation.factor)
    if change < 0:
        return f"{mitigation.name} makes the risk {mitigation.factor:.2g} times as large"
    return f"{mitigation.name} reduces the risk by {change:.0f} %{_limits(mitigation, 1)}"


def _limits(mitigation: Mitigation, sign: int) -> str:
    """Limits of a reduction (1) or a gain (-1) in per cent."""
    if not math.isfinite(mitigation.lower):
        return ""
    low, high = sorted(sign * 100 * (1 - limit) for limit in (mitigation.lower, mitigation.upper))
    return f" ({low:z.0f} to {high:z.0f} %)".replace("-", "−")


def sure(found: Assessment) -> str:
    """The motions, what makes the interval wide, what would narrow it, and what was assumed."""
    return " ".join([f"{found.motions.words}.", *uncertainty(found), *_assumed(found)])


def uncertainty(found: Assessment) -> list[str]:
    """Sentences of what makes the interval wide, and of what would narrow it."""
    main = found.main
    lines = []
    named = [
        f"{100 * part:.0f} % from {NAMES[name]}"
        for name, part in parts_of(main.sources).items()
        if part >= LEAST_PART
    ]
    if named:
        lines.append(f"The variance of the interval comes to {listed(named[:MOST_SOURCES])}.")
    named_already = not_decidable(found) and main is found.fraction
    if (found.probability or found.fraction) and not named_already and (said := _narrowing(main)):
        lines.append(said)
    return lines


def main_assumptions(found: Assessment) -> list[str]:
    """What was assumed that matters most, a sentence each."""
    return [assumption.words for assumption in all_assumed(found) if assumption.short][
        :MOST_ASSUMPTIONS
    ]


def _assumed(found: Assessment) -> list[str]:
    named, more = _main_assumptions(found)
    if not named:
        return []
    rest = f"; {counted(more, 'more assumption')} on the page" if more else ""
    return [f"Assumed: {', '.join(named)}{rest}."]


def _main_assumptions(found: Assessment) -> tuple[list[str], int]:
    """What matters most, in a few words each, and how many more there are."""
    lines = [assumption for assumption in all_assumed(found) if assumption.short]
    return [line.short for line in lines[:MOST_ASSUMPTIONS]], max(0, len(lines) - MOST_ASSUMPTIONS)


def all_assumed(found: Assessment) -> list[Assumption]:
    """What was assumed, that first which widens the interval most."""
    sources = found.main.sources
    lines = [*found.request.place.assumed, *found.request.objects.assumed]

    def size(assumption: Assumption) -> float:
        return sum(sources.get(name, 0.0) ** 2 for name in assumption.sources)

    return sorted(lines, key=size, reverse=True)


def assumptions(found: Assessment) -> list[str]:
    """Sentences of all that was assumed and of all that a reader must know."""
    request = found.request
    lines = [assumption.words for assumption in all_assumed(found)]
    if request.place.building is not None:
        lines.append(
            "The building stays elastic; one that cracks shakes its floors less strongly and more slowly."
        )
    if not found.motions.both:
        lines.append("It rocks in one plane on sharp rigid edges.")
    if found.directions is not None and math.isfinite(found.directions.factor):
        lines.append(
            "Motions come in the direction in which they were recorded, at random. The worst direction is not "
            "counted "
            "in the figures; that both components act at once is counted in their intervals, as for a square box."
        )
    if math.isfinite(found.flip_rate):
        lines.append(
            "If the corners of its base lie elsewhere by a millionth of its size, and it is turned by as little, "
            f"{fraction_words(found.flip_rate)} of the outcomes in space at that level change."
        )
    if math.isfinite(found.sliding_fraction) and found.fraction is not None:
        lines.append(
            f"With a friction of {request.objects.friction:g} it may slide, and "
            f"{fraction_words(found.sliding_fraction)} of the motions at that level topple it instead of "
            f"{fraction_words(found.fraction.value)}; all other numbers are without sliding."
        )
    else:
        lines.append("It does not slide; that needs enough friction (--friction tries it).")
    if found.conversion:
        lines.append(found.conversion.words)
    if found.hazard:
        lines.append(f"Hazard: {found.hazard.source}, {found.hazard.measure.imt}.")
    factor = found.counted.intensity_levels.allowed.mean()
    lines.append(
        f"Motions are scaled by {1 / LARGEST_FACTOR:g} to {LARGEST_FACTOR:g} at most, which admits "
        f"{100 * factor:.0f} % of all pairs of motion and level."
    )
    return lines


def quality_flags(found: Assessment) -> list[str]:
    """Sentences of what looks wrong."""
    lines = [*found.request.objects.quality_flags, *found.motions.warnings]
    if found.hazard is not None and found.request.level is not None:
        rate = float(found.hazard.rate(found.request.level.value))
        if rate > 0.2 or rate < 1e-6:
            lines.append(
                f"{found.request.level.words} is exceeded {rate:.2g} times a year by this hazard; check both."
            )
    if found.conversion and (beyond := found.conversion.beyond(found.level)):
        lines.append(beyond)
    if found.hazard is not None:
        strong = float(found.hazard.level(1 / 475))
        least, most = {"PGA": (0.01, 2.0), "SA": (0.01, 6.0), "PGV": (0.5, 250.0)}[
            found.measure.openquake
        ]
        if not least <= strong <= most:
            lines.append(
                f"The hazard's level of 475 years, {strong:.2g} {found.measure.unit}, is unusual; check its unit."
            )
    if found.request.objects.in_space and not found.motions.pairs:
        lines.append(
            "No record has two components; it was shaken by one, which may understate what it feels."
        )
    if found.outcomes.light:
        lines.append(
            f"Under the strongest shaking that was tried, {found.measure.imt} "
            f"{found.outcomes.intensity_levels.levels[-1]:.2g} {found.measure.unit}, a body may leave the ground, "
            "which this model does not let it."
        )
    for earthquake, fraction in _influential(found):
        lines.append(
            f"{100 * fraction:.0f} % of the motions that topple it at that level are of {earthquake}."
        )
    return lines


def _influential(found: Assessment) -> list[tuple[str, float]]:
    """Earthquakes of which most of the motions are that topple the object at the level asked about."""
    if found.level is None:
        return []
    outcomes = found.outcomes
    at = int(outcomes.intensity_levels.levels.searchsorted(found.level.value))
    fell = outcomes.overturned[:, min(at, outcomes.intensity_levels.levels.size - 1)]
    if fell.sum() < 4:
        return []
    names = outcomes.earthquakes[fell]
    counts = {name: (names == name).mean() for name in dict.fromkeys(names)}
    return [(str(name), float(fraction)) for name, fraction in counts.items() if fraction > 0.5]
