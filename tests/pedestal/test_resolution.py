"""Amplitudes from a series of levels are known to a step: no statement about the pedestal is finer."""

import math

import numpy as np
import pytest

from rockfrag.pedestal import study_pedestal
from rockfrag.pedestal.cluster_means import detectable_ratio, equivalence, mean_effect, t_estimate
from rockfrag.pedestal.paired_tests import pair_tests

LOWEST = 0.05


def on_levels(tests, step):
    """The same tests raised in steps of a ratio 1 + step; the figure is the last step survived."""
    level = np.floor(np.log(tests["amplitude_g"] / LOWEST) / math.log1p(step))
    lower = LOWEST * (1 + step) ** level
    return tests.assign(lower_g=lower, upper_g=lower * (1 + step), amplitude_g=lower)


def tied(tests_table, step=0.05):
    return on_levels(tests_table(1, effect=0, sd_earthquake=0, sd_motion=0, sd_pair=0), step)


@pytest.mark.parametrize(
    ("step", "margin", "shown"),
    [(0.05, 0.10, True), (0.05, 0.05, False), (0.05, 0.01, False), (0.005, 0.01, True)],
)
def test_steps_show_equivalence_to_more_than_a_step_and_to_no_less(
    tests_table, step, margin, shown
):
    effect = mean_effect(pair_tests(tied(tests_table, step)).table)
    assert (equivalence(effect, margin) < 0.05) == shown


def test_what_can_be_detected_is_never_less_than_a_step(tests_table):
    effect = mean_effect(pair_tests(tied(tests_table)).table)
    assert detectable_ratio(effect) > 1.05


def test_pairs_that_differ_are_not_widened(tests_table):
    """Where every pair differs the rounding is part of the scatter and averages out."""
    fine = mean_effect(pair_tests(tests_table(1)).table)
    rough = mean_effect(pair_tests(on_levels(tests_table(1), 0.01)).table)
    assert rough.resolution < 0.15 * math.log(1.01) * 2
    assert rough.upper - rough.lower == pytest.approx(fine.upper - fine.lower, rel=0.1)


def test_equal_figures_without_steps_have_no_interval(tests_table):
    tests = tests_table(1, effect=0, sd_earthquake=0, sd_motion=0, sd_pair=0)
    study = study_pedestal(tests, seed=1)
    assert study.effects[["lower", "upper", "p"]].isna().all(axis=None)
    assert not study.effects["equivalent"].any()
    assert any("does not give the steps" in note for note in study.notes)


def test_no_effect_of_a_study_has_an_interval_without_width(tests_table):
    tests = tied(tests_table)
    # one pair jumps by three steps, as a structural resurrection makes it do
    jump = tests.index[(tests["pedestal"] == "P") & (tests["motion"] == "Kobe-F5")][0]
    tests.loc[jump, ["lower_g", "upper_g", "amplitude_g"]] *= 1.05**3
    effects = study_pedestal(tests, seed=1).effects
    several = effects[effects["units"] > 1]
    assert (np.log(several["upper"] / several["lower"]) > 0.03).all()
    assert (several["detectable_ratio"] > several["resolution_ratio"]).all()
    assert effects.loc[0, "tied"] == 35


def test_notes_say_that_intervals_are_cautious_where_most_pairs_agree(tests_table):
    cautious = "wider than their level says"
    assert any(cautious in note for note in study_pedestal(tied(tests_table), seed=1).notes)
    assert not any(cautious in note for note in study_pedestal(tests_table(1), seed=1).notes)


def test_pair_with_one_unfinished_side_is_counted_at_its_bound(tests_table):
    """The test that never overturned may be the largest effect of all; it must not be left out."""
    tests = tests_table(1)
    lone, _ = tests.index[(tests["object"] == "T2") & (tests["motion"] == "Northridge-F5")]
    columns = ["lower_g", "upper_g", "amplitude_g", "censored"]
    tests.loc[lone, columns] = [2.0, np.nan, np.nan, "right"]
    study = study_pedestal(tests, seed=1)
    with_it = study.effects.iloc[0]
    assert (with_it["pairs"], with_it["at_bound"]) == (36, 1)
    pairs = study.pairs.table
    without = mean_effect(pairs[pairs["bound"] == ""])
    assert with_it["ratio"] < without.ratio
    bound = pairs.loc[pairs["bound"] != ""].iloc[0]
    assert bound["bound"] == "at most"
    assert any("T2/Northridge-F5 at most" in note for note in study.notes)


def test_pair_of_two_unfinished_tests_is_left_out_and_named(tests_table):
    tests = tests_table(1)
    both = (tests["object"] == "T2") & (tests["motion"] == "Northridge-F5")
    tests.loc[both, ["upper_g", "amplitude_g"]] = np.nan
    tests.loc[both, "censored"] = "right"
    pairs = pair_tests(tests)
    assert len(pairs.table) == 35
    assert any("both tests are unfinished (T2/Northridge-F5)" in note for note in pairs.notes())


def test_units_that_all_jump_alike_are_not_certain_beyond_what_the_steps_allow():
    effect = t_estimate([0.1, 0.1, 0.1, 0.1], resolution=0.05)
    assert 0 < effect.p < 0.05
    assert effect.lower == pytest.approx(0.05)


def test_every_scope_is_there_with_its_power(tests_table):
    study = study_pedestal(tests_table(1), slenderness={"T1": 3.0, "T2": 4.0, "T3": 5.0}, seed=1)
    counts = study.effects["scope"].value_counts().to_dict()
    assert counts == {"whole": 1, "floor": 3, "earthquake": 4, "object": 3, "cell": 9}
    assert (study.effects["lower"] <= study.effects["ratio"]).all()
    assert (study.effects["ratio"] <= study.effects["upper"]).all()
    assert (study.effects["p_holm"] >= study.effects["p"]).all()
    assert (study.effects["detectable_ratio"] > 1).all()
    assert (study.effects.loc[study.effects["scope"] == "cell", "smallest_p"] == 0.125).all()
    assert "4 are a sample" in study.notes[0] and "0.125" in study.notes[0]


def test_known_effect_is_recovered_by_every_estimator(tests_table):
    study = study_pedestal(
        tests_table(3, effect=0.2, sd_earthquake=0, sd_motion=0, sd_pair=0.02), seed=1
    )
    assert study.whole["estimate"].to_numpy() == pytest.approx(np.exp(0.2), rel=0.02)


def test_pedestal_that_never_moves_gives_one_up_to_the_steps(tests_table):
    tests = tests_table(1, effect=0, sd_earthquake=0, sd_motion=0, sd_pair=0)
    study = study_pedestal(tests.assign(upper_g=1.05 * tests["lower_g"]), seed=1)
    assert study.effects["ratio"].to_numpy() == pytest.approx(1, abs=1e-12)
    assert (study.effects["upper"] >= 1.05 - 1e-12).all()
    assert (study.effects["lower"] <= 1 / 1.05 + 1e-12).all()
    assert (study.effects["p"] == 1).all()
    # limits that agree between methods to three digits may all be the width of the steps
    with_limits = study.whole[study.whole["lower"].notna()]
    assert with_limits["remark"].str.contains("width of the steps").all()
    apart = study_pedestal(tests_table(1, sd_pair=0.3), seed=1).whole
    assert not apart["remark"].str.contains("width of the steps").any()


def test_one_earthquake_is_about_its_motions_only(tests_table):
    tests = tests_table(1)
    study = study_pedestal(tests[tests["earthquake"] == "Kobe"], seed=1)
    assert study.effects.loc[0, "unit"] == "motion"
    assert "not about other earthquakes" in study.notes[0]


def test_one_motion_gives_a_figure_without_an_interval(tests_table):
    tests = tests_table(1)
    study = study_pedestal(tests[tests["motion"] == "Kobe-GF"], seed=1)
    whole = study.effects.iloc[0]
    assert np.isfinite(whole["ratio"]) and np.isnan(whole["lower"]) and np.isnan(whole["p"])


def test_all_pairs_censored_gives_empty_tables_and_says_why(tests_table):
    tests = tests_table(1)
    tests["censored"] = "right"
    study = study_pedestal(tests, seed=1)
    assert study.effects.empty and "ratio" in study.effects
    assert "no pair has a known ratio" in study.notes[-1]
