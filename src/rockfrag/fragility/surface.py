"""Overturning as a function of several intensity measures, for example ln PGA and ln PGV."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy import optimize, special

from rockfrag.errors import InputError
from rockfrag.fragility.batch_glm import BatchFit, fit_batch
from rockfrag.fragility.observations import Floats, positive, read_observations
from rockfrag.short_repr import short_repr

MOST_FOR_THE_PLANE = 20_000
"""Tests up to which separation is found exactly; a linear programme of more takes too long."""


@dataclass(frozen=True)
class FragilitySurface:
    """P(overturn | IM1, IM2, …) = Φ(c0 + c1 ln IM1 + c2 ln IM2 + …).

    Attributes
    ----------
    coefficients
        Intercept first; with an interaction of two measures its coefficient of ln IM1 ln IM2 last.
    covariance
        From the expected information, as many rows and columns as coefficients.
    measures
        Columns of the measures.
    log_likelihood, aic, n, method
        As in :class:`rockfrag.fragility.lognormal.FragilityFit`.
    """

    coefficients: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]
    measures: tuple[str, ...]
    log_likelihood: float
    aic: float
    n: int
    method: str

    __repr__ = short_repr

    def probability(self, *im: ArrayLike) -> Floats:
        """Probability of overturning at values of the measures, in order; they broadcast."""
        logs = [np.log(np.asarray(values, dtype=np.float64)) for values in im]
        if len(self.coefficients) > len(self.measures) + 1:
            logs.append(logs[0] * logs[1])
        eta = np.asarray(self.coefficients[0], dtype=np.float64)
        for slope, values in zip(self.coefficients[1:], logs, strict=True):
            eta = eta + slope * values
        return np.asarray(special.ndtr(eta))


def fit_surface(
    table: pd.DataFrame,
    measures: Sequence[str],
    *,
    interaction: bool = False,
    overturned: str = "overturned",
    source: str = "table",
) -> FragilitySurface:
    """Fit a probit surface in the logarithms of one or more measures, one row per test.

    Under separation (found exactly, by linear programming) the likelihood is penalised and
    ``method`` says so.

    Parameters
    ----------
    table
        One row a test.
    measures
        Columns of the intensity measures.
    interaction
        Add the product of the logarithms of two measures.
    overturned
        Column with the outcomes.
    source
        What messages call the table.

    Returns
    -------
    FragilitySurface
        Coefficients, their covariance, log-likelihood and AIC.

    Raises
    ------
    InputError
        If a value is missing or out of range, all tests agree, or measures are proportional.
    """
    logs = [np.log(positive(table, column, source)) for column in measures]
    outcome = read_observations(table, overturned, source)
    if outcome.min() == outcome.max():
        raise InputError(
            f"{source}, column {overturned!r}: all {outcome.size} tests have the outcome "
            f"{outcome[0]:g}; a surface needs both."
        )
    design = design_of(logs, interaction)
    if np.linalg.matrix_rank(design) < design.shape[1]:
        raise InputError(
            f"{source}: the measures {', '.join(measures)} are proportional to each other (or "
            "constant) in these tests; choose fewer."
        )
    method = "probit, maximum likelihood"
    # among so many tests no plane parts what a fit does not find parted
    apart = outcome.size <= MOST_FOR_THE_PLANE and linearly_separable(design, outcome)
    fit = _fitted(design, outcome, penalised=apart)
    if not apart and not fit.converged[0]:
        apart, fit = True, _fitted(design, outcome, penalised=True)
    if apart:
        method = "probit, penalised likelihood (Firth)"
    coefficients, information = fit.coefficients[0], fit.information[0]
    eta = design @ coefficients
    log_likelihood = float(special.log_ndtr(np.where(outcome > 0, eta, -eta)).sum())
    covariance = np.linalg.inv(information)
    return FragilitySurface(
        tuple(float(value) for value in coefficients),
        tuple(tuple(float(value) for value in row) for row in covariance),
        tuple(measures),
        log_likelihood,
        2.0 * design.shape[1] - 2.0 * log_likelihood,
        int(outcome.size),
        method,
    )


def design_of(logs: Sequence[Floats], interaction: bool) -> Floats:
    """Return the predictors: ones, the logarithms of the measures and, if asked for, the product of two."""
    product = [logs[0] * logs[1]] if interaction else []
    return np.column_stack([np.ones(logs[0].size), *logs, *product])


def linearly_separable(design: Floats, outcome: Floats) -> bool:
    """Tell whether a plane parts overturned from survived tests (ties on the plane allowed).

    Solves for the direction c, |c| ≤ 1, that maximises Σ s x·c subject to s x·c ≥ 0, with s = ±1
    the outcome; a maximum above zero means separation (Konis, 2007, ch. 4).
    """
    signed = np.where(outcome > 0, 1.0, -1.0)[:, None] * design
    found = optimize.linprog(
        -signed.sum(axis=0), A_ub=-signed, b_ub=np.zeros(len(signed)), bounds=(-1.0, 1.0)
    )
    return bool(-found.fun > 1e-9)


def _fitted(design: Floats, outcome: Floats, *, penalised: bool) -> BatchFit:
    trials = np.ones((1, outcome.size))
    return fit_batch(design, outcome[None, :], trials, penalised=penalised, tolerance=1e-11)
