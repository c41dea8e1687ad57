"""Exponentials, logarithms and the normal distribution of plain arithmetic, beside many digits and scipy."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest
from scipy import special

from rockfrag.base import exponentials


def units_off(found: float, exact: Decimal) -> float:
    """Error in units of the last place."""
    return abs(float((Decimal(found) - exact) / Decimal(math.ulp(float(exact)))))


@pytest.mark.parametrize(
    ("name", "low", "high", "of"),
    [
        ("exp", -700, 700, lambda x: x.exp()),
        ("exp", -1, 1, lambda x: x.exp()),
        ("expm1", -2, 2, lambda x: x.exp() - 1),
        ("expm1", -1e-6, 1e-6, lambda x: x.exp() - 1),
        ("log", 1e-12, 10, lambda x: x.ln()),
        ("log", 0.5, 2, lambda x: x.ln()),
        ("log1p", -0.9, 5, lambda x: (1 + x).ln()),
        ("log1p", -1e-6, 1e-6, lambda x: (1 + x).ln()),
    ],
)
def test_errors_are_below_two_units_in_the_last_place(name, low, high, of):
    rng = np.random.default_rng(4)
    with localcontext() as context:
        context.prec = 60
        for x in rng.uniform(low, high, 200).tolist():
            found = getattr(exponentials, name)(x)
            assert units_off(found, of(Decimal(x))) < 2, x


def test_logarithms_of_all_sizes():
    for exponent in range(-1074, 1024, 7):
        x = math.ldexp(1.0, exponent)
        assert exponentials.log(x) == pytest.approx(math.log(x), rel=4e-16)
    assert exponentials.exp(exponentials.log(1e300)) == pytest.approx(1e300, rel=1e-12)


def test_ends():
    exp, log, log1p = exponentials.exp, exponentials.log, exponentials.log1p
    assert (exp(0.0), exp(710.0), exp(-750.0)) == (1.0, math.inf, 0.0)
    assert (exp(math.inf), exp(-math.inf)) == (math.inf, 0.0)
    assert (log(1.0), log(0.0), log(math.inf)) == (0.0, -math.inf, math.inf)
    assert (log1p(-1.0), log1p(0.0)) == (-math.inf, 0.0)
    assert all(map(math.isnan, (exp(math.nan), log(math.nan), log(-1.0))))
    assert exponentials.expm1(-math.inf) == -1.0


def test_the_normal_distribution_is_scipys():
    x = np.linspace(-30, 8, 4001)
    found = np.array([exponentials.log_normal_cdf(each) for each in x])
    np.testing.assert_allclose(found, special.log_ndtr(x), rtol=3e-15, atol=1e-16)
    x = np.linspace(-8, 8, 4001)
    found = np.array([exponentials.normal_cdf(each) for each in x])
    # whose squares are rounded
    np.testing.assert_allclose(found, special.ndtr(x), rtol=2e-14)
    exact = {-8.0: 6.220960574271784e-16, -5.0: 2.866515718791939e-07}
    for point, value in exact.items():
        assert exponentials.normal_cdf(point) == pytest.approx(value, rel=1e-15)
