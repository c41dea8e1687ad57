"""A couple in the contact brakes or drives it: its rate is a fixed multiple of what momentum leaves.

The contact then loses a fixed fraction of the energy that is free in it (``docs/restitution.md``, "Couple").
"""

import math

from rockfrag.laws import BUILT_IN, ForKernels, declare
from rockfrag.system.geometry import Shape, momentum_restitution

NUMBER = BUILT_IN.index("couple")


def tell(shape: Shape, restitution: float, pivot: int) -> ForKernels:
    """Return the multiple: what was measured over what momentum leaves the lone body; NaN if that is nothing."""
    by_momentum = momentum_restitution(shape, pivot)
    return NUMBER, restitution / by_momentum if by_momentum > 0.0 else math.nan


def rate(value: float, by_momentum: float, before: float, moved: float) -> float:
    """Rate after an impact as a multiple of what momentum leaves; arguments as of :class:`rockfrag.laws.Law`."""
    return value * by_momentum


LAW = declare("couple", tell, rate, scales_momentum=True)
