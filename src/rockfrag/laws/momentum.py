"""Conservation of angular momentum about the new pivot (Housner 1963): the law where nothing was measured."""

from rockfrag.laws import BUILT_IN, ForKernels, declare
from rockfrag.system.geometry import Shape

NUMBER = BUILT_IN.index("momentum")


def tell(shape: Shape, restitution: float, pivot: int) -> ForKernels:
    """Return what the kernels get, whatever was measured."""
    return NUMBER, 1.0


def rate(value: float, by_momentum: float, before: float, moved: float) -> float:
    """Rate after an impact that momentum gives; arguments as of :class:`rockfrag.laws.Law`."""
    return by_momentum


LAW = declare("momentum", tell, rate)
