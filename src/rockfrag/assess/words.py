"""The answer in words: five lines for a terminal, and what they rest on."""

import math
from collections.abc import Mapping

from rockfrag.assess.answer import Assessment
from rockfrag.assess.remedies import Remedy
from rockfrag.assess.risk import LEVEL, Estimate
from rockfrag.assess.verdicts import LARGEST_FACTOR
from rockfrag.report.wording import counted

NAMES: Mapping[str, str] = {
    "motions": "the motions of other earthquakes",
    "width": "the width that carries",
    "cg_height": "the height of the centre of gravity",
    "restitution": "the energy that impacts take",
    "mass": "the mass",
    "period": "the building's first period",
    "damping": "the building's damping",
    "model": "the planar rocking model",
    "conversion": "how fast the ground moves at that hazard",
    "hazard": "the hazard curve",
}
"""Sources of uncertainty and assumptions as a reader may know them."""

MANY = 0.5
"""Share of motions from which an object is said to topple."""

FEW = 0.01
"""Share of motions below which it is said to stand."""


def share_words(value: float) -> str:
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
    """A probability with its interval, such as ``4 % (1 to 18 %)``, to as many digits as the interval deserves."""
    if estimate.value == 0:
        return f"less than {share_words(estimate.upper)}"
    if estimate.value == 1:
        return f"more than {share_words(estimate.lower)}"
    # two digits of the upper limit, but enough to tell the estimate from nothing
    digits = max(0, 1 - _place(estimate.upper), -_place(estimate.value))
    value, low, high = (
        f"{100 * one:.{digits}f}" for one in (estimate.value, estimate.lower, estimate.upper)
    )
    return f"{value} % ({low} to {high} %)"


def _place(share: float) -> int:
    """Power of ten of a share in per cent; that of 10⁻⁴ % for less."""
    return math.floor(math.log10(max(100 * share, 1e-4)))


def value_words(found: Assessment, value: float) -> str:
    """What is estimated, as a share in per cent or as an amplitude with its unit."""
    if found.probability or found.share:
        return share_words(value)
    if not math.isfinite(value):
        return "none reached"
    return f"{value:.2g} {found.measure.unit}"


def five_lines(found: Assessment) -> list[str]:
    """Return the answer in five lines.

    Parameters
    ----------
    found
        The assessment.
    """
    return [
        f"Topples?  {_at_the_site(found)}",
        f"How likely?  {_probability(found)}",
        f"How does it stand best?  {_arrangements(found)}",
        f"What helps?  {_helps(found)}",
        f"How sure?  {_sure(found)}",
    ]


def verdict(found: Assessment) -> str:
    """Say in a few words whether the object rocks and topples; the heading of the page."""
    name = found.request.name[:1].upper() + found.request.name[1:]
    if found.share is None or found.level is None:
        half = found.amplitudes[0.5].value
        if not math.isfinite(half):
            return f"No shaking that was tried topples {name} in half of the motions"
        return f"Half of the motions topple {name} at {found.measure.name} {half:.2g} {found.measure.unit}"
    at = found.level.words
    if found.share.value >= MANY:
        return f"{name} is likely to topple at {at}"
    if found.share.value > FEW:
        return f"{name} may topple at {at}"
    if found.rocking_share > FEW:
        return f"{name} rocks at {at} and hardly topples"
    return f"{name} does not even rock at {at}"


def _at_the_site(found: Assessment) -> str:
    place = found.request.place.words
    if found.level is None or found.share is None:
        tenth, half = (found.amplitudes[p].value for p in (0.1, 0.5))
        unit = found.measure.unit
        if not math.isfinite(tenth):
            return (
                f"{found.request.name}, {place}: not one in ten motions topples it, however strong."
            )
        more = f", half of them at {half:.2g} {unit}" if math.isfinite(half) else ""
        return (
            f"{found.request.name}, {place}: one in ten motions topples it at {found.measure.name} "
            f"{tenth:.2g} {unit}{more}."
        )
    period = " (475 years)" if found.request.level is None else ""
    return (
        f"{found.request.name}, {place}, {found.level.words}{period}: rocks in "
        f"{share_words(found.rocking_share)} and topples in {estimate_words(found.share)} of the motions."
    )


def _probability(found: Assessment) -> str:
    if found.probability is None:
        return "no hazard was given; --hazard FILE or --return-period YEARS gives it."
    return f"{estimate_words(found.probability)} in {found.request.years:g} years, {100 * LEVEL:.0f} % interval."


def _arrangements(found: Assessment) -> str:
    ranked = _ranked(found)
    worst = _worst_direction(found)
    if len(ranked) == 1:
        return worst
    words = ", ".join(f"{name} {value_words(found, value)}" for name, value in ranked)
    return f"{words}. {worst}".strip()


def _ranked(found: Assessment) -> list[tuple[str, float]]:
    """Arrangements with what is estimated, the safest first."""
    grows = found.probability is None and found.share is None
    return sorted(found.by_arrangement.items(), key=lambda item: -item[1] if grows else item[1])


def safest(found: Assessment) -> str:
    """The arrangement in which the object is safest."""
    return _ranked(found)[0][0]


def _worst_direction(found: Assessment) -> str:
    plane = f"It rocks {found.request.objects.plane}"
    directions = found.directions
    if directions is None or not math.isfinite(directions.factor):
        return f"{plane}."
    return (
        f"{plane}; from the worst direction {directions.factor:.2f} times the shaking topples it."
    )


def _helps(found: Assessment) -> str:
    if not found.remedies:
        return "nothing was tried."
    best = [remedy_words(found, remedy) for remedy in found.remedies[:3]]
    return "; ".join(best) + "."


def remedy_words(found: Assessment, remedy: Remedy) -> str:
    """A change and its factor."""
    what = "amplitude" if found.probability is None and found.share is None else "risk"
    if math.isnan(remedy.factor):
        return f"{remedy.name}: {value_words(found, remedy.value)}"
    if remedy.factor == 0:
        return f"{remedy.name}: no motion topples it"
    return f"{remedy.name}: {what} times {remedy.factor:.2g}"


def _sure(found: Assessment) -> str:
    main = found.main
    parts = [found.motions.words + "."]
    if main.largest:
        parts.append(f"The range comes mostly from {NAMES[main.largest]}.")
    assumed = found.request.objects.assumed + found.request.place.assumed
    if assumed:
        parts.append(f"Assumed: {counted(len(assumed), 'thing')}, see the page.")
    return " ".join(parts)


def assumptions(found: Assessment) -> list[str]:
    """Sentences of all that was assumed and of all that a reader must know."""
    request = found.request
    lines = [*request.objects.assumed, *request.place.assumed]
    if request.place.building is not None:
        lines.append(
            "The building stays elastic; one that cracks passes on less, and that of other frequencies."
        )
    lines.append("It rocks in one plane on sharp rigid edges.")
    if math.isfinite(found.sliding_share) and found.share is not None:
        lines.append(
            f"With a friction of {request.objects.friction:g} it may slide and topples in "
            f"{share_words(found.sliding_share)} of the motions at that level instead of "
            f"{share_words(found.share.value)}; all other numbers are without sliding."
        )
    else:
        lines.append("It does not slide; that needs friction, and a rough base.")
    if found.conversion:
        lines.append(found.conversion.words)
    if found.hazard:
        lines.append(f"Hazard: {found.hazard.source}, {found.hazard.measure.name}.")
    factor = found.verdicts.ladder.allowed.mean()
    lines.append(
        f"Motions are scaled by {1 / LARGEST_FACTOR:g} to {LARGEST_FACTOR:g} at most; {100 * factor:.0f} % of all "
        "that the levels ask for is within that."
    )
    return lines


def doubts(found: Assessment) -> list[str]:
    """Sentences of what looks wrong."""
    lines = [*found.request.objects.doubts, *found.motions.warnings]
    if found.hazard is not None and found.request.level is not None:
        rate = float(found.hazard.rate(found.request.level.value))
        if rate > 0.2 or rate < 1e-6:
            lines.append(
                f"{found.request.level.words} is exceeded {rate:.2g} times a year by this hazard; check both."
            )
    if found.hazard is not None:
        strong = float(found.hazard.level(1 / 475))
        least, most = {"PGA": (0.01, 2.0), "SA": (0.01, 6.0), "PGV": (0.5, 250.0)}[
            found.measure.kind
        ]
        if not least <= strong <= most:
            lines.append(
                f"The hazard's level of 475 years, {strong:.2g} {found.measure.unit}, is unusual; check its unit."
            )
    for event, share in _influential(found):
        lines.append(f"{share:.0%} of the motions that topple it at that level are of {event}.")
    return lines


def _influential(found: Assessment) -> list[tuple[str, float]]:
    """Earthquakes that make most of the verdicts at the level asked about."""
    if found.level is None:
        return []
    verdicts = found.verdicts
    at = int(verdicts.ladder.levels.searchsorted(found.level.value))
    fell = verdicts.overturned[:, min(at, verdicts.ladder.levels.size - 1)]
    if fell.sum() < 4:
        return []
    names = verdicts.events[fell]
    counts = {name: (names == name).mean() for name in dict.fromkeys(names)}
    return [(str(name), float(share)) for name, share in counts.items() if share > 0.5]
