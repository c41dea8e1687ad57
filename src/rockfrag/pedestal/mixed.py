"""Mixed models with crossed effects of event and motion, each fit checked before it is believed.

statsmodels fits the variances by general optimisation, and with crossed effects this can stop
short or, by ``lbfgs``, return an intercept of exactly zero as converged.  In a balanced design the
fixed effects are known beforehand: they are those of ordinary least squares, that is, means of
cells.  So every fit is compared with them, and its likelihood with that of a direct two-parameter
search.  A fit that fails is an error, never a number.
"""

import warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
import statsmodels.formula.api as smf
from scipy import optimize, stats

from rockfrag.errors import InputError
from rockfrag.pedestal.units import CONFIDENCE, Array

VARIANCES = {"event": "0+C(event)", "motion": "0+C(event):C(floor)"}
OPTIMISER = "bfgs"
SHORTFALL = 0.05
"""Largest shortfall of log-likelihood that still counts as the same maximum [-]."""

EFFECT = "d ~ 1"
EFFECT_BY_FLOOR = "d ~ C(floor,Sum)*s_c"
AMPLITUDE = "ln_a ~ C(ped)*C(floor)*s_c"


class FitDisagreementError(RuntimeError):
    """A fitted mixed model contradicts the means of balanced data, so it must not be reported."""


@dataclass(frozen=True)
class MixedFit:
    """A mixed model that passed its checks.

    Parameters
    ----------
    formula
        Fixed effects.
    coefficients
        Table: term, estimate, se, lower, upper, p, least_squares (the balanced-data value).
    sd_event, sd_motion, sd_residual
        Standard deviations of the random effects and the residual, at the direct REML maximum [-].
    events
        Number of events; intervals use t with one degree of freedom less.
    balanced
        Whether least squares is the exact answer for the fixed effects.
    notes
        What the optimiser had to say, and what was done about it.
    """

    formula: str
    coefficients: pd.DataFrame
    sd_event: float
    sd_motion: float
    sd_residual: float
    events: int
    balanced: bool
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _Direct:
    """REML maximum over the two variance ratios and what follows from it."""

    loglik: float
    ratios: Array
    scale: float
    beta: Array
    covariance: Array


def _indicator(labels: pd.Series) -> Array:
    return pd.get_dummies(labels).to_numpy(dtype=float)


class _Reml:
    """Restricted likelihood of y = X β + event + motion + residual."""

    def __init__(self, y: Array, x: Array, event: Array, motion: Array) -> None:
        self.y, self.x = y, x
        self.kernels = (event @ event.T, motion @ motion.T)

    def at(self, ratios: Array) -> _Direct:
        """Everything at given ratios of the variances of event and motion to the residual's."""
        v = np.eye(len(self.y)) + ratios[0] * self.kernels[0] + ratios[1] * self.kernels[1]
        v_x = np.linalg.solve(v, self.x)
        v_y = np.linalg.solve(v, self.y)
        information = self.x.T @ v_x
        beta = np.asarray(np.linalg.solve(information, self.x.T @ v_y), dtype=np.float64)
        residual = self.y - self.x @ beta
        free = len(self.y) - self.x.shape[1]
        scale = float(residual @ np.linalg.solve(v, residual)) / free
        loglik = -0.5 * (
            free * (np.log(2 * np.pi * scale) + 1)
            + np.linalg.slogdet(v)[1]
            + np.linalg.slogdet(information)[1]
        )
        covariance: Array = scale * np.linalg.inv(information)
        return _Direct(float(loglik), ratios, scale, beta, covariance)

    def maximum(self) -> _Direct:
        """Search from three starts; roots of the ratios are free, so zero is no wall."""
        best: _Direct | None = None
        for start in ((0.3, 0.3), (1.0, 0.1), (0.1, 1.0)):
            found = optimize.minimize(
                lambda root: -self.at(root**2).loglik,
                np.array(start),
                method="Nelder-Mead",
                options={"xatol": 1e-6, "fatol": 1e-9},
            )
            one = self.at(found.x**2)
            if best is None or one.loglik > best.loglik:
                best = one
        assert best is not None
        return best


def random_effects_balanced(rows: pd.DataFrame) -> bool:
    """Whether every motion carries the same rows and every event every floor."""
    per_motion = rows.groupby(["event", "floor"]).size()
    grid = rows["event"].nunique() * rows["floor"].nunique()
    return len(per_motion) == grid and len(set(per_motion)) == 1


def fit_mixed(rows: pd.DataFrame, formula: str, optimiser: str = OPTIMISER) -> MixedFit:
    """Fit a mixed model by REML and check it.

    Parameters
    ----------
    rows
        Columns event, floor and those of ``formula``; one row per pair or per test.
    formula
        Fixed effects, one of `EFFECT`, `EFFECT_BY_FLOOR`, `AMPLITUDE`.
    optimiser
        Only the tests that show what is wrong with ``lbfgs`` give another one.

    Returns
    -------
    MixedFit

    Raises
    ------
    InputError
        If there are fewer than two events or three motions, an empty cell, or no scatter.
    FitDisagreementError
        If the fixed effects disagree with those of least squares (balanced data) or of generalised
        least squares at the REML maximum (unbalanced data).
    """
    if rows["event"].nunique() < 2 or rows.groupby(["event", "floor"]).ngroups < 3:
        raise InputError(
            "Mixed model: it needs at least two events and three motions to tell their variances; "
            "add motions or read the means only."
        )
    notes: list[str] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        model = smf.mixedlm(
            formula, rows.assign(one=1), groups="one", re_formula="0", vc_formula=VARIANCES
        )
        y, x = np.asarray(model.endog, dtype=float), np.asarray(model.exog, dtype=float)
        least_squares: Array = np.linalg.lstsq(x, y, rcond=None)[0]
        if np.linalg.matrix_rank(x) < x.shape[1]:
            raise InputError(f"Mixed model {formula}: a cell of the design is empty; fill it.")
        if np.ptp(y - x @ least_squares) < 1e-12 * max(1.0, float(np.ptp(y))):
            raise InputError(
                f"Mixed model {formula}: the data have no scatter to model; read the means."
            )
        fitted = model.fit(reml=True, method=optimiser)
    if caught:
        notes.append(f"statsmodels warned {len(caught)} time(s) while optimising")
    motion = rows["event"].astype(str) + "/" + rows["floor"].astype(str)
    reml = _Reml(y, x, _indicator(rows["event"]), _indicator(motion))
    direct = reml.maximum()
    balanced = random_effects_balanced(rows)
    expected = least_squares if balanced else direct.beta
    estimate = np.asarray(fitted.fe_params, dtype=float)
    terms = list(model.exog_names)
    se = np.sqrt(np.diag(direct.covariance))
    check_fixed_effects(terms, formula, estimate, expected, se, balanced)
    theirs = reml.at(np.asarray(fitted.vcomp, dtype=float) / float(fitted.scale))
    if theirs.loglik < direct.loglik - SHORTFALL:
        notes.append(
            f"statsmodels stopped {direct.loglik - theirs.loglik:.2f} short of the largest "
            "log-likelihood; variances and standard errors are those of the direct maximum"
        )
    events = int(rows["event"].nunique())
    return MixedFit(
        formula=formula,
        coefficients=_coefficients(terms, estimate, direct, least_squares, events),
        sd_event=float(np.sqrt(direct.ratios[0] * direct.scale)),
        sd_motion=float(np.sqrt(direct.ratios[1] * direct.scale)),
        sd_residual=float(np.sqrt(direct.scale)),
        events=events,
        balanced=balanced,
        notes=tuple(notes),
    )


def check_fixed_effects(
    terms: list[str], formula: str, estimate: Array, expected: Array, se: Array, balanced: bool
) -> None:
    """Refuse fixed effects that are not the known ones.

    Balanced data leave no freedom; for unbalanced data the optimiser's variances enter a little, so
    a fifth of a standard error is allowed there.

    Raises
    ------
    FitDisagreementError
        Naming the term.
    """
    allowed = (1e-4 if balanced else 0.2) * se
    for term, one, known, limit in zip(terms, estimate, expected, allowed, strict=True):
        if not abs(one - known) <= limit:
            raise FitDisagreementError(
                f"mixed model {formula}: fixed effect {term} came out as {one:.6g}, but the "
                f"{'means of the balanced data' if balanced else 'generalised least squares'} "
                f"give {known:.6g}"
            )


def _coefficients(
    names: list[str], estimate: Array, direct: _Direct, least_squares: Array, events: int
) -> pd.DataFrame:
    se = np.sqrt(np.diag(direct.covariance))
    half = float(stats.t.ppf(0.5 + CONFIDENCE / 2, events - 1)) * se
    return pd.DataFrame(
        {
            "term": names,
            "estimate": estimate,
            "se": se,
            "lower": estimate - half,
            "upper": estimate + half,
            "p": 2 * stats.t.sf(np.abs(estimate) / se, events - 1),
            "least_squares": least_squares,
        }
    )


def long_rows(pairs: pd.DataFrame) -> pd.DataFrame:
    """Turn pairs into the rows of `AMPLITUDE`: two tests a pair, with ln_a and ped (0 or 1)."""
    sides = [
        pairs[["tower", "event", "floor", "motion", "s_c"]].assign(
            ped=value, ln_a=np.log(pairs[column])
        )
        for value, column in ((0, "a_np_g"), (1, "a_p_g"))
    ]
    return pd.concat(sides, ignore_index=True)
