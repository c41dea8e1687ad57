"""Parts of sources in a variance, and what knowing a source would do: first-order effects of given draws.

The first-order index of a source is the variance of the mean given that source over the variance (Sobol' 1993),
estimated from the draws that are there (Plischke, Borgonovo and Smith 2013, Eur. J. Oper. Res. 226: 536).
"""

import numpy as np
from scipy import special

from rockfrag.assess.core.draws import Draws
from rockfrag.base.arrays import Floats

BINS = 32  # Of equally many draws, by which a source is known

_EDGES = special.ndtri(np.linspace(0, 1, BINS + 1))
CENTRES: Floats = -BINS * np.diff(np.exp(-0.5 * _EDGES**2)) / np.sqrt(2 * np.pi)
"""Mean of a standard normal source in each bin."""


def part_of_source(values: Floats, normals: Floats) -> float:
    """Part of a source in the variance of values [-].

    Parameters
    ----------
    values, normals : of each draw, shape (draws,) both
    """
    return _part(means_by_source(values, normals), values)


def part_of_earthquakes(values: Floats, draws: Draws) -> float:
    """Part of the earthquakes in the variance of values, shape (draws,) [-]."""
    return _part(values.reshape(len(draws.weights), -1).mean(axis=1), values)


def means_by_source(values: Floats, normals: Floats) -> Floats:
    """Mean of the values in bins of equally many draws, by rising source, shape (``BINS``,)."""
    order = np.argsort(normals, kind="stable")
    return np.asarray(values[order].reshape(BINS, -1).mean(axis=1))


def means_once_known(values: Floats, normals: Floats, left: float) -> Floats:
    """Mean of the values by what a measurement of a source may say.

    Parameters
    ----------
    values, normals : of each draw, shape (draws,) both
    left : what the measurement leaves of the source's standard deviation [-]

    Returns
    -------
    Means after equally likely results, shape (``BINS``,).
    """
    means = means_by_source(values, normals)
    if left <= 0:
        return means
    # the source is what is measured and what is left of it, both normal
    measured = np.sqrt(1 - left**2) * CENTRES[:, np.newaxis]
    weights = np.exp(-0.5 * ((CENTRES - measured) / left) ** 2)
    return np.asarray(weights @ means / weights.sum(axis=1))


def _part(means: Floats, values: Floats) -> float:
    """Variance of means over that of the values; draws that fill space leave next to no chance in means."""
    total = float(values.var())
    return float(means.var()) / total if total > 0 else 0.0
