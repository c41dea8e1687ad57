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

NAN = math.nan


def table_of(*amplitudes: float, pedestal: str = "NP", fallen: str = "statue") -> pd.DataFrame:
    """Tests with these amplitudes; NaN never overturned up to 2 g, 0 at the first step of 0.1 g."""
    a = np.array(amplitudes)
    return pd.DataFrame(
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


@pytest.mark.parametrize(
    ("amplitudes", "headline", "numbers"),
    [
        ((0.5, NAN), "1 of 2 simulated tests overturns, at 0.50 g", "by up to 2.00 g: test 1."),
        ((NAN, NAN), "No simulated test overturns", ""),
        (
            (0.0, 0.0),
            "All 2 simulated tests overturn, at the first step",
            "known: test 0 and test 1.",
        ),
    ],
)
def test_amplitudes_are_spoken_of_where_something_overturned_after_the_first_step(
    amplitudes, headline, numbers
):
    finding = amplitudes_found(table_of(*amplitudes))
    assert finding.headline == headline
    assert numbers in finding.numbers


def test_only_what_stood_on_a_pedestal_can_be_said_to_have_fallen_from_it():
    assert "pedestal" not in amplitudes_found(table_of(0.5, 0.6)).said
    assert "never what it stood on" in amplitudes_found(table_of(0.5, pedestal="P")).said
    fallen = amplitudes_found(table_of(0.5, 0.6, pedestal="P", fallen="pedestal"))
    assert "What the object stood on fell first" in fallen.said


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
    assert objects_compared(means_of(low=0.6), slenderness) == []
    assert objects_compared(means_of(high=0.6, also=0.5), slenderness) == []
    assert objects_compared(means_of(high=NAN, low=NAN), slenderness) == []


def test_it_is_said_over_which_motions_means_are_taken():
    assert "5 motions of 6" in mean_sentence(means_of(a=0.5))
    assert "all 5 motions" in mean_sentence(means_of(a=0.5).assign(of=5))
    assert "no means" in mean_sentence(means_of(a=NAN).assign(motions=0))


def effects(lower: float, ratio: float, upper: float, **changes: object) -> pd.DataFrame:
    row = {"definition": "step_protocol", "scope": "whole", "level": "all", "pairs": 36}
    row |= {"unit": "earthquake", "units": 4, "ratio": ratio, "lower": lower, "upper": upper}
    row |= {"equivalent": False, "detectable_ratio": 1.2, "at_bound": 0}
    return pd.DataFrame([row | {"tied": 0, "resolution_ratio": 1.0} | changes])


BY_PAIR = effects(NAN, 1.1, NAN, pairs=1, units=1)
TIED = effects(0.98, 1.0, 1.02, tied=30, resolution_ratio=1.05)


@pytest.mark.parametrize(
    ("table", "headline", "more"),
    [
        (effects(1.05, 1.2, 1.4), "raises the overturning amplitude by 20.0 %", ""),
        (effects(0.7, 0.8, 0.9), "lowers the overturning amplitude by 20.0 %", ""),
        (effects(0.8, 1.1, 1.5), "not distinguishable from zero", ""),
        (effects(0.98, 1.01, 1.03, equivalent=True), "less than 10 %", ""),
        (BY_PAIR, "The pedestal raises the amplitude by 10.0 % in 1 pair", "there is no interval"),
        (BY_PAIR, "", "from 1 earthquake there is no interval"),
        (effects(1, 1, 1), "The amplitudes with and without pedestal are the same", ""),
        (
            effects(1.05, 1.2, 1.4, at_bound=3),
            "",
            "3 of which have one test that gives a bound only",
        ),
        (TIED, "", "30 of 36 pairs overturned in the same step"),
        (TIED, "", "hide effects below 5.0 %"),
        (effects(1, 1, 1).iloc[:0], "not known", ""),
    ],
)
def test_the_pedestal_has_an_effect_only_where_the_interval_excludes_none(table, headline, more):
    (found,) = pedestal_effect(table)
    assert headline in found.headline and more in found.said
    assert "nan" not in found.said
    same = found.headline.endswith("are the same")
    assert not same or ("[" not in found.said and "80 %" not in found.said)


def test_floors_are_compared_where_there_are_two():
    item = effects(0.9, 1.0, 1.1)
    floors = [effects(1.1, 1.2, 1.3, scope="floor", level=name) for name in ("cellar", "attic")]
    assert len(pedestal_effect(pd.concat([item, floors[0]]))) == 1
    found = pedestal_effect(pd.concat([item, *floors]))
    assert "all 2 floors" in found[1].headline


def validity(friction: list[float], force: list[float], sides: str = "") -> pd.DataFrame:
    """Tests without a pedestal, or with (P) and without one (N) as ``sides`` says."""
    pedestal = [{"P": "P", "N": "NP"}[side] for side in sides or "N" * len(friction)]
    return pd.DataFrame(
        {"pedestal": pedestal, "friction_demand": friction, "least_normal_force_n": force}
    )


def test_friction_counts_the_tests_that_need_more_than_a_usual_surface_has():
    found = model_allowed(validity([0.3, 0.5, 1.3, math.inf], [5, 5, 5, -1]))
    assert found.headline == "2 of 4 tests require a friction coefficient above 0.6"
    assert "0.30 to 1.30" in found.numbers
    assert "No friction would be enough in 1 of 4 tests" in found.numbers
    assert "would have lifted off in 1 of 4 tests" in found.numbers
    assert "inf" not in found.said


def test_what_friction_says_of_the_pedestal_is_said_where_both_sides_were_tested():
    found = model_allowed(validity([0.2, 0.3, 0.7, 1.4], [5, 5, 5, 5], "NNPP"))
    beyond = "All 2 tests with the pedestal require a friction coefficient above 0.6"
    assert found.headline == f"{beyond}, and none of 2 tests without"
    assert "with the pedestal 0.70 to 1.40" in found.numbers
    assert "without 0.20 to 0.30" in found.numbers


def resurrections(*counts: int) -> pd.DataFrame:
    return pd.DataFrame({"first_upper": 0.5, "resurrections": list(counts)})


def test_survival_windows_are_counted_over_the_ida_curves_that_overturn():
    definitions = ["first_overturning", "always_overturning"]
    tests = pd.DataFrame({"test": "a", "definition": definitions, "amplitude_g": [0.5, 1.0]})
    found = resurrections_found(resurrections(2, 0), tests)
    assert found.headline.startswith("Non-monotone response: in 1 of 2 analyses")
    assert "2.00 times" in found.numbers
    none = resurrections_found(resurrections(0, 0), tests)
    assert none.headline.startswith("Every motion stronger")
    standing = resurrections_found(resurrections(0).assign(first_upper=NAN), tests)
    assert standing.headline.startswith("Nothing overturns")


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
    only = "A peak base acceleration of 0.52 g overturns bust with 50 % probability"
    assert found.headline == only
    assert strength_found(curves(), "90 %") is None


@pytest.mark.parametrize(
    ("names", "overturned", "near", "headline", "sure"),
    [
        ("a", [1], [1.0], "the only motion overturns everything", "No outcome changes"),
        (
            *("aa", [0, 0], [0.0, 0.4], "the 2 motions overturn nothing"),
            "1 of 2 outcomes flips if the motion is scaled within ±10 %",
        ),
        (
            *("aabb", [1, 0, 1, 1], [1.0, 0.0, 0.9, 1.0]),
            *("1 (a) to 2 (b) of 2 motions overturn the object", "1 of 4 outcomes flips"),
        ),
    ],
)
def test_motions_as_recorded_say_what_overturns_and_which_outcomes_are_sensitive(
    names, overturned, near, headline, sure
):
    table = pd.DataFrame({"configuration": list(names), "fraction_near": near})
    found = recorded_found(table.assign(overturned=np.array(overturned, dtype=bool)))
    assert found.headline == f"At recorded strength {headline}"
    assert sure in found.text
