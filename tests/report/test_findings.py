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
from rockfrag.report.sections.pedestal import level_in_words

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
    row |= {
        "unit": "earthquake",
        "units": 4,
        "equivalent": False,
        "detectable_ratio": 1.2,
    }
    return pd.DataFrame(
        [row | {"at_bound": 0, "tied": 0, "resolution_ratio": 1.0} | changes]
    )


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
    floors = [
        effects([1.1, 1.2, 1.3], scope="floor", level=name)
        for name in ("cellar", "attic")
    ]
    assert len(pedestal_effect(pd.concat([item, floors[0]]))) == 1
    assert "all 2 floors" in pedestal_effect(pd.concat([item, *floors]))[1].headline


def test_friction_counts_the_tests_that_need_more_than_a_usual_surface_has():
    needed = {
        "friction_demand": [0.3, 0.5, 1.3, math.inf],
        "least_normal_force_n": [5, 5, 5, -1],
    }
    found = model_allowed(pd.DataFrame(needed).assign(pedestal="NP"))
    assert found.headline == "2 of 4 tests require a friction coefficient above 0.6"
    assert "0.30 to 1.30" in found.numbers
    assert "No friction would be enough in 1 of 4 tests" in found.numbers
    assert "would have lifted off in 1 of 4 tests" in found.numbers
    assert "inf" not in found.said
    # what it says of the pedestal is said where both sides were tested
    needed = {
        "friction_demand": [0.2, 0.3, 0.7, 1.4],
        "pedestal": ["NP", "NP", "P", "P"],
    }
    found = model_allowed(pd.DataFrame(needed).assign(least_normal_force_n=5))
    beyond = "All 2 tests with the pedestal require a friction coefficient above 0.6"
    assert found.headline == f"{beyond}, and none of 2 tests without"
    assert "with the pedestal 0.70 to 1.40" in found.numbers
    assert "without 0.20 to 0.30" in found.numbers


def test_survival_windows_are_counted_over_the_ida_curves_that_overturn():
    definitions = ["first_overturning", "always_overturning"]
    tests = pd.DataFrame(
        {"test": "a", "definition": definitions, "amplitude_g": [0.5, 1.0]}
    )
    windows = pd.DataFrame({"first_upper": 0.5, "resurrections": [2, 0]})
    found = resurrections_found(windows, tests)
    assert found.headline.startswith("Non-monotone response: in 1 of 2 analyses")
    assert "2.00 times" in found.numbers
    none = resurrections_found(windows.assign(resurrections=0), tests)
    assert none.headline.startswith("Every motion stronger")
    standing = resurrections_found(windows.assign(first_upper=NAN), tests)
    assert standing.headline.startswith("Nothing overturns")


def curves(**medians: tuple[float, float, float]) -> pd.DataFrame:
    table = pd.DataFrame(
        medians.values(), columns=["theta_lower", "theta", "theta_upper"]
    )
    isotonic = 1.1 * table.rename(
        columns=lambda name: name.replace("theta", "theta_isotonic")
    )
    about = {
        "im": "peak base acceleration",
        "unit": "g",
        "estimator": "mean_probability",
    }
    return table.join(isotonic).assign(configuration=list(medians), p_fit=0.5, **about)


@pytest.mark.parametrize(
    ("medians", "changes", "begins", "holds", "lacks"), CASES["strength"]
)
def test_the_weakest_is_named_first_and_medians_stand_behind_a_click(
    medians, changes, begins, holds, lacks
):
    found = strength_found(curves(**medians).assign(**changes), "90 %")
    assert found.headline.startswith(begins)
    assert [words for words in holds if words not in found.said] == []
    assert [words for words in lacks if words in found.said] == []
    assert "[" not in found.shown
    shown = set(re.findall(r"\d+\.\d+", found.said))
    values = [x for ends in (*medians.values(), *changes.values()) for x in ends]
    assert shown <= {f"{k * x:.2f}" for x in values for k in (1, 1.1)}


def test_without_a_curve_nothing_is_said_of_strength():
    assert strength_found(pd.DataFrame(), "90 %") is None


@pytest.mark.parametrize(
    ("names", "overturned", "near", "headline", "sure"), CASES["recorded"]
)
def test_motions_as_recorded_say_what_overturns_and_which_outcomes_are_sensitive(
    names, overturned, near, headline, sure
):
    table = pd.DataFrame({"configuration": list(names), "fraction_near": near})
    found = recorded_found(table.assign(overturned=overturned))
    assert found.headline == f"At recorded strength {headline}"
    assert sure in found.text


def test_a_slash_parts_floor_and_object_and_stays_in_the_name_of_an_earthquake():
    name = "Loma Prieta, 10/18/1989"
    assert level_in_words(name, "earthquake") == name
    assert level_in_words("hall/vase", "cell") == "hall, vase"
    assert level_in_words("all", "whole") == "all pairs"
