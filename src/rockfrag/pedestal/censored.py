"""Interval likelihood with a random effect of the pair: for steps and tests that never overturned.

ln a = x β + δ [P] + u + e, with u ~ N(0, τ²) shared by the two tests of a pair and e ~ N(0, σ²) per
test.  A test contributes the probability of its interval (lower, upper]; a censored one that of
everything above its lower bound; an exact figure its density.  Both sides are taken to scatter
alike.  Integrating u out leaves a bivariate normal per pair, which is integrated exactly along one
axis and by quadrature along the other.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import optimize
from scipy.special import ndtr

from rockfrag.errors import InputError
from rockfrag.pedestal.cluster_means import ROUNDING, Array, Estimate, t_beyond, t_estimate
from rockfrag.pedestal.paired_tests import KEY, check_tests, pedestals_apart

Rows = npt.NDArray[np.intp]

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)  # gauss-Legendre quadrature on (-1, 1)
MOST_REFITTED = 50
"""Earthquakes up to which the likelihood is fitted anew without each; of more, each one's pull is linear."""
MOST_PAIRS = 2_000  # more pairs than this are put together where they are alike
STEP = 1e-4  # step of parameters for derivatives [-]
FAR = 9.0  # standard deviations beyond which the normal density is nothing


@dataclass(frozen=True)
class CensoredFit:
    """Maximum of the interval likelihood."""

    effect: Estimate  # δ = ln(P/NP) with the interval of the jackknife over earthquakes [-]
    # sd_pair, sd_test: τ and σ [-]
    sd_pair: float
    sd_test: float
    loglik: float  # log-likelihood at the maximum
    # tests, censored: numbers of tests used and of those that never overturned
    tests: int
    censored: int


@dataclass(frozen=True)
class _Design:
    """Bounds and regressors: per test, and which two tests form a pair.

    Of many pairs those with the same bounds and regressors are one with their number as its weight.
    """

    lower: Array
    upper: Array
    x: Array
    first: Rows
    second: Rows
    weight: Array
    single: Rows
    pairs: Rows
    """First test of each pair."""
    place: Rows
    """Where each pair is among ``first``."""


def fit_censored(tests: pd.DataFrame) -> CensoredFit:
    """Estimate the pedestal's effect from exact, interval- and right-censored tests (`check_tests`).

    Fixed effects are the object, the floor, and the pedestal.  The interval of the effect comes from leaving out
    one earthquake at a time, since earthquakes were sampled, not tests.
    """
    clean = check_tests(pedestals_apart(tests)[0])
    for side, rows in clean.groupby("pedestal"):
        if (rows["censored"] == "right").all():
            raise InputError(
                f"Interval likelihood: no test with pedestal = {side} overturned, so only a bound "
                "of the effect exists; raise the shaker's limit or read the pairs' bounds."
            )
    if set(clean["pedestal"]) != {"P", "NP"}:
        raise InputError("Interval likelihood: tests with and without pedestal are needed.")
    if _sides_agree(clean):
        raise InputError(
            "Interval likelihood: the two tests of every pair gave the same figure, so there is no "
            "scatter to model; the ratio is 1."
        )
    best, design = _maximum(clean)
    many = clean["earthquake"].nunique() > MOST_REFITTED
    effect = _linear(clean, best.x, design) if many else _jackknife(clean, best.x)
    return CensoredFit(
        effect=effect,
        sd_pair=math.exp(best.x[-2]),
        sd_test=math.exp(best.x[-1]),
        loglik=-float(best.fun),
        tests=len(design.lower),
        censored=int((clean["censored"] == "right").sum()),
    )


def _sides_agree(clean: pd.DataFrame) -> bool:
    """Whether no pair has two different figures."""
    by_pair = clean[["lower_g", "upper_g"]].groupby([clean[name] for name in (*KEY, "repetition")])
    ratio = by_pair.max().to_numpy() / by_pair.min().to_numpy()
    return not bool(np.any(ratio > 1 + ROUNDING))


def _jackknife(clean: pd.DataFrame, start: Array) -> Estimate:
    """Pseudo-values over earthquakes; a subset on which a side is wholly censored is not usable."""
    delta = float(start[0])
    earthquakes = sorted(clean["earthquake"].unique())
    k = len(earthquakes)
    if k < 2:
        return Estimate(delta, math.nan, k, math.nan, math.nan, math.nan)
    values = []
    for earthquake in earthquakes:
        rest = clean[clean["earthquake"] != earthquake]
        exact = rest[rest["censored"] == "none"]
        if set(exact["pedestal"]) != {"P", "NP"}:
            return Estimate(delta, math.nan, k, math.nan, math.nan, math.nan)
        values.append(float(_maximum(rest, start)[0].x[0]))
    return _from_pseudo_values(delta, np.array(values))


def _linear(clean: pd.DataFrame, best: Array, design: _Design) -> Estimate:
    """Infinitesimal jackknife over earthquakes: what each pulls at the effect, from derivatives at the maximum."""
    codes, names = pd.factorize(clean["earthquake"], sort=True)
    k, size = len(names), len(best)

    def by_earthquake(parameters: Array) -> Array:
        pairs, single = _of_each(parameters, design)
        found = np.bincount(codes[design.pairs], pairs[design.place], minlength=k)
        return np.asarray(found + np.bincount(codes[design.single], single, minlength=k))

    steps = STEP * np.eye(size)
    score = np.column_stack([by_earthquake(best + h) - by_earthquake(best - h) for h in steps]) / (
        2 * STEP
    )
    hessian = np.empty((size, size))
    for i, step in enumerate(steps):
        for j, other in enumerate(steps[: i + 1]):
            corners = (
                _loglik(best + step + other, design)
                - _loglik(best + step - other, design)
                - _loglik(best - step + other, design)
                + _loglik(best - step - other, design)
            )
            hessian[i, j] = hessian[j, i] = corners / (4 * STEP**2)
    # an earthquake left out takes its fraction of the information with it
    without = best[0] + k / (k - 1) * (score @ np.linalg.pinv(hessian)[:, 0])
    return _from_pseudo_values(float(best[0]), without)


def _from_pseudo_values(delta: float, without: Array) -> Estimate:
    """Effect with the interval of the jackknife, from the effects without each earthquake."""
    k = len(without)
    spread = t_estimate(k * delta - (k - 1) * without)
    shift = delta - spread.mean
    p = spread.p
    if spread.se > 0:
        p = float(2 * t_beyond(abs(delta) / spread.se, k - 1))
    return Estimate(delta, spread.se, k, spread.lower + shift, spread.upper + shift, p)


def _design(clean: pd.DataFrame) -> _Design:
    fixed = pd.get_dummies(clean[["object", "floor"]], drop_first=True).to_numpy(dtype=float)
    pedestal = (clean["pedestal"] == "P").to_numpy(dtype=float)
    x = np.column_stack([pedestal, np.ones(len(clean)), fixed])
    with np.errstate(divide="ignore"):
        lower = np.log(clean["lower_g"].to_numpy(dtype=float))
    right = (clean["censored"] == "right").to_numpy()
    upper = np.where(right, np.inf, np.log(clean["upper_g"].fillna(1.0).to_numpy(dtype=float)))
    members = clean.reset_index(drop=True).groupby([*KEY, "repetition"]).indices
    rows = [np.sort(index) for index in members.values()]
    two = np.array([index for index in rows if len(index) == 2], dtype=int).reshape(-1, 2)
    alone = np.array([index[0] for index in rows if len(index) == 1], dtype=int)
    first, second = two[:, 0], two[:, 1]
    place, weight = np.arange(len(two)), np.ones(len(two))
    if len(two) > MOST_PAIRS:
        bounds = [side[rows] for rows in (first, second) for side in (lower, upper)]
        alike = np.column_stack([*bounds, x[first], x[second]])
        found = np.unique(alike, axis=0, return_index=True, return_inverse=True, return_counts=True)
        place, weight = found[2].ravel(), found[3].astype(float)
        first, second = first[found[1]], second[found[1]]
    return _Design(lower, upper, x, first, second, weight, alone, two[:, 0], place)


def _maximum(
    clean: pd.DataFrame, start: Array | None = None
) -> tuple[optimize.OptimizeResult, _Design]:
    design = _design(clean)
    if start is None or len(start) != design.x.shape[1] + 2:
        start = _start(design)
    bounds = [(None, None)] * design.x.shape[1] + [(math.log(1e-4), math.log(10.0))] * 2
    found = optimize.minimize(
        lambda parameters: -_loglik(parameters, design), start, method="L-BFGS-B", bounds=bounds
    )
    return found, design


def _start(design: _Design) -> Array:
    """Least squares on the figures; survived amplitudes count as they are."""
    finite = np.isfinite(design.upper)
    with np.errstate(invalid="ignore"):
        middle = np.where(finite, (design.lower + design.upper) / 2, design.lower)
    middle = np.where(np.isfinite(middle), middle, np.where(finite, design.upper, 0.0))
    beta = np.linalg.lstsq(design.x, middle, rcond=None)[0]
    scatter = math.log(max(float(np.std(middle - design.x @ beta)), 1e-3) / math.sqrt(2))
    return np.array([*beta, scatter, scatter])


def _loglik(parameters: Array, design: _Design) -> float:
    """Log-likelihood of (β, ln τ, ln σ)."""
    pairs, single = _of_each(parameters, design)
    return float(np.sum(single)) + float(np.sum(design.weight * pairs))


def _of_each(parameters: Array, design: _Design) -> tuple[Array, Array]:
    """Log-likelihood of each pair and of each single test."""
    tau, sigma = np.exp(parameters[-2:])
    sd = math.hypot(tau, sigma)
    rho = float(tau**2 / sd**2)
    mean = design.x @ parameters[:-2]
    low, high = (design.lower - mean) / sd, (design.upper - mean) / sd
    single = _log_single(low[design.single], high[design.single], sd)
    first, second = design.first, design.second
    # the axis integrated by quadrature is the one with the exact figure, if there is one
    swap = (low[second] == high[second]) & (low[first] != high[first])
    first, second = np.where(swap, second, first), np.where(swap, first, second)
    exact = low[first] == high[first]
    residual = math.sqrt(1 - rho**2)
    pairs = np.zeros(len(first))
    if exact.any():
        z, a, b = low[first][exact], low[second][exact], high[second][exact]
        conditional = _log_single((a - rho * z) / residual, (b - rho * z) / residual, residual * sd)
        pairs[exact] = _log_density(z) - math.log(sd) + conditional
    if (~exact).any():
        a, b = low[first][~exact], high[first][~exact]
        c, d = low[second][~exact], high[second][~exact]
        pairs[~exact] = np.log(_rectangle(a, b, c, d, rho, residual))
    return pairs, single


def _log_density(z: Array) -> Array:
    """Log of the standard normal density."""
    return np.asarray(-0.5 * z**2 - 0.5 * math.log(2 * math.pi), dtype=np.float64)


def _log_single(low: Array, high: Array, sd: float) -> Array:
    """Log of the normal density (exact figures) or of the probability of an interval."""
    exact = low == high
    probability = np.where(low > 0, ndtr(-low) - ndtr(-high), ndtr(high) - ndtr(low))
    interval = np.log(np.maximum(probability, 1e-300))
    density = _log_density(low) - math.log(sd)
    return np.asarray(np.where(exact, density, interval), dtype=np.float64)


def _rectangle(a: Array, b: Array, c: Array, d: Array, rho: float, residual: float) -> Array:
    """Probability of (a, b] x (c, d] under the standard bivariate normal, by Gauss-Legendre."""
    # where the conditional probability of the other axis is nothing the integrand is, too
    left = np.clip(a, -FAR, FAR)
    right = np.clip(b, -FAR, FAR)
    if rho > 0:
        left = np.maximum(left, (np.maximum(c, -FAR) - FAR * residual) / rho)
        right = np.minimum(right, (np.minimum(d, FAR) + FAR * residual) / rho)
    half = np.maximum(right - left, 0.0) / 2
    z = left[:, None] + half[:, None] * (NODES + 1)
    inner = ndtr((d[:, None] - rho * z) / residual) - ndtr((c[:, None] - rho * z) / residual)
    value = half * np.sum(WEIGHTS * np.exp(_log_density(z)) * inner, axis=1)
    return np.asarray(np.maximum(value, 1e-300), dtype=np.float64)
