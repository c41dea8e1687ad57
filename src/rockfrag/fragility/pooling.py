"""Tests at nearly the same value taken together, so that memory does not grow with their number."""

import numpy as np
from numpy.typing import NDArray

from rockfrag.fragility.observations import Floats

MOST_VALUES = 1000
"""Different values of a measure that are kept apart; more fall into as many cells of equal counts."""


def cells(
    measure: Floats, most: int = MOST_VALUES, tests: Floats | None = None
) -> tuple[NDArray[np.intp], Floats]:
    """Put each row into a cell of equal or neighbouring values; its number, (n,), and the mean of each cell.

    Means rise.  Up to ``most`` different values have a cell each; of more, cells have about equally many rows, or
    ``tests`` where their number in each row is given.
    """
    values, cell = np.unique(measure, return_inverse=True)
    if values.size <= most:
        return cell, values
    count = np.bincount(cell, tests)
    middle = np.cumsum(count) - 0.5 * count
    coarse = np.unique((middle / count.sum() * most).astype(np.intp), return_inverse=True)[1]
    cell = coarse[cell]
    return cell, np.bincount(cell, measure) / np.bincount(cell)


def counts(group: NDArray[np.intp], cell: NDArray[np.intp], weight: Floats) -> Floats:
    """Sum weights by group and cell, shape (groups, cells)."""
    groups, columns = int(group.max()) + 1, int(cell.max()) + 1
    flat = np.bincount(group * columns + cell, weight, minlength=groups * columns)
    return np.asarray(flat.reshape(groups, columns))
