import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockfrag.base.errors import InputError
from rockfrag.shaketable.definitions import (
    DEFINITIONS,
    always_overturning,
    first_overturning,
    mean_amplitudes,
    step_protocol,
)
from rockfrag.shaketable.definitions import tests_from_ida as read_ida
from rockfrag.shaketable.protocols import (
    Accelerometer,
    ForceOverMass,
    GeometricSteps,
    LinearSteps,
    Outcome,
    Protocol,
)
from rockfrag.shaketable.tests_table import COLUMNS

from .conftest import ida_table

GRID = np.round(np.arange(0.05, 1.0001, 0.01), 10)
# overturns from 0.30 to 0.34, survives to 0.50, overturns above: one structural resurrection
WINDOW = ((GRID > 0.295) & (GRID < 0.345)) | (GRID > 0.505)

ida_curves = st.lists(st.booleans(), min_size=1, max_size=60).map(np.array)


def grid(outcomes):
    return 0.05 + 0.01 * np.arange(len(outcomes))


def vase(overturned=WINDOW):
    return ida_table(overturned, GRID)


def test_level_series_climb_as_their_names_say():
    assert LinearSteps(0.1, 0.1).amplitudes(0.5) == pytest.approx(
        [0.1, 0.2, 0.3, 0.4, 0.5]
    )
    assert GeometricSteps(0.1, 1.0).amplitudes(0.8) == pytest.approx(
        [0.1, 0.2, 0.4, 0.8]
    )
    assert LinearSteps(0.1, 0.1).amplitudes(0.05).size == 0


def test_three_readings_of_one_ida_differ():
    protocol = Protocol(LinearSteps(0.05, 0.1), limit_g=1.0)
    assert step_protocol(GRID, WINDOW, protocol) == Outcome(0.45, 0.55)
    assert first_overturning(GRID, WINDOW) == Outcome(0.29, 0.30)
    assert always_overturning(GRID, WINDOW) == Outcome(0.50, 0.51)


def test_a_table_of_tests_has_the_schema_of_the_contract():
    table = read_ida(vase(), Protocol(LinearSteps(0.05, 0.05)))
    assert tuple(table.columns) == COLUMNS
    assert table["definition"].tolist() == list(DEFINITIONS)
    assert (table["amplitude_g"] == table["lower_g"]).all()
    assert (table["overturned_body"] == "statue").all()
    assert read_ida(vase().iloc[:0], Protocol(LinearSteps(1, 1))).dtypes.equals(
        table.dtypes
    )
    table = read_ida(vase(), Protocol(LinearSteps(0.05, 0.05), definition="at"))
    assert (table["amplitude_g"] == table["upper_g"]).all()


def test_repetitions_start_within_a_step_of_each_other():
    protocol = Protocol(LinearSteps(0.05, 0.1), limit_g=1.0, repetitions=2)
    table = read_ida(vase(), protocol, definitions=["step_protocol"])
    assert table["repetition"].tolist() == [1, 2]
    assert table["upper_g"].tolist() == pytest.approx([0.55, 0.30])


def test_the_shakers_limit_censors_the_step_protocol_only():
    limits = {"Kobe_ground": 0.272}
    table = read_ida(vase(), Protocol(LinearSteps(0.05, 0.05)), limits_g=limits)
    lab, first, _ = table.to_dict("records")
    assert lab["lower_g"] == pytest.approx(0.25)
    assert math.isnan(lab["upper_g"]) and math.isnan(lab["amplitude_g"])
    assert (lab["censored"], lab["overturned_body"]) == ("right", "")
    assert first["upper_g"] == pytest.approx(0.30)


def test_overturning_at_the_first_step_leaves_nothing_to_report_before_it():
    table = read_ida(vase(np.ones(GRID.size, bool)), Protocol(LinearSteps(0.2, 0.1)))
    expected = {
        "lower_g": 0,
        "censored": "none",
        "remark": "overturned at the first step",
    }
    for row in table.to_dict("records"):
        assert expected.items() <= row.items() and math.isnan(row["amplitude_g"])


def test_unaccounted_mass_raises_light_specimens_more():
    lab = ForceOverMass({"T1": 20.0, "P T1": 50.0}, unaccounted_mass=10.0)
    assert lab.show(Outcome(0.2, 0.4), "T1") == Outcome(
        pytest.approx(0.3), pytest.approx(0.6)
    )
    assert lab.show(Outcome(0.2, 0.4), "P T1").upper_g == pytest.approx(0.48)
    with pytest.raises(InputError, match="no mass is given for configuration 'T9'"):
        lab.show(Outcome(0.2, 0.4), "T9")


def test_a_clipped_accelerometer_gives_a_lower_bound_only():
    protocol = Protocol(
        LinearSteps(0.05, 0.1), limit_g=1.0, measurement=Accelerometer(0.5)
    )
    shown = read_ida(vase(), protocol, definitions=["step_protocol"]).iloc[0]
    assert (shown["lower_g"], shown["censored"]) == (pytest.approx(0.45), "right")
    assert protocol.measurement.show(Outcome(0.55, 0.65), "T1").lower_g == 0.5
    assert protocol.measurement.show(Outcome(0.3, 0.4), "T1") == Outcome(0.3, 0.4)


@settings(derandomize=True)
@given(outcomes=ida_curves, step=st.floats(0.003, 0.3), start=st.floats(0.01, 0.5))
def test_the_bounds_hold_a_survival_and_an_overturning(outcomes, step, start):
    amplitudes = grid(outcomes)
    outcome = step_protocol(amplitudes, outcomes, Protocol(LinearSteps(start, step)))
    known = dict(zip(amplitudes, outcomes, strict=True))
    assert outcome.lower_g == 0 or not known[outcome.lower_g]
    if not outcome.censored:
        assert outcome.lower_g < outcome.upper_g
        assert known[outcome.upper_g]


@settings(derandomize=True)
@given(outcomes=ida_curves, step=st.floats(0.003, 0.3))
def test_no_protocol_overturns_below_the_first_overturning_which_fine_steps_find(
    outcomes, step
):
    amplitudes = grid(outcomes)
    first = first_overturning(amplitudes, outcomes)
    fine, outcome = (
        step_protocol(amplitudes, outcomes, Protocol(LinearSteps(0.05, size)))
        for size in (0.002, step)
    )
    # as text: an upper bracket that is NaN is not equal to itself
    assert repr(fine) == repr(first)
    assert outcome.censored or outcome.upper_g >= first.upper_g


@settings(derandomize=True)
@given(growth=st.floats(0.01, 0.5), threshold=st.floats(0.1, 1.5))
def test_a_monotone_specimen_is_bracketed_within_one_step(growth, threshold):
    protocol = Protocol(GeometricSteps(0.05, growth), limit_g=3.0)
    amplitudes = protocol.amplitudes()
    outcome = first_overturning(amplitudes, amplitudes > threshold)
    assert outcome.lower_g <= threshold < outcome.upper_g
    assert outcome.upper_g / outcome.lower_g == pytest.approx(1 + growth)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: LinearSteps(0.1, 0.0), "step_g: expected a positive number"),
        (lambda: GeometricSteps(-0.1, 0.1), "start_g: expected a positive number"),
        (lambda: Protocol(LinearSteps(0.1, 0.1), limit_g=math.inf), "limit_g"),
        (lambda: Protocol(LinearSteps(0.1, 0.1), repetitions=0), "repetitions"),
        (lambda: LinearSteps(0.1, 1e-9).amplitudes(1.0), "so small"),
        (lambda: Accelerometer(0.0), "clip_g"),
        (lambda: ForceOverMass({"T1": 5.0}, -6.0), "must be positive masses"),
    ],
)
def test_protocols_that_make_no_sense_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_ida_curves_with_missing_columns_or_doubled_amplitudes_are_refused():
    protocol = Protocol(LinearSteps(0.1, 0.1))
    with pytest.raises(InputError, match="'earthquake' is missing"):
        read_ida(vase().drop(columns="earthquake"), protocol)
    with pytest.raises(InputError, match="vase Kobe_ground: amplitudes must"):
        read_ida(pd.concat([vase(), vase()]), protocol)


def table_of(amplitudes: dict[str, list[float]], floor: str = "up") -> pd.DataFrame:
    """Tests of a vase on each side by motions a, b, c … of a floor, NaN where one never overturned."""
    rows = [
        (f"vase {side}", side, "abc"[i], f"{'abc'[i]}_{floor}", value)
        for side, values in amplitudes.items()
        for i, value in enumerate(values)
    ]
    names = ["configuration", "pedestal", "earthquake", "motion", "amplitude_g"]
    return pd.DataFrame(rows, columns=names).assign(
        object="vase", floor=floor, repetition=1
    )


def means(tests: pd.DataFrame, by: str) -> pd.DataFrame:
    table = mean_amplitudes(tests)
    return table[table["by"] == by].set_index(by)[["mean_g", "motions", "of"]]


def test_the_ratio_of_the_means_is_the_mean_ratio_of_the_pairs_that_both_overturned():
    # with its pedestal the vase survives the strongest motion: the mean of what is left would fall
    found = means(
        table_of({"NP": [0.4, 0.5, 1.5], "P": [0.5, 0.6, np.nan]}), "configuration"
    )
    expected = np.sqrt(0.5 / 0.4 * 0.6 / 0.5)
    assert found["mean_g"]["vase P"] / found["mean_g"]["vase NP"] == pytest.approx(
        expected
    )
    assert found["motions"].tolist() == [2, 2]


def test_without_a_motion_that_overturned_everything_there_is_no_mean():
    found = means(table_of({"NP": [0.4, np.nan], "P": [np.nan, 0.5]}), "configuration")
    assert found["mean_g"].isna().all()
    assert found[["motions", "of"]].to_numpy().tolist() == [[0, 2], [0, 2]]


def test_floors_are_compared_over_the_same_records():
    tests = [table_of({"NP": [0.4, 0.5]}), table_of({"NP": [0.8, np.nan]}, "down")]
    found = means(pd.concat(tests, ignore_index=True), "floor")
    assert found["mean_g"].to_dict() == pytest.approx({"up": 0.4, "down": 0.8})
