"""Whether every estimator of the pedestal's effect finds the effect that was put in.

Tests of the thesis's design are simulated: ln a of an object, a floor and an earthquake, a random effect of
the pair, scatter per test, and a true effect of the pedestal that varies with earthquake and motion. Some
are raised in steps of 20 %, some end at the shaker's limit. The tables in
``docs/validation-pedestal.md`` are written by these tests.
"""

import math
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from rockfrag.pedestal.cluster_means import mean_effect
from rockfrag.pedestal.paired_tests import pair_tests
from rockfrag_thesis.hypotheses.contrasts import contrast, slope_effect

from .made import document

SEED, DATA_SETS = 20261121, 200
EARTHQUAKES = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
FLOORS = {"GF": 0.10, "F3": -0.05, "F5": -0.05}
TOWERS = {"T1": (3, 0.50), "T2": (4, 0.38), "T3": (5, 0.30)}
EFFECT_SIZE, SLOPE = 0.10, 0.04
SD_EARTHQUAKE, SD_MOTION, SD_PAIR, SD_TEST = 0.06, 0.05, 0.15, 0.095
SD_LEVEL = 0.1  # of ln a between earthquakes, with and without pedestal alike
LIMIT, STEP = 0.50, 1.2


def simulated(seed: int) -> pd.DataFrame:
    """72 tests with exact figures."""
    rng = np.random.default_rng([SEED, seed])
    rows = []
    for earthquake in EARTHQUAKES:
        by_earthquake, level_earthquake = rng.normal(0, SD_EARTHQUAKE), rng.normal(0, SD_LEVEL)
        for floor, by_floor in FLOORS.items():
            by_motion = rng.normal(0, SD_MOTION)
            for object_name, (slenderness, amplitude) in TOWERS.items():
                pair = math.log(amplitude) + level_earthquake + rng.normal(0, SD_PAIR)
                effect = (
                    EFFECT_SIZE + by_floor + SLOPE * (slenderness - 4) + by_earthquake + by_motion
                )
                about = object_name, earthquake, floor, f"{earthquake}-{floor}"
                for pedestal in ("NP", "P"):
                    ln_a = pair + effect * (pedestal == "P") + rng.normal(0, SD_TEST)
                    rows.append((*about, pedestal, math.exp(ln_a)))
    names = ["object", "earthquake", "floor", "motion", "pedestal", "amplitude_g"]
    table = pd.DataFrame(rows, columns=names).assign(censored="none")
    return table.assign(lower_g=table["amplitude_g"], upper_g=table["amplitude_g"])


def stepped(tests: pd.DataFrame) -> pd.DataFrame:
    """The same tests raised in steps of 20 % from 0.05 g; the figure is the end of the last step."""
    steps = np.floor(np.log(tests["amplitude_g"] / 0.05) / math.log(STEP))
    lower = 0.05 * STEP**steps
    return tests.assign(lower_g=lower, upper_g=lower * STEP, amplitude_g=lower * STEP)


def cut(tests: pd.DataFrame) -> pd.DataFrame:
    """The same tests on a shaker that ends at ``LIMIT``."""
    over = tests["upper_g"] > LIMIT
    ended = tests.copy()
    ended.loc[over, "censored"] = "right"
    ended.loc[over, "lower_g"] = np.minimum(ended.loc[over, "lower_g"], LIMIT)
    ended.loc[over & (tests["lower_g"] > LIMIT), "lower_g"] = LIMIT
    ended.loc[over, ["upper_g", "amplitude_g"]] = np.nan
    return ended


def pairs_of(tests: pd.DataFrame) -> pd.DataFrame:
    return pair_tests(tests, {name: slenderness for name, (slenderness, _) in TOWERS.items()}).table


# what is estimated, how, and the truth
ESTIMATORS: dict[str, tuple[Callable[[pd.DataFrame], float], float]] = {
    "mean of d": (lambda t: mean_effect(pairs_of(t)).mean, EFFECT_SIZE),
    "GF minus F3": (
        lambda t: contrast(pairs_of(t), "floor", "GF", "F3").mean,
        FLOORS["GF"] - FLOORS["F3"],
    ),
    "slope of d on H/B": (lambda t: slope_effect(pairs_of(t)).mean, SLOPE),
    "mean of d, steps of 20 %": (lambda t: mean_effect(pairs_of(stepped(t))).mean, EFFECT_SIZE),
    "mean of d, limit 0.5 g, unfinished tests at their bound": (
        lambda t: mean_effect(pairs_of(cut(t))).mean,
        EFFECT_SIZE,
    ),
}


def recovery(name: str) -> dict[str, float]:
    """Truth, mean estimate, its standard error, and the scatter of one estimate."""
    estimate, truth = ESTIMATORS[name]
    found = np.array([estimate(simulated(seed)) for seed in range(DATA_SETS)])
    return {
        "truth": truth,
        "mean estimate": float(found.mean()),
        "standard error": float(found.std(ddof=1) / math.sqrt(DATA_SETS)),
        "scatter of one": float(found.std(ddof=1)),
        "data sets": DATA_SETS,
    }


@pytest.fixture(scope="module")
def recovered() -> pd.DataFrame:
    found = pd.DataFrame({name: recovery(name) for name in ESTIMATORS}).T
    table = found.astype({"data sets": int}).reset_index(names="estimator")
    document("validation-pedestal.md", "recovery", table)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", ESTIMATORS)
def test_estimator_finds_what_was_put_in(recovered, name):
    row = recovered.loc[name]
    assert abs(row["mean estimate"] - row["truth"]) < 3 * row["standard error"]


@pytest.mark.slow
def test_intervals_of_unfinished_tests_cover():
    effects = [mean_effect(pairs_of(cut(simulated(seed)))) for seed in range(DATA_SETS)]
    held = float(np.mean([item.lower <= EFFECT_SIZE <= item.upper for item in effects]))
    found = pd.DataFrame(
        {"interval": ["t over earthquakes, limit 0.5 g"], "coverage of 95 %": [held]}
    )
    document("validation-pedestal.md", "censored intervals", found)
    assert held >= 0.87
