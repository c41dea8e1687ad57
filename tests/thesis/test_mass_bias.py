"""Mass that was moved and not counted."""

import math

import pytest

from rockfrag.errors import InputError
from rockfrag_thesis.sensitivity_analysis.mass_bias import ratio_bias


@pytest.mark.parametrize(
    ("statue", "pedestal", "table", "counted_with", "counted_without", "bias"),
    [
        (2.172, 2.3, 10.0, 14.472, 12.172, 1.0),
        # the pedestal is not counted on ten kilograms: 17 to 19 %
        (2.172, 2.3, 10.0, 12.172, 12.172, 1.19),
        (2.790, 2.3, 10.0, 12.790, 12.790, 1.18),
        (3.456, 2.3, 10.0, 13.456, 13.456, 1.17),
        # it is divided by the blocks' weight alone
        (2.172, 2.3, 10.0, 4.472, 2.172, 0.58),
        (2.790, 2.3, 10.0, 5.090, 2.790, 0.65),
        (3.456, 2.3, 10.0, 5.756, 3.456, 0.70),
        # 10 m/s² on 20 kg of table, 2 kg of statue, 2 kg of pedestal, divided by 22 kg both times
        (2.0, 2.0, 20.0, 22.0, 22.0, 1.09),
    ],
)
def test_mass_that_is_not_counted_biases_the_ratio(
    statue, pedestal, table, counted_with, counted_without, bias
):
    found = ratio_bias(
        statue, pedestal, table, counted_with=counted_with, counted_without=counted_without
    )
    assert round(found, 2) == bias


@pytest.mark.parametrize("mass", [-1.0, math.nan])
def test_impossible_masses_are_refused(mass):
    with pytest.raises(InputError, match="mass of 0 kg or more"):
        ratio_bias(mass, 2, 20, counted_with=22, counted_without=22)
    with pytest.raises(InputError, match="divided by"):
        ratio_bias(1, 2, 20, counted_with=0, counted_without=22)
