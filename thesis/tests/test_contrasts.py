"""Contrasts and slopes find what is in the pairs, and their power is that of the t test."""

import math

import pytest

from rockfrag.effects.cluster_means import detectable_ratio, mean_effect, t_estimate
from rockfrag.effects.paired_tests import pair_tests
from rockfrag_thesis.hypotheses.contrasts import (
    contrast,
    power_note,
    power_of_t,
    slope_effect,
    units_needed,
)
from tests.paired_tests import build

SLENDERNESS = {"T1": 3.0, "T2": 4.0, "T3": 5.0}


def test_slopes_and_contrasts_are_taken_inside_each_earthquake():
    table = pair_tests(build(noise=0.1), SLENDERNESS).table
    # a shift of a whole earthquake matters neither to a slope nor to a difference of floors
    of_kobe = 5.0 * (table["earthquake"] == "Kobe")
    slope = slope_effect(table.assign(d=0.1 - 0.07 * table["s_c"] + of_kobe))
    assert slope.mean == pytest.approx(-0.07, abs=1e-12)
    moved = table.assign(d=table["d"] + of_kobe)
    first, other = (contrast(t, "floor", "GF", "F3") for t in (table, moved))
    assert first.mean == pytest.approx(other.mean) and first.se == pytest.approx(
        other.se
    )


def test_what_is_known_to_a_step_is_not_known_better():
    """Every pair is tied, on a series of 5 %."""
    table = pair_tests(build(noise=0.0, step=0.05), SLENDERNESS).table
    for effect in (contrast(table, "floor", "GF", "F3"), slope_effect(table)):
        assert effect.mean == pytest.approx(0, abs=1e-12)
        assert effect.upper - effect.lower > 0.05
    assert "within the 5.0 % that the steps resolve" in power_note(mean_effect(table))


def test_detectable_change_and_units_needed_have_the_power_by_definition():
    effect = t_estimate([0.1, -0.05, 0.08, 0.02])
    detectable = power_of_t(detectable_ratio(effect), effect.sd, effect.units)
    assert detectable == pytest.approx(0.8, abs=1e-6)
    n = int(units_needed(effect))
    fewer, enough = (power_of_t(effect.ratio, effect.sd, k) for k in (n - 1, n))
    assert fewer < 0.8 <= enough
    assert f"{n} earthquakes" in power_note(effect)
    assert units_needed(t_estimate([0.1, -0.1])) == math.inf
    assert "no power" in power_note(t_estimate([0.1]))
    assert "steps are not known" in power_note(t_estimate([0.0, 0.0, 0.0]))
