"""What two perpendicular components come to in a direction, of plain arithmetic; kernels call it too.

In: components of one unit. Out: a component in that unit. Theory: ``docs/motions.md``.
"""

from typing import TypeVar

from rockfrag.base.arrays import Floats

Real = TypeVar("Real", float, Floats)


def in_direction(first: Real, second: Real, cosine: float, sine: float) -> Real:
    """What two perpendicular components come to in a direction, of numbers and of arrays alike.

    Parameters
    ----------
    first, second : the components, of one unit
    cosine, sine : of the angle from first towards second [-]

    Returns
    -------
    The component, in that unit.
    """
    return first * cosine + second * sine
