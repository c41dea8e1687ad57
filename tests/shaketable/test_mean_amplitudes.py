"""Means are compared over the same motions only."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.shaketable.definitions import mean_amplitudes


def table_of(amplitudes: dict[tuple[str, str], list[float]]) -> pd.DataFrame:
    """Tests of objects and sides by motions a, b, c … of the floor up, NaN where one never overturned."""
    rows = [
        {
            "configuration": f"{name} {side}",
            "object": name,
            "pedestal": side,
            "earthquake": "abc"[i],
            "floor": "up",
            "motion": f"{'abc'[i]}_up",
            "amplitude_g": value,
            "repetition": 1,
        }
        for (name, side), values in amplitudes.items()
        for i, value in enumerate(values)
    ]
    return pd.DataFrame(rows)


def means(table: pd.DataFrame, by: str) -> dict[str, float]:
    rows = table[table["by"] == by]
    return dict(zip(rows["configuration"], rows["mean_g"], strict=True))


def test_the_ratio_of_the_means_is_the_mean_ratio_of_the_pairs_that_both_overturned():
    # with its pedestal the vase survives the strongest motion: the mean of what is left would fall
    tests = table_of({("vase", "NP"): [0.4, 0.5, 1.5], ("vase", "P"): [0.5, 0.6, np.nan]})
    found = means(mean_amplitudes(tests), "configuration")
    expected = np.sqrt(0.5 / 0.4 * 0.6 / 0.5)
    assert found["vase P"] / found["vase NP"] == pytest.approx(expected)
    assert mean_amplitudes(tests)["motions"].tolist()[:2] == [2, 2]


def test_without_a_motion_that_overturned_everything_there_is_no_mean():
    tests = table_of({("vase", "NP"): [0.4, np.nan], ("jug", "NP"): [np.nan, 0.5]})
    found = mean_amplitudes(tests)
    rows = found[found["by"] == "configuration"]
    assert rows["mean_g"].isna().all()
    assert rows["motions"].tolist() == [0, 0]
    assert rows["of"].tolist() == [2, 2]


def test_floors_are_compared_over_the_same_records():
    tests = table_of({("vase", "NP"): [0.4, 0.5]})
    lower = tests.assign(floor="down", motion=["a_down", "b_down"], amplitude_g=[0.8, np.nan])
    found = mean_amplitudes(pd.concat([tests, lower], ignore_index=True))
    rows = found[found["by"] == "floor"].set_index("floor")["mean_g"]
    assert rows.to_dict() == pytest.approx({"up": 0.4, "down": 0.8})
