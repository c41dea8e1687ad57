"""The whole study of a table, and its degenerate cases."""

import numpy as np
import pytest

from rockfrag.pedestal import study_pedestal


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
