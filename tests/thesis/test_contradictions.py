"""The thesis's contradictions with itself are contradictions."""

import itertools

from rockfrag_thesis.hypotheses import Evidence, contradictions
from rockfrag_thesis.hypotheses.contradictions import orderings_of_floor_means
from rockfrag_thesis.hypotheses.slenderness import stack_slenderness


def test_no_order_of_the_four_means_satisfies_all_four_statements():
    assert orderings_of_floor_means() == 0
    # and it takes all four: dropping any one leaves orders that satisfy the rest
    names = ("P GF", "P F5", "NP GF", "NP F5")
    rules = (
        lambda m: m["P GF"] > m["NP GF"],
        lambda m: m["P F5"] < m["NP F5"],
        lambda m: m["P F5"] > m["P GF"],
        lambda m: m["NP GF"] > m["NP F5"],
    )
    for dropped in range(4):
        kept = [rule for i, rule in enumerate(rules) if i != dropped]
        orders = (dict(zip(names, o, strict=True)) for o in itertools.permutations(range(4)))
        assert any(all(rule(means) for rule in kept) for means in orders)


def test_stack_slenderness_by_hand(made):
    """Common centre of gravity from Table 3.1 without the package's geometry."""
    masses, heights = (2172, 2790, 3456), (37.2, 49.6, 62.0)
    table = stack_slenderness(Evidence(made(), "simulated"))
    for mass, height, stacked in zip(masses, heights, table["stacked"], strict=True):
        centre = (2300 * 10.4 + mass * (20.8 + height / 2)) / (2300 + mass)
        assert abs(stacked - centre / 9.2) < 1e-12
    assert table["stacked"].round(2).tolist() == [2.66, 3.23, 3.83]


def test_table_says_what_the_tests_show(made):
    bare = contradictions()
    assert len(bare) == 10
    assert (bare["in_these_tests"] == "").all()
    seen = contradictions(Evidence(made(), "simulated"))
    first = seen.iloc[0]
    assert "C42" in first["hypotheses"] and "P GF" in first["in_these_tests"]
    tests = made()
    ground = contradictions(Evidence(tests[tests["floor"] == "GF"], "simulated"))
    assert "cannot be said" in ground.iloc[0]["in_these_tests"]
