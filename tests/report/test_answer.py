"""What stands first on a page follows from the tables: how strong, what in a repeat, and how sure."""

import math
import re

import pandas as pd
import pytest

from rockfrag.report.findings import recorded_found, strength_found


def curves(**medians: tuple[float, float, float]) -> pd.DataFrame:
    if not medians:
        return pd.DataFrame()
    table = pd.DataFrame(medians.values(), columns=["theta_lower", "theta", "theta_upper"])
    table = table.join(
        1.1 * table.rename(columns=lambda name: name.replace("theta", "theta_isotonic"))
    )
    about = {"im": "peak base acceleration", "unit": "g", "estimator": "mean_probability"}
    return table.assign(configuration=list(medians), p_fit=0.5, **about)


def numbers(text: str) -> set[str]:
    return set(re.findall(r"\d+(?:\.\d+)?", text))


def test_how_strong_it_must_be_names_the_weakest_first_and_keeps_the_other_medians_behind_a_click():
    table = curves(bust=(0.411, 0.523, 0.666), urn=(0.7, 0.8, 0.9))
    found = strength_found(table, "90 %")
    assert found.headline.startswith("bust is the most fragile: a peak base acceleration of 0.52 g")
    assert found.headline.endswith("urn needs 0.80 g")
    assert "with 90 % intervals" in found.numbers
    assert "bust 0.52 [0.41, 0.67], urn 0.80 [0.70, 0.90]" in found.numbers
    assert "[" not in found.shown
    assert numbers(found.said) == {"0.52", "0.80", "50", "90", "0.41", "0.67", "0.70", "0.90"}


def test_one_estimator_serves_all_configurations_of_a_comparison():
    table = curves(bust=(0.4, 0.5, 0.6), urn=(0.7, 0.8, 0.9))
    plain = strength_found(table, "90 %")
    assert "lognormal curves" in plain.numbers and "nonparametric" not in plain.numbers
    # one rejected curve changes the estimator of all, or the list would compare estimators
    found = strength_found(table.assign(p_fit=[0.01, 0.5]), "90 %")
    assert "bust 0.55 [0.44, 0.66], urn 0.88 [0.77, 0.99]" in found.numbers
    assert "rejected for bust" in found.numbers


def test_the_estimator_cannot_turn_the_order_of_two_bodies_round():
    # lognormal and nonparametric medians of both have the same order; a choice body by body has not
    table = curves(slender=(0.3, 0.40, 0.5), squat=(0.4, 0.47, 0.6)).assign(
        theta_isotonic=[0.32, 0.39], p_fit=[0.07, 0.01]
    )
    assert strength_found(table, "90 %").headline.startswith("slender is the most fragile")


def test_objects_that_no_shown_digit_tells_apart_are_named_together():
    table = curves(bust=(0.1, 0.3428, 0.9), torso=(0.1, 0.3429, 0.9), chest=(0.3, 0.6, 0.9))
    found = strength_found(table, "90 %")
    assert found.headline.startswith("bust and torso are the most fragile: ")
    assert "overturns them with 50 % probability, while chest needs 0.60 g" in found.headline


def test_without_limits_no_interval_is_spoken_of():
    found = strength_found(curves(bust=(math.nan, 0.523, math.nan)), "90 %")
    assert "interval" not in found.said and "[" not in found.said
    assert (
        found.headline == "A peak base acceleration of 0.52 g overturns bust with 50 % probability"
    )
    assert strength_found(curves(), "90 %") is None


def recorded(*cases: tuple[str, str, bool, float]) -> pd.DataFrame:
    return pd.DataFrame(cases, columns=["configuration", "motion", "overturned", "fraction_near"])


@pytest.mark.parametrize(
    ("table", "headline", "sure"),
    [
        (
            recorded(("a", "x", True, 1.0)),
            "At recorded strength the only motion overturns everything",
            "No outcome changes",
        ),
        (
            recorded(("a", "x", False, 0.0), ("a", "y", False, 0.4)),
            "At recorded strength the 2 motions overturn nothing",
            "1 of 2 outcomes flips if the motion is scaled within ±10 %",
        ),
        (
            recorded(
                ("a", "x", True, 1.0),
                ("a", "y", False, 0.0),
                ("b", "x", True, 0.9),
                ("b", "y", True, 1),
            ),
            "At recorded strength 1 (a) to 2 (b) of 2 motions overturn the object",
            "1 of 4 outcomes flips",
        ),
    ],
)
def test_motions_as_recorded_say_what_overturns_and_which_outcomes_are_sensitive(
    table, headline, sure
):
    found = recorded_found(table)
    assert found.headline == headline
    assert sure in found.text
