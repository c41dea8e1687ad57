"""Tests become pairs, and what cannot be paired is said."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.pedestal.paired_tests import pair_tests, with_counterparts


def test_thesis_design_gives_36_pairs_in_12_motions_of_4_earthquakes(tests_table):
    tests = tests_table(1)
    pairs = pair_tests(tests)
    assert len(pairs.table) == 36
    assert pairs.table["motion"].nunique() == 12
    assert pairs.table["earthquake"].nunique() == 4
    assert pairs.notes() == []
    amplitudes = tests.set_index(["object", "motion", "pedestal"])["amplitude_g"]
    ratio = amplitudes["T2", "Kobe-F3", "P"] / amplitudes["T2", "Kobe-F3", "NP"]
    d = pairs.table.set_index(["object", "motion"]).loc[("T2", "Kobe-F3"), "d"]
    assert d == pytest.approx(np.log(ratio), abs=1e-14)
    shuffled = pair_tests(tests.sample(frac=1, random_state=3))
    pd.testing.assert_frame_equal(pairs.table, shuffled.table)


def test_an_arrangement_is_paired_with_the_one_that_it_names(tests_table):
    alone = tests_table(1).query("pedestal == 'NP'")
    arranged = {
        name: alone.assign(configuration=name, pedestal=side, amplitude_g=f * alone["amplitude_g"])
        for name, side, f in (("alone", "NP", 1.0), ("plinth", "P", 2.0), ("base", "P", 6.0))
    }
    tests = pd.concat(
        [rows[rows["object"] == "T1"] for rows in arranged.values()], ignore_index=True
    ).drop(columns=["lower_g", "upper_g"], errors="ignore")
    named, origin = with_counterparts(tests, {"base": "plinth"})
    assert origin == {"base against plinth": "T1"}
    pairs = pair_tests(named, {"T1": 3.0, "base against plinth": 3.0}).table
    ratio = np.exp(pairs.groupby("object")["d"].agg(["min", "max"]))
    np.testing.assert_allclose(ratio.loc["T1"], 2.0)
    np.testing.assert_allclose(ratio.loc["base against plinth"], 3.0)


def test_missing_partner_is_left_out_and_named(tests_table):
    tests = tests_table(1).iloc[1:]
    pairs = pair_tests(tests)
    assert len(pairs.table) == 35
    assert pairs.unpaired["missing"].tolist() == ["NP"]
    assert "T1/Friuli-GF without NP" in pairs.notes()[0]


@pytest.mark.parametrize(
    ("censored", "lower", "upper", "bound", "limits"),
    [
        ("right", 0.6, np.nan, "at least", ("d", np.inf)),
        ("none", 0.0, 0.6, "at most", (-np.inf, "d")),
    ],
)
def test_censored_side_bounds_the_log_ratio(tests_table, censored, lower, upper, bound, limits):
    """On a pedestal that never overturned, or did at its first step."""
    tests = tests_table(1)
    lone, on = tests.index[(tests["object"] == "T1") & (tests["motion"] == "Kobe-GF")]
    values = [censored, lower, upper, np.nan]
    tests.loc[on, ["censored", "lower_g", "upper_g", "amplitude_g"]] = values
    pairs = pair_tests(tests)
    item = pairs.table.set_index(["object", "motion"]).loc["T1", "Kobe-GF"]
    d = np.log(0.6 / tests.loc[lone, "amplitude_g"])
    assert len(pairs.table) == 36 and item["bound"] == bound
    assert (item["d"], item["a_p_g"]) == pytest.approx((d, 0.6))
    expected = [d if limit == "d" else limit for limit in limits]
    assert pairs.censored.iloc[0][["d_lower", "d_upper"]].tolist() == pytest.approx(expected)
    assert "never" in pairs.notes()[0]


def test_repetitions_are_averaged_in_the_logarithm(tests_table):
    tests = tests_table(1)
    again = tests.iloc[[0]].assign(repetition=2, amplitude_g=tests["amplitude_g"].iloc[0] * 1.21)
    again["lower_g"] = again["upper_g"] = again["amplitude_g"]
    both = pair_tests(pd.concat([tests, again])).table
    alone = pair_tests(tests).table
    ratio = both["a_np_g"] / alone["a_np_g"]
    assert ratio.max() == pytest.approx(1.1)
    assert np.count_nonzero(ratio != 1) == 1


def cell(column, value):
    """Exchange one cell of a table."""
    return lambda t: t.assign(**{column: t[column].astype(object).where(t.index != 5, value)})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        *((cell("amplitude_g", a), f"amplitude_g is {a}") for a in (np.nan, 0.0, -0.2, np.inf)),
        (cell("pedestal", "yes"), "pedestal is 'yes'"),
        (cell("censored", "up"), "censored is 'up'"),
        (cell("earthquake", None), "earthquake is empty"),
        (cell("object", "T9"), "slenderness of object T9"),
        (cell("lower_g", 9.0), "exceeds upper_g"),
        (lambda t: pd.concat([t, t.iloc[[3]]]), "row 73: the same test as row 4"),
        (lambda t: t.assign(definition=["first", *["step"] * 71]), "several definitions"),
        (lambda t: t[t["pedestal"] == "P"], "with and without pedestal"),
        (lambda t: t.drop(columns="floor"), "floor missing"),
        (lambda t: t.iloc[:0], "no rows"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_sentence(tests_table, change, words):
    with pytest.raises(InputError, match=words):
        pair_tests(change(tests_table(1)), {"T1": 3.0, "T2": 4.0, "T3": 5.0})


def test_each_pedestal_of_an_object_is_paired_with_the_lone_object(tests_table):
    tests = tests_table(1)
    tests["configuration"] = np.where(
        tests["pedestal"] == "P", "P&" + tests["object"], tests["object"]
    )
    wider = tests[(tests["pedestal"] == "P") & (tests["object"] == "T2")]
    other = wider.assign(configuration="Q&T2", amplitude_g=2 * wider["amplitude_g"])
    other = other.assign(lower_g=other["amplitude_g"], upper_g=other["amplitude_g"])
    slenderness = {"T1": 3.0, "T2": 4.0, "T3": 5.0}
    pairs = pair_tests(pd.concat([tests, other]), slenderness).table
    assert len(pairs) == 48
    means = pairs.groupby("object")["d"].mean()
    assert means["Q&T2"] == pytest.approx(means["P&T2"] + np.log(2))
    assert set(pairs.loc[pairs["object"] == "Q&T2", "slenderness"]) == {4.0}
