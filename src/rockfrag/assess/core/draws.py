"""Fixed quasi-random draws of all that is not known: sources of error, and the weights of earthquakes.

Sources are standard normal. Weights of earthquakes are Dirichlet's (Rubin 1981, Ann. Stat. 9: 130), as wide as
Student's t asks for few earthquakes. There is one earthquake more than was recorded: the next one, whose capacity
lies where those of the others do, as in a Dirichlet process about their distribution (Ferguson 1973, Ann. Stat. 1:
209). Points are Sobol's (1967).

In: numbers of draws, sources and earthquakes. Out: points, (draws, sources), and weights, (draws, earthquakes
+ 1).
Theory: ``docs/assess.md``, "How sure".
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

from rockfrag.assess.core.estimates import BINS
from rockfrag.assess.core.sobol import sobol_points
from rockfrag.base.arrays import Floats

BLOCKS = 256  # Sets of weights
MEMBERS = 16  # Draws of the sources under each set of weights
FEW_MEMBERS = 4  # The same where values are only compared
LATER = 512  # Where the points of the weights begin: not those of the sources


class Draws(NamedTuple):
    """Draws, those under one set of weights one after the other.

    Attributes
    ----------
    sources : standard normal values, shape (draws, sources)
    weights : of each earthquake and of the next one, shape (blocks, earthquakes + 1); each row sums to 1
    bins : of equally many draws by each rising source, from 0, shape (sources, draws)
    """

    sources: Floats
    weights: Floats
    bins: NDArray[np.uint8]


@lru_cache(maxsize=64)
def make_draws(sources: int, earthquakes: int, members: int = MEMBERS) -> Draws:
    """Make draws of some sources under some earthquakes, the same whenever they are made.

    Parameters
    ----------
    sources, earthquakes : their numbers
    members : draws of the sources under each set of weights

    Returns
    -------
    ``BLOCKS`` × ``members`` draws.
    """
    points = _points(earthquakes + 1, BLOCKS, LATER)
    weights = special.gammaincinv(_concentration(earthquakes), points)
    weights /= weights.sum(axis=1, keepdims=True)
    # points that follow each other fill space by themselves: each set of weights has some of these
    normals = special.ndtri(_points(max(sources, 1), BLOCKS * members, 0))
    normals = np.ascontiguousarray(normals[:, :sources])
    order = np.argsort(np.argsort(normals, axis=0, kind="stable"), axis=0)
    bins = (order * BINS // len(normals)).T.astype(np.uint8)
    return Draws(normals, weights, np.ascontiguousarray(bins))


def _concentration(earthquakes: int) -> float:
    """Parameter of Dirichlet's distribution with which the 90 % interval of a mean is Student's [-].

    With 1 the variance of a mean is s²/(n + 1), s² with n in its denominator (Rubin 1981): too little for few.
    """
    n = max(earthquakes, 2)
    student, normal = special.stdtrit(n - 1, 0.95), special.ndtri(0.95)
    wider = (student / normal) ** 2 * (n + 1) / (n - 1)
    return float(max((n + 1) / wider - 1, 0.1 * n) / n)


def _points(dimensions: int, count: int, first: int) -> Floats:
    """Points of Sobol's sequence in the unit cube, shifted by the golden ratio's multiples, (count, dimensions).

    ``first``: place of the first point in the sequence.
    """
    points = sobol_points(dimensions, count, first)
    shift = (np.arange(1, dimensions + 1) * (np.sqrt(5.0) - 1) / 2) % 1.0
    return np.asarray((points + shift) % 1.0).clip(1e-9, 1 - 1e-9)
