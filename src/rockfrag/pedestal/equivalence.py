"""Equivalence: "no effect" is a finding only when a relevant effect is excluded."""

import math

from rockfrag.pedestal.cluster_means import Estimate

MARGIN = 0.10  # largest change of the overturning amplitude that counts as none, ±10 % [-]


def equivalence(effect: Estimate, margin: float = MARGIN) -> float:
    """Test that a mean log ratio lies within ±ln(1 + margin), by two one-sided tests (Schuirmann 1987).

    It is never shown where the estimate's resolution reaches beyond a bound: a series of 5 % cannot
    show equivalence to ±1 %. Returned is the larger of the two one-sided p values [-], NaN for a single unit.
    """
    bound = math.log1p(margin)
    return max(effect.p_above(-bound), effect.p_below(bound))
