"""Discrete-time hazard of a step protocol: the chance to overturn at a step, given survival so far.

Regression of every shake of every test with the complementary log-log link (Prentice and Gloeckler,
1978, Biometrics 34: 57-67). It uses each shake, not only the bracket of the last two, and shows
whether many small steps overturn a body earlier than a few large ones.
"""

import warnings as python_warnings
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from statsmodels.genmod import families
from statsmodels.genmod.generalized_linear_model import GLM
from statsmodels.tools.sm_exceptions import (
    ConvergenceWarning,
    PerfectSeparationError,
    PerfectSeparationWarning,
)
from statsmodels.tools.tools import add_constant

from rockfrag.errors import InputError
from rockfrag.fragility.observations import (
    Floats,
    labels,
    name_and_unit,
    positive,
    read_observations,
)


@dataclass(frozen=True)
class StepHazard:
    """Hazard of overturning that grows as a power of the amplitude.

    The hazard per unit of ln amplitude is exp(intercept) · IM^shape, so the overturning amplitude
    follows a Weibull distribution with this shape, whatever the steps.

    Attributes
    ----------
    theta
        Median overturning amplitude, in ``unit``.
    shape, intercept
        Parameters of the hazard; ``beta`` is the logarithmic standard deviation that they imply.
    se_log_theta, se_shape
        Standard errors by the delta method, robust to dependence within a motion.
    log_likelihood, aic
        Of the shakes.
    n, n_overturned, n_shakes, n_motions
        Tests, those that overturned, shakes of all tests, different motions.
    """

    theta: float
    shape: float
    intercept: float
    se_log_theta: float
    se_shape: float
    log_likelihood: float
    aic: float
    n: int
    n_overturned: int
    n_shakes: int
    n_motions: int
    im: str
    unit: str
    warnings: tuple[str, ...] = ()

    @property
    def beta(self) -> float:
        """Logarithmic standard deviation of the overturning amplitude, π/(√6 shape)."""
        return float(np.pi / (np.sqrt(6.0) * self.shape))

    def probability(self, im: ArrayLike) -> Floats:
        """Probability to have overturned when the steps have reached ``im``, same shape."""
        ratio = np.asarray(im, dtype=np.float64) / self.theta
        return np.asarray(1.0 - np.exp(-np.log(2.0) * ratio**self.shape))


def fit_step_hazard(
    shakes: pd.DataFrame,
    *,
    test: str = "test",
    amplitude: str = "amplitude_g",
    overturned: str = "overturned",
    motion: str = "motion",
    source: str = "table",
) -> StepHazard:
    """Fit the hazard to the shakes of step protocols, one row per shake.

    The width of a step in ln amplitude enters as an offset, so tests with steps of 1 % and of 20 %
    estimate the same curve. The first step of a test counts as wide as its second; tests of one
    shake as wide as the median of all steps. The hazard is taken at the geometric middle of each
    step.

    Parameters
    ----------
    shakes
        One row a shake.
    test
        Column with the name of the test.
    amplitude
        Column of the amplitude.
    overturned
        Column with the outcomes.
    motion
        Column with the name of the motion; None where tests have none.
    source
        What messages call the table.

    Returns
    -------
    The :class:`StepHazard`.

    Raises
    ------
    InputError
        If values are missing or out of range, amplitudes of a test do not rise, a test goes on
        after overturning, or no step protocol has two steps.
    """
    table = pd.DataFrame(
        {
            "test": labels(shakes, test, source),
            "motion": labels(shakes, motion, source),
            "log_im": np.log(positive(shakes, amplitude, source)),
            "overturned": read_observations(shakes, overturned, source),
        }
    )
    if table.empty:
        raise InputError(f"{source}: there is no row; give at least one shake.")
    table["width"] = table.groupby("test", sort=False)["log_im"].diff()
    before = table.groupby("test", sort=False)["overturned"].cumsum() - table["overturned"]
    bad = np.flatnonzero((table["width"] <= 0) | (before > 0))
    if bad.size:
        raise InputError(
            f"{source}, row {bad[0] + 1}: test {table['test'].iloc[bad[0]]!r} must rise from "
            "shake to shake and end with the first overturning; sort its rows or leave later ones "
            "out."
        )
    typical = table["width"].median()
    if not np.isfinite(typical):
        raise InputError(f"{source}: no test has two shakes; a step protocol needs steps.")
    second = table.groupby("test", sort=False)["width"].transform("first")
    table["width"] = table["width"].fillna(second).fillna(typical)
    return _fit(table, *name_and_unit(amplitude))


def _fit(table: pd.DataFrame, name: str, unit: str) -> StepHazard:
    tests, fell = table["test"].nunique(), int(table["overturned"].sum())
    if fell == 0 or fell == len(table):
        raise InputError(
            f"{fell} of {len(table)} shakes overturned: a hazard needs shakes that overturned and "
            "shakes that did not."
        )
    design = add_constant((table["log_im"] - 0.5 * table["width"]).to_numpy())
    codes, motions = pd.factorize(table["motion"])
    model = GLM(
        table["overturned"].to_numpy(),
        design,
        family=families.Binomial(families.links.CLogLog()),
        offset=np.log(table["width"].to_numpy()),
    )
    with python_warnings.catch_warnings():
        python_warnings.simplefilter("error", PerfectSeparationWarning)
        python_warnings.simplefilter("error", ConvergenceWarning)
        try:
            result = model.fit(tol=1e-12, maxiter=200)
            robust = (
                model.fit(tol=1e-12, maxiter=200, cov_type="cluster", cov_kwds={"groups": codes})
                if len(motions) > 1
                else result
            )
        except (PerfectSeparationError, PerfectSeparationWarning, ConvergenceWarning) as error:
            raise InputError(
                "one amplitude separates the shakes that overturned from those that did not, so "
                "the hazard has no finite estimate; fit the brackets of the tests instead."
            ) from error
    notes: tuple[str, ...] = ()
    if len(motions) == 1:
        notes = ("All tests share one motion: the hazard describes this motion only.",)
    elif len(motions) < 10:
        notes = (f"With {len(motions)} motions the robust standard errors are too small.",)
    intercept, shape = (float(value) for value in result.params)
    if shape <= 0:
        raise InputError(
            f"the hazard does not grow with {name} (shape {shape:.3g}); there is no curve."
        )
    log_theta = (np.log(shape * np.log(2.0)) - intercept) / shape
    gradient = np.array([-1.0 / shape, (1.0 / shape - log_theta) / shape])
    covariance = np.asarray(robust.cov_params())
    return StepHazard(
        float(np.exp(log_theta)),
        shape,
        intercept,
        float(np.sqrt(gradient @ covariance @ gradient)),
        float(np.sqrt(covariance[1, 1])),
        float(result.llf),
        float(result.aic),
        tests,
        fell,
        len(table),
        len(motions),
        name,
        unit,
        notes,
    )
