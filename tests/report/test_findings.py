"""Each headline of a report follows from the numbers, and is not said without them."""

import math
import re

import numpy as np
import pandas as pd
import pytest

from rockfrag.report.findings import (
    amplitudes_found,
    mean_sentence,
    model_allowed,
    objects_compared,
    pedestal_effect,
    recorded_found,
    resurrections_found,
    strength_found,
)

from ..case_tables import case_tables

NAN = math.nan
CASES = case_tables(__file__)


@pytest.mark.parametrize(
    ("amplitudes", "pedestal", "fallen", "headline", "more"), CASES["amplitudes"]
)
def test_what_overturned_is_said_with_what_is_not_known(
    amplitudes, pedestal, fallen, headline, more
):
    a = np.array(amplitudes)
    table = pd.DataFrame(
        {
            "test": [f"test {number}" for number in range(a.size)],
            "object": "figure",
            "pedestal": pedestal,
            "amplitude_g": np.where(a > 0, a, NAN),
            "lower_g": np.where(np.isnan(a), 2.0, a),
            "upper_g": np.where(np.isnan(a), NAN, np.maximum(1.05 * a, 0.1)),
            "overturned_body": np.where(np.isnan(a), "", fallen),
        }
    )
    found = amplitudes_found(table)
    assert found.headline == headline and more in found.said
    assert pedestal == "P" or "pedestal" not in found.said


def means_of(**objects: float) -> pd.DataFrame:
    means = pd.DataFrame({"object": list(objects), "mean_g": list(objects.values())})
    about = {"by": "configuration", "pedestal": "NP", "motions": 5, "of": 6}
    return means.assign(configuration=means["object"], **about)


def test_slenderness_is_spoken_of_only_where_objects_differ_in_it():
    slenderness = {"low": 2.0, "high": 5.0, "also": 5.0}
    (found,) = objects_compared(means_of(high=0.3, low=0.6), slenderness)
    assert found.headline == "More slender objects overturn at lower amplitudes"
    assert "low 0.600 g and high 0.300 g" in found.numbers
    (found,) = objects_compared(means_of(high=0.7, low=0.6), slenderness)
    assert "not simply follow" in found.headline
    for alike in ({"low": 0.6}, {"high": 0.6, "also": 0.5}, {"high": NAN, "low": NAN}):
        assert objects_compared(means_of(**alike), slenderness) == []


def test_it_is_said_over_which_motions_means_are_taken():
    assert "5 motions of 6" in mean_sentence(means_of(a=0.5))
    assert "all 5 motions" in mean_sentence(means_of(a=0.5).assign(of=5))
    assert "no means" in mean_sentence(means_of(a=NAN).assign(motions=0))


def effects(limits: list[float], **changes: object) -> pd.DataFrame:
    row = {"definition": "step_protocol", "scope": "whole", "level": "all", "pairs": 36}
    row |= dict(zip(("lower", "ratio", "upper"), limits, strict=True))
    row |= {"unit": "earthquake", "units": 4, "equivalent": False, "detectable_ratio": 1.2}
    return pd.DataFrame([row | {"at_bound": 0, "tied": 0, "resolution_ratio": 1.0} | changes])


@pytest.mark.parametrize(("limits", "changes", "headline", "more"), CASES["effects"])
def test_the_pedestal_has_an_effect_only_where_the_interval_excludes_none(
    limits, changes, headline, more
):
    (found,) = pedestal_effect(effects(limits, **changes))
    assert headline in found.headline and more in found.said
    assert "nan" not in found.said
    same = found.headline.endswith("are the same")
    assert not same or ("[" not in found.said and "80 %" not in found.said)


def test_floors_are_compared_where_there_are_two():
    item = effects([0.9, 1.0, 1.1])
    assert "not known" in pedestal_effect(item.iloc[:0])[0].headline
    floors = [effects([1.1, 1.2, 1.3], scope="floor", level=name) for name in ("cellar", "attic")]
    assert len(pedestal_effect(pd.concat([item, floors[0]]))) == 1
    assert "all 2 floors" in pedestal_effect(pd.concat([item, *floors]))[1].headline


def test_friction_counts_the_tests_that_need_more_than_a_usual_surface_has():
    needed = {"friction_demand": [0.3, 0.5, 1.3, math.inf], "least_normal_force_n": [5, 5, 5, -1]}
    found = model_allowed(pd.DataFrame(needed).assign(pedestal="NP"))
    assert found.headline == "2 of 4 tests require a friction coefficient above 0.6"
    assert "0.30 to 1.30" in found.numbers
    assert "No friction would be enough in 1 of 4 tests" in found.numbers
    assert "would have lifted off in 1 of 4 tests" in found.numbers
    assert "inf" not in found.said
    # what it says of the pedestal is said where both sides were tested
    needed = {"friction_demand": [0.2, 0.3, 0.7, 1.4], "pedestal": ["NP", "NP", "P", "P"]}
    found = model_allowed(pd.DataFrame(needed).assign(least_normal_force_n=5))
    beyond = "All 2 tests with the pedestal require a friction coefficient above 0.6"
    assert found.headline == f"{beyond}, and none of 2 tests without"
    assert "with the pedestal 0.70 to 1.40" in found.numbers
    assert "without 0.20 to 0.30" in found.numbers


def test_survival_windows_are_counted_over_the_ida_curves_that_overturn():
    definitions = ["first_overturning", "always_overturning"]
    tests = pd.DataFrame({"test": "a", "definition": definitions, "amplitude_g": [0.5, 1.0]})
    windows = pd.DataFrame({"first_upper": 0.5, "resurrections": [2, 0]})
    found = resurrections_found(windows, tests)
    assert found.headline.startswith("Non-monotone response: in 1 of 2 analyses")
    assert "2.00 times" in found.numbers
    none = resurrections_found(windows.assign(resurrections=0), tests)
    assert none.headline.startswith("Every motion stronger")
    standing = resurrections_found(windows.assign(first_upper=NAN), tests)
    assert standing.headline.startswith("Nothing overturns")


def curves(**medians: tuple[float, float, float]) -> pd.DataFrame:
    table = pd.DataFrame(medians.values(), columns=["theta_lower", "theta", "theta_upper"])
    isotonic = 1.1 * table.rename(columns=lambda name: name.replace("theta", "theta_isotonic"))
    about = {"im": "peak base acceleration", "unit": "g", "estimator": "mean_probability"}
    return table.join(isotonic).assign(configuration=list(medians), p_fit=0.5, **about)


def test_the_weakest_is_named_first_and_the_other_medians_stand_behind_a_click():
    table = curves(bust=(0.411, 0.523, 0.666), urn=(0.7, 0.8, 0.9))
    found = strength_found(table, "90 %")
    assert found.headline.startswith("bust is the most fragile: a peak base acceleration of 0.52 g")
    assert found.headline.endswith("urn needs 0.80 g")
    assert "with 90 % intervals" in found.numbers
    assert "bust 0.52 [0.41, 0.67], urn 0.80 [0.70, 0.90]" in found.numbers
    assert "lognormal curves" in found.numbers and "nonparametric" not in found.numbers
    assert "[" not in found.shown
    numbers = set(re.findall(r"\d+(?:\.\d+)?", found.said))
    assert numbers == {"0.52", "0.80", "50", "90", "0.41", "0.67", "0.70", "0.90"}


def test_one_estimator_serves_all_configurations_of_a_comparison():
    # one rejected curve changes the estimator of all, or the list would compare estimators
    table = curves(bust=(0.4, 0.5, 0.6), urn=(0.7, 0.8, 0.9)).assign(p_fit=[0.01, 0.5])
    found = strength_found(table, "90 %")
    assert "bust 0.55 [0.44, 0.66], urn 0.88 [0.77, 0.99]" in found.numbers
    assert "rejected for bust" in found.numbers
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
    found = strength_found(curves(bust=(NAN, 0.523, NAN)), "90 %")
    assert "interval" not in found.said and "[" not in found.said
    only = "A peak base acceleration of 0.52 g overturns bust with 50 % probability"
    assert found.headline == only
    assert strength_found(pd.DataFrame(), "90 %") is None


@pytest.mark.parametrize(("names", "overturned", "near", "headline", "sure"), CASES["recorded"])
def test_motions_as_recorded_say_what_overturns_and_which_outcomes_are_sensitive(
    names, overturned, near, headline, sure
):
    table = pd.DataFrame({"configuration": list(names), "fraction_near": near})
    found = recorded_found(table.assign(overturned=overturned))
    assert found.headline == f"At recorded strength {headline}"
    assert sure in found.text
