"""Synthetic tests with known effects, for everything about the pedestal."""

from itertools import product

import numpy as np

from ..paired_tests import EARTHQUAKES, FLOORS, build

SLENDERNESS = {"T1": 3.0, "T2": 4.0, "T3": 5.0}


def synthetic_tests(
    seed=1,
    *,
    effect=0.1,
    floor_effect=None,
    sd_earthquake=0.05,
    sd_motion=0.05,
    sd_pair=0.134,
):
    """Tests of the thesis's design: ln(P/NP) is effect + floor + earthquake + motion + pair."""
    rng = np.random.default_rng(seed)
    of_earthquake = dict(zip(EARTHQUAKES, rng.normal(0, sd_earthquake, 4), strict=True))
    of_motion = {
        place: rng.normal(0, sd_motion) for place in product(EARTHQUAKES, FLOORS)
    }

    def log_ratio(_, earthquake, floor):
        own = of_earthquake[earthquake] + of_motion[earthquake, floor]
        return effect + own + (floor_effect or {}).get(floor, 0.0)

    # the scatter of d is shared evenly by the two tests of a pair
    tests = build(log_ratio, noise=sd_pair / np.sqrt(2), seed=[seed, 1], of_motion=0.2)
    return tests.assign(
        repetition=1, lower_g=tests["amplitude_g"], upper_g=tests["amplitude_g"]
    )


def without_scatter(effect=0.0):
    """The same tests of which all pairs have one effect."""
    return synthetic_tests(effect=effect, sd_earthquake=0, sd_motion=0, sd_pair=0)
