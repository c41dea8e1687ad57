"""What stands beside a fragility in two measures: a test of fit, and what the outcomes say without it."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import optimize, special

from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.goodness import binned_deviance, refitted_deviance
from rockfrag.fragility.observations import Floats, labels, positive, read_observations
from rockfrag.fragility.pooling import cells
from rockfrag.fragility.vector import VectorFragility, design_of

BINS = 10  # bins of the fitted probability in which observed and fitted numbers are compared
MOST_CELLS = 12  # cells of each measure in the non-parametric surface
TOLERANCE = 1e-9
"""Change of a probability at which the alternating projections of the surface end [-]."""

MOST_DRAWN = 4_000_000  # outcomes that are drawn at once, which bounds the memory

MOST_CYCLES = 5_000  # cycles of alternating projections; some hundreds are usual


@dataclass(frozen=True)
class VectorChecks:
    """Test of fit and non-parametric surface of a fragility in two measures.

    Attributes
    ----------
    p_fit
        p value of the hypothesis that the fit describes the outcomes, by parametric bootstrap [-].
    surface
        A row per cell of the two measures that has tests: the measures' columns (geometric means of the cell's
        row and column), ``tests``, ``overturned``, ``probability`` (rising in both measures) and ``fitted``.
    """

    p_fit: float
    surface: pd.DataFrame

    @property
    def rejected(self) -> bool:
        """Whether the fit does not describe its outcomes."""
        return self.p_fit < REJECTED


def check_vector(
    fit: VectorFragility,
    table: pd.DataFrame,
    *,
    overturned: str = "overturned",
    motion: str | None = "motion",
    replicates: int = 200,
    seed: int = 0,
) -> VectorChecks:
    """Judge a fragility in two measures by the outcomes that it was fitted to.

    Parameters
    ----------
    fit, table
        The fit and its table, one row a test.
    overturned, motion
        Columns of the outcome and of the motion; None where each test has a motion of its own.  In simulated data
        each motion has one capacity, so that its tests depend on each other as in an incremental dynamic analysis.
    replicates, seed
        Of the parametric bootstrap.

    Returns
    -------
    VectorChecks
        p value and non-parametric surface.
    """
    logs = [np.log(positive(table, column)) for column in fit.measures]
    outcome = read_observations(table, overturned)
    design = design_of(logs, fit.interaction.kept)
    eta = design @ np.array(fit.coefficients)
    # bins with about equally many tests, in order of the fitted probability
    bins, values = cells(eta, BINS)
    bins = bins if values.size > 1 else np.zeros(eta.size, dtype=np.intp)
    motions = pd.factorize(pd.Series(labels(table, motion, "table")))[0]
    capacity = np.random.default_rng(seed).normal(size=(replicates, int(motions.max()) + 1))
    fell, expected, trials = (
        np.asarray(np.bincount(bins, values), dtype=np.float64)
        for values in (outcome, special.ndtr(eta), np.ones(eta.size))
    )
    own = binned_deviance(fell, expected, trials)
    at_once = max(MOST_DRAWN // eta.size, 1)
    simulated = np.concatenate(
        [
            refitted_deviance(design, 1.0 * (eta > part[:, motions]), np.ones(eta.size), bins)
            for part in np.split(capacity, range(at_once, replicates, at_once))
        ]
    )
    p_fit = float((1 + np.sum(simulated >= own - 1e-9)) / (1 + simulated.size))
    return VectorChecks(p_fit, _surface_table(fit, logs, outcome))


def _surface_table(fit: VectorFragility, logs: list[Floats], outcome: Floats) -> pd.DataFrame:
    (row, first), (column, second) = (cells(values, MOST_CELLS) for values in logs)
    shape = (first.size, second.size)
    flat = row * shape[1] + column
    tests = np.bincount(flat, minlength=first.size * second.size).reshape(shape)
    fell = np.bincount(flat, outcome, minlength=first.size * second.size).reshape(shape)
    probability = monotone_probability(fell.astype(np.float64), tests.astype(np.float64))
    i, j = np.nonzero(tests)
    x, y = np.exp(first[i]), np.exp(second[j])
    return pd.DataFrame(
        {
            fit.measures[0]: x,
            fit.measures[1]: y,
            "tests": tests[i, j],
            "overturned": fell[i, j].astype(np.int64),
            "probability": probability[i, j],
            "fitted": fit.probability(x, y),
        }
    )


def monotone_probability(overturned: Floats, tests: Floats) -> Floats:
    """Probability of overturning by cell that rises along rows and columns and is closest to what was observed.

    Weighted least squares under both orders, by alternating projections (Dykstra and Robertson 1982, Annals of
    Statistics 10: 708-716). Arrays have the shape (rows, columns); cells without tests follow their neighbours.
    """
    weight = np.maximum(tests, 1e-9)
    value = np.where(tests > 0, overturned / weight, overturned.sum() / tests.sum())
    by_row, by_column = np.zeros_like(value), np.zeros_like(value)
    for _ in range(MOST_CYCLES):
        along = _rising(value + by_row, weight)
        by_row = value + by_row - along
        across = _rising((along + by_column).T, weight.T).T
        by_column = along + by_column - across
        moved = float(np.abs(across - value).max())
        value = across
        if moved < TOLERANCE:
            break
    return np.asarray(np.clip(value, 0.0, 1.0))


def _rising(values: Floats, weights: Floats) -> Floats:
    """Isotonic regression of each row."""
    pairs = zip(values, weights, strict=True)
    return np.array([optimize.isotonic_regression(v, weights=w).x for v, w in pairs])
