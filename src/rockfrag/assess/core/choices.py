"""Which text says what was found: by its numbers alone, for the command line and the page alike.

Plain functions of numbers, which the page's module is made of too. Each returns the place of a text among those
that :data:`rockfrag.assess.findings.TEXTS` lists for it.

In: probabilities with limits [-], levels of shaking, counts. Out: places. Docs: ``docs/assess.md``, "What to do".
"""

import math

from rockfrag.base.arrays import Floats
from rockfrag.words.catalogue import LEAST, SURE

HARDLY = 0.1  # Fraction of the motions up to which an object hardly rocks
FEWEST_EARTHQUAKES = 5
"""Earthquakes below which no verdict is given: an interval over fewer was not validated."""

LEAST_PART = 0.05
"""Part of the variance from which a source is worth naming [-]."""
LEAST_WORTH = 0.05
"""Chance of deciding from which a measurement is listed [-]."""

BELOW = (0.01, 0.10, 0.33)
"""Probabilities below which the steps of the scale of likelihoods lie, and up to which the next ones lie [-]."""
UP_TO = (0.66, 0.90, 0.99)

LEAVE, SECURE, MEASURE = 0, 1, 2
"""What to do with an object."""


def likelihood(probability: float) -> int:
    """Step, 0 to 6, of a probability [-] in the IPCC's scale: < 1, < 10, < 33 %, up to 66, 90, 99 %, above."""
    for step in range(3):
        if probability < BELOW[step]:
            return step
    for step in range(3):
        if probability <= UP_TO[step]:
            return 3 + step
    return 6


def stays(rocking_at_most: float) -> bool:
    """Whether it is exceptionally unlikely that an object rocks, limits included."""
    return likelihood(rocking_at_most) == 0


def are_few(earthquakes: int) -> bool:
    """Whether there are too few earthquakes for a verdict."""
    return earthquakes < FEWEST_EARTHQUAKES


def is_open(lower: float, upper: float) -> bool:
    """Whether limits from 0 to 1 leave every value possible, as those of few earthquakes do."""
    return lower <= 0.0 and upper >= 1.0


# ---- the first screen


def how_likely(few: bool, at_rest: bool, rocking: float) -> int:
    """Place of a text: earthquakes are few, it does not move, it hardly rocks, or how likely it topples.

    ``few``, ``at_rest``: whether so; ``rocking``: fraction of the motions that rock it [-].
    """
    if few:
        return 0
    if at_rest:
        return 1
    return 2 if rocking <= HARDLY else 3


def chance(value: float, lower: float, upper: float) -> int:
    """Place of a text: a probability, or its upper or its lower limit where all motions agree [-]."""
    if value == 0.0 and upper > 0.0:
        return 1
    return 2 if value == 1.0 and lower < 1.0 else 0


def how_far(half: float, upper: float) -> int:
    """Place of a text: the level at which half topple with both limits, with the lower alone, or none tried.

    ``half`` and its ``upper`` limit are infinite where no level that was tried reaches them.
    """
    if not half < math.inf:
        return 2
    return 0 if upper < math.inf else 1


def in_years(value: float, lower: float, upper: float) -> int:
    """Place of a text: a probability in some years [-], or its upper limit alone."""
    return 1 if value == 0.0 or is_open(lower, upper) else 0


def advice(action: int, by_hazard: bool, at_rest: bool, worth: float) -> int:
    """Place of a text: measure first; with a hazard secure or leave it; without, what follows from costs.

    Parameters
    ----------
    action : ``LEAVE``, ``SECURE`` or ``MEASURE``
    by_hazard, at_rest : whether a hazard is known, and whether the object does not move
    worth : part of what a fall costs that securing may cost [-]; next to nothing, or all, is not said
    """
    if action == MEASURE:
        return 0
    if by_hazard:
        return 1 if action == SECURE else 2
    if at_rest or (action == LEAVE and worth < LEAST):
        return 3
    if action == SECURE and worth > SURE:
        return 1
    return 4 if action == SECURE else 5


# ---- behind it


def counted(total: int, every: int) -> int:
    """Place of a text: how many motions do so, of all (0) or of those that can be scaled so far (1)."""
    return 1 if total < every else 0


def between(value: float, lower: float, upper: float) -> int:
    """Place of a text: a fraction [-] is open, or its upper, its lower or both limits."""
    if is_open(lower, upper):
        return 0
    if value == 0.0:
        return 1
    return 2 if value == 1.0 else 3


def starts(level: float) -> int:
    """Place of a text: where rocking starts, a level in the unit of the measure, or that none tried starts it."""
    return 0 if level < math.inf else 1


def over_years(value: float, lower: float, upper: float) -> int:
    """Place of a text: the upper limit of a probability [-], that it is open, or both limits."""
    if value == 0.0:
        return 0
    return 1 if is_open(lower, upper) else 2


def needs_change(value: float, at_rest: bool, by_hazard: bool) -> bool:
    """Whether there is anything that a change could make smaller."""
    return not (value == 0.0 or (at_rest and not by_hazard))


def reduces(factor: float, grows: bool) -> int:
    """Place of a text: none is left (``factor`` 0), what a change takes off, how much more is borne, nearly all.

    ``factor``: risk, or what it bears, with the change over that without [-]; ``grows``: whether growing helps.
    """
    if factor == 0.0:
        return 0
    if grows:
        return 2
    return 3 if takes_nearly_all(factor) else 1


def takes_nearly_all(factor: float) -> bool:
    """Whether a change takes off so much of a risk that no digits of it are said; ``factor``: what is left [-]."""
    return 1.0 - factor > SURE


def whole_percent_below(part: float) -> int:
    """Whole per cent that a part from 0 to 1 [-] is no less than; never 100, as what is nearly all is not all."""
    return min(int(100.0 * part), 99)


def change_alone(factor: float, grows: bool, shown: bool) -> int:
    """Place of a text on what one change does to a risk, or to what an object bears.

    Parameters
    ----------
    factor : risk, or what it bears, with the change over that without [-]; NaN if not known
    grows : whether growing helps, as of what it bears
    shown : whether the motions show that it helps
    """
    if math.isnan(factor):
        return 0
    if factor == 1.0:
        return 9
    if grows and factor < 1.0:
        return 1
    if not grows and factor > 1.0:
        return 2
    if factor == 0.0 and shown:
        return 3
    if not shown:
        return 4 if grows else 5
    if grows:
        return 6
    return 8 if takes_nearly_all(factor) else 7


def tell_reduction(factor: float, lower: float, upper: float, found: Floats) -> None:
    """Fill what a factor takes off a risk, or adds to what is borne, and its limits, rising [-], shape (3,)."""
    sign = -1.0 if factor > 1.0 else 1.0
    first, second = sign * (1.0 - lower), sign * (1.0 - upper)
    found[0] = sign * (1.0 - factor)
    found[1], found[2] = min(first, second), max(first, second)


def names_source(part: float) -> bool:
    """Whether a source is worth naming, by its part in the variance."""
    return part >= LEAST_PART


def lists_measurement(chance: float) -> bool:
    """Whether a measurement is listed, by the chance that it decides."""
    return chance >= LEAST_WORTH


def is_worse(lower: float, helps: bool) -> bool:
    """Whether a way to stand is shown to be worse than its own.

    ``lower``: lower limit of its risk over that of its own [-]; ``helps``: whether it is estimated to help.
    """
    return lower > 1.0 and not helps


def safest(is_shown: bool) -> int:
    """Place of a text: which way to stand is safest, or that the motions show none to be."""
    return 0 if is_shown else 1
