"""Synthetic tests with known effects, for everything about the pedestal."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

EARTHQUAKES = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
FLOORS = ("GF", "F3", "F5")
TOWERS = {"T1": 0.46, "T2": 0.36, "T3": 0.29}


def synthetic_tests(
    seed: int,
    *,
    effect: float = 0.1,
    floor_effect: dict[str, float] | None = None,
    sd_earthquake: float = 0.05,
    sd_motion: float = 0.05,
    sd_pair: float = 0.134,
) -> pd.DataFrame:
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
                for pedestal, ln_a in (("NP", common - noise), ("P", common + d)):
                    rows.append(
                        {
                            "test": f"{object_name}-{pedestal}-{earthquake}-{floor}",
                            "object": object_name,
                            "pedestal": pedestal,
                            "earthquake": earthquake,
                            "floor": floor,
                            "motion": f"{earthquake}-{floor}",
                            "lower_g": np.exp(ln_a),
                            "upper_g": np.exp(ln_a),
                            "amplitude_g": np.exp(ln_a),
                            "censored": "none",
                            "overturned_body": "statue",
                            "repetition": 1,
                            "remark": "synthetic",
                        }
                    )
    return pd.DataFrame(rows)


@pytest.fixture
def tests_table() -> Callable[..., pd.DataFrame]:
    return synthetic_tests
