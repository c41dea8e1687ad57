"""What stands first on a page follows from the tables: how strong, what in a repeat, and how sure."""

import math
import re

import pandas as pd
import pytest

from rockfrag.report.findings import recorded_found, strength_found


def curves(**medians: tuple[float, float, float]) -> pd.DataFrame:
    rows = [
        {
            "configuration": name,
            "im": "peak base acceleration",
            "unit": "g",
            "estimator": "mean_probability",
            "theta": theta,
            "theta_lower": lower,
            "theta_upper": upper,
            "p_fit": 0.5,
            "theta_isotonic": 1.1 * theta,
            "theta_isotonic_lower": 1.1 * lower,
            "theta_isotonic_upper": 1.1 * upper,
        }
        for name, (lower, theta, upper) in medians.items()
    ]
    return pd.DataFrame(rows)


def numbers(text: str) -> set[str]:
    return set(re.findall(r"\d+(?:\.\d+)?", text))


def test_how_strong_it_must_be_names_the_least_and_the_largest_median_with_limits():
    table = curves(bust=(0.411, 0.523, 0.666), urn=(0.7, 0.8, 0.9))
    found = strength_found(table, "90 %")
    assert found.headline.endswith(
        "of 0.52 (bust) to 0.80 g (urn) to overturn in half of the cases"
    )
    assert "with 90 % intervals" in found.text
    assert "bust 0.52 [0.41, 0.67], urn 0.80 [0.70, 0.90] g" in found.text
    assert numbers(found.said) == {"0.52", "0.80", "90", "0.41", "0.67", "0.70", "0.90"}


def test_where_the_lognormal_curve_is_rejected_the_median_is_that_of_the_curve_without_a_form():
    table = curves(bust=(0.4, 0.5, 0.6), urn=(0.7, 0.8, 0.9))
    found = strength_found(table.assign(p_fit=[0.01, 0.5]), "90 %")
    assert "bust 0.55 [0.44, 0.66], urn 0.80 [0.70, 0.90] g" in found.text
    assert found.text.endswith(
        "For bust a lognormal curve does not describe the tests: the median is that of a curve without a form."
    )
    assert "of 0.55 (bust) to 0.80 g (urn)" in found.headline


def test_without_limits_no_interval_is_spoken_of():
    found = strength_found(curves(bust=(math.nan, 0.523, math.nan)), "90 %")
    assert "interval" not in found.said and "[" not in found.said
    assert found.headline == (
        "It takes a peak base acceleration of 0.52 g to overturn in half of the cases"
    )
    assert strength_found(curves(), "90 %") is None


def recorded(*cases: tuple[str, str, bool, float]) -> pd.DataFrame:
    return pd.DataFrame(cases, columns=["configuration", "motion", "overturned", "share_near"])


@pytest.mark.parametrize(
    ("table", "headline", "sure"),
    [
        (
            recorded(("a", "x", True, 1.0)),
            "In a repeat the one motion overturns everything",
            "None",
        ),
        (
            recorded(("a", "x", False, 0.0), ("a", "y", False, 0.4)),
            "In a repeat each of 2 motions overturns nothing",
            "1 of 2 verdicts depends on the exact strength",
        ),
        (
            recorded(
                ("a", "x", True, 1.0),
                ("a", "y", False, 0.0),
                ("b", "x", True, 0.9),
                ("b", "y", True, 1),
            ),
            "In a repeat of 2 motions there fall a under 1 and b under 2",
            "1 of 4 verdicts depends",
        ),
    ],
)
def test_a_repeat_says_what_falls_and_which_verdicts_are_near(table, headline, sure):
    found = recorded_found(table)
    assert found.headline == headline
    assert sure in found.text
