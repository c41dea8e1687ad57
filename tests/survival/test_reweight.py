"""Survival reweights hazard branches: closed forms, limits, and histories that are drawn."""

import math

import numpy as np
import pytest
from scipy import special

from rockfrag.assess.hazard.curve import PGA, HazardCurve
from rockfrag.survival.reweight import SAMPLES, Reweighted, reweight, scaled
from rockfrag.survival.site import (
    Age,
    Branch,
    Site,
    StandingObject,
    VelocityRatio,
    lognormal_coefficients,
)

SLOPE = 2.5


def power_law(k0: float, slope: float = SLOPE) -> HazardCurve:
    """H(x) = k0 x^-slope."""
    levels = np.geomspace(0.01, 5.0, 25)
    return HazardCurve(PGA, levels, k0 * levels**-slope, "made")


def made_branches(*factors: float, weights: list[float] | None = None) -> list[Branch]:
    fractions = weights or [1 / len(factors)] * len(factors)
    return [
        Branch(f"factor {f:g}", w, {PGA: power_law(1e-4 * f)})
        for f, w in zip(factors, fractions, strict=True)
    ]


def rock(years: float, theta: float = 0.4, beta: float = 0.3, sd: float = 0.0, name: str = "rock"):
    age = Age(years, years)
    return StandingObject(name, PGA, lognormal_coefficients(theta, beta), sd, age)


def weighed(branches, objects, samples=SAMPLES, **more) -> Reweighted:
    return reweight(Site("here", tuple(branches), tuple(objects), **more), samples)


def test_no_time_leaves_the_weights_as_do_equal_branches_and_long_time_leaves_the_gentlest():
    found = weighed(made_branches(1.0, 1.0, 1.0), [rock(3000, sd=0.3)])
    assert found.weights == pytest.approx([1 / 3] * 3)
    assert found.information == pytest.approx(0.0, abs=1e-12)
    branches = made_branches(0.5, 1.0, 2.0, weights=[0.2, 0.5, 0.3])
    assert weighed(branches, [rock(1e-9)]).weights == pytest.approx([0.2, 0.5, 0.3])
    assert weighed(branches, [rock(1e6)]).weights == pytest.approx([1.0, 0.0, 0.0], abs=1e-12)


def test_independent_objects_multiply_and_identical_ones_with_shared_error_do_not():
    branches = made_branches(0.5, 1.0, 2.0)
    first, other = rock(2000, sd=0.4, name="one"), rock(2000, sd=0.4, name="other")
    alone = weighed(branches, [first]).log_survival
    apart = weighed(branches, [first, other], shared_error=0.0, same_earthquakes=False)
    assert apart.log_survival == pytest.approx(2 * alone, rel=5e-3)
    together = weighed(branches, [first, other], shared_error=1.0, same_earthquakes=False)
    assert (together.log_survival > 2 * alone + 0.02).all()


def test_an_object_that_came_later_is_exposed_to_fewer_earthquakes():
    branches = made_branches(1.0, 2.0)
    old, young = rock(2000, theta=0.4, name="old"), rock(500, theta=0.3, name="young")
    found = weighed(branches, [old, young])
    for k0, value in zip((1e-4, 2e-4), found.log_survival, strict=True):
        x = np.geomspace(1e-3, 50, 20_001)
        fall = -np.diff(k0 * x**-SLOPE)
        middle = np.sqrt(x[1:] * x[:-1])
        p_old, p_young = (special.ndtr(np.log(middle / theta) / 0.3) for theta in (0.4, 0.3))
        both = 1 - (1 - p_old) * (1 - p_young)
        assert value == pytest.approx(-(1500 * (p_old @ fall) + 500 * (both @ fall)), rel=2e-3)


def test_velocity_that_scatters_widens_a_fragility_in_two_measures_as_normal_theory_says():
    """Φ(c0 + c1 ln a + c2 (m + s Z)) averaged over Z is Φ((c0 + c1 ln a + c2 m) / √(1 + c2² s²))."""
    body = StandingObject("rock", PGA, (10.0, 4.0, 3.0), 0.0, Age(1000, 1000))
    m, s = math.log(0.08), 0.5
    root = math.sqrt(1 + (3.0 * s) ** 2)
    one = ((10.0 + 3.0 * m) / root, 4.0 / root)
    merged = StandingObject("merged", PGA, one, 0.0, Age(1000, 1000))
    branches = made_branches(0.1, 0.3)
    found = weighed(branches, [body], velocity=VelocityRatio(0.08, s))
    assert found.log_survival == pytest.approx(weighed(branches, [merged]).log_survival, rel=2e-3)


def test_drawn_histories_of_sites_recover_the_weights():
    """Draw a branch, then a history of T years, and keep the histories in which the object stands."""
    rng = np.random.default_rng(12)
    factors, weights, years = np.array([0.3, 1.0, 3.0]), [0.3, 0.4, 0.3], 2000.0
    found = weighed(made_branches(*factors, weights=weights), [rock(years, sd=0.3)], samples=8192)
    n = 20_000
    branch = rng.choice(3, n, p=weights)
    theta = 0.4 * np.exp(rng.normal(0, 0.3, n))
    # earthquakes above 0.08 g in T years; hardly one below topples it
    lowest = 0.08
    counts = rng.poisson(years * 1e-4 * factors[branch] * lowest**-SLOPE)
    history = np.repeat(np.arange(n), counts)
    level = lowest * rng.random(history.size) ** (-1 / SLOPE)
    topples = rng.random(history.size) < special.ndtr(np.log(level / theta[history]) / 0.3)
    stands = np.bincount(history[topples], minlength=n) == 0
    kept = np.bincount(branch[stands], minlength=3) / stands.sum()
    error = np.sqrt(kept * (1 - kept) / stands.sum())
    assert (np.abs(found.weights - kept) < 4 * error + 0.002).all()


def test_curves_before_are_the_weighted_mean_and_ratios_follow_from_the_curves():
    branches = made_branches(0.5, 1.0, 2.0, weights=[0.25, 0.5, 0.25])
    found = weighed(branches, [rock(3000)])
    curves = found.curves()
    mean = sum(b.weight * b.curves[PGA].rate(curves["level"].to_numpy()) for b in branches)
    assert curves["mean_before"].to_numpy() == pytest.approx(mean)
    fractiles = curves.filter(regex="fractile.*before").to_numpy()
    assert (np.diff(fractiles, axis=1) >= 0).all()
    row = found.ratios().set_index("annual_rate").loc[1e-3]
    assert row["rate_ratio"] == pytest.approx(row["level_ratio"] ** SLOPE, rel=1e-3)
    assert row["level_after"] < row["level_before"]


def test_more_capacity_or_less_age_tells_less():
    branches, body = made_branches(0.5, 1.0, 2.0), rock(3000)
    base = weighed(branches, [body]).information
    assert weighed(branches, scaled([body], capacity=1.5)).information < base
    assert weighed(branches, scaled([body], age=0.5)).information < base


def test_ages_are_certain_uniform_or_lognormal_and_end_with_fragility():
    uniform = np.array([0.0, 0.5, 1.0])
    assert Age(3000, 3000).exposure(uniform) == pytest.approx([3000] * 3)
    assert Age(1000, 3000).exposure(uniform) == pytest.approx([1000, 2000, 3000])
    assert Age(9000, 9000, 0.3).exposure(np.array([0.5])) == pytest.approx([9000])
    assert Age(9000, 9000, 0.3, 4000).exposure(np.array([0.5])) == pytest.approx([4000])
