"""What to do: leave it, secure it, or measure something first, by a risk that is accepted.

In: draws of a probability and the accepted one [-]. Out: the decision, as a number.
Docs: ``docs/assess.md``, "What to do".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from rockfrag.assess.core.estimates import BINS, fill_turned
from rockfrag.assess.core.prediction import Prediction
from rockfrag.base.arrays import Floats

LEAST_CHANCE = (
    0.2  # With which a measurement must turn the decision round to be named [-]
)


class Action(Enum):
    """What to do with an object."""

    LEAVE = "leave"
    SECURE = "secure"
    MEASURE = "measure"


@dataclass(frozen=True)
class Measurement:
    """What knowing a source would do.

    Attributes
    ----------
    source : its name
    chance : with which it turns the decision round [-]
    mean_if : mean probability where it does [-]; that of today where it never does
    """

    source: str
    chance: float
    mean_if: float


@dataclass(frozen=True)
class Decision:
    """What to do, and what could turn it round.

    Attributes
    ----------
    action : what to do
    otherwise : what to do if nothing is measured; ``LEAVE`` or ``SECURE``
    source : name of what is measured first, the cheapest that may turn it round; empty where nothing may
    chance : with which knowing it turns the decision round [-]
    measurements : all that were considered, the cheapest first
    """

    action: Action
    otherwise: Action
    source: str = ""
    chance: float = 0.0
    measurements: tuple[Measurement, ...] = ()


def decide(
    mean: float,
    values: Floats,
    prediction: Prediction,
    left: Mapping[str, float],
    accepted: float,
) -> Decision:
    """Decide by the mean of a probability.

    Parameters
    ----------
    mean : of the probability, or rate, over what is not known
    values : the same in each draw, shape (draws,)
    prediction : whose draws they are
    left : what measuring a source leaves of its standard deviation [-], the cheapest measurement first
    accepted : probability, or rate, that is accepted

    Returns
    -------
    The decision; to measure is named where that would turn it round with a chance of ``LEAST_CHANCE``.
    """
    tried = []
    for source, rest in left.items():
        if source not in prediction.sources:
            continue
        found, means = np.zeros(2), np.zeros(BINS)
        bins = prediction.draws.bins[prediction.sources.index(source)]
        fill_turned(values, bins, float(rest), mean, accepted, means, found)
        tried.append(Measurement(source, *found.tolist()))
    first = next((each for each in tried if each.chance >= LEAST_CHANCE), None)
    otherwise = Action.SECURE if mean > accepted else Action.LEAVE
    if first is None:
        return Decision(otherwise, otherwise, measurements=tuple(tried))
    return Decision(Action.MEASURE, otherwise, first.source, first.chance, tuple(tried))
