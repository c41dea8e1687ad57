"""Many small binary regressions at once, maximum likelihood or penalised, by Fisher scoring.

In: predictors that all share, (rows, k), and counts of each replicate, (batch, rows). Out: :class:`BatchFit`.
A test compares them with statsmodels, which fits one in milliseconds.

Theory: ``docs/fragility.md``, "Estimators"; Firth (1993) for the penalty.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

from rockfrag.fragility.observations import Floats

Link = Literal["probit", "logit"]

# steps after which a regression that has not converged is left as it is
MOST_STEPS = 100
_LARGEST_PREDICTOR = 30.0
_LOG_ROOT_TWO_PI = 0.5 * np.log(2.0 * np.pi)


@dataclass(frozen=True)
class BatchFit:
    """Coefficients of a batch of regressions of the same predictors."""

    coefficients: Floats  # shape (batch, k); NaN where all tests of a replicate agree
    information: Floats  # expected (Fisher) information, shape (batch, k, k)
    converged: NDArray[np.bool_]  # shape (batch,)


def log_terms(eta: Floats, link: Link) -> tuple[Floats, Floats, Floats, Floats]:
    """Logarithms of what the likelihood of one test is made of.

    Parameters
    ----------
    eta : linear predictor, any shape
    link : of the regression

    Returns
    -------
    ln p, ln(1 - p), ln of the density dp/d eta, and d ln w / d eta with the working weight w; shape of ``eta``
        each.
    """
    if link == "logit":
        log_p = -np.logaddexp(0.0, -eta)
        log_q = -np.logaddexp(0.0, eta)
        return log_p, log_q, log_p + log_q, 1.0 - 2.0 * np.exp(log_p)
    log_p = special.log_ndtr(eta)
    log_q = special.log_ndtr(-eta)
    log_density = -0.5 * eta**2 - _LOG_ROOT_TWO_PI
    slope = -2.0 * eta - np.exp(log_density - log_p) + np.exp(log_density - log_q)
    return log_p, log_q, log_density, slope


def fit_batch(
    design: Floats,
    failures: Floats,
    trials: Floats,
    *,
    link: Link = "probit",
    penalised: bool = False,
    start: Floats | None = None,
    tolerance: float = 1e-9,
) -> BatchFit:
    """Fit binomial regressions that have their predictors in common.

    Parameters
    ----------
    design : predictors with ones, shape (rows, k)
    failures, trials : counts, shape (batch, rows); a row with 0 trials takes no part
    link : of the regression
    penalised
        Adds half the logarithm of the determinant of the information to the log-likelihood (Firth, 1993,
        Biometrika 80: 27-38), whose maximum is finite under separation also (Kosmidis and Firth, 2021,
        Biometrika 108: 71-82).
    start, tolerance : coefficients to start from, shape (k,), and the step at which a regression has converged

    Returns
    -------
    The :class:`BatchFit`.
    """
    batch, columns = failures.shape[0], design.shape[1]
    mixed = (failures.sum(axis=1) > 0) & (failures.sum(axis=1) < trials.sum(axis=1))
    coefficients = (
        np.zeros((batch, columns)) if start is None else np.tile(start, (batch, 1))
    )
    coefficients[~mixed] = np.nan
    objective = np.full(batch, -np.inf)
    information = np.full((batch, columns, columns), np.nan)
    converged = ~mixed
    active = np.flatnonzero(mixed)
    step = np.zeros((batch, columns))
    for _ in range(MOST_STEPS):
        if active.size == 0:
            break
        trial = coefficients[active] + step[active]
        at = _evaluated(design, failures[active], trials[active], trial, link)
        goal = at.log_likelihood
        if penalised:
            goal = goal + 0.5 * np.linalg.slogdet(at.information)[1]
        # a step that makes it worse is halved; the others are taken, and the next one found
        worse = goal < objective[active] - 1e-10
        settled = (
            ~worse
            & (np.abs(step[active]).max(axis=1) < tolerance)
            & (objective[active] > -np.inf)
        )
        step[active[worse]] *= 0.5
        stuck = worse & (np.abs(step[active]).max(axis=1) < 1e-14)
        better = np.flatnonzero(~worse)
        where = active[better]
        coefficients[where] = trial[better]
        objective[where] = goal[better]
        information[where] = at.information[better]
        step[where] = _next_steps(design, at, better, penalised=penalised)
        converged[active[settled]] = True
        active = active[~settled & ~stuck]
    return BatchFit(coefficients, information, converged)


class _Evaluated(NamedTuple):
    """A batch of regressions at their coefficients."""

    log_likelihood: Floats  # shape (batch,)
    information: Floats  # expected, shape (batch, k, k)
    # slope of the log-likelihood by the predictor, weight, and slope of its logarithm, shape (batch, rows) each
    score: Floats
    weight: Floats
    weight_slope: Floats


def _evaluated(
    design: Floats, failures: Floats, trials: Floats, coefficients: Floats, link: Link
) -> _Evaluated:
    """Likelihood and information of regressions at coefficients, shape (batch, k).

    ``design``: shape (rows, k); ``failures``, ``trials``: shape (batch, rows).
    """
    rows, columns = design.shape
    eta = np.clip(coefficients @ design.T, -_LARGEST_PREDICTOR, _LARGEST_PREDICTOR)
    log_p, log_q, log_density, weight_slope = log_terms(eta, link)
    survived = trials - failures
    weight = trials * np.exp(2.0 * log_density - log_p - log_q)
    outer = (design[:, :, None] * design[:, None, :]).reshape(rows, -1)
    return _Evaluated(
        log_likelihood=(failures * log_p + survived * log_q).sum(axis=1),
        information=(weight @ outer).reshape(-1, columns, columns),
        score=failures * np.exp(log_density - log_p)
        - survived * np.exp(log_density - log_q),
        weight=weight,
        weight_slope=weight_slope,
    )


def _next_steps(
    design: Floats, at: _Evaluated, chosen: NDArray[np.int64], *, penalised: bool
) -> Floats:
    """Steps of Fisher's scoring of the ``chosen`` regressions, shape (chosen, k); Firth's if ``penalised``.

    Firth's score has half the leverage of each test times the slope of ln w added.
    """
    inverse = np.linalg.pinv(at.information[chosen], hermitian=True)
    score = at.score[chosen]
    if penalised:
        leverage = np.einsum("ri,bij,rj->br", design, inverse, design)
        leverage = at.weight[chosen] * leverage
        score = score + 0.5 * leverage * at.weight_slope[chosen]
    return np.asarray(np.einsum("bij,bj->bi", inverse, score @ design))


def separated(log_im: Floats, failures: Floats, trials: Floats) -> NDArray[np.bool_]:
    """Replicates in which one value separates survived from overturned tests.

    Then the likelihood has no finite maximum. Replicates in which all tests agree count as separated.

    Parameters
    ----------
    log_im, failures, trials : ln IM, shape (rows,), and counts, shape (batch, rows)

    Returns
    -------
    Whether each is separated, shape (batch,).
    """
    fell, stood = failures > 0, trials - failures > 0

    def extreme(mask: NDArray[np.bool_], sign: float) -> Floats:
        """Largest ``sign`` times ln IM among the tests of a mask, shape (batch,)."""
        return np.asarray(np.where(mask, sign * log_im, -np.inf).max(axis=1))

    upward = extreme(stood, 1.0) <= -extreme(fell, -1.0)
    downward = extreme(fell, 1.0) <= -extreme(stood, -1.0)
    return np.asarray(upward | downward)
