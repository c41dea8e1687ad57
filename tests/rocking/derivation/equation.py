"""One equation of the thesis: as printed, as it follows from the positions, as it should read."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .systems import System, random_systems

Quantity = Callable[[System], np.ndarray]


@dataclass(frozen=True)
class Equation:
    """A printed equation, its truth and, where the print is wrong, the form that holds.

    Each is a function of the random systems with values of any shape (..., n); an equation A = B is
    given as A - B and compared with the same difference derived from the positions.
    """

    number: str
    printed: Quantity
    true: Quantity
    mended: Quantity | None = None
    systems: Callable[[], System] = random_systems
    tolerance: float = 1e-12
