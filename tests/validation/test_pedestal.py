"""How often statements about the pedestal hold the truth, call nothing something, or find what was put in.

Data sets are of the thesis's crossed design: 36 pairs, 3 objects under 12 motions, 3 floors of each of 4
earthquakes; d = earthquake + motion + pair. These tests write the tables in ``docs/validation-pedestal.md``.
"""

import math
import warnings

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.effects.cluster_means import (
    equivalence,
    holm,
    mean_effect,
    t_estimate,
    tied_resolution,
)
from rockfrag.effects.paired_tests import pair_tests
from rockfrag_thesis.hypotheses.contrasts import contrast, power_of_t, slope_effect

from ..case_tables import case_tables
from ..effects.conftest import SLENDERNESS, synthetic_tests
from .made import document, drawn, pairs_of

SEED = 20261121
SHAPE = (4, 3, 3)
COVERED, WITHOUT_EFFECT = case_tables(__file__).values()
DESIGNS = COVERED | WITHOUT_EFFECT

TIES = [name for name in COVERED if name.startswith("nearly")]
BEYOND = [name for name in DESIGNS if "tails" in name or "skewed" in name]
# scatter that differs between earthquakes makes t cautious, ties make it so by the width of a step
CAUTIOUS = [*TIES, "heteroscedastic: one earthquake scatters three times as much"]
CAUTIOUS += ["series of 5 %, scatter of one step"]


def simulated(name: str, data_sets: int):
    """Values of d, shape (data sets, earthquakes, floors, objects), their true mean, and one pair's resolution."""
    rng = np.random.default_rng([SEED, list(DESIGNS).index(name)])
    design, shape = DESIGNS[name], (data_sets, *SHAPE)
    earthquake, motion, pair = (
        np.asarray(sd) for sd in design.get("sd", (0.0, 0.0, 0.0))
    )
    law = design.get("law", "normal")
    d = earthquake.reshape(-1, 1, 1) * drawn(rng, law, (data_sets, 4, 1, 1))
    d = (
        d
        + motion * rng.normal(size=(data_sets, 4, 3, 1))
        + pair * rng.normal(size=shape)
    )
    rate, jump, shift = (design.get(key, 0.0) for key in ("rate", "jump", "shift"))
    d = d + jump * (rng.random(shape) < rate) + shift
    step = math.log1p(design.get("step", 0.0))
    if step:
        without = rng.uniform(0.0, 1.0, shape)
        d = step * (np.floor((without + d) / step) - np.floor(without / step))
    if "missing" in design:
        flat = d.reshape(data_sets, -1)
        order = rng.permuted(np.tile(np.arange(flat.shape[1]), (data_sets, 1)), axis=1)
        np.put_along_axis(flat, order[:, : design["missing"]], np.nan, axis=1)
    return d, rate * jump + shift, step


def estimate(d: np.ndarray, step: float, confidence: float):
    """The package's estimate for balanced pairs, without the tables around it."""
    hidden = tied_resolution(d.ravel(), np.full(d.size, step)).mean()
    return t_estimate(d.mean(axis=(1, 2)), confidence, float(hidden))


def fractions(name: str) -> dict[str, object]:
    """Coverage of the 90 % interval, false alarms at 5 % of a true effect of none, and widths."""
    d, truth, step = simulated(name, 4_000)
    # centred on no effect, jumps either way
    sign = (
        np.sign(np.random.default_rng(SEED).random(d.shape) - 0.5)
        if name in TIES
        else 1.0
    )
    found = [estimate(item, step, 0.90) for item in d]
    held = [item.lower <= truth <= item.upper for item in found]
    bare = [t_estimate(item.mean(axis=(1, 2)), 0.90) for item in d]
    # an interval without width is one value
    limits = [
        (e.mean, e.mean) if math.isnan(e.lower) else (e.lower, e.upper) for e in bare
    ]
    naive = [low - 1e-12 <= truth <= high + 1e-12 for low, high in limits]
    return {
        "design": name,
        "coverage of 90 %": float(np.mean(held)),
        "of t without the steps": float(np.mean(naive)),
        "false alarms at 5 %": float(
            np.mean([estimate(e, step, 0.95).p < 0.05 for e in sign * d])
        ),
        "median width of ln P/NP": float(
            np.median([item.upper - item.lower for item in found])
        ),
    }


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    found = pd.DataFrame([fractions(name) for name in COVERED])
    document("validation-pedestal.md", "coverage", found)
    return found.set_index("design")


@pytest.mark.slow
@pytest.mark.parametrize("name", COVERED)
def test_interval_covers_87_to_93_percent_and_level_is_3_to_7_percent(table, name):
    """Never less where it is cautious; tails and skew cost little."""
    usual, warned = name not in (*CAUTIOUS, *BEYOND), name in BEYOND
    covered, level = table.loc[name, ["coverage of 90 %", "false alarms at 5 %"]]
    assert (0.84 if warned else 0.87) <= covered <= (0.93 if usual else 1)
    assert (0.03 if usual else 0) <= level <= (0.09 if warned else 0.07)


@pytest.mark.slow
def test_interval_that_ignores_the_steps_fails_where_nearly_all_pairs_agree(table):
    assert table.loc[TIES, "of t without the steps"].min() < 0.4
    assert (table.loc[TIES, "median width of ln P/NP"] > 0.015).all()


def test_fast_estimates_are_those_of_the_package():
    for name in COVERED:
        (d,), _, step = simulated(name, 1)
        ours, theirs = (
            estimate(d, step, 0.95),
            mean_effect(pairs_of(d, resolution=step)),
        )
        assert (ours.lower, ours.upper, ours.p) == pytest.approx(
            (theirs.lower, theirs.upper, theirs.p), nan_ok=True
        )
    d, *_ = simulated("earthquakes and motions", 20)
    package = [mean_effect(pairs_of(item)).p for item in d]
    assert package == pytest.approx(p_of_t(d.mean(axis=(2, 3))), rel=1e-9)
    floors, means = (
        (contrast(pairs_of(item), "floor", "F0", "F1").p for item in d),
        d.mean(axis=3),
    )
    assert list(floors) == pytest.approx(
        p_of_t(means[:, :, 0] - means[:, :, 1]), rel=1e-9
    )


@pytest.mark.parametrize(("rate", "level"), [(0.10, "0.004"), (0.05, "0.0002")])
def test_no_exact_test_of_signs_comes_near_5_percent_where_nearly_all_pairs_agree(
    rate, level
):
    """The level that docs/validation-pedestal.md quotes: over the number of pairs that differ."""
    attained = 0.0
    for k in range(37):
        ups = np.arange(k + 1)
        p = 2 * np.minimum(
            stats.binom.cdf(ups, k, 0.5), stats.binom.sf(ups - 1, k, 0.5)
        )
        size = stats.binom.pmf(ups, k, 0.5)[p <= 0.05].sum()
        attained += stats.binom.pmf(k, 36, rate) * size
    assert f"{attained:.{len(level) - 2}f}" == level


DATA_SETS = 20_000
CHOSEN = "t, earthquake means"


def p_of_t(values: np.ndarray) -> np.ndarray:
    """p values of one-sample t tests along the last axis, NaN left out."""
    return stats.ttest_1samp(values, 0.0, axis=-1, nan_policy="omit").pvalue


def levels(design: str) -> dict[str, float]:
    """Fraction of false rejections at 5 % of each test."""
    d, *_ = simulated(design, DATA_SETS)
    with warnings.catch_warnings():
        # a motion may have lost all three of its pairs
        warnings.simplefilter("ignore", RuntimeWarning)
        motion = np.nanmean(d, axis=3)
    result = {
        "t, 36 pairs": d.reshape(len(d), -1),
        "t, 12 motion means": motion.reshape(len(d), -1),
        CHOSEN: np.nanmean(motion, axis=2),
    }
    return {
        name: float(np.mean(p_of_t(values) < 0.05)) for name, values in result.items()
    }


def further(design: str) -> dict[str, float]:
    """Tests that are too slow, or too rarely used, for all data sets."""
    d, *_ = simulated(design, 2_000)
    motion = d.mean(axis=3)
    floors = p_of_t(np.swapaxes(motion, 1, 2))
    ranks = [
        stats.wilcoxon(item.ravel(), method="exact").pvalue for item in motion[:1_000]
    ]
    options = {"method": "BCa", "n_resamples": 999, "rng": SEED}
    bounds = [
        stats.bootstrap((item.ravel(),), np.mean, **options).confidence_interval
        for item in motion[:500]
    ]
    shifted = motion.mean(axis=2) + math.log(1.1)
    same = [equivalence(t_estimate(item)) < 0.05 for item in shifted]
    difference = p_of_t(motion[:, :, 0] - motion[:, :, 1])
    return {
        "signed ranks, 12 motion means": float(np.mean(np.array(ranks) < 0.05)),
        "BCa over 12 motions leaves 0 out": float(
            np.mean([lo > 0 or hi < 0 for lo, hi in bounds])
        ),
        "difference of two floors, t over earthquakes": float(
            np.mean(difference < 0.05)
        ),
        "any of 3 floors, Holm": float(np.mean([holm(p).min() < 0.05 for p in floors])),
        "equivalence shown at a true change of 10 %": float(np.mean(same)),
    }


@pytest.fixture(scope="module")
def alarms() -> pd.DataFrame:
    """Fraction of false rejections of each test in every design."""
    found = pd.DataFrame({design: levels(design) for design in WITHOUT_EFFECT}).T
    document(
        "validation-pedestal.md", "false alarms", found.reset_index(names="design")
    )
    return found


@pytest.mark.slow
@pytest.mark.parametrize("design", WITHOUT_EFFECT)
def test_chosen_test_holds_its_level_and_stays_near_it_beyond_the_normal(
    alarms, design
):
    least, most = (0, 0.09) if design in BEYOND else (0.03, 0.07)
    assert least <= alarms.loc[design, CHOSEN] <= most
    # and the naive test does not
    assert alarms.loc["earthquakes and motions", "t, 36 pairs"] > 0.14


@pytest.mark.slow
def test_other_decisions_hold_their_level():
    names = ("pairs only", "motions", "earthquakes and motions")
    found = pd.DataFrame({name: further(name) for name in names})
    document("validation-pedestal.md", "decisions", found.reset_index(names="decision"))
    assert (found.iloc[2:] < 0.07).all(axis=None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("units", "sd", "ratio"), [(4, 0.05, 1.10), (4, 0.09, 1.18), (19, 0.05, 1.04)]
)
def test_power_is_that_of_the_test_that_is_made(units, sd, ratio):
    """t over the means of earthquakes, not over pairs: what is printed is what simulated data show."""
    rng = np.random.default_rng(SEED)
    p = p_of_t(math.log(ratio) + sd * rng.normal(size=(DATA_SETS, units)))
    assert power_of_t(ratio, sd, units) == pytest.approx(np.mean(p < 0.05), abs=0.01)


EFFECT, SLOPE, STEP, LIMIT = 0.10, 0.04, 1.2, 0.50
FLOORS = {"GF": 0.10, "F3": -0.05, "F5": -0.05}
RECOVERED = 200
COLUMNS = ("truth", "mean estimate", "standard error", "scatter of one", "data sets")


def with_slope(seed: int) -> pd.DataFrame:
    """72 tests with exact figures, whose effect varies with floor, slenderness, earthquake and motion."""
    tests = synthetic_tests(
        seed, effect=EFFECT, floor_effect=FLOORS, sd_earthquake=0.06
    )
    slope = SLOPE * (tests["object"].map(SLENDERNESS) - 4) * (tests["pedestal"] == "P")
    amplitude = tests["amplitude_g"] * np.exp(slope)
    return tests.assign(amplitude_g=amplitude, lower_g=amplitude, upper_g=amplitude)


def stepped(tests: pd.DataFrame) -> pd.DataFrame:
    """The same tests raised in steps of 20 % from 0.05 g; the figure is the end of the last step."""
    steps = np.floor(np.log(tests["amplitude_g"] / 0.05) / math.log(STEP))
    lower = 0.05 * STEP**steps
    return tests.assign(lower_g=lower, upper_g=lower * STEP, amplitude_g=lower * STEP)


def cut(tests: pd.DataFrame) -> pd.DataFrame:
    """The same tests on a shaker that ends at ``LIMIT``."""
    ended = tests.copy()
    ended.loc[
        tests["upper_g"] > LIMIT, ["censored", "lower_g", "upper_g", "amplitude_g"]
    ] = [*("right", LIMIT, np.nan, np.nan)]
    return ended


@pytest.mark.slow
def test_estimators_find_what_was_put_in_and_unfinished_tests_are_covered():
    floors = FLOORS["GF"] - FLOORS["F3"]
    # what is estimated, of which tests, how, and the truth
    estimators = {
        "mean of d": (with_slope, mean_effect, EFFECT),
        "GF minus F3": (
            with_slope,
            lambda pairs: contrast(pairs, "floor", "GF", "F3"),
            floors,
        ),
        "slope of d on H/B": (with_slope, slope_effect, SLOPE),
        "mean of d, steps of 20 %": (
            lambda seed: stepped(with_slope(seed)),
            mean_effect,
            EFFECT,
        ),
        "mean of d, limit 0.5 g, unfinished tests at their bound": (
            lambda seed: cut(with_slope(seed)),
            mean_effect,
            EFFECT,
        ),
    }
    rows = {}
    for name, (tests, how, truth) in estimators.items():
        found = [
            how(pair_tests(tests(seed), SLENDERNESS).table) for seed in range(RECOVERED)
        ]
        mean = np.array([item.mean for item in found])
        scatter = float(mean.std(ddof=1))
        about = [
            truth,
            float(mean.mean()),
            scatter / math.sqrt(RECOVERED),
            scatter,
            RECOVERED,
        ]
        rows[name] = dict(zip(COLUMNS, about, strict=True))
        held = float(np.mean([item.lower <= truth <= item.upper for item in found]))
    recovered = pd.DataFrame(rows).T
    table = recovered.astype({"data sets": int}).reset_index(names="estimator")
    document("validation-pedestal.md", "recovery", table)
    apart = (recovered["mean estimate"] - recovered["truth"]).abs()
    assert (apart < 3 * recovered["standard error"]).all()
    # of the last one
    interval = {
        "interval": ["t over earthquakes, limit 0.5 g"],
        "coverage of 95 %": [held],
    }
    document("validation-pedestal.md", "censored intervals", pd.DataFrame(interval))
    assert held >= 0.87
