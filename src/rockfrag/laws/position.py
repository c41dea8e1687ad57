"""The impulse acts nearer the middle of the base than the new pivot, where momentum leaves less than was measured.

Material points of the base meet away from the corner, because the surfaces are uneven or yield.  The lone body
then conserves its momentum about the point of the impulse, which gives the point (``docs/restitution.md``, eq. 4).
Where momentum leaves more there is no such point within the base, and a couple brakes.
"""

from rockfrag.laws import BUILT_IN, ForKernels, couple, declare
from rockfrag.system.geometry import Shape, impulse_position, momentum_restitution

NUMBER = BUILT_IN.index("position")


def tell(shape: Shape, restitution: float, pivot: int) -> ForKernels:
    """Return the place of the impulse, or the couple that brakes.

    Parameters
    ----------
    shape : the block that comes down, as it stands
    restitution : measured ratio of the rates after and before its impact [-]
    pivot : on which it comes down, +1 right, -1 left

    Returns
    -------
    Number of the law, and the place over half the width or the multiple [-].
    """
    # one way out: Numba takes the numbers of two returns for constants, and keeps one of them for both
    number, value = NUMBER, impulse_position(shape, restitution, pivot)
    if restitution < momentum_restitution(shape, pivot):
        number, value = couple.tell(shape, restitution, pivot)
    return number, value


def rate(value: float, by_momentum: float, before: float, moved: float) -> float:
    """Rate after an impact [rad/s]: the one that momentum about the place of the impulse leaves, ``moved``.

    ``value``, ``by_momentum`` and ``before``, the law's number and the rates by momentum about the corner and
    before the impact, have no part in it.
    """
    return moved


LAW = declare("position", tell, rate, moves_impulse=True)
