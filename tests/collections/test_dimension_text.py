"""Dimensions in words: what is stated is read, what is not is asked, and nothing is guessed."""

import pytest

from rockfrag.base.errors import InputError
from rockfrag.collections.dimension_text import read_dimensions

from ..case_tables import case_tables

CASES = case_tables(__file__)


@pytest.mark.parametrize("case", CASES["read"], ids=lambda case: case[0])
def test_what_a_museum_states_is_read(case):
    text, sides, *mass = case
    found = read_dimensions(text)
    assert not found.question
    read = (found.height, found.width, found.depth, found.diameter)
    for length, expected in zip(read, sides, strict=True):
        assert (length is None) == (expected is None)
        if length is not None:
            assert 100 * length.middle == pytest.approx(expected, rel=1e-3)
    expected = pytest.approx(mass[0], rel=1e-4) if mass else None
    assert found.mass == expected


@pytest.mark.parametrize(("text", "names"), CASES["asked"])
def test_what_is_not_stated_is_asked_and_gives_no_length(text, names):
    found = read_dimensions(text)
    assert names in found.question
    assert (found.height, found.width, found.depth, found.diameter) == (None,) * 4


def test_an_order_that_is_known_of_the_table_names_bare_lengths():
    found = read_dimensions("70 7/8 × 24 × 15 3/4 in. (180 × 61 × 40 cm)", "HWD")
    assert found.understood == "height 180 cm, width 61 cm, depth 40 cm"
    # and never takes the place of what the text says
    stated = read_dimensions("L x W x H 40 x 60 x 180 cm", "HWD")
    assert stated.height.middle == pytest.approx(1.8)
    with pytest.raises(InputError, match="order: expected letters"):
        read_dimensions("180 x 60 cm", "HQ")


def test_a_range_keeps_its_limits():
    height = read_dimensions("H 180–185 cm, W 60 cm").height
    assert (height.low, height.high) == pytest.approx((1.8, 1.85))


def test_sizes_of_other_parts_are_kept_beside_the_one_taken():
    found = read_dimensions("with base: H 200 cm, W 60 cm; without base: H 180 cm")
    assert found.part == "with base"
    assert found.others == ("h 180 cm",)
