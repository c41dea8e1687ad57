"""Each headline of a report follows from the numbers, and is not said without them."""

import math

import numpy as np
import pandas as pd
import pytest

from rockfrag.report.findings import (
    amplitudes_found,
    mean_sentence,
    model_allowed,
    objects_compared,
    pedestal_effect,
    windows_found,
)

NAN = math.nan


def table_of(*amplitudes: float, pedestal: str = "NP", fallen: str = "statue") -> pd.DataFrame:
    """Tests with these amplitudes; NaN never overturned up to 2 g, 0 at the first step of 0.1 g."""
    a = np.array(amplitudes)
    return pd.DataFrame(
        {
            "test": [f"test {number}" for number in range(a.size)],
            "pedestal": pedestal,
            "amplitude_g": np.where(a > 0, a, NAN),
            "lower_g": np.where(np.isnan(a), 2.0, a),
            "upper_g": np.where(np.isnan(a), NAN, np.maximum(1.05 * a, 0.1)),
            "overturned_body": np.where(np.isnan(a), "", fallen),
        }
    )


def test_tests_that_never_overturned_are_named_with_the_amplitude_that_they_survived():
    finding = amplitudes_found(table_of(0.5, NAN))
    assert finding.headline == "1 of 2 simulated tests has an overturning amplitude"
    assert "Not overturned, up to 2.00 g at most: test 1." in finding.text
    assert "is 0.50 g" in finding.text


def test_where_nothing_overturned_no_amplitude_is_spoken_of():
    finding = amplitudes_found(table_of(NAN, NAN))
    assert finding.headline == "Nothing overturned"
    assert "lies between" not in finding.text


def test_overturning_at_the_first_step_is_no_amplitude():
    finding = amplitudes_found(table_of(0.0, 0.0))
    assert finding.headline == "No test has an overturning amplitude"
    assert "Overturned at the first step already: test 0 and test 1." in finding.text


def test_only_what_stood_on_a_pedestal_can_be_said_to_have_fallen_from_it():
    assert "pedestal" not in amplitudes_found(table_of(0.5, 0.6)).text
    assert "never the pedestal" in amplitudes_found(table_of(0.5, pedestal="P")).text
    fallen = amplitudes_found(table_of(0.5, 0.6, pedestal="P", fallen="pedestal"))
    assert "it was the pedestal that fell" in fallen.text


def means_of(**objects: float) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "by": "configuration",
            "configuration": list(objects),
            "object": list(objects),
            "pedestal": "NP",
            "mean_g": list(objects.values()),
            "motions": 5,
            "of": 6,
        }
    )


def test_slenderness_is_spoken_of_only_where_objects_differ_in_it():
    slenderness = {"low": 2.0, "high": 5.0, "also": 5.0}
    (found,) = objects_compared(means_of(high=0.3, low=0.6), slenderness)
    assert found.headline == "More slender objects overturn earlier"
    assert "low 0.600 g and high 0.300 g" in found.text
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
    row = {
        "reading": "step_protocol",
        "scope": "whole",
        "level": "all",
        "pairs": 36,
        "unit": "event",
        "units": 4,
        "ratio": ratio,
        "lower": lower,
        "upper": upper,
        "equivalent": False,
        "detectable_ratio": 1.2,
        "at_bound": 0,
        "tied": 0,
        "resolution_ratio": 1.0,
        **changes,
    }
    return pd.DataFrame([row])


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (effects(1.05, 1.2, 1.4), "raises the overturning amplitude by 20.0 %"),
        (effects(0.7, 0.8, 0.9), "lowers the overturning amplitude by 20.0 %"),
        (effects(0.8, 1.1, 1.5), "cannot be told from none"),
        (effects(0.98, 1.01, 1.03, equivalent=True), "less than 10 %"),
        (effects(NAN, 1.1, NAN, pairs=1, units=1), "In 1 pair the pedestal raises"),
        (effects(1.0, 1.0, 1.0), "the amplitudes are the same"),
    ],
)
def test_the_pedestal_has_an_effect_only_where_the_interval_excludes_none(
    table: pd.DataFrame, words: str
):
    (found,) = pedestal_effect(table)
    assert words in found.headline
    assert "nan" not in found.text


def test_without_an_interval_it_is_said_why():
    (found,) = pedestal_effect(effects(NAN, 1.1, NAN, pairs=1, units=1))
    assert "from 1 event there is no interval" in found.text
    (found,) = pedestal_effect(effects(1.0, 1.0, 1.0))
    assert "[" not in found.text
    assert "80 %" not in found.text


def test_pairs_that_give_a_bound_only_are_counted():
    (found,) = pedestal_effect(effects(1.05, 1.2, 1.4, at_bound=3))
    assert "3 of which with one test that gives a bound only" in found.text


def test_what_the_steps_hide_is_said():
    (found,) = pedestal_effect(effects(0.98, 1.0, 1.02, tied=30, resolution_ratio=1.05))
    assert "30 of 36 pairs overturned in the same step" in found.text
    assert "below 5.0 % are hidden" in found.text


def test_without_any_pair_the_effect_is_not_known():
    (found,) = pedestal_effect(effects(1, 1, 1).iloc[:0])
    assert "not known" in found.headline


def test_floors_are_compared_where_there_are_two():
    one = effects(0.9, 1.0, 1.1)
    floors = [effects(1.1, 1.2, 1.3, scope="floor", level=name) for name in ("cellar", "attic")]
    assert len(pedestal_effect(pd.concat([one, floors[0]]))) == 1
    found = pedestal_effect(pd.concat([one, *floors]))
    assert "all 2 floors" in found[1].headline


def validity(friction: list[float], force: list[float]) -> pd.DataFrame:
    return pd.DataFrame({"friction_demand": friction, "least_normal_force_n": force})


def test_friction_counts_the_tests_that_a_usual_surface_would_hold():
    (found,) = model_allowed(validity([0.3, 0.5, 1.3, math.inf], [5, 5, 5, -1]))
    assert "2 of 4 tests would rock without sliding" in found.headline
    assert "between 0.30 and 1.30" in found.text
    assert "In 1 of 4 tests no friction would be enough" in found.text
    assert "In 1 of 4 tests a block would have lifted off" in found.text
    assert "inf" not in found.text
    assert model_allowed(validity([], [])) == []


def windows(*counts: int) -> pd.DataFrame:
    return pd.DataFrame({"first_upper": 0.5, "windows": list(counts)})


def test_survival_windows_are_counted_over_the_sweeps_that_overturn():
    tests = pd.DataFrame(
        {
            "test": ["a", "a"],
            "reading": ["first_overturning", "always_overturning"],
            "amplitude_g": [0.5, 1.0],
        }
    )
    found = windows_found(windows(2, 0), tests)
    assert found.headline == "1 of 2 overturning sweeps has survival windows"
    assert "2.00 times" in found.text
    assert windows_found(windows(0, 0), tests).headline == "No sweep has survival windows"
    assert "everything overturned" in windows_found(windows(0, 0), tests).text
    assert windows_found(windows(0).assign(first_upper=NAN), tests).headline == "No sweep overturns"
