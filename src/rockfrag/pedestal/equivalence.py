"""Equivalence: "no effect" is a finding only when a relevant effect is excluded."""

import math
from dataclasses import dataclass

from rockfrag.pedestal.cluster_means import Estimate

MARGIN = 0.10
"""Largest change of the overturning amplitude that counts as none, ±10 % [-]."""


@dataclass(frozen=True)
class Equivalence:
    """Two one-sided tests of |ln ratio| < ln(1 + margin) (Schuirmann 1987).

    Parameters
    ----------
    p
        The larger of the two one-sided p values; equivalence is shown where it is below the level.
    margin
        Change that counts as none [-]; the bounds of the ratio are 1/(1 + margin) and 1 + margin.
    """

    p: float
    margin: float

    def shown(self, level: float = 0.05) -> bool:
        """Whether equivalence is shown at ``level``; never with a single unit (p is NaN)."""
        return self.p < level


def equivalence(effect: Estimate, margin: float = MARGIN) -> Equivalence:
    """Test that a mean log ratio lies within ±ln(1 + margin).

    It is never shown where the estimate's resolution reaches beyond a bound: a ladder of 5 % cannot
    show equivalence to ±1 %.
    """
    bound = math.log1p(margin)
    return Equivalence(max(effect.p_above(-bound), effect.p_below(bound)), margin)
