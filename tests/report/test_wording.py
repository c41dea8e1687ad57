"""Numbers in words: no NaN, no infinity, no interval without width."""

import math

import pandas as pd
import pytest

from rockfrag.report.wording import (
    amplitude,
    counted,
    decimals_of,
    estimate,
    estimates,
    listed,
    number,
    of_all,
    probability,
    shortened,
)

NAN, INF = math.nan, math.inf


@pytest.mark.parametrize(
    ("value", "lower", "upper", "words"),
    [
        (1.008, 0.987, 1.03, "1.01 [0.99, 1.03]"),
        (1.0, 1.0, 1.0, "1.00"),
        (0.516, NAN, NAN, "0.52"),
        (0.5, 0.2, INF, "0.50 [0.20, open]"),
        (0.5, 0.0, 0.9, "0.50 [open, 0.90]"),
        (0.5, 0.0, INF, "0.50"),
        (0.12, 1e-9, 2e12, "0.12"),
        (0.12, 0.1, 2e12, "0.12 [0.10, open]"),
        (NAN, NAN, NAN, "–"),
        (INF, 1.0, INF, "–"),
    ],
)
def test_an_estimate_has_limits_only_where_they_say_something(value, lower, upper, words):
    assert estimate(value, lower, upper, 2) == words


def test_a_column_of_estimates_has_one_number_of_decimals():
    table = pd.DataFrame({"a": [12.34, 0.123], "a_lower": [10.0, 0.1], "a_upper": [15.0, 0.2]})
    assert estimates(table, "a") == ["12.340 [10.000, 15.000]", "0.123 [0.100, 0.200]"]


def test_p_values_are_never_zero():
    assert probability(1e-9) == "< 0.001"
    assert probability(0.0421) == "0.042"
    assert probability(NAN) == "–"


def test_numbers_of_things_agree_with_their_nouns():
    assert counted(1, "record") == "1 record"
    assert counted(2, "record") == "2 records"
    assert counted(0, "pair") == "no pair"
    assert of_all(1, 1, "test") == "the only test"
    assert of_all(3, 3, "test") == "all 3 tests"
    assert of_all(1, 3, "test") == "1 of 3 tests"
    assert of_all(0, 3, "test") == "none of 3 tests"


def test_lists_read_as_sentences_and_stay_short():
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert listed([str(i) for i in range(20)]).endswith("7 and 12 more")


def test_an_amplitude_that_is_not_known_is_shown_as_its_bound():
    assert amplitude({"amplitude_g": 0.5234, "lower_g": 0.5, "upper_g": 0.55}) == "0.523"
    assert amplitude({"amplitude_g": NAN, "lower_g": 2.0, "upper_g": NAN}) == "> 2.000"
    assert amplitude({"amplitude_g": NAN, "lower_g": 0.0, "upper_g": 0.1}) == "< 0.100"
    assert amplitude({"amplitude_g": NAN, "lower_g": 0.0, "upper_g": NAN}) == "–"


def test_long_names_keep_their_head_and_tail():
    assert shortened("short") == "short"
    cut = shortened("Figure of a saint, left niche", 12)
    assert len(cut) == 12 and cut.startswith("Figur") and cut.endswith("niche")


def test_decimals_show_three_digits():
    assert [decimals_of(x) for x in (0.0123, 1.23, 123.0, 0.0)] == [4, 2, 0, 3]
    assert number(-0.5, 1) == "−0.5"
