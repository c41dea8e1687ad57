"""What helps: the object changed, as a body, shaken by the same motions, as a factor on the probability.

In: an object and its changes. Out: factors on the probability, with limits [-].
Docs: ``docs/assess.md``, "What helps".
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockfrag.assess.core.estimates import SHOWN, fill_comparison
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import Drawn, Evidence, Target
from rockfrag.words.findings import Finding


@dataclass(frozen=True)
class Mitigation:
    """What a change does."""

    change: Finding  # What is changed
    value: float  # The probability, fraction or amplitude with it
    # That over the one without it [-]; 0 where no motion topples the object any more
    factor: float
    # Limits of the factor, of the same motions with and without it; NaN where there are none
    lower: float
    upper: float
    # Whether the object is better off: the risk shrinks, or an amplitude grows
    helps: bool
    # Whether the motions show that it is, beyond what one earthquake decides
    shown: bool
    # What it costs, in the user's unit; NaN where that was not stated
    cost: float = math.nan


def compare(
    target: Target,
    evidence: Evidence,
    now: ObjectOutcomes,
    changed: Mapping[Finding, ObjectOutcomes],
) -> list[Mitigation]:
    """Estimate again with each change of the object, with the same errors of all that is not known.

    Limits of the factor are over the earthquakes; a change is shown to help if they leave nothing else open. So
    few earthquakes as give no verdict give no limits.

    Parameters
    ----------
    target : what is estimated
    evidence : what it rests on
    now : outcomes without a change
    changed : outcomes of the same motions with each change

    Returns
    -------
    What each change does, in their order.
    """
    drawn = evidence.drawn(target, evidence.of(now))
    earthquakes = len(set(evidence.outcomes.earthquakes))
    found = []
    for change, outcomes in changed.items():
        other = evidence.drawn(target, evidence.of(outcomes))
        _, after, factor, least, most, helps, shown = _compared(
            drawn, other, earthquakes
        )
        found.append(
            Mitigation(
                change=change,
                value=after,
                factor=factor,
                lower=least,
                upper=most,
                helps=helps > 0,
                shown=shown > 0,
            )
        )
    return found


def _compared(before: Drawn, after: Drawn, earthquakes: int) -> list[float]:
    """Seven numbers of a comparison (``fill_comparison``): before, after, ratio, its limits, helps, is shown."""
    sets = len(before.prediction.draws.weights)
    work, found = np.zeros((2, before.values.size)), np.zeros(SHOWN + 1)
    kind = before.target.kind
    shown = before.shown, after.shown
    fill_comparison(kind, shown[0], shown[1], sets, earthquakes, work, found)
    values: list[float] = found.tolist()
    return values
