"""The whole study of a table, its degenerate cases, and the explanation study."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.pedestal import explain, study_pedestal

FAST = dict(seed=1)


def test_every_scope_is_there_with_its_power(tests_table):
    study = study_pedestal(tests_table(1), slenderness={"T1": 3.0, "T2": 4.0, "T3": 5.0}, **FAST)
    counts = study.effects["scope"].value_counts().to_dict()
    assert counts == {"whole": 1, "floor": 3, "event": 4, "object": 3, "cell": 9}
    assert (study.effects["lower"] <= study.effects["ratio"]).all()
    assert (study.effects["ratio"] <= study.effects["upper"]).all()
    assert (study.effects["p_holm"] >= study.effects["p"]).all()
    assert (study.effects["detectable_ratio"] > 1).all()
    assert (study.effects.loc[study.effects["scope"] == "cell", "smallest_p"] == 0.125).all()
    assert "4 are a sample" in study.notes[0] and "0.125" in study.notes[0]


def test_known_effect_is_recovered_by_every_estimator(tests_table):
    study = study_pedestal(
        tests_table(3, effect=0.2, sd_event=0, sd_motion=0, sd_pair=0.02), **FAST
    )
    assert study.whole["estimate"].to_numpy() == pytest.approx(np.exp(0.2), rel=0.02)
    intercept = study.mixed[study.mixed["formula"] == "d ~ 1"]["estimate"].item()
    assert intercept == pytest.approx(0.2, abs=0.02)


def test_pedestal_that_never_moves_gives_one_up_to_the_steps(tests_table):
    tests = tests_table(1, effect=0, sd_event=0, sd_motion=0, sd_pair=0)
    study = study_pedestal(tests.assign(upper_g=1.05 * tests["lower_g"]), **FAST)
    assert study.effects["ratio"].to_numpy() == pytest.approx(1, abs=1e-12)
    assert (study.effects["upper"] >= 1.05 - 1e-12).all()
    assert (study.effects["lower"] <= 1 / 1.05 + 1e-12).all()
    assert (study.effects["p"] == 1).all()
    assert any("no scatter" in note for note in study.notes)


def test_one_event_is_about_its_motions_only(tests_table):
    tests = tests_table(1)
    study = study_pedestal(tests[tests["event"] == "Kobe"], **FAST)
    assert study.effects.loc[0, "unit"] == "motion"
    assert "not about other earthquakes" in study.notes[0]


def test_one_motion_gives_a_figure_without_an_interval(tests_table):
    tests = tests_table(1)
    study = study_pedestal(tests[tests["motion"] == "Kobe-GF"], **FAST)
    whole = study.effects.iloc[0]
    assert np.isfinite(whole["ratio"]) and np.isnan(whole["lower"]) and np.isnan(whole["p"])


def test_all_pairs_censored_gives_empty_tables_and_says_why(tests_table):
    tests = tests_table(1)
    tests["censored"] = "right"
    study = study_pedestal(tests, **FAST)
    assert study.effects.empty and "ratio" in study.effects
    assert "no pair has a known ratio" in study.notes[-1]


def explanation_table(effect=0.15):
    rng = np.random.default_rng(2)
    rows = []
    for level, shift in ((0.85, 0.0), (0.80, effect), (0.75, 2 * effect)):
        for object_name in ("T1", "T2", "T3"):
            for event in "ABCD":
                for floor in ("GF", "F3", "F5"):
                    sign = 1 if floor == "GF" else -0.5
                    for replicate in range(3):
                        d = sign * shift + rng.normal(0, 0.02)
                        rows.append(
                            (
                                "restitution",
                                level,
                                level == 0.85,
                                object_name,
                                event,
                                floor,
                                replicate,
                                d,
                            )
                        )
    names = ["factor", "level", "reference", "object", "event", "floor", "replicate", "d"]
    table = pd.DataFrame(rows, columns=names)
    return table.assign(ratio=np.exp(table["d"])).drop(columns="d")


def test_explanation_recovers_the_effect_of_a_level_by_floor():
    result = explain(explanation_table(0.15)).set_index(["level", "floor"])
    for level, factor in ((0.80, 1), (0.75, 2)):
        for floor, sign in (("GF", 1), ("F3", -0.5)):
            row = result.loc[(level, floor)]
            assert row["effect_lower"] < np.exp(sign * 0.15 * factor) < row["effect_upper"]
    assert result.loc[(0.80, "GF"), "judgement"] == "changes P/NP"
    assert result.loc[(0.85, "all"), "effect"] == 1.0


def test_explanation_pairs_with_the_reference_and_counts_what_is_left_out():
    table = explanation_table()
    gone = (table["level"] == 0.80) & (table["event"] == "A") & (table["object"] == "T1")
    table.loc[gone, "ratio"] = np.nan
    row = explain(table).set_index(["level", "floor"]).loc[(0.80, "all")]
    assert (row["pairs"], row["left_out"]) == (33, 3)


def test_explanation_needs_one_reference_and_positive_ratios():
    table = explanation_table()
    with pytest.raises(InputError, match="0 reference levels"):
        explain(table.assign(reference=False))
    with pytest.raises(InputError, match=r"row 1: ratio is 0\.0"):
        explain(table.assign(ratio=0.0))
    with pytest.raises(InputError, match="floor missing"):
        explain(table.drop(columns="floor"))


def test_a_method_whose_limits_are_the_steps_says_so(tests_table):
    """Limits that agree between methods to three digits may all be the width of the steps."""
    tests = tests_table(1, effect=0, sd_event=0, sd_motion=0, sd_pair=0)
    tied = study_pedestal(tests.assign(upper_g=1.05 * tests["lower_g"]), **FAST).whole
    with_limits = tied[tied["lower"].notna()]
    assert with_limits["remark"].str.contains("width of the steps").all()
    apart = study_pedestal(tests_table(1, sd_pair=0.3), **FAST).whole
    assert not apart["remark"].str.contains("width of the steps").any()
