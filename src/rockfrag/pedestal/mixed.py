"""Mixed models with crossed effects of event and motion, each fit checked before it is believed.

statsmodels fits the variances by general optimisation, and with crossed effects this can stop
short or, by ``lbfgs``, return an intercept of exactly zero as converged.  In a balanced design the
fixed effects are known beforehand: they are those of ordinary least squares, that is, means of
cells.  So every fit is compared with them, and its likelihood with that of a direct two-parameter
search.  A fit that fails is an error, never a number.
"""

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import statsmodels.formula.api as smf
from scipy import optimize, stats

from rockfrag.errors import InputError
from rockfrag.pedestal.cluster_means import CONFIDENCE, Array

VARIANCES = {"event": "0+C(event)", "motion": "0+C(event):C(floor)"}
OPTIMISER = "bfgs"
LARGEST_FOR_STATSMODELS = 150
"""Rows up to which statsmodels fits too; its dense algebra takes minutes for 400."""
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


class _Reml:
    """Restricted likelihood of y = X β + event + motion + residual.

    Motions lie within events, so the covariance falls into a block per event.
    """

    def __init__(self, y: Array, x: Array, rows: pd.DataFrame) -> None:
        self.free = len(y) - x.shape[1]
        places = rows.reset_index(drop=True).groupby("event").indices.values()
        floors = rows["floor"].to_numpy()
        self.blocks = [
            (y[i], x[i], (floors[i][:, None] == floors[i][None, :]).astype(float)) for i in places
        ]

    def at(self, ratios: Array) -> _Direct:
        """Everything at given ratios of the variances of event and motion to the residual's."""
        columns = self.blocks[0][1].shape[1]
        information = np.zeros((columns, columns))
        response, squares, log_det = np.zeros(columns), 0.0, 0.0
        for y, x, same_motion in self.blocks:
            v = np.eye(len(y)) + ratios[0] + ratios[1] * same_motion
            solved = np.linalg.solve(v, np.column_stack([x, y]))
            information += x.T @ solved[:, :-1]
            response += x.T @ solved[:, -1]
            squares += float(y @ solved[:, -1])
            log_det += float(np.linalg.slogdet(v)[1])
        beta = np.asarray(np.linalg.solve(information, response), dtype=np.float64)
        scale = (squares - float(beta @ response)) / self.free
        loglik = -0.5 * (
            self.free * (np.log(2 * np.pi * scale) + 1)
            + log_det
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
    model = smf.mixedlm(
        formula, rows.assign(one=1), groups="one", re_formula="0", vc_formula=VARIANCES
    )
    y, x = np.asarray(model.endog, dtype=float), np.asarray(model.exog, dtype=float)
    terms = list(model.exog_names)
    least_squares: Array = np.linalg.lstsq(x, y, rcond=None)[0]
    if np.linalg.matrix_rank(x) < x.shape[1]:
        raise InputError(f"Mixed model {formula}: a cell of the design is empty; fill it.")
    if np.ptp(y - x @ least_squares) < 1e-12 * max(1.0, float(np.ptp(y))):
        raise InputError(
            f"Mixed model {formula}: the data have no scatter to model; read the means."
        )
    reml = _Reml(y, x, rows)
    direct = reml.maximum()
    balanced = random_effects_balanced(rows)
    expected = least_squares if balanced else direct.beta
    se = np.sqrt(np.diag(direct.covariance))
    if len(rows) > LARGEST_FOR_STATSMODELS:
        estimate = direct.beta
        notes.append(f"{len(rows)} rows: direct search of the restricted likelihood only")
    else:
        estimate, more = _by_statsmodels(model, optimiser, reml, direct)
        notes.extend(more)
    check_fixed_effects(terms, formula, estimate, expected, se, balanced)
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


def _by_statsmodels(
    model: Any, optimiser: str, reml: _Reml, direct: _Direct
) -> tuple[Array, list[str]]:
    """Fixed effects by statsmodels, and what to know about how its optimiser went."""
    notes = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            fitted = model.fit(reml=True, method=optimiser)
        except np.linalg.LinAlgError:
            # one floor only: the variances of events and of motions cannot be told apart
            return direct.beta, [
                "statsmodels met a singular matrix; estimates are those of the direct maximum"
            ]
    if caught:
        notes.append(f"statsmodels warned {len(caught)} time(s) while optimising")
    theirs = reml.at(np.asarray(fitted.vcomp, dtype=float) / float(fitted.scale))
    if theirs.loglik < direct.loglik - SHORTFALL:
        notes.append(
            f"statsmodels stopped {direct.loglik - theirs.loglik:.2f} short of the largest "
            "log-likelihood; variances and standard errors are those of the direct maximum"
        )
    return np.asarray(fitted.fe_params, dtype=float), notes


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
        pairs[["object", "event", "floor", "motion", "s_c"]].assign(
            ped=value, ln_a=np.log(pairs[column])
        )
        for value, column in ((0, "a_np_g"), (1, "a_p_g"))
    ]
    return pd.concat(sides, ignore_index=True)
