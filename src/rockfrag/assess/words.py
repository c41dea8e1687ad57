"""The answer in words: five lines for a terminal, and what they rest on; the sentences stand in ``words.j2``."""

import math
from collections.abc import Mapping
from typing import Any

from rockfrag.assess.answer import Assessment
from rockfrag.assess.assumed import Assumption
from rockfrag.assess.outcomes import LARGEST_FACTOR
from rockfrag.assess.risk import LEVEL, Estimate, step_of
from rockfrag.assess.sources import MEASUREMENTS, SOURCES, is_wide, narrowed, parts_of
from rockfrag.report.part import Says

NAMES: Mapping[str, str] = {name: source.words for name, source in SOURCES.items()}
"""Sources of uncertainty and assumptions as a reader may know them."""

MOST_SOURCES = 3  # Sources of uncertainty that are named in a line
LEAST_PART = 0.05  # Part of the variance from which a source is worth naming [-]
MANY = 0.5  # Fraction of motions from which an object is said to topple
FEW = 0.01  # Fraction of motions up to which it is said to be unlikely to topple
MOST_ASSUMPTIONS = 3  # Assumptions that are named in a line; the page has all


def fraction_words(value: float) -> str:
    """A probability or fraction in per cent, to two digits."""
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
    if estimate.lower <= 0 and estimate.upper >= 1:
        return fraction_words(estimate.value)
    return f"{fraction_words(estimate.value)} ({range_words(estimate.lower, estimate.upper)})"


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


def does_not_move(found: Assessment) -> bool:
    """Whether even what is not known leaves the object at rest at the level."""
    return found.does_not_move


def not_expected_to_move(found: Assessment) -> bool:
    """Whether the level is below that at which it starts to rock."""
    assert found.level is not None
    assert found.rocking is not None
    return found.does_not_move or (
        found.rocks_from > found.level.value and found.rocking.value < MANY
    )


def not_decidable(found: Assessment) -> bool:
    """Whether the interval reaches from unlikely to likely toppling."""
    return found.fraction is not None and is_wide(found.fraction)


def _influential(found: Assessment) -> list[tuple[str, float]]:
    """Earthquakes of which most of the motions are that topple the object at the level asked about."""
    if found.level is None:
        return []
    outcomes = found.outcomes
    fell = outcomes.overturned[:, outcomes.intensity_levels.place_of(found.level.value)]
    if fell.sum() < 4:
        return []
    names = outcomes.earthquakes[fell]
    counts = {name: (names == name).mean() for name in dict.fromkeys(names)}
    return [
        (str(name), float(fraction))
        for name, fraction in counts.items()
        if fraction > 0.5
    ]


def all_assumed(found: Assessment) -> list[Assumption]:
    """What was assumed, that first which widens the interval most."""
    sources = found.main.sources
    lines = [*found.request.place.assumed, *found.request.objects.assumed]

    def size(assumption: Assumption) -> float:
        return sum(sources.get(name, 0.0) ** 2 for name in assumption.sources)

    return sorted(lines, key=size, reverse=True)


def _largest_sources(found: Assessment) -> list[str]:
    parts = parts_of(found.main.sources).items()
    named = [
        f"{100 * part:.0f} % from {NAMES[name]}"
        for name, part in parts
        if part >= LEAST_PART
    ]
    return named[:MOST_SOURCES]


_WORDS: dict[str, Any] = {
    "LEVEL": LEVEL,
    "MANY": MANY,
    "FEW": FEW,
    "LARGEST_FACTOR": LARGEST_FACTOR,
    "MOST_ASSUMPTIONS": MOST_ASSUMPTIONS,
    "MEASUREMENTS": MEASUREMENTS,
    "SOURCES": SOURCES,
    "exp": math.exp,
    "influential": _influential,
    "largest_sources": _largest_sources,
}
_FUNCTIONS = (
    *(all_assumed, does_not_move, estimate_words, fraction_words, narrowed),
    *(not_decidable, not_expected_to_move, parts_of, range_words, step_of),
)
_WORDS |= {function.__name__: function for function in _FUNCTIONS}

says, page_says, gallery_says = (
    Says("rockfrag.assess", f"{name}.j2", **_WORDS)
    for name in ("words", "page", "gallery")
)
"""The macros of the answer, of its page, and of a gallery."""


def five_lines(found: Assessment) -> list[str]:
    """Return the answer in five lines."""
    return says("five_lines", found)
