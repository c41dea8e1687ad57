"""Mixed models with crossed effects of event and motion.

The variances of event and motion (as ratios to the residual's) are found by a direct search of the
restricted likelihood; the fixed effects follow by generalised least squares.  General optimisers
stop short here, or return an intercept of exactly zero as converged.  In a balanced design the fixed
effects are known beforehand: they are those of ordinary least squares, that is, means of cells, and
every fit is held against them.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import optimize, special

from rockfrag.errors import InputError
from rockfrag.pedestal.cluster_means import CONFIDENCE, Array, t_beyond

STARTS = (0.0, 0.1, 0.5, 1.5)
"""Square roots of the variance ratios from whose best pair the search starts [-]."""

MOST_APART = 50
"""Events up to which each has a block of the covariance to itself."""

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
    """

    formula: str
    coefficients: pd.DataFrame
    sd_event: float
    sd_motion: float
    sd_residual: float
    events: int
    balanced: bool


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

    Motions lie within events, so the covariance falls into a block per event.  Of many events those with equal
    floors share a block and are solved for together.
    """

    def __init__(self, y: Array, x: Array, rows: pd.DataFrame) -> None:
        self.columns = x.shape[1]
        self.free = len(y) - self.columns
        places = list(rows.reset_index(drop=True).groupby("event").indices.values())
        floors = rows["floor"].to_numpy()
        self.blocks = (
            [] if len(places) > MOST_APART else [(y[i], x[i], _equal(floors[i])) for i in places]
        )
        alike: dict[tuple[str, ...], list[npt.NDArray[np.intp]]] = {}
        for i in places if len(places) > MOST_APART else ():
            alike.setdefault(tuple(floors[i]), []).append(np.asarray(i))
        data = np.column_stack([x, y])
        self.alike = [(data[np.array(some).T], _equal(floors[some[0]])) for some in alike.values()]

    def at(self, ratios: Array) -> _Direct:
        """Everything at given ratios of the variances of event and motion to the residual's."""
        columns = self.columns
        information = np.zeros((columns, columns))
        response, squares, log_det = np.zeros(columns), 0.0, 0.0
        for y, x, same_motion in self.blocks:
            v = np.eye(len(y)) + ratios[0] + ratios[1] * same_motion
            solved = np.linalg.solve(v, np.column_stack([x, y]))
            information += x.T @ solved[:, :-1]
            response += x.T @ solved[:, -1]
            squares += float(y @ solved[:, -1])
            log_det += float(np.linalg.slogdet(v)[1])
        for data, same_motion in self.alike:
            v = np.eye(len(data)) + ratios[0] + ratios[1] * same_motion
            solved = np.linalg.solve(v, data.reshape(len(data), -1)).reshape(data.shape)
            products = np.tensordot(data, solved, ([0, 1], [0, 1]))
            information += products[:-1, :-1]
            response += products[:-1, -1]
            squares += float(products[-1, -1])
            log_det += data.shape[1] * float(np.linalg.slogdet(v)[1])
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
        """Search from the best of a grid; roots of the ratios are free, so zero is no wall."""
        grid = [np.array([one, other]) for one in STARTS for other in STARTS]
        start = max(grid, key=lambda root: self.at(root**2).loglik)
        found = optimize.minimize(
            lambda root: -self.at(root**2).loglik,
            start,
            method="Nelder-Mead",
            options={"xatol": 1e-5, "fatol": 1e-8},
        )
        return self.at(found.x**2)


def _equal(names: npt.NDArray[np.object_]) -> Array:
    """1 where two of several names are equal and 0 elsewhere, shape (n, n)."""
    return np.asarray(names[:, None] == names[None, :], dtype=float)


def random_effects_balanced(rows: pd.DataFrame) -> bool:
    """Whether every motion carries the same rows and every event every floor."""
    per_motion = rows.groupby(["event", "floor"]).size()
    grid = rows["event"].nunique() * rows["floor"].nunique()
    return len(per_motion) == grid and len(set(per_motion)) == 1


def fit_mixed(rows: pd.DataFrame, formula: str) -> MixedFit:
    """Fit a mixed model by REML and check it.

    Parameters
    ----------
    rows
        Columns event, floor and those of ``formula``; one row per pair or per test.
    formula
        Fixed effects, one of `EFFECT`, `EFFECT_BY_FLOOR`, `AMPLITUDE`.

    Returns
    -------
    MixedFit

    Raises
    ------
    InputError
        If there are fewer than two events or three motions, an empty cell, or no scatter.
    FitDisagreementError
        If the fixed effects of balanced data disagree with those of least squares.
    """
    from statsmodels.regression.linear_model import OLS

    if rows["event"].nunique() < 2 or rows.groupby(["event", "floor"]).ngroups < 3:
        raise InputError(
            "Mixed model: it needs at least two events and three motions to tell their variances; "
            "add motions or read the means only."
        )
    model = OLS.from_formula(formula, rows)
    y, x = np.asarray(model.endog, dtype=float), np.asarray(model.exog, dtype=float)
    terms = list(model.exog_names)
    least_squares: Array = np.linalg.lstsq(x, y, rcond=None)[0]
    if np.linalg.matrix_rank(x) < x.shape[1] or len(y) <= x.shape[1]:
        raise InputError(f"Mixed model {formula}: a cell of the design is empty; fill it.")
    if np.ptp(y - x @ least_squares) < 1e-12 * max(1.0, float(np.ptp(y))):
        raise InputError(
            f"Mixed model {formula}: the data have no scatter to model; read the means."
        )
    direct = _Reml(y, x, rows).maximum()
    balanced = random_effects_balanced(rows)
    if balanced:
        se = np.sqrt(np.diag(direct.covariance))
        check_fixed_effects(terms, formula, direct.beta, least_squares, se)
    events = int(rows["event"].nunique())
    return MixedFit(
        formula=formula,
        coefficients=_coefficients(terms, direct, least_squares, events),
        sd_event=float(np.sqrt(direct.ratios[0] * direct.scale)),
        sd_motion=float(np.sqrt(direct.ratios[1] * direct.scale)),
        sd_residual=float(np.sqrt(direct.scale)),
        events=events,
        balanced=balanced,
    )


def check_fixed_effects(
    terms: list[str], formula: str, estimate: Array, expected: Array, se: Array
) -> None:
    """Refuse fixed effects of balanced data that are not the means of its cells.

    Raises
    ------
    FitDisagreementError
        Naming the term.
    """
    for term, one, known, limit in zip(terms, estimate, expected, 1e-4 * se, strict=True):
        if not abs(one - known) <= limit:
            raise FitDisagreementError(
                f"mixed model {formula}: fixed effect {term} came out as {one:.6g}, but the means of "
                f"the balanced data give {known:.6g}"
            )


def _coefficients(
    names: list[str], direct: _Direct, least_squares: Array, events: int
) -> pd.DataFrame:
    estimate = direct.beta
    se = np.sqrt(np.diag(direct.covariance))
    half = float(special.stdtrit(events - 1, 0.5 + CONFIDENCE / 2)) * se
    return pd.DataFrame(
        {
            "term": names,
            "estimate": estimate,
            "se": se,
            "lower": estimate - half,
            "upper": estimate + half,
            "p": 2 * t_beyond(np.abs(estimate) / se, events - 1),
            "least_squares": least_squares,
        }
    )


def long_rows(pairs: pd.DataFrame) -> pd.DataFrame:
    """Turn pairs into the rows of `AMPLITUDE`: two tests a pair, with ln_a and ped (0 or 1).

    ``resolution`` of a test is half the width of its step [-], half that of its pair.
    """
    sides = [
        pairs[["object", "event", "floor", "motion", "s_c"]].assign(
            ped=value, ln_a=np.log(pairs[column]), resolution=pairs["resolution"] / 2
        )
        for value, column in ((0, "a_np_g"), (1, "a_p_g"))
    ]
    return pd.concat(sides, ignore_index=True)
