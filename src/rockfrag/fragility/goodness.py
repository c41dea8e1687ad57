"""Does the fitted curve describe the verdicts? Deviance, parametric bootstrap, calibration."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.errors import InputError
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.empirical import bin_codes, wilson_interval
from rockfrag.fragility.lognormal import FragilityFit
from rockfrag.fragility.observations import Floats, Outcomes


@dataclass(frozen=True)
class GoodnessOfFit:
    """How well a curve describes the verdicts it was fitted to.

    Attributes
    ----------
    deviance
        Binomial deviance of bins of the measure against the curve.
    p_value
        Share of data sets simulated from the curve (and refitted) whose deviance is at least as
        large.
    dependence
        What was simulated, see :func:`goodness_of_fit`.
    replicates
        Number of simulated data sets.
    brier
        Mean squared difference of verdict and fitted probability.
    calibration
        One row per bin: ``im``, ``tests``, ``predicted`` (mean fitted probability), ``observed``,
        ``observed_lower``, ``observed_upper`` (90 % binomial limits).
    words
        The finding in one sentence.
    """

    deviance: float
    p_value: float
    dependence: str
    replicates: int
    brier: float
    calibration: pd.DataFrame
    words: str


def goodness_of_fit(
    outcomes: Outcomes,
    fit: FragilityFit,
    *,
    dependence: Literal["tests", "motions"] | None = None,
    bins: int = 10,
    replicates: int = 500,
    seed: int = 0,
) -> GoodnessOfFit:
    """Compare the deviance with that of data simulated from the curve (parametric bootstrap).

    Parameters
    ----------
    outcomes, fit
        The verdicts and the curve fitted to them.
    dependence
        ``tests`` simulates each verdict by itself; ``motions`` gives each motion one capacity from
        the curve, so that its verdicts hang together as in an amplitude sweep. None takes
        ``motions`` where motions have more than one row.
    bins
        Most bins of the measure.

    Raises
    ------
    InputError
        If there is no curve.
    """
    if not np.isfinite(fit.theta):
        raise InputError(f"goodness of fit: there is no curve to judge ({fit.method}).")
    if dependence is None:
        dependence = "motions" if outcomes.n_motions < outcomes.im.size else "tests"
    code = np.unique(bin_codes(outcomes, bins), return_inverse=True)[1]
    member = (code[:, None] == np.arange(code.max() + 1)).astype(np.float64)
    probability = fit.probability(outcomes.im)
    trials = outcomes.trials @ member
    expected = (outcomes.trials * probability) @ member
    observed = outcomes.overturned @ member
    deviance = float(_deviance(observed, expected, trials))
    rng = np.random.default_rng(seed)
    if dependence == "tests":
        drawn = rng.binomial(
            outcomes.trials.astype(np.int64), probability, size=(replicates, probability.size)
        ).astype(np.float64)
    else:
        drawn = _swept(outcomes, fit, replicates, rng)
    simulated = _refitted_deviance(outcomes, fit, drawn, member)
    p_value = float((1 + np.sum(simulated >= deviance - 1e-9)) / (1 + simulated.size))
    lower, upper = wilson_interval(observed, trials)
    calibration = pd.DataFrame(
        {
            "im": np.exp((outcomes.trials * outcomes.log_im) @ member / trials),
            "tests": trials.astype(np.int64),
            "predicted": expected / trials,
            "observed": observed / trials,
            "observed_lower": lower,
            "observed_upper": upper,
        }
    ).sort_values("im", ignore_index=True)
    miss = outcomes.overturned * (1 - probability) ** 2
    miss += (outcomes.trials - outcomes.overturned) * probability**2
    return GoodnessOfFit(
        deviance,
        p_value,
        dependence,
        int(simulated.size),
        float(miss.sum() / outcomes.n),
        calibration,
        _words(deviance, p_value, len(calibration), dependence),
    )


def _deviance(observed: Floats, expected: Floats, trials: Floats) -> Floats:
    survived = trials - observed
    # a bin that the curve calls impossible may not lie there by rounding alone
    expected = np.clip(expected, 1e-12 * trials, (1 - 1e-12) * trials)
    terms = special.xlogy(observed, observed / expected)
    terms = terms + special.xlogy(survived, survived / (trials - expected))
    return np.asarray(2.0 * terms.sum(axis=-1))


def _swept(
    outcomes: Outcomes, fit: FragilityFit, replicates: int, rng: np.random.Generator
) -> Floats:
    codes, names = pd.factorize(pd.Series(outcomes.motion))
    size = (replicates, len(names))
    draw = rng.normal(size=size) if fit.link == "probit" else rng.logistic(size=size)
    capacity = np.log(fit.theta) + fit.beta * draw
    return np.asarray((outcomes.log_im > capacity[:, codes]) * outcomes.trials)


def _refitted_deviance(
    outcomes: Outcomes, fit: FragilityFit, drawn: Floats, member: Floats
) -> Floats:
    design = np.column_stack([np.ones(outcomes.im.size), outcomes.log_im])
    trials = np.broadcast_to(outcomes.trials, drawn.shape)
    # the penalty keeps separated data sets finite and hardly moves the others
    batch = fit_batch(design, drawn, trials, link=fit.link, penalised=True, tolerance=1e-6)
    usable = np.isfinite(batch.coefficients).all(axis=1)
    eta = batch.coefficients[usable] @ design.T
    probability = special.ndtr(eta) if fit.link == "probit" else special.expit(eta)
    expected = (outcomes.trials * probability) @ member
    return _deviance(drawn[usable] @ member, expected, outcomes.trials @ member)


def _words(deviance: float, p_value: float, bins: int, dependence: str) -> str:
    verdict = (
        "the curve does not describe the verdicts; look at the empirical shares"
        if p_value < 0.05
        else "nothing speaks against the curve"
    )
    return (
        f"Deviance {deviance:.1f} in {bins} bins, p = {p_value:.3f} (parametric bootstrap of "
        f"{dependence}): {verdict}."
    )
