"""Synthetic tests with known effects, for everything about the pedestal."""

import numpy as np
import pandas as pd
import pytest

EARTHQUAKES = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
FLOORS = ("GF", "F3", "F5")
TOWERS = {"T1": 0.46, "T2": 0.36, "T3": 0.29}


def synthetic_tests(
    seed, *, effect=0.1, floor_effect=None, sd_earthquake=0.05, sd_motion=0.05, sd_pair=0.134
):
    """Tests of the thesis's design: ln(P/NP) is effect + floor + earthquake + motion + pair."""
    rng = np.random.default_rng(seed)
    rows = []
    for earthquake in EARTHQUAKES:
        by_earthquake = rng.normal(0, sd_earthquake)
        level_earthquake = rng.normal(0, 0.1)
        for floor in FLOORS:
            by_motion = rng.normal(0, sd_motion)
            level = level_earthquake + rng.normal(0, 0.1)
            for object_name, amplitude in TOWERS.items():
                # the scatter of d is shared evenly by the two tests of a pair
                noise, own = rng.normal(0, sd_pair / np.sqrt(2), 2)
                d = effect + by_earthquake + by_motion + own
                d += (floor_effect or {}).get(floor, 0.0)
                common = np.log(amplitude) + level + rng.normal(0, 0.1)
                about = (object_name, earthquake, floor, f"{earthquake}-{floor}")
                rows += [(*about, "NP", np.exp(common - noise)), (*about, "P", np.exp(common + d))]
    names = ["object", "earthquake", "floor", "motion", "pedestal", "amplitude_g"]
    table = pd.DataFrame(rows, columns=names).assign(censored="none", repetition=1)
    return table.assign(lower_g=table["amplitude_g"], upper_g=table["amplitude_g"])


@pytest.fixture
def tests_table():
    return synthetic_tests
