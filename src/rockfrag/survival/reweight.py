"""Posterior weights of hazard branches, given that objects still stand.

The probability that all objects stand if branch i is true is

    S_i = E[exp(-∫ λ_i(t) dt)],    λ_i(t) = ∫ [1 - Π (1 - P_k(x))] |dν_i(x)|,

with the product over the objects k that stood at time t, and the expectation over their ages and the errors of
their fragilities. Rates of objects that feel different earthquakes add up. Weights afterwards are
w_i S_i / Σ w_j S_j (Bayes; Baker and others 2013, eq. 8).

In: a site with branches and objects. Out: weights and curves after. Theory: ``docs/survival.md``, "How it is
calculated".
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.survival.site import (
    Site,
    StandingObject,
    draw_errors,
    quantile_weights,
    shaking_rates,
)

SAMPLES = 1024  # Draws of ages and errors of fragilities
DECISION_RATE = 1e-4  # Annual rate at which sensitivities are compared [1/year]

RATES = (1e-2, 1e-3, 1e-4, 1e-5)  # Annual rates at which curves are compared [1/year]

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
        """Annual rates by ``level`` in the site's measure: ``mean_before``, ``fractile_0.84_after`` and so on."""
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
        before = np.log(curves["mean_before"].to_numpy())
        after = np.log(curves["mean_after"].to_numpy())
        wanted = np.log(RATES)
        levels = [
            np.exp(np.interp(-wanted, -rates, log_level, left=np.nan, right=np.nan))
            for rates in (before, after)
        ]
        # ln rate after at the levels before
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

    For each draw of the objects' ages and errors the earthquakes that would have toppled one of them are counted
    (λ of the module, integrated over time); the probability that none came is exp(-count), and S the mean of it.

    Parameters
    ----------
    site : branches and objects
    samples : number of draws, a power of two

    Returns
    -------
    The :class:`Reweighted`.
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
    indices = [body.index(shaking) for body in objects]
    # number of earthquakes that would have toppled one, by draw and branch
    expected = np.zeros((samples, len(shaking.rates)))
    for draw, (error, exposure) in enumerate(zip(errors, years, strict=True)):
        # shape (objects, points of shaking)
        topple = np.array(
            [
                body.probability(index, own)
                for body, index, own in zip(objects, indices, error, strict=True)
            ]
        )
        expected[draw] = _toppling_earthquakes(
            shaking.rates, topple, exposure, together=site.same_earthquakes
        )
    log_survival = special.logsumexp(-expected, axis=0) - np.log(samples)
    logs = np.log([branch.weight for branch in site.branches]) + log_survival
    weights = np.exp(logs - special.logsumexp(logs))
    return Reweighted(site, np.asarray(log_survival), weights)


def _toppling_earthquakes(
    rates: Floats, topple: Floats, years: Floats, *, together: bool
) -> Floats:
    """Expected number of earthquakes that topple an object while it stands, by branch.

    Parameters
    ----------
    rates : of the points of shaking in each branch [1/year], shape (branches, points)
    topple : probability that each topples each object, shape (objects, points)
    years : for how long each object has stood [years], shape (objects,)
    together : whether all feel the same earthquakes; else their numbers add up

    Returns
    -------
    Shape (branches,).
    """
    expected = np.zeros(len(rates))
    all_stand = np.ones(rates.shape[1])
    # from the object that has stood longest: each next one adds to what may topple since then
    order = np.argsort(-years, kind="stable")
    since_next = np.append(years[order[1:]], 0.0)
    for k, next_years in zip(order, since_next, strict=True):
        if together:
            all_stand = all_stand * (1.0 - topple[k])
            expected += (years[k] - next_years) * (rates @ (1.0 - all_stand))
        else:
            expected += years[k] * (rates @ topple[k])
    return expected


def scaled(
    objects: Sequence[StandingObject], capacity: float = 1.0, age: float = 1.0
) -> tuple[StandingObject, ...]:
    """Objects that withstand a factor more shaking, or have stood and been fragile a factor longer [-]."""
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


LEAST_SURVIVAL = 1e-9
"""Probability that all objects stand below which, in every branch, hazard, fragility or age must be wrong."""

RULED_OUT = 0.01  # Fraction of its weight below which a branch counts as ruled out

IN_SPACE = 0.84
"""Median of toppling of boxes under two horizontal components over that of planar rocking under one [-]; see
``docs/space.md``.  Round bases: about a half."""


@dataclass(frozen=True)
class Constrained:
    """Hazard of a site after survival, and what it hangs on.

    Ratios of levels are of the mean hazard after over before at ``DECISION_RATE``.
    """

    site: Site  #: What is known of the site
    result: Reweighted  #: Weights and curves
    #: A row an object: ``object``, ``information_bit``, ``level_ratio_alone`` and ``level_ratio_without``
    by_object: pd.DataFrame
    #: A row an assumption: its name as ``assumption``, and ``level_ratio``
    sensitivity: pd.DataFrame

    @property
    def ruled_out(self) -> list[str]:
        """Branches whose weight fell below ``RULED_OUT`` of what it was."""
        kept = self.result.weights >= RULED_OUT * self.result.prior
        return [
            b.name
            for b, stays in zip(self.site.branches, kept, strict=True)
            if not stays
        ]


def constrain(site: Site) -> Constrained:
    """Reweight branches of a site by the survival of its objects; InputError if none lets all of them stand.

    Parameters
    ----------
    site : branches of its hazard and its objects

    Returns
    -------
    The :class:`Constrained`.
    """
    result = reweight(site)
    if float(result.log_survival.max()) < np.log(LEAST_SURVIVAL):
        alone = {}
        for body in site.objects:
            alone[body.name] = reweight(
                replace(site, objects=(body,))
            ).log_survival.max()
        worst = min(alone, key=alone.__getitem__)
        raise InputError(
            "objects: in no branch of the hazard do all of them stand with a probability above "
            f"{LEAST_SURVIVAL:g}; {worst} is most at odds with the branches: check its fragility, "
            "its age and the units of the hazard."
        )
    return Constrained(site, result, _by_object(site), _sensitivity(site))


def _by_object(site: Site) -> pd.DataFrame:
    """What each object says alone, and what the others say without it, those that say most first."""
    rows = []
    for body in site.objects:
        alone = reweight(replace(site, objects=(body,)))
        others = tuple(other for other in site.objects if other is not body)
        without = reweight(replace(site, objects=others)).level_ratio if others else 1.0
        rows.append((body.name, alone.information, alone.level_ratio, without))
    columns = ["object", "information_bit", "level_ratio_alone", "level_ratio_without"]
    table = pd.DataFrame(rows, columns=columns)
    return table.sort_values("information_bit", ascending=False, ignore_index=True)


def _sensitivity(site: Site) -> pd.DataFrame:
    """Ratio of levels where one assumption at a time is another."""
    objects = site.objects
    cases = {
        "as_stated": scaled(objects),
        "half_as_old": scaled(objects, age=0.5),
        "twice_as_old": scaled(objects, age=2.0),
        "stronger": scaled(objects, capacity=1.25),
        "weaker": scaled(objects, capacity=0.75),
        # boxes under two components instead of one plane
        "in_space": scaled(objects, capacity=IN_SPACE),
    }
    sites = {name: replace(site, objects=moved) for name, moved in cases.items()}
    if len(objects) > 1:
        sites["independent_errors"] = replace(site, shared_error=0.0)
        sites["shared_errors"] = replace(site, shared_error=1.0)
    rows = [(name, reweight(other).level_ratio) for name, other in sites.items()]
    return pd.DataFrame(rows, columns=["assumption", "level_ratio"])
