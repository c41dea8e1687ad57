"""Mass that was moved and not counted."""

import math

import pytest

from rockfrag.errors import InputError
from rockfrag_thesis.sensitivity_analysis.mass_bias import ratio_bias


def test_right_masses_give_no_bias():
    bias = ratio_bias(2.172, 2.3, 10.0, counted_with=14.472, counted_without=12.172)
    assert bias == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize(("mass", "bias"), [(2.172, 1.19), (2.790, 1.18), (3.456, 1.17)])
def test_pedestal_not_counted_on_ten_kilograms_raises_the_ratio_by_17_to_19_percent(mass, bias):
    found = ratio_bias(mass, 2.3, 10, counted_with=10 + mass, counted_without=10 + mass)
    assert round(found, 2) == bias


@pytest.mark.parametrize("mass", [2.172, 2.790, 3.456])
def test_dividing_by_the_blocks_weight_alone_lowers_the_ratio(mass):
    bias = ratio_bias(mass, 2.3, 10, counted_with=mass + 2.3, counted_without=mass)
    assert 0.5 < bias < 0.75


def test_force_over_mass_by_hand():
    # 10 m/s² on 20 kg of table, 2 kg of statue, 2 kg of pedestal, divided by 22 kg both times
    with_pedestal, without = 24 * 10.0 / 22, 22 * 10.0 / 22
    assert ratio_bias(2, 2, 20, counted_with=22, counted_without=22) == pytest.approx(
        with_pedestal / without
    )


@pytest.mark.parametrize("mass", [-1.0, math.nan])
def test_impossible_masses_are_refused(mass):
    with pytest.raises(InputError, match="mass of 0 kg or more"):
        ratio_bias(mass, 2, 20, counted_with=22, counted_without=22)
    with pytest.raises(InputError, match="divided by"):
        ratio_bias(1, 2, 20, counted_with=0, counted_without=22)
