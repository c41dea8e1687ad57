"""The model of Abrahamson and Bhasin (2020) beside values of ShakeMap's tests and by hand."""

import math

import numpy as np
import pytest

from rockfrag.motions.conditional_velocity import (
    BY_PGA,
    BY_SA_1S,
)

# ln of the measure [ln g], distance [km], Vs30 [m/s] and ln PGV of the tests of ShakeMap 4 (shakelib, version of
# 2021, conversions/imt), for M 7.4
POINTS = [
    (2.0, 2.0, 200.0),
    (1.4, 30.0, 630.0),
    (0.8, 60.0, 360.0),
    (0.1, 100.0, 600.0),
]
SHAKEMAP = [
    (BY_SA_1S, 7.4, [5.61589861, 4.54874047, 4.11077608, 3.43577395]),
    (BY_PGA, 7.4, [5.64284705, 4.4158703, 4.17526695, 3.45235077]),
]


@pytest.mark.parametrize(("model", "magnitude", "expected"), SHAKEMAP)
def test_medians_are_those_of_shakemap(model, magnitude, expected):
    found = [
        float(model.log_velocity(np.array(math.exp(y)), magnitude, r, vs30))
        for y, r, vs30 in POINTS
    ]
    assert found == pytest.approx(expected, abs=1e-8)


def test_medians_and_spreads_are_those_by_hand():
    # eq. 3.4 by hand: M 7, 10 km, 760 m/s, PGA 0.5 g; M 6, 20 km, 500 m/s, SA(1 s) 0.15 g
    found = BY_PGA.log_velocity(np.array(0.5), 7.0, 10.0, 760.0)
    assert float(found) == pytest.approx(3.388089712, abs=1e-9)
    found = BY_SA_1S.log_velocity(np.array(0.15), 6.0, 20.0, 500.0)
    assert float(found) == pytest.approx(2.523011030, abs=1e-9)
    assert BY_SA_1S.spreads(6.0) == pytest.approx((0.145, 0.33))
    assert BY_PGA.spreads(7.5) == pytest.approx((0.26, 0.42))
    assert BY_PGA.spreads(4.0) == pytest.approx((0.12, 0.32))
