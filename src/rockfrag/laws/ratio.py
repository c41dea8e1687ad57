"""Newton's hypothesis for the rotation: the ratio of the rates after and before an impact is the contact's own.

It is the measured one, whatever the bodies weigh (``docs/restitution.md``, "Ratio").
"""

from rockfrag.laws import BUILT_IN, ForKernels, declare
from rockfrag.system.geometry import Shape

NUMBER = BUILT_IN.index("ratio")


def tell(shape: Shape, restitution: float, pivot: int) -> ForKernels:
    """Return the measured ratio."""
    return NUMBER, restitution


def rate(value: float, by_momentum: float, before: float, moved: float) -> float:
    """Rate after an impact, ``value`` times that before it; arguments as of :class:`rockfrag.laws.Law`."""
    return value * before


LAW = declare("ratio", tell, rate)
