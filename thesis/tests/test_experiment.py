"""Hypotheses about the experiment come out right where the truth is known."""

import itertools

import numpy as np
import pandas as pd
import pytest

from rockfrag_thesis.hypotheses import (
    COLUMNS,
    HYPOTHESES,
    Evidence,
    Finding,
    contradictions,
    hypothesis_table,
)
from rockfrag_thesis.hypotheses.earthquakes import rank_correlation
from rockfrag_thesis.hypotheses.slenderness import stack_slenderness
from rockfrag_thesis.sections.hypotheses import hypotheses_html
from tests.paired_tests import build

FOR, AGAINST, OPEN = Finding.FOR, Finding.AGAINST, Finding.OPEN


def result(number, tests, **extra):
    return HYPOTHESES[number].test(Evidence(tests, "simulated", **extra))


def finding(number, tests, **extra):
    return result(number, tests, **extra).finding


def where(place):
    """Maker of effects by the name of an object, an earthquake or a floor."""
    return lambda **effects: (
        lambda *names: effects.get(names[place].replace(" ", ""), 0.0)
    )


on_object, on_earthquake, on_floor = map(where, range(3))


def everywhere(size):
    return lambda *names: size


def t1_first(floor, size):
    return lambda name, _, at: size * (3 if name == "T1" else 1) * (at == floor)


THESIS_SIGNS = on_floor(GF=0.2, F3=-0.05, F5=-0.05)

CASES = [
    # number, for, against
    (27, everywhere(0.2), on_object(T3=0.3)),
    (29, everywhere(0.2), everywhere(-0.2)),
    (31, everywhere(0.2), on_object(T1=-0.2, T3=0.2)),
    (32, on_object(T3=0.3, T1=0.1), on_object(T1=0.3)),
    (33, on_object(T2=0.05), on_object(T2=-0.2)),
    (34, on_floor(GF=0.2), on_floor(GF=0.2, F3=0.2)),
    (35, on_floor(GF=0.2), on_floor(GF=-0.2)),
    (36, on_floor(F3=-0.05), on_floor(F3=0.1)),
    (37, on_floor(F5=-0.05), on_floor(F5=0.1)),
    (39, t1_first("GF", 0.1), t1_first("GF", -0.1)),
    (40, t1_first("F5", -0.1), t1_first("F5", 0.1)),
    (41, on_floor(GF=0.3, F3=-0.1, F5=0.1), on_floor(GF=0.1, F3=-0.3)),
    (45, on_earthquake(Friuli=0.2, Kobe=0.2, LomaPrieta=0.2), on_earthquake(Kobe=-0.2)),
    (46, on_earthquake(Northridge=-0.2), on_earthquake(Northridge=0.2)),
    (47, on_earthquake(LomaPrieta=0.3), on_earthquake(Friuli=0.3, LomaPrieta=0.1)),
    (48, on_earthquake(Friuli=0.3, LomaPrieta=0.1), on_earthquake(LomaPrieta=0.3)),
    (49, everywhere(0.1), everywhere(-0.1)),
    (50, THESIS_SIGNS, on_floor(F3=0.1, F5=0.1)),
    (51, THESIS_SIGNS, on_floor(GF=-0.1)),
]


@pytest.mark.parametrize(("number", "true", "false"), CASES)
def test_effect_decides_the_finding(number, true, false):
    assert finding(number, build(true)) is FOR
    assert finding(number, build(false)) is AGAINST


def test_c29_and_c49_say_the_same():
    # the mean falls with Northridge, though 27 of 36 pairs rise
    tests = build(
        on_earthquake(Friuli=0.03, Kobe=0.03, LomaPrieta=0.03, Northridge=-0.6)
    )
    assert finding(29, tests) is finding(49, tests) is OPEN


@pytest.mark.parametrize("basis", ["simulated", "measured"])
def test_without_an_effect_large_changes_are_excluded_in_equal_words_and_small_ones_are_not(
    basis,
):
    """Whatever a hypothesis calls its change: the row's interval decides."""
    rows = hypothesis_table(Evidence(build(), basis)).set_index("number")
    assert (rows.loc[rows["p"].notna(), "p_of"] != "").all()
    assert rows.loc[26, "p_of"] == "no change"
    single = rows.loc[[29, 33, 35, 36, 37, 46, 49, 51]]
    assert len(set(single["outcome"])) == 1
    assert (
        (single["lower"] < 1) & (single["upper"] > 1) & (single["upper"] < 1.1)
    ).all()
    rules = rows.loc[[29, 33, 35, 36, 37, 45, 46, 50, 51], "rule"]
    assert rules.str.contains("10 %").all() and rules.str.contains("excluded").all()
    assert rows.loc[35, "finding"] == Finding.BOUNDED
    assert rows.loc[35, "outcome"] == "a change of 10 % or more is excluded"
    assert (
        rows.loc[35, "p_of"] == "a change of 10 % or more" and rows.loc[35, "p"] < 0.05
    )
    assert "smaller change" in rows.loc[35, "remark"]
    of_the_pedestal = [29, 33, 34, 35, 36, 37, 39, 40, 45, 46, 48, 49, 51]
    assert not {"not reproduced", "rejected"} & set(
        rows.loc[of_the_pedestal, "outcome"]
    )


@pytest.mark.parametrize(
    ("basis", "outcomes"),
    [
        ("simulated", ["reproduced", "not reproduced"]),
        ("measured", ["confirmed", "rejected"]),
    ],
)
def test_a_simulation_reproduces_and_a_laboratory_decides(basis, outcomes):
    rows = hypothesis_table(Evidence(build(everywhere(0.2)), basis)).set_index("number")
    assert rows.loc[[29, 36], "outcome"].tolist() == outcomes


def test_ties_are_known_to_a_step_lead_nowhere_and_exclude_no_slight_change():
    """Tests whose pedestal never matters, on a series of 5 %: every pair is tied."""
    tests = build(noise=0.0, step=0.05)
    assert (tests.groupby(["object", "motion"])["amplitude_g"].agg(np.ptp) == 0).all()
    measures = measures_of(tests, mean_period_s=np.linspace(0.1, 1, 12))
    rows = hypothesis_table(Evidence(tests, "simulated", measures)).set_index("number")
    found, limits = rows["finding"], ["estimate", "lower", "upper"]
    assert rows.loc[35, limits].tolist() == pytest.approx([1.0, 1 / 1.05, 1.05])
    assert (found[[32, 41, 47]] == OPEN).all()
    assert found[[33, 36, 37, 38, 50]].isin([OPEN, Finding.BOUNDED]).all()
    known = rows[rows["lower"].notna()].drop(index=55)
    assert (known["upper"] > known["lower"]).all()
    # nor have tied effects an order to correlate
    assert (
        rows.loc[52, "outcome"] == "undecided"
        and "same effect" in rows.loc[52, "remark"]
    )


def test_exceptions_on_the_upper_floors_are_counted_beyond_their_steps():
    tests = build(on_floor(F3=-0.1, F5=-0.1), noise=0.0, step=0.05)
    assert "24 decrease and 0 increase" in result(50, tests).remark
    # two thirds fall a little, one third rises much: no "few exceptions"
    mixed = build(lambda o, e, f: 0.06 if o == "T1" else -0.2, step=0.05)
    assert result(50, mixed).remark.startswith(
        "pairs: 24, of which 16 decrease and 8 increase"
    )


def thesis_cells(object_name, earthquake, floor):
    return 0.1 if floor == "GF" or (floor == "F3" and object_name == "T1") else -0.1


def steeper_above(object_name, earthquake, floor):
    return 0.0 if floor == "GF" else 0.3 * (object_name == "T1")


# NP: GF 1.2, F3 1.0, F5 1.1; P on the 5th raised above all
RAISED = {
    "effect": on_floor(F5=0.3, GF=0.1),
    "level": on_floor(GF=np.log(1.2), F5=np.log(1.1)),
}
RISING = {"objects": {"T1": 0.3, "T2": 0.4, "T3": 0.5}}
BENT = {"objects": {"T1": 0.5, "T2": 0.4, "T3": 0.45}}
TRENDS = {
    "a on H/B": {"T1": 0.5, "T2": 0.4, "T3": 0.3},
    "ln a on H/B": {"T1": 0.5, "T2": 0.4, "T3": 0.32},
    "a on B/H": {"T1": 0.5, "T2": 0.375, "T3": 0.3},
}


@pytest.mark.parametrize(
    ("numbers", "true", "false"),
    [
        (
            (38,),
            {"effect": thesis_cells},
            {"effect": on_floor(GF=0.1, F3=-0.1, F5=-0.1)},
        ),
        ((42, 43, 44), RAISED, {"level": on_floor(F3=0.3)}),
        ((25, 26, 53), {}, RISING),
        ((28,), {"level": steeper_above}, {}),
        # extrapolation is safe on the thesis's line, and not where no trend holds
        ((54,), BENT, {"objects": TRENDS["a on H/B"]}),
    ],
)
def test_tables_of_tests_decide_the_finding(numbers, true, false):
    for number in numbers:
        assert finding(number, build(**true)) is FOR
        assert finding(number, build(**false)) is AGAINST


def test_a_fall_is_almost_linear_unless_it_bends():
    # equilibrium alone, a as B/H, bends by 6 %, which is still almost straight
    inverse = result(25, build(objects={"T1": 1.5 / 3, "T2": 1.5 / 4, "T3": 1.5 / 5}))
    assert inverse.estimate == pytest.approx(0.9375, abs=0.01)
    assert finding(25, build(objects={"T1": 0.5, "T2": 0.3, "T3": 0.29})) is AGAINST


@pytest.mark.parametrize("trend", TRENDS)
def test_scatter_about_an_exact_trend_does_not_speak_against_extrapolation(trend):
    tables = (
        build(noise=0.134, seed=seed, objects=TRENDS[trend]) for seed in range(20)
    )
    assert sum(finding(54, table) is FOR for table in tables) <= 1


def measures_of(tests, **columns):
    motions = (
        tests[["motion", "earthquake", "floor"]]
        .drop_duplicates()
        .reset_index(drop=True)
    )
    return motions.rename(columns={"motion": "name"}).assign(**columns)


def test_correlation_with_the_motion_is_found_when_it_is_there():
    rng = np.random.default_rng(3)
    earthquakes = [f"E{k}" for k in range(12)]
    motions = build(earthquakes=earthquakes)["motion"].unique()
    period = dict(zip(motions, rng.uniform(0.2, 1.0, len(motions)), strict=True))
    tests = build(
        lambda _, e, floor: 0.5 * period[f"{e}-{floor}"], earthquakes=earthquakes
    )
    idle = {name: rng.uniform(size=36) for name in ("pgv_over_pga_s", "d5_95_s")}
    measures = measures_of(tests, mean_period_s=list(period.values()), **idle)
    found = result(52, tests, measures=measures)
    assert found.finding is AGAINST
    assert "mean period" in found.remark
    # twelve motions cannot show that there is no correlation
    tests = build(noise=0.1)
    measures = measures_of(
        tests, mean_period_s=np.random.default_rng(4).uniform(size=12)
    )
    assert finding(52, tests, measures=measures) is OPEN


def test_correlation_counts_earthquakes_and_not_their_motions():
    """Motions that share their earthquake's effect and period: no correlation beyond chance."""
    rng = np.random.default_rng(0)
    rejected = 0
    for _ in range(300):
        effect, period = rng.normal(size=(2, 4))
        rows = pd.DataFrame({"earthquake": list("ABCD"), "d": effect, "x": period})
        rows = rows.loc[rows.index.repeat(3)].reset_index(drop=True)
        for name in ("d", "x"):
            rows[name] += rng.normal(0, 0.3, 12)
        rejected += rank_correlation(rows, "x").p < 0.05
    # as independent motions Spearman's test finds one in four of these
    assert rejected / 300 < 0.08


def test_pure_rocking_is_judged_by_friction_and_normal_force():
    smooth = build().assign(friction_demand=0.2, least_normal_force_n=10.0)
    assert finding(57, smooth) is FOR
    assert finding(57, smooth.assign(friction_demand=0.5)) is OPEN
    assert finding(57, smooth.assign(friction_demand=1.5)) is AGAINST
    # where the ground gives way under both contacts no friction is enough, which is no number
    for endless in (np.inf, [np.inf, 0.3] * (len(smooth) // 2)):
        table = hypothesis_table(
            Evidence(smooth.assign(friction_demand=endless), "measured")
        )
        words = str(table.set_index("number").loc[57].to_dict())
        assert "none is enough in" in words and "median inf" not in words
    opened = hypothesis_table(
        Evidence(smooth.assign(least_normal_force_n=-0.1), "measured")
    )
    row = opened.set_index("number").loc[57]
    # it is the model's premise that fails; about the experiment nothing is said
    assert (row["outcome"], row["basis"]) == ("refuted", "simulated")


def test_force_over_mass_is_checked_where_recorded():
    tests = build()
    mass = 10.0 + 2.172
    noisy = tests["amplitude_g"] * (
        1 + 0.002 * np.random.default_rng(1).normal(size=len(tests))
    )
    right = tests.assign(moved_mass_kg=mass, force_n=noisy * 9.81 * mass)
    assert finding(56, right) is FOR
    assert finding(56, right.assign(moved_mass_kg=mass * 1.1)) is AGAINST
    without = result(56, tests)
    assert without.finding is OPEN and "17 % to 19 %" in without.figure


def test_twelve_motions_per_specimen_are_counted():
    tests = build()
    assert finding(55, tests) is FOR
    assert finding(55, tests[tests["earthquake"] != "Kobe"]) is OPEN


def test_hypothesis_table_has_all_34_statements_with_columns_and_reasons():
    table = hypothesis_table(Evidence(build(noise=0.1), "measured"))
    assert list(table.columns) == list(COLUMNS)
    assert table["number"].tolist() == list(range(25, 59))
    assert (
        table.loc[table["number"] == 58, "remark"]
        .item()
        .startswith("these data cannot decide")
    )
    undecided = table[
        (table["outcome"] == "undecided") & table["number"].between(27, 51)
    ]
    power = "80 % power|has no power|power is not known"
    assert undecided["remark"].str.contains(power, regex=True).all()
    # what is inferred says how often it errs, and what is left when all hypotheses are counted
    inferred = table[table["p"].notna()]
    assert len(inferred) > 20
    assert inferred["error_rate"].str.contains("%").all()
    assert (inferred["p_holm"] >= inferred["p"]).all()


def test_neither_the_order_of_rows_nor_the_spelling_of_names_matters():
    tests = build(noise=0.1)
    first = hypothesis_table(Evidence(tests, "simulated"))
    shuffled = tests.sample(frac=1, random_state=5)
    pd.testing.assert_frame_equal(
        first, hypothesis_table(Evidence(shuffled, "simulated"))
    )
    plain = tests["earthquake"].str.lower().str.replace(" ", "_")
    other = hypothesis_table(Evidence(tests.assign(earthquake=plain), "simulated"))
    assert other["outcome"].equals(first["outcome"])


@pytest.mark.parametrize(
    ("part", "numbers", "confirmed"),
    [
        ("floor == 'GF' and earthquake != 'Kobe'", (36, 37, 41, 42, 44, 45), []),
        ("object == 'T2'", (25, 26, 27, 28, 31, 32, 39, 53, 54), [29]),
        ("pedestal == 'NP'", range(31, 52), []),
    ],
)
def test_what_a_part_of_the_tests_cannot_say_stays_open(part, numbers, confirmed):
    tests = build(everywhere(0.2), noise=0.05).query(part)
    rows = hypothesis_table(Evidence(tests, "measured")).set_index("number")
    for number in numbers:
        assert rows.loc[number, "outcome"] == "undecided", number
        assert "cannot decide" in rows.loc[number, "remark"]
    assert (rows.loc[confirmed, "outcome"] == "confirmed").all()


def test_one_motion_decides_nothing_and_breaks_nothing():
    tests = build(noise=0.1)
    rows = hypothesis_table(Evidence(tests[tests["motion"] == "Kobe-GF"], "measured"))
    assert len(rows) == 34
    # but for geometry no hypothesis may be decided by one motion
    assert set(rows.loc[rows["outcome"] != "undecided", "number"]) <= {30}


def test_an_object_on_two_pedestals_is_no_double_test():
    tests = build(everywhere(0.2)).assign(configuration="lone")
    on_one = tests["pedestal"] == "P"
    tests.loc[on_one, "configuration"] = "low " + tests["object"]
    second = tests[on_one].assign(configuration="high " + tests["object"])
    rows = hypothesis_table(Evidence(pd.concat([tests, second]), "measured")).set_index(
        "number"
    )
    assert rows.loc[29, "outcome"] == "confirmed"


def test_the_hypothesis_table_shows_kind_outcome_rule_and_error_rate():
    html = str(
        hypotheses_html(hypothesis_table(Evidence(build(noise=0.1), "simulated")))
    )
    assert html.count('<div class="hypothesis') == 34
    assert "with/without pedestal" in html and "without/with pedestal" in html
    assert html.count("Rule: ") == html.count("Error: ") == 34
    assert 'class="hypothesis for"' in html and 'class="hypothesis open"' in html
    assert "description of the thesis&#39;s plots; simulated" in html
    assert "nan" not in html


def test_no_order_of_the_four_means_satisfies_all_four_statements():
    """C35, C37, C42 and C43, of the means with (P) and without pedestal on the ground and on the 5th floor."""
    kept = [
        (p_ground > ground, p_fifth < fifth, p_fifth > p_ground, ground > fifth)
        for p_ground, p_fifth, ground, fifth in itertools.permutations(range(4))
    ]
    # and it takes all four: dropping any one leaves orders that satisfy the rest
    assert max(map(sum, kept)) == 3
    assert all(
        any(sum(rules) == 3 and not rules[i] for rules in kept) for i in range(4)
    )


def test_stack_slenderness_by_hand():
    """Common centre of gravity from Table 3.1 without the package's geometry."""
    masses, heights = (2172, 2790, 3456), (37.2, 49.6, 62.0)
    table = stack_slenderness(Evidence(build(), "simulated"))
    for mass, height, stacked in zip(masses, heights, table["stacked"], strict=True):
        centre = (2300 * 10.4 + mass * (20.8 + height / 2)) / (2300 + mass)
        assert abs(stacked - centre / 9.2) < 1e-12
    assert table["stacked"].round(2).tolist() == [2.66, 3.23, 3.83]
    row = hypothesis_table(Evidence(build(), "measured")).set_index("number").loc[30]
    assert (row["finding"], row["outcome"], row["basis"]) == (
        AGAINST,
        "refuted",
        "computed",
    )
    assert row["figure"].startswith("stack 2.66, 3.23, 3.83 against 3.00, 4.00, 5.00")


def test_table_says_what_the_tests_show():
    seen = contradictions(Evidence(build(), "simulated"))
    first = seen.iloc[0]
    assert (
        len(seen) == 10
        and "C42" in first["hypotheses"]
        and "P GF" in first["in_these_tests"]
    )
    ground = contradictions(Evidence(build().query("floor == 'GF'"), "simulated"))
    assert "cannot be said" in ground.iloc[0]["in_these_tests"]
