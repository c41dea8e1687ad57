"""Points of Sobol's sequence, those of :class:`scipy.stats.qmc.Sobol` to the last bit.

``scipy.stats`` takes half a second to load, which is a good part of an answer; its table of direction numbers
(Joe and Kuo 2008, SIAM J. Sci. Comput. 30: 2635) does not. The recurrence is that of Bratley and Fox (1988, ACM
Trans. Math. Softw. 14: 88), points follow each other in the order of Gray's code.

In: numbers of dimensions and points. Out: points inside the unit cube, (points, dimensions) [-].
Theory: ``docs/assess.md``, "How sure".
"""

from pathlib import Path

import numpy as np
import scipy
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats

_TABLE = Path(scipy.__file__).parent / "stats" / "_sobol_direction_numbers.npz"


def sobol_points(dimensions: int, count: int, first: int = 0) -> Floats:
    """Return points of the sequence that follow each other.

    Parameters
    ----------
    dimensions, count : numbers of dimensions and of points
    first : place of the first of them in the sequence, from 0

    Returns
    -------
    The points, shape (count, dimensions).
    """
    if not _TABLE.is_file():
        return _points_of_scipy(dimensions, count, first)
    bits = max((first + count - 1).bit_length(), 1)
    directions = _direction_numbers(dimensions, bits)
    places = np.arange(first, first + count)
    gray = places ^ (places >> 1)
    found = np.zeros((count, dimensions), dtype=np.int64)
    for bit, numbers in enumerate(directions):
        holds = (gray >> bit) & 1
        found ^= holds[:, np.newaxis] * (numbers << (bits - 1 - bit))
    return found / 2.0**bits


def _direction_numbers(dimensions: int, bits: int) -> NDArray[np.int64]:
    """Odd numbers m by bit j and dimension, shape (bits, dimensions); directions are m / 2^(j + 1)."""
    with np.load(_TABLE) as table:
        polynomials = table["poly"][:dimensions].tolist()
        initial = table["vinit"][:dimensions].tolist()
    # the first dimension is van der Corput's sequence
    found = np.ones((bits, dimensions), dtype=np.int64)
    for dimension in range(1, dimensions):
        polynomial = polynomials[dimension]
        degree = polynomial.bit_length() - 1
        numbers = initial[dimension][:degree]
        while len(numbers) < bits:
            numbers.append(_next_number(numbers, polynomial, degree))
        found[:, dimension] = numbers[:bits]
    return found


def _next_number(numbers: list[int], polynomial: int, degree: int) -> int:
    """Continue direction numbers by a primitive polynomial, whose coefficients are bits, the highest first."""
    found = numbers[-degree]
    for back in range(1, degree + 1):
        if (polynomial >> (degree - back)) & 1:
            found ^= numbers[-back] << back
    return found


def _points_of_scipy(dimensions: int, count: int, first: int) -> Floats:
    """Return the same points where scipy keeps its table elsewhere."""
    from scipy.stats import qmc

    sequence = qmc.Sobol(dimensions, scramble=False)
    if first:
        sequence.fast_forward(first)
    return np.asarray(sequence.random(count))
