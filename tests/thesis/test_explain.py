"""Effects of perturbed parameters by their pairs with the ideal model."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag_thesis.sensitivity_analysis.explain import explain


def sensitivity_analysis_table(effect=0.15):
    names = ["level", "object", "earthquake", "floor", "replicate"]
    sides = ((0.85, 0.80, 0.75), ("T1", "T2", "T3"), list("ABCD"), ("GF", "F3", "F5"), range(3))
    table = pd.MultiIndex.from_product(sides, names=names).to_frame(index=False)
    shift = table["level"].map({0.85: 0.0, 0.80: effect, 0.75: 2 * effect})
    sign = table["floor"].map({"GF": 1, "F3": -0.5, "F5": -0.5})
    d = sign * shift + np.random.default_rng(2).normal(0, 0.02, len(table))
    return table.assign(factor="restitution", reference=table["level"] == 0.85, ratio=np.exp(d))


def test_sensitivity_analysis_recovers_the_effect_of_a_level_by_floor():
    result = explain(sensitivity_analysis_table(0.15)).set_index(["level", "floor"])
    for level, factor in ((0.80, 1), (0.75, 2)):
        for floor, sign in (("GF", 1), ("F3", -0.5)):
            row = result.loc[(level, floor)]
            assert row["effect_lower"] < np.exp(sign * 0.15 * factor) < row["effect_upper"]
    assert result.loc[(0.80, "GF"), "judgement"] == "changes P/NP"
    assert result.loc[(0.85, "all"), "effect"] == 1.0


def test_sensitivity_analysis_pairs_with_the_reference_and_counts_what_is_left_out():
    table = sensitivity_analysis_table()
    gone = (table["level"] == 0.80) & (table["earthquake"] == "A") & (table["object"] == "T1")
    table.loc[gone, "ratio"] = np.nan
    row = explain(table).set_index(["level", "floor"]).loc[(0.80, "all")]
    assert (row["pairs"], row["left_out"]) == (33, 3)


def test_sensitivity_analysis_needs_one_reference_and_positive_ratios():
    table = sensitivity_analysis_table()
    with pytest.raises(InputError, match="0 reference levels"):
        explain(table.assign(reference=False))
    with pytest.raises(InputError, match=r"row 1: ratio is 0\.0"):
        explain(table.assign(ratio=0.0))
    with pytest.raises(InputError, match="floor missing"):
        explain(table.drop(columns="floor"))


def test_where_nothing_overturns_no_level_is_judged():
    table = sensitivity_analysis_table().assign(ratio=np.nan)
    assert explain(table).empty
