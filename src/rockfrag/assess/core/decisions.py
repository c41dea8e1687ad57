"""What to do: leave it, secure it, or measure something first, by a risk that is accepted.

In: draws of a probability and the accepted one [-]. Out: the decision, as a number.
Docs: ``docs/assess.md``, "What to do".
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np

from rockfrag.assess.core.estimates import (
    ACTION,
    BINS,
    FIRST,
    LEAST_CHANCE,
    OTHERWISE,
    fill_decision,
)
from rockfrag.assess.core.prediction import Prediction
from rockfrag.base.arrays import Floats

__all__ = ["LEAST_CHANCE", "Action", "Decision", "Measurement", "decide"]


class Action(Enum):
    """What to do with an object, in the order of the core's numbers."""

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
    known = [name for name in left if name in prediction.sources]
    places = np.array(
        [prediction.sources.index(name) for name in known], dtype=np.int64
    )
    rest = np.array([left[name] for name in known], dtype=np.float64)
    turned, found = np.zeros((len(known), 2)), np.zeros(3)
    bins, means = prediction.draws.bins, np.zeros(BINS)
    fill_decision(values, bins, places, rest, mean, accepted, means, turned, found)
    tried = tuple(map(Measurement, known, *turned.T.tolist()))
    actions = tuple(Action)
    action, otherwise = actions[int(found[ACTION])], actions[int(found[OTHERWISE])]
    if action is not Action.MEASURE:
        return Decision(action, otherwise, measurements=tried)
    first = tried[int(found[FIRST])]
    return Decision(action, otherwise, first.source, first.chance, tried)
