"""The bootstrap draws whole motions or earthquakes, and is the same for the same seed."""

import pytest

from rockfrag.pedestal.bootstrap import rank_probabilities
from rockfrag.pedestal.paired_tests import pair_tests


def test_clear_order_of_floors_is_found_with_certainty(tests_table):
    tests = tests_table(1, floor_effect={"GF": 0.5, "F3": -0.5}, sd_pair=0.02)
    ranks = rank_probabilities(pair_tests(tests).table, "floor", "earthquake", 1).set_index("level")
    assert ranks.loc["GF", "p_largest"] == ranks.loc["F3", "p_smallest"] == 1.0


def test_what_levels_share_does_not_blur_their_order(tests_table):
    """A large earthquake effect moves all floors together, so the ranks must not notice it."""
    table = pair_tests(tests_table(1)).table
    shift = table["earthquake"].map(
        {"Friuli": 3.0, "Kobe": -3.0, "Loma Prieta": 1.0, "Northridge": 0.0}
    )
    same = rank_probabilities(table, "floor", "earthquake", 1)
    moved = rank_probabilities(table.assign(d=table["d"] + shift), "floor", "earthquake", 1)
    assert moved["p_largest"].tolist() == same["p_largest"].tolist()


def test_probabilities_add_to_one_and_ties_share(tests_table):
    table = pair_tests(tests_table(1)).table
    for factor, cluster, within in (("object", "motion", False), ("earthquake", "motion", True)):
        ranks = rank_probabilities(table, factor, cluster, 1, within=within)
        assert ranks["p_largest"].sum() == pytest.approx(1)
        assert ranks["p_smallest"].sum() == pytest.approx(1)
    tied = rank_probabilities(table.assign(d=0.0), "object", "motion", 1)
    assert tied["p_largest"].tolist() == pytest.approx([1 / 3] * 3)
