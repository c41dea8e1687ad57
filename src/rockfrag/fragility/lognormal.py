"""A fragility curve of one intensity measure, fitted to outcomes: lognormal (probit) or log-logistic (logit).

P(overturn | IM) = F((ln IM - ln θ) / β), by maximum likelihood of a binomial generalised linear model in ln IM.
In: :class:`rockfrag.fragility.observations.Observations`. Out: :class:`FragilityFit`, with θ in the unit of the
measure, β [-], their covariance, and warnings in sentences.

Theory: ``docs/fragility.md``, first equation and "Estimators"; Firth (1993, Biometrika 80: 27-38) under
separation.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import fit_notes
from rockfrag.fragility.batch_glm import Link, fit_batch, log_terms, separated
from rockfrag.fragility.observations import Floats, Observations, cells

ROUNDING = 1e-9  # levels whose logarithms differ by less are the same
LEAST_SLOPE = 1e-3
"""A curve with a smaller slope in ln IM (β above 1000) is flat: the measure predicts nothing."""

MOST_ROWS = 100_000
"""Rows beyond which tests are fitted in 10 000 cells of nearly equal values, which moves θ by less than 1e-6."""

Covariance = tuple[tuple[float, float], tuple[float, float]]


class Curve(NamedTuple):
    """Parameters of a curve: θ in the unit of its measure, β [-], and the covariance of (ln θ, β)."""

    theta: float
    beta: float
    covariance: Covariance


NO_CURVE = Curve(np.nan, np.nan, ((np.nan, np.nan), (np.nan, np.nan)))


@dataclass(frozen=True)
class FragilityFit:
    """A fragility curve P(overturn | IM) = F((ln IM - ln θ) / β), F normal (``probit``) or logistic (``logit``).

    Attributes
    ----------
    theta, beta
        Median of the intensity measure at overturning, in ``unit``, and logarithmic standard deviation (probit) or
        logistic scale (logit); NaN where the data give none.
    covariance : covariance of (ln θ, β), 2 × 2, by the delta method from the expected information
        It takes tests for independent; where motions repeat, use an interval over motions instead.
    log_likelihood : with binomial coefficients
    n, n_overturned, n_motions : tests, those that overturned, and different motions
    method, warnings
        How it was fitted, in words, and a sentence for each thing that a reader must know before using the curve.
    im, unit, link : intensity measure and its unit; ``probit`` or ``logit``
    of_motions : whether the motions are known; else ``n_motions`` is the number of rows
    """

    theta: float
    beta: float
    covariance: Covariance
    log_likelihood: float
    n: int
    n_overturned: int
    n_motions: int
    method: str
    im: str = "IM"
    unit: str = ""
    link: Link = "probit"
    warnings: tuple[str, ...] = ()
    of_motions: bool = True

    __repr__ = short_repr

    @property
    def se_log_theta(self) -> float:
        """Standard error of ln θ."""
        return float(np.sqrt(self.covariance[0][0]))

    @property
    def se_beta(self) -> float:
        """Standard error of β."""
        return float(np.sqrt(self.covariance[1][1]))

    @property
    def aic(self) -> float:
        """Akaike's criterion; the parameters counted are two."""
        return 4.0 - 2.0 * self.log_likelihood

    @property
    def coefficients(self) -> tuple[float, float]:
        """Intercept and slope of the linear predictor in ln IM."""
        return -np.log(self.theta) / self.beta, 1.0 / self.beta

    def probability(self, im: ArrayLike) -> Floats:
        """Probability of overturning at ``im`` [in ``unit``], same shape; 0 at an IM of 0."""
        values = np.asarray(im, dtype=np.float64)
        with np.errstate(divide="ignore"):
            eta = (np.log(values) - np.log(self.theta)) / self.beta
        return np.asarray(
            special.ndtr(eta) if self.link == "probit" else special.expit(eta)
        )


def curve_parameters(coefficients: Floats, covariance: Floats) -> Curve:
    """θ = exp(-c0/c1), β = 1/c1 and the covariance of (ln θ, β), from intercept c0 and slope c1.

    Parameters
    ----------
    coefficients, covariance : intercept and slope in ln IM, shape (2,), and their covariance, shape (2, 2)

    Returns
    -------
    The :class:`Curve`, θ in the unit of IM.
    """
    c0, c1 = float(coefficients[0]), float(coefficients[1])
    jacobian = np.array([[-1.0 / c1, c0 / c1**2], [0.0, -1.0 / c1**2]])
    (a, b), (c, d) = (jacobian @ covariance @ jacobian.T).tolist()
    return Curve(float(np.exp(-c0 / c1)), 1.0 / c1, ((a, b), (c, d)))


@named_keywords
def fit_lognormal(outcomes: Observations, *, link: Link = "probit") -> FragilityFit:
    """Fit a curve to outcomes by maximum likelihood (binomial, of ln IM).

    Where one value of the measure separates survival from overturning the likelihood has no maximum; the fit is
    then penalised (Firth, 1993), as ``method`` and ``warnings`` say. θ and β are NaN where all tests agree or are
    at one value, or the probability does not rise; a warning says what the data do tell.

    Parameters
    ----------
    outcomes, link : outcomes with their measure; ``probit`` (lognormal curve) or ``logit``

    Returns
    -------
    The :class:`FragilityFit`.
    """
    notes = fit_notes.notes_of_outcomes(outcomes)
    if outcomes.im.size > MOST_ROWS:
        pooled = _fit_pooled(outcomes, link)
        return replace(pooled, warnings=(*notes, *pooled.warnings))
    curve, log_likelihood = NO_CURVE, 0.0
    if outcomes.n_overturned in (0, outcomes.n):
        method = "none: all tests agree"
        notes.append(fit_notes.note_of_agreement(outcomes))
    elif np.ptp(outcomes.log_im) < ROUNDING:
        method = "none: one level of the measure"
        notes.append(
            fit_notes.note_of_one_level(
                outcomes, outcomes.n, outcomes.name, outcomes.im[0]
            )
        )
    else:
        found = _estimate(outcomes, link)
        method = found.method
        notes += found.notes
        log_likelihood = _log_likelihood(outcomes, found.coefficients, link)
        if found.coefficients[1] < LEAST_SLOPE:
            method = "none: probability does not rise"
            notes.append(fit_notes.note_of_falling(outcomes))
        else:
            covariance = np.asarray(np.linalg.inv(found.information))
            curve = curve_parameters(found.coefficients, covariance)
    return FragilityFit(
        theta=curve.theta,
        beta=curve.beta,
        covariance=curve.covariance,
        log_likelihood=log_likelihood,
        n=outcomes.n,
        n_overturned=outcomes.n_overturned,
        n_motions=outcomes.n_motions,
        method=method,
        im=outcomes.name,
        unit=outcomes.unit,
        link=link,
        warnings=tuple(notes),
        of_motions=outcomes.of_motions,
    )


def _fit_pooled(outcomes: Observations, link: Link) -> FragilityFit:
    """Fit a curve to many tests, pooled in 10⁴ cells of the measure; its likelihood is that of the tests."""
    cell, values = cells(outcomes.log_im, 10_000)
    pooled = outcomes.pooled(cell, np.exp(values))
    fit = fit_lognormal(pooled, link=link)
    # cells are not tests: which of a cell's tests overturned is known
    arrangements = float(
        outcomes.log_arrangements().sum() - pooled.log_arrangements().sum()
    )
    return replace(
        fit,
        n_motions=outcomes.n_motions,
        log_likelihood=fit.log_likelihood + arrangements,
    )


def _log_likelihood(outcomes: Observations, coefficients: Floats, link: Link) -> float:
    """Binomial log-likelihood of outcomes under a curve with these coefficients, (2,), in ln IM."""
    log_p, log_q, *_ = log_terms(
        coefficients[0] + coefficients[1] * outcomes.log_im, link
    )
    survived = outcomes.trials - outcomes.overturned
    terms = outcomes.overturned * log_p + survived * log_q
    return float((terms + outcomes.log_arrangements()).sum())


class _Estimate(NamedTuple):
    """Coefficients, (2,), with their information, (2, 2), how they were found, and what to warn of."""

    method: str
    coefficients: Floats
    information: Floats
    notes: list[str]


def _estimate(outcomes: Observations, link: Link) -> _Estimate:
    """Coefficients by maximum likelihood, penalised where that has no finite maximum."""
    apart = separated(
        outcomes.log_im, outcomes.overturned[None], outcomes.trials[None]
    )[0]
    notes: list[str] = []
    if not apart:
        found = _most_likely(outcomes, link)
        if found is not None:
            return _Estimate(f"{link}, maximum likelihood (GLM)", *found, notes)
        notes.append(fit_notes.NOT_FINITE)
    design = np.column_stack([np.ones(outcomes.im.size), outcomes.log_im])
    fit = fit_batch(
        design,
        outcomes.overturned[None],
        outcomes.trials[None],
        link=link,
        penalised=True,
    )
    if apart and fit.coefficients[0, 1] >= LEAST_SLOPE:
        notes.append(fit_notes.note_of_separation(outcomes))
    method = f"{link}, penalised likelihood (Firth)"
    return _Estimate(method, fit.coefficients[0], fit.information[0], notes)


STEP = 1e-12
"""Step of the coefficients below which the maximum of the likelihood is found [-]."""


def _most_likely(outcomes: Observations, link: Link) -> tuple[Floats, Floats] | None:
    """Coefficients of the GLM and their expected information; None without a finite maximum."""
    # tests at one value are one row of counts: the same likelihood, and a tenth of the time
    values, level = np.unique(outcomes.log_im, return_inverse=True)
    fell = np.bincount(level, outcomes.overturned).astype(np.float64)
    trials = np.bincount(level, outcomes.trials).astype(np.float64)
    design = np.column_stack([np.ones(values.size), values])
    fit = fit_batch(design, fell[None], trials[None], link=link, tolerance=STEP)
    if not fit.converged[0]:
        return None
    return fit.coefficients[0], fit.information[0]
