"""Annual rate of overturning."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from scipy import integrate

from rockfrag.errors import InputError
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.observations import observations_from_table
from rockfrag.fragility.seismic_hazard import overturning_rate


@pytest.fixture
def fit():
    table = pd.DataFrame(
        {"pga_g": [0.2, 0.4, 0.6, 0.8], "overturned": [2, 10, 25, 34], "trials": 40}
    )
    return fit_lognormal(observations_from_table(table, "pga_g", trials="trials", motion=None))


@pytest.mark.parametrize("power", [0.5, 2.0, 4.0])
def test_a_power_law_hazard_gives_the_closed_form(fit, power):
    im = np.geomspace(1e-3, 1e2, 7)
    rate = 1e-4 * im**-power
    # Cornell and others (2002): H(θ) exp(k² β² / 2)
    expected = 1e-4 * fit.theta**-power * np.exp(0.5 * (power * fit.beta) ** 2)
    found = overturning_rate(fit, im, rate)
    assert found.annual_rate == pytest.approx(expected, rel=1e-10)
    assert found.probability == pytest.approx(1 - np.exp(-50 * expected), rel=1e-10)
    assert found.warnings == ()


def test_a_curved_hazard_agrees_with_numerical_integration(fit):
    im = np.geomspace(0.02, 3.0, 40)
    rate = 0.01 * np.exp(-0.5 * np.log(im / 0.01) ** 2 / 1.2)

    def integrand(x):
        z = (x - np.log(fit.theta)) / fit.beta
        density = np.exp(-0.5 * z**2) / (fit.beta * np.sqrt(2 * np.pi))
        return density * np.exp(np.interp(x, np.log(im), np.log(rate)))

    knots = np.log(im)
    expected = sum(integrate.quad(integrand, a, b)[0] for a, b in pairwise(knots))
    found = overturning_rate(fit, im, rate)
    inside = found.annual_rate * (1 - found.fraction_below - found.fraction_above)
    assert inside == pytest.approx(expected, rel=1e-8)


def test_a_hazard_curve_that_ends_too_early_is_said(fit):
    found = overturning_rate(fit, [0.3, 0.5], [1e-3, 2e-4])
    assert found.fraction_above > 0.05
    assert any("above the hazard curve" in note for note in found.warnings)


def test_a_hazard_curve_must_fall(fit):
    for im, rate in (([0.1, 0.2], [1e-4, 1e-3]), ([0.2, 0.1], [1e-3, 1e-4]), ([0, 1], [1, 0.1])):
        with pytest.raises(InputError, match="sort the curve"):
            overturning_rate(fit, im, rate)
    with pytest.raises(InputError, match="equally many"):
        overturning_rate(fit, [0.1, 0.2], [1e-3])
