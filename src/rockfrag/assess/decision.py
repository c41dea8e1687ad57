"""What to do: leave an object, secure it, or measure something first, by a risk that is accepted.

An object is left where its probability is at most the accepted one. A measurement comes first where what it could
show would turn that round with a chance worth its trouble.
"""

import math
from dataclasses import dataclass
from enum import Enum

from scipy import special

from rockfrag.assess.risk import Estimate
from rockfrag.assess.sources import MEASUREMENTS

LEAST_CHANCE = (
    0.2  # With which a measurement must turn the decision round to be named [-]
)


class Action(Enum):
    """What to do with an object."""

    LEAVE = "leave"
    SECURE = "secure"
    MEASURE = "measure"


@dataclass(frozen=True)
class Decision:
    """What to do, and what could turn it round."""

    action: Action
    # Name of the source that is measured first; empty if none is
    source: str = ""
    chance: float = 0.0  # With which knowing it turns the decision round [-]


def decide(probability: Estimate, accepted: float) -> Decision:
    """Decide by a probability and the one that is accepted [-].

    Logits are taken as normal: what knowing a source takes from the variance is how far the answer may move.
    """
    action = Action.SECURE if probability.value > accepted else Action.LEAVE
    if not 0 < probability.value < 1:
        return Decision(action)
    away = abs(special.logit(probability.value) - special.logit(accepted))
    for name, source in MEASUREMENTS.items():
        spread = probability.sources.get(name, 0.0) * math.sqrt(1 - source.left**2)
        chance = float(special.ndtr(-away / spread)) if spread > 0 else 0.0
        if chance >= LEAST_CHANCE:
            return Decision(Action.MEASURE, name, chance)
    return Decision(action)
