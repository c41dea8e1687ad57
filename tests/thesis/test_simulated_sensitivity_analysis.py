"""Perturbed parameters from the ideal model act through the pedestal's motion, or not at all."""

import math

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.rocking.options import system_of
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.sensitivity_analysis.explain import (
    CHANGES,
    OPEN,
    SAME,
    explain,
    where_laws_agree,
)
from rockfrag_thesis.sensitivity_analysis.mass_bias import ratio_bias
from rockfrag_thesis.sensitivity_analysis.simulated import (
    LAW_OF,
    Case,
    case_ratios,
    factor_cases,
    ideal_case,
    mass_error_rows,
    perturbed_cases,
    with_references,
)

from .conftest import bursts

TOWER = Block(0.124, 0.496, 2.79)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
# so wide and heavy that neither a motion nor an impact of the object moves it
ROCK = Stack(Block(3.0, 2.4, 1e6), TOWER)
INTENSITY_LEVELS = 0.1 * 1.08 ** np.arange(32)


@pytest.fixture(scope="module")
def motions() -> list[Motion]:
    return bursts(11, "ABC", "GF", 400, 1.5)


def test_no_restitution_makes_a_difference_on_a_pedestal_that_cannot_move(motions):
    levels = {"statue_restitution": (0.9, 1.05), "ground_restitution": (0.5, 1.5)}
    rows = case_ratios(factor_cases("T2", ROCK, levels), motions, INTENSITY_LEVELS)
    assert rows["np_g"].max() > rows["np_g"].min()
    assert rows["ratio"].dropna().to_numpy() == pytest.approx(1.0, abs=0)
    assert len(rows["ratio"].dropna()) >= 8


def test_an_interface_that_takes_more_energy_acts_like_a_lone_object_that_does(motions):
    lossy = 0.9 * TOWER.momentum_restitution()
    rows = case_ratios(
        factor_cases("T2", ROCK, {"interface_restitution": (0.9,)}), motions, INTENSITY_LEVELS
    )
    lone = Case(
        "lone",
        0.0,
        "T2",
        system_of(TOWER, restitution=lossy),
        system_of(ROCK, restitution=(None, lossy)),
    )
    alike = case_ratios([lone], motions, INTENSITY_LEVELS)
    # on so heavy a pedestal by every law
    for _, by_law in rows.groupby("factor"):
        assert by_law["p_g"].to_numpy() == pytest.approx(
            alike["np_g"].to_numpy(), abs=0, nan_ok=True
        )


def test_mass_that_is_not_counted_scales_every_ratio_by_the_masses(motions):
    ideal = case_ratios([ideal_case("T2", STACK)], motions, INTENSITY_LEVELS)
    rows = mass_error_rows(ideal, {"T2": STACK}, [10.0])
    factor = rows.groupby("factor")["ratio"].mean() / ideal["ratio"].mean()
    assert factor["pedestal_not_counted"] == pytest.approx((10 + 2.79 + 2.3) / (10 + 2.79))
    table = (12.79 + 2.3) / (2.79 + 2.3) / (12.79 / 2.79)
    assert factor["table_not_counted"] == pytest.approx(table)


def test_the_table_is_one_that_the_sensitivity_analysis_takes(motions):
    ideal = case_ratios([ideal_case("T2", STACK)], motions, INTENSITY_LEVELS)
    cases = factor_cases("T2", STACK, {"pedestal_width_cm": (13.0,), "pedestal_lean_deg": (2.0,)})
    effects = explain(with_references(case_ratios(cases, motions, INTENSITY_LEVELS), ideal))
    assert set(effects["factor"]) == {"pedestal_width_cm", "pedestal_lean_deg"}
    ideal_rows = effects[effects["level"] == "ideal"]
    assert set(ideal_rows["effect"]) == {1.0} and set(ideal_rows["judgement"]) == {""}


def test_perturbed_copies_follow_from_the_seed_and_differ_on_the_two_sides():
    first, again = (
        perturbed_cases("T2", STACK, 0.01, 0.02, 3, np.random.default_rng(5)) for _ in range(2)
    )
    assert first == again
    widths = [(case.lone.bodies[0].width, case.stack.bodies[1].width) for case in first]
    assert len(set(widths)) == 3
    assert all(lone != upper for lone, upper in widths)


@pytest.mark.parametrize(
    ("levels", "words"),
    [
        ({"statue_restitution": (1.2,)}, ["statue_restitution", "1.2", "between 0 and 1"]),
        ({"statue_offset_mm": (150.0,)}, ["statue_offset_mm", "150", "centre of gravity"]),
        ({"statue_cg_offset_mm": (70.0,)}, ["statue_cg_offset_mm", "cannot stand"]),
    ],
)
def test_a_level_that_cannot_be_is_named(levels, words):
    with pytest.raises(InputError) as caught:
        factor_cases("T2", STACK, levels)
    for word in ("sensitivity_analysis.", "T2", *words):
        assert word in str(caught.value)


def test_restitution_is_varied_by_each_law_that_differs():
    levels = {"interface_restitution": (0.9, 1.05)}
    cases = factor_cases("T2", STACK, levels)
    found = {(case.factor, case.level): case.stack.contacts[1].law.name for case in cases}
    assert found == {
        ("interface_restitution", 0.9): "position",
        ("interface_restitution", 1.05): "position",
        ("interface_restitution_couple", 1.05): "couple",
        ("interface_restitution_ratio", 0.9): "ratio",
        ("interface_restitution_ratio", 1.05): "ratio",
    }


def test_a_perturbation_is_judged_only_where_its_laws_agree():
    names = ["interface_restitution", "interface_restitution_ratio", "pedestal_lean_deg"]
    effects = pd.DataFrame(
        {
            "factor": [*names, *names],
            "level": ["0.9"] * 3 + ["1.05"] * 3,
            "floor": "all",
            "judgement": [CHANGES, SAME, SAME, CHANGES, CHANGES, OPEN],
        }
    )
    judged = where_laws_agree(effects, LAW_OF)["judgement"].tolist()
    assert judged == [OPEN, OPEN, SAME, CHANGES, CHANGES, OPEN]


@pytest.mark.parametrize(
    ("statue", "pedestal", "table", "counted_with", "counted_without", "bias"),
    [
        (2.172, 2.3, 10.0, 14.472, 12.172, 1.0),
        # the pedestal is not counted on ten kilograms: 17 to 19 %
        (2.172, 2.3, 10.0, 12.172, 12.172, 1.19),
        (2.790, 2.3, 10.0, 12.790, 12.790, 1.18),
        (3.456, 2.3, 10.0, 13.456, 13.456, 1.17),
        # it is divided by the blocks' weight alone
        (2.172, 2.3, 10.0, 4.472, 2.172, 0.58),
        (2.790, 2.3, 10.0, 5.090, 2.790, 0.65),
        (3.456, 2.3, 10.0, 5.756, 3.456, 0.70),
        # 10 m/s² on 20 kg of table, 2 kg of statue, 2 kg of pedestal, divided by 22 kg both times
        (2.0, 2.0, 20.0, 22.0, 22.0, 1.09),
    ],
)
def test_mass_that_is_not_counted_biases_the_ratio(
    statue, pedestal, table, counted_with, counted_without, bias
):
    found = ratio_bias(
        statue, pedestal, table, counted_with=counted_with, counted_without=counted_without
    )
    assert round(found, 2) == bias


@pytest.mark.parametrize("mass", [-1.0, math.nan])
def test_impossible_masses_are_refused(mass):
    with pytest.raises(InputError, match="mass of 0 kg or more"):
        ratio_bias(mass, 2, 20, counted_with=22, counted_without=22)
    with pytest.raises(InputError, match="divided by"):
        ratio_bias(1, 2, 20, counted_with=0, counted_without=22)
