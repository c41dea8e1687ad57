"""Tests become pairs, what cannot be paired is said, and nothing is said more finely than the steps allow."""

import math

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.effects import study_pedestal
from rockfrag.effects.cluster_means import detectable_ratio, equivalence, mean_effect
from rockfrag.effects.paired_tests import pair_tests, with_counterparts

from .conftest import SLENDERNESS, synthetic_tests, without_scatter

LOWEST = 0.05


def test_thesis_design_gives_36_pairs_in_12_motions_of_4_earthquakes():
    tests = synthetic_tests()
    pairs = pair_tests(tests)
    assert pairs.table[["motion", "earthquake"]].nunique().tolist() == [12, 4]
    assert len(pairs.table) == 36 and pairs.notes() == []
    amplitudes = tests.set_index(["object", "motion", "pedestal"])["amplitude_g"]
    ratio = amplitudes["T2", "Kobe-F3", "P"] / amplitudes["T2", "Kobe-F3", "NP"]
    d = pairs.table.set_index(["object", "motion"]).loc[("T2", "Kobe-F3"), "d"]
    assert d == pytest.approx(np.log(ratio), abs=1e-14)
    shuffled = pair_tests(tests.sample(frac=1, random_state=3))
    pd.testing.assert_frame_equal(pairs.table, shuffled.table)


def test_an_arrangement_is_paired_with_the_one_that_it_names():
    alone = synthetic_tests().query("pedestal == 'NP' and object == 'T1'")
    alone = alone.drop(columns=["lower_g", "upper_g"])
    tests = pd.concat(
        alone.assign(
            configuration=name, pedestal=side, amplitude_g=f * alone["amplitude_g"]
        )
        for name, side, f in (
            ("alone", "NP", 1.0),
            ("plinth", "P", 2.0),
            ("base", "P", 6.0),
        )
    )
    named, origin = with_counterparts(tests, {"base": "plinth"})
    assert origin == {"base against plinth": "T1"}
    pairs = pair_tests(named, {"T1": 3.0, "base against plinth": 3.0}).table
    ratio = np.exp(pairs.groupby("object")["d"].agg(["min", "max"]))
    np.testing.assert_allclose(ratio.loc["T1"], 2.0)
    np.testing.assert_allclose(ratio.loc["base against plinth"], 3.0)


def test_each_pedestal_of_an_object_is_paired_with_the_lone_object():
    tests = synthetic_tests()
    on = tests["pedestal"] == "P"
    tests["configuration"] = np.where(on, "P&" + tests["object"], tests["object"])
    wider = tests[on & (tests["object"] == "T2")].assign(configuration="Q&T2")
    wider[["amplitude_g", "lower_g", "upper_g"]] *= 2
    pairs = pair_tests(pd.concat([tests, wider]), SLENDERNESS).table
    assert len(pairs) == 48
    means = pairs.groupby("object")["d"].mean()
    assert means["Q&T2"] == pytest.approx(means["P&T2"] + np.log(2))
    assert set(pairs.loc[pairs["object"] == "Q&T2", "slenderness"]) == {4.0}


def test_repetitions_are_averaged_in_the_logarithm():
    tests = synthetic_tests()
    again = tests.iloc[[0]].assign(repetition=2)
    again[["amplitude_g", "lower_g", "upper_g"]] *= 1.21
    both, alone = (
        pair_tests(some).table["a_np_g"] for some in (pd.concat([tests, again]), tests)
    )
    assert (both / alone).max() == pytest.approx(1.1)
    assert np.count_nonzero(both != alone) == 1


def test_missing_partner_is_left_out_and_named():
    pairs = pair_tests(synthetic_tests().iloc[1:])
    assert len(pairs.table) == 35
    assert pairs.unpaired["missing"].tolist() == ["NP"]
    assert "T1/Friuli-GF without NP" in pairs.notes()[0]


@pytest.mark.parametrize(
    ("side", "outcome", "bound", "limits"),
    [
        (1, ["right", 0.6, np.nan, np.nan], "at least", ("d", np.inf)),
        (1, ["none", 0.0, 0.6, np.nan], "at most", (-np.inf, "d")),
        (0, ["right", 2.0, np.nan, np.nan], "at most", (-np.inf, "d")),
    ],
)
def test_pair_with_one_unfinished_side_is_counted_at_its_bound(
    side, outcome, bound, limits
):
    """The test that never overturned, or did at its first step, may be the largest effect of all."""
    tests = synthetic_tests()
    place = tests.index[
        (tests["object"] == "T2") & (tests["motion"] == "Northridge-F5")
    ]
    tests.loc[place[side], ["censored", "lower_g", "upper_g", "amplitude_g"]] = outcome
    study = study_pedestal(tests, seed=1)
    pairs = study.pairs.table
    item = pairs.set_index(["object", "motion"]).loc["T2", "Northridge-F5"]
    other = tests.loc[place[1 - side], "amplitude_g"]
    d = np.log(np.nanmax(outcome[1:]) / other) * (1 if side else -1)
    assert (item["d"], item["bound"]) == (pytest.approx(d), bound)
    expected = [d if limit == "d" else limit for limit in limits]
    found = study.pairs.censored.iloc[0][["d_lower", "d_upper"]].tolist()
    assert found == pytest.approx(expected)
    whole = study.effects.iloc[0]
    assert (whole["pairs"], whole["at_bound"]) == (36, 1)
    without = mean_effect(pairs[pairs["bound"] == ""]).ratio
    assert (whole["ratio"] < without) == (d < np.log(without))
    assert any(f"T2/Northridge-F5 {bound}" in note for note in study.notes)


def test_pairs_of_two_unfinished_tests_are_left_out_and_named():
    tests = synthetic_tests()
    both = (tests["object"] == "T2") & (tests["motion"] == "Northridge-F5")
    tests.loc[both, ["upper_g", "amplitude_g"]] = np.nan
    tests.loc[both, "censored"] = "right"
    pairs = pair_tests(tests)
    assert len(pairs.table) == 35
    assert any(
        "both tests are unfinished (T2/Northridge-F5)" in note for note in pairs.notes()
    )
    study = study_pedestal(tests.assign(censored="right"), seed=1)
    assert study.effects.empty and "ratio" in study.effects
    assert "no pair has a known ratio" in study.notes[-1]


def cell(column, value):
    """Exchange one cell of a table."""
    return lambda t: t.assign(
        **{column: t[column].astype(object).where(t.index != 5, value)}
    )


@pytest.mark.parametrize(
    ("change", "words"),
    [
        *(
            (cell("amplitude_g", a), f"amplitude_g is {a}")
            for a in (np.nan, 0.0, -0.2, np.inf)
        ),
        (cell("amplitude_g", "a lot"), "amplitude_g is 'a lot', not a number of g"),
        (cell("pedestal", "yes"), "pedestal is 'yes'"),
        (cell("censored", "up"), "censored is 'up'"),
        (cell("earthquake", None), "earthquake is empty"),
        (cell("object", "T9"), "slenderness of object T9"),
        (cell("lower_g", 9.0), "exceeds upper_g"),
        (lambda t: pd.concat([t, t.iloc[[3]]]), "row 73: the same test as row 4"),
        (
            lambda t: t.assign(definition=["first", *["step"] * 71]),
            "several definitions",
        ),
        (lambda t: t[t["pedestal"] == "P"], "with and without pedestal"),
        (lambda t: t.drop(columns="floor"), "floor missing"),
        (lambda t: t.iloc[:0], "no rows"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_sentence(change, words):
    with pytest.raises(InputError, match=words):
        pair_tests(change(synthetic_tests()), SLENDERNESS)


def on_levels(tests, step):
    """The same tests raised in steps of a ratio 1 + step; the figure is the last step survived."""
    level = np.floor(np.log(tests["amplitude_g"] / LOWEST) / math.log1p(step))
    lower = LOWEST * (1 + step) ** level
    return tests.assign(lower_g=lower, upper_g=lower * (1 + step), amplitude_g=lower)


@pytest.mark.parametrize(
    ("step", "margin", "shown"),
    [(0.05, 0.10, True), (0.05, 0.05, False), (0.05, 0.01, False), (0.005, 0.01, True)],
)
def test_steps_show_equivalence_to_more_than_a_step_and_to_no_less(step, margin, shown):
    effect = mean_effect(pair_tests(on_levels(without_scatter(), step)).table)
    assert (equivalence(effect, margin) < 0.05) == shown
    assert detectable_ratio(effect) > 1 + step


def test_pairs_that_differ_are_not_widened():
    """Where every pair differs the rounding is part of the scatter and averages out."""
    fine = mean_effect(pair_tests(synthetic_tests()).table)
    rough = mean_effect(pair_tests(on_levels(synthetic_tests(), 0.01)).table)
    assert rough.resolution < 0.15 * math.log(1.01) * 2
    assert rough.upper - rough.lower == pytest.approx(fine.upper - fine.lower, rel=0.1)


def test_equal_figures_without_steps_have_no_interval():
    study = study_pedestal(without_scatter(), seed=1)
    assert study.effects[["lower", "upper", "p"]].isna().all(axis=None)
    assert not study.effects["equivalent"].any()
    assert any("does not give the steps" in note for note in study.notes)


def test_no_effect_of_a_study_has_an_interval_without_width():
    tests = on_levels(without_scatter(), 0.05)
    # one pair jumps by three steps, as a structural resurrection makes it do
    jump = tests.index[(tests["pedestal"] == "P") & (tests["motion"] == "Kobe-F5")][0]
    tests.loc[jump, ["lower_g", "upper_g", "amplitude_g"]] *= 1.05**3
    study = study_pedestal(tests, seed=1)
    several = study.effects[study.effects["units"] > 1]
    assert (np.log(several["upper"] / several["lower"]) > 0.03).all()
    assert (several["detectable_ratio"] > several["resolution_ratio"]).all()
    assert study.effects.loc[0, "tied"] == 35
    assert any("wider than their level says" in note for note in study.notes)


def test_every_scope_is_there_with_its_power():
    study = study_pedestal(synthetic_tests(), slenderness=SLENDERNESS, seed=1)
    counts = study.effects["scope"].value_counts().to_dict()
    assert counts == {"whole": 1, "floor": 3, "earthquake": 4, "object": 3, "cell": 9}
    assert (
        study.effects["ratio"]
        .between(study.effects["lower"], study.effects["upper"])
        .all()
    )
    assert (study.effects["p_holm"] >= study.effects["p"]).all()
    assert (study.effects["detectable_ratio"] > 1).all()
    assert (
        study.effects.loc[study.effects["scope"] == "cell", "smallest_p"] == 0.125
    ).all()
    assert np.ptp(study.whole["estimate"]) == 0
    assert not study.whole["remark"].str.contains("width of the steps").any()
    assert "4 are a sample" in study.notes[0] and "0.125" in study.notes[0]
    assert not any("wider than their level says" in note for note in study.notes)


def test_pedestal_with_one_effect_gives_it_up_to_the_steps():
    tests = without_scatter(0.2)
    study = study_pedestal(tests.assign(upper_g=1.05 * tests["lower_g"]), seed=1)
    assert study.effects["ratio"].to_numpy() == pytest.approx(np.exp(0.2))
    tests = without_scatter()
    study = study_pedestal(tests.assign(upper_g=1.05 * tests["lower_g"]), seed=1)
    assert study.effects["ratio"].to_numpy() == pytest.approx(1, abs=1e-12)
    assert (study.effects["upper"] >= 1.05 - 1e-12).all()
    assert (study.effects["lower"] <= 1 / 1.05 + 1e-12).all()
    assert (study.effects["p"] == 1).all()
    # limits that agree between methods to three digits may all be the width of the steps
    with_limits = study.whole[study.whole["lower"].notna()]
    assert with_limits["remark"].str.contains("width of the steps").all()


def test_one_earthquake_is_about_its_motions_and_one_motion_gives_no_interval():
    tests = synthetic_tests()
    study = study_pedestal(tests[tests["earthquake"] == "Kobe"], seed=1)
    assert study.effects.loc[0, "unit"] == "motion"
    assert "not about other earthquakes" in study.notes[0]
    whole = study_pedestal(tests[tests["motion"] == "Kobe-GF"], seed=1).effects.iloc[0]
    assert np.isfinite(whole["ratio"]) and np.isnan([whole["lower"], whole["p"]]).all()
