"""How often the interval of the pedestal's effect holds the truth, and how often nothing is called something.

36 pairs of 4 earthquakes, 3 floors, 3 objects, amplitudes exact or on a series of steps. The table in
``docs/validation-pedestal.md`` is written by these tests.
"""

import math

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.pedestal.cluster_means import mean_effect, t_estimate, tied_resolution

from .made import document, drawn, pairs_of

SEED, DATA_SETS = 20261121, 4_000
SHAPE = (4, 3, 3)

# standard deviations of earthquake, motion and pair, law, step of the series of levels, rate and size of jumps
DESIGNS = {
    "lognormal, pairs only": dict(sd=(0.0, 0.0, 0.134)),
    "lognormal, motions and earthquakes": dict(sd=(0.10, 0.10, 0.134)),
    "heteroscedastic: objects 0.05, 0.13, 0.30": dict(sd=(0.05, 0.05, (0.05, 0.13, 0.30))),
    "heteroscedastic: one earthquake scatters three times as much": dict(
        sd=((0.1, 0.1, 0.1, 0.3), 0.05, 0.1)
    ),
    "earthquakes dominate": dict(sd=(0.30, 0.05, 0.10)),
    "series of 5 %": dict(sd=(0.05, 0.05, 0.134), step=0.05),
    "series of 1 %": dict(sd=(0.05, 0.05, 0.134), step=0.01),
    "series of 5 %, scatter of one step": dict(sd=(0.02, 0.02, 0.05), step=0.05),
    "heavy tails (t, 3 df), earthquakes": dict(sd=(0.10, 0.10, 0.134), law="t3"),
    "skewed earthquakes (exponential)": dict(sd=(0.10, 0.10, 0.134), law="exponential"),
    "nearly all ties, 5 %: jumps of ×1.35 in 1 % of pairs": dict(step=0.05, rate=0.01, jump=0.3),
    "nearly all ties, 5 %: jumps of ×1.35 in 3 %": dict(step=0.05, rate=0.03, jump=0.3),
    "nearly all ties, 5 %: jumps of ×1.35 in 10 %": dict(step=0.05, rate=0.10, jump=0.3),
    "nearly all ties, 1 %: jumps of ×1.05 in 3 %": dict(step=0.01, rate=0.03, jump=0.05),
    "nearly all ties, 1 %: jumps of ×1.05 in 10 %": dict(step=0.01, rate=0.10, jump=0.05),
    "nearly all ties, 5 %: all shifted by 2 %": dict(step=0.05, shift=0.02),
}
TIES = [name for name in DESIGNS if name.startswith("nearly")]
WARNED = [name for name in DESIGNS if "tails" in name or "skewed" in name]
# scatter that differs between earthquakes makes t cautious, ties make it so by the width of a step
CAUTIOUS = [*TIES, "heteroscedastic: one earthquake scatters three times as much"]
CAUTIOUS += ["series of 5 %, scatter of one step"]


def simulated(name, rng, effect=0.0):
    """d of one data set, its true mean, and the resolution of one pair."""
    design = DESIGNS[name]
    earthquake, motion, pair = (np.asarray(sd) for sd in design.get("sd", (0.0, 0.0, 0.0)))
    law = design.get("law", "normal")
    d = effect + earthquake.reshape(-1, 1, 1) * drawn(rng, law, (4, 1, 1))
    d = d + motion * rng.normal(size=(4, 3, 1)) + pair * rng.normal(size=SHAPE)
    rate, jump = design.get("rate", 0.0), design.get("jump", 0.0)
    d = d + jump * (rng.random(SHAPE) < rate) + design.get("shift", 0.0)
    truth = effect + rate * jump + design.get("shift", 0.0)
    step = math.log1p(design.get("step", 0.0))
    if step:
        without = rng.uniform(0.0, 1.0, SHAPE)
        d = step * (np.floor((without + d) / step) - np.floor(without / step))
    return d, truth, step


def estimate(d: np.ndarray, step: float, confidence: float):
    """The package's estimate for balanced pairs, without the tables around it."""
    hidden = tied_resolution(d.ravel(), np.full(d.size, step)).mean()
    return t_estimate(d.mean(axis=(1, 2)), confidence, float(hidden))


def fractions(name: str) -> dict[str, object]:
    """Coverage of the 90 % interval, false alarms at 5 % of a true effect of none, and widths."""
    rng = np.random.default_rng([SEED, list(DESIGNS).index(name)])
    held, naive, width, alarms = [], [], [], []
    for _ in range(DATA_SETS):
        d, truth, step = simulated(name, rng)
        item = estimate(d, step, 0.90)
        bare = t_estimate(d.mean(axis=(1, 2)), 0.90)
        held.append(item.lower <= truth <= item.upper)
        # an interval without width is one value
        limits = (bare.mean, bare.mean) if math.isnan(bare.lower) else (bare.lower, bare.upper)
        naive.append(limits[0] - 1e-12 <= truth <= limits[1] + 1e-12)
        width.append(item.upper - item.lower)
        # centred on no effect, jumps either way
        none = np.sign(rng.random(SHAPE) - 0.5) * d if name in TIES else d
        alarms.append(estimate(none, step, 0.95).p < 0.05)
    return {
        "design": name,
        "coverage of 90 %": float(np.mean(held)),
        "of t without the steps": float(np.mean(naive)),
        "false alarms at 5 %": float(np.mean(alarms)),
        "median width of ln P/NP": float(np.median(width)),
    }


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    found = pd.DataFrame([fractions(name) for name in DESIGNS])
    document("validation-pedestal.md", "coverage", found)
    return found.set_index("design")


@pytest.mark.slow
@pytest.mark.parametrize("name", DESIGNS)
def test_interval_covers_87_to_93_percent_and_level_is_3_to_7_percent(table, name):
    """Never less where it is cautious; tails and skew cost little."""
    usual, warned = name not in (*CAUTIOUS, *WARNED), name in WARNED
    covered, level = table.loc[name, ["coverage of 90 %", "false alarms at 5 %"]]
    assert (0.84 if warned else 0.87) <= covered <= (0.93 if usual else 1)
    assert (0.03 if usual else 0) <= level <= (0.09 if warned else 0.07)


@pytest.mark.slow
def test_interval_that_ignores_the_steps_fails_where_nearly_all_pairs_agree(table):
    assert table.loc[TIES, "of t without the steps"].min() < 0.4
    assert (table.loc[TIES, "median width of ln P/NP"] > 0.015).all()


def test_fast_estimate_is_that_of_the_package():
    rng = np.random.default_rng(SEED)
    for name in DESIGNS:
        d, _, step = simulated(name, rng)
        ours, theirs = estimate(d, step, 0.95), mean_effect(pairs_of(d, resolution=step))
        assert (ours.lower, ours.upper, ours.p) == pytest.approx(
            (theirs.lower, theirs.upper, theirs.p), nan_ok=True
        )


@pytest.mark.parametrize(("rate", "level"), [(0.10, "0.004"), (0.05, "0.0002")])
def test_no_exact_test_of_signs_comes_near_5_percent_where_nearly_all_pairs_agree(rate, level):
    """The level that docs/validation-pedestal.md quotes: over the number of pairs that differ."""
    attained = 0.0
    for k in range(37):
        ups = np.arange(k + 1)
        p = 2 * np.minimum(stats.binom.cdf(ups, k, 0.5), stats.binom.sf(ups - 1, k, 0.5))
        size = stats.binom.pmf(ups, k, 0.5)[p <= 0.05].sum()
        attained += stats.binom.pmf(k, 36, rate) * size
    assert f"{attained:.{len(level) - 2}f}" == level
