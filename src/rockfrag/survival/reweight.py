"""Posterior weights of hazard branches, given that objects still stand.

The probability that all objects stand if branch i is true is

    S_i = E[exp(-∫ λ_i(t) dt)],    λ_i(t) = ∫ [1 - Π (1 - P_k(x))] |dν_i(x)|,

with the product over the objects k that stood at time t, and the expectation over their ages and the errors of
their fragilities. Rates of objects that feel different earthquakes add up. Weights afterwards are
w_i S_i / Σ w_j S_j (Bayes; Baker and others 2013, eq. 8; docs/survival.md).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.arrays import Floats
from rockfrag.survival.evidence import (
    ShakingRates,
    StandingObject,
    draw_errors,
    quantile_weights,
    shaking_rates,
)
from rockfrag.survival.site import Site

SAMPLES = 1024  # Draws of ages and errors of fragilities
DECISION_RATE = 1e-4  # Annual rate at which sensitivities are compared [1/year]

RATES = (1e-2, 1e-3, 1e-4, 1e-5)
"""Annual rates at which curves before and after are compared [1/year]."""

QUANTILES = (0.05, 0.16, 0.5, 0.84, 0.95)  # Fractiles of the hazard over the branches


@dataclass(frozen=True)
class Reweighted:
    """Weights of branches before and after."""

    site: Site  #: The site, with its branches
    #: ln S_i, the logarithm of the probability that all objects stand, shape (branches,)
    log_survival: Floats
    weights: Floats  #: Weights afterwards, shape (branches,), of sum 1

    @property
    def prior(self) -> Floats:
        """Weights before, shape (branches,)."""
        return np.array([branch.weight for branch in self.site.branches])

    @property
    def information(self) -> float:
        """How much the weights moved: Kullback and Leibler's divergence of after from before [bit]."""
        return float(special.rel_entr(self.weights, self.prior).sum() / np.log(2.0))

    def table(self) -> pd.DataFrame:
        """A row a branch: ``branch``, ``weight_before``, ``survival``, ``weight_after``, ``ratio``."""
        return pd.DataFrame(
            {
                "branch": [branch.name for branch in self.site.branches],
                "weight_before": self.prior,
                "survival": np.exp(self.log_survival),
                "weight_after": self.weights,
                "ratio": self.weights / self.prior,
            }
        )

    def curves(self) -> pd.DataFrame:
        """Mean and fractile curves before and after in the site's measure: annual rates by ``level``.

        Columns such as ``mean_before`` and ``fractile_0.84_after``.
        """
        stated = [branch.curves[self.site.measure] for branch in self.site.branches]
        levels = np.unique(np.concatenate([curve.levels for curve in stated]))
        rates = np.array([curve.rate(levels) for curve in stated])
        columns = {"level": levels}
        for when, weights in (("before", self.prior), ("after", self.weights)):
            columns[f"mean_{when}"] = weights @ rates
            fractiles = quantile_weights(rates, weights, np.array(QUANTILES))
            for q, values in zip(QUANTILES, fractiles, strict=True):
                columns[f"fractile_{q:g}_{when}"] = values
        return pd.DataFrame(columns)

    def ratios(self) -> pd.DataFrame:
        """Mean hazard before and after at annual rates of 1e-2 to 1e-5; levels beyond the curves are NaN.

        ``rate_ratio`` is by how much the rate at the level before has changed.
        """
        curves = self.curves()
        log_level = np.log(curves["level"].to_numpy())
        before, after = (np.log(curves[f"mean_{when}"].to_numpy()) for when in ("before", "after"))
        wanted = np.log(RATES)
        levels = [
            np.exp(np.interp(-wanted, -rates, log_level, left=np.nan, right=np.nan))
            for rates in (before, after)
        ]
        at = np.interp(np.log(levels[0]), log_level, after)
        return pd.DataFrame(
            {
                "annual_rate": RATES,
                "level_before": levels[0],
                "level_after": levels[1],
                "level_ratio": levels[1] / levels[0],
                "rate_ratio": np.exp(at - wanted),
            }
        )

    @property
    def level_ratio(self) -> float:
        """Level of the mean hazard at ``DECISION_RATE`` after over before [-]."""
        return float(self.ratios()["level_ratio"][RATES.index(DECISION_RATE)])


def reweight(site: Site, samples: int = SAMPLES) -> Reweighted:
    """Weigh branches of the hazard by how probably they let all objects stand.

    ``samples`` of errors and ages are a power of two.
    """
    objects = site.objects
    wanted = set().union(*(body.measures for body in objects))
    reach = (min(b.reach[0] for b in objects), max(b.reach[1] for b in objects))
    normal, uniform = draw_errors(len(objects), site.shared_error, samples)
    errors = normal * [body.sd_ln for body in objects]
    years = np.column_stack(
        [body.age.exposure(u) for body, u in zip(objects, uniform.T, strict=True)]
    )
    curves = [branch.curves for branch in site.branches]
    shaking = shaking_rates(curves, wanted, site.velocity, reach)
    expected = _expected_topplings(objects, shaking, errors, years, site.same_earthquakes)
    log_survival = special.logsumexp(-expected, axis=0) - np.log(samples)
    logs = np.log([branch.weight for branch in site.branches]) + log_survival
    weights = np.exp(logs - special.logsumexp(logs))
    return Reweighted(site, np.asarray(log_survival), weights)


def _expected_topplings(
    objects: Sequence[StandingObject],
    shaking: ShakingRates,
    errors: Floats,
    years: Floats,
    same_earthquakes: bool,
) -> Floats:
    """Expected number of earthquakes that topple an object that stands, (samples, branches)."""
    indices = [body.index(shaking) for body in objects]
    expected = np.zeros((len(errors), len(shaking.rates)))
    for at, (error, exposure) in enumerate(zip(errors, years, strict=True)):
        stands = np.ones(shaking.rates.shape[1])
        # from the object that has stood longest: each next one adds to what may topple since then
        order = np.argsort(-exposure, kind="stable")
        until = np.append(exposure[order[1:]], 0.0)
        for k, next_exposure in zip(order, until, strict=True):
            topples = objects[k].probability(indices[k], error[k])
            if same_earthquakes:
                stands = stands * (1.0 - topples)
                expected[at] += (exposure[k] - next_exposure) * (shaking.rates @ (1.0 - stands))
            else:
                expected[at] += exposure[k] * (shaking.rates @ topples)
    return expected


def scaled(
    objects: Sequence[StandingObject], capacity: float = 1.0, age: float = 1.0
) -> tuple[StandingObject, ...]:
    """Objects that withstand a factor more shaking, or have stood and been fragile a factor longer."""
    found = []
    for body in objects:
        c = body.coefficients
        moved = (c[0] - c[1] * float(np.log(capacity)), *c[1:])
        ages = replace(
            body.age,
            low=body.age.low * age,
            high=body.age.high * age,
            fragile_for=body.age.fragile_for * age,
        )
        found.append(replace(body, coefficients=moved, age=ages))
    return tuple(found)
