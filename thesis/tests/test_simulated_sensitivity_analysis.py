"""Perturbed parameters from the ideal model act through the pedestal's motion, or not at all."""

import math
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockfrag import overturns
from rockfrag.base.errors import InputError
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.simulation.options import system_of
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.sections.sensitivity_analysis import (
    FACTORS,
    MOST_DRAWN,
    adjusted_words,
    perturbations,
    sensitivity_analysis_figure,
)
from rockfrag_thesis.sensitivity_analysis.explain import (
    CHANGES,
    OPEN,
    SAME,
    explain,
    where_laws_agree,
)
from rockfrag_thesis.sensitivity_analysis.friction_grid import (
    friction_effects,
    friction_ratios,
    survived_amplitudes,
)
from rockfrag_thesis.sensitivity_analysis.simulated import (
    LAW_OF,
    REFERENCE,
    Case,
    case_ratios,
    factor_cases,
    ideal_case,
    level_amplitudes,
    mass_error_rows,
    perturbed_cases,
)
from rockfrag_thesis.standing import SIZES, standing_definitions
from tests.simulation.reference_bodies import polyline

TOWER = Block(0.124, 0.496, 2.79)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
# so wide and heavy that neither a motion nor an impact of the object moves it
ROCK = Stack(Block(3.0, 2.4, 1e6), TOWER)
INTENSITY_LEVELS = 0.1 * 1.08 ** np.arange(32)


def bursts(
    seed: int, earthquakes: str, floor: str, count: int, middle: float
) -> list[Motion]:
    """One burst of waves an earthquake, of so many samples of 10 ms [m/s²]."""
    time = np.arange(count) * 0.01
    rng = np.random.default_rng(seed)
    found = []
    for name in earthquakes:
        waves = np.sin(
            2 * np.pi * np.outer(time, rng.uniform(0.6, 4, 12)) + rng.uniform(0, 6, 12)
        )
        values = waves.sum(axis=1) * np.exp(-(((time - middle) / (middle / 2)) ** 2))
        about = {"earthquake": name, "floor": floor}
        found.append(Motion(values, 0.01, f"{name}_{floor}", about))
    return found


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
    cases = factor_cases("T2", ROCK, {"interface_restitution": (0.9,)})
    rows = case_ratios(cases, motions, INTENSITY_LEVELS)
    alone, on_it = (
        system_of(TOWER, restitution=lossy),
        system_of(ROCK, restitution=(None, lossy)),
    )
    alike = case_ratios(
        [Case("lone", 0.0, "T2", alone, on_it)], motions, INTENSITY_LEVELS
    )
    expected = pytest.approx(alike["np_g"].to_numpy(), abs=0, nan_ok=True)
    # on so heavy a pedestal by every law
    for _, by_law in rows.groupby("factor"):
        assert by_law["p_g"].to_numpy() == expected


def test_mass_that_is_not_counted_scales_every_ratio_by_the_masses(motions):
    ideal = case_ratios([ideal_case("T2", STACK)], motions, INTENSITY_LEVELS)
    rows = mass_error_rows(ideal, {"T2": STACK}, [10.0])
    factor = rows.groupby("factor")["ratio"].mean() / ideal["ratio"].mean()
    assert factor["pedestal_not_counted"] == pytest.approx(
        (10 + 2.79 + 2.3) / (10 + 2.79)
    )
    table = (12.79 + 2.3) / (2.79 + 2.3) / (12.79 / 2.79)
    assert factor["table_not_counted"] == pytest.approx(table)


def test_perturbed_copies_follow_from_the_seed_and_differ_on_the_two_sides():
    first, again = (
        perturbed_cases(
            "T2",
            STACK,
            tolerance=0.01,
            restitution=0.02,
            replicates=3,
            rng=np.random.default_rng(5),
        )
        for _ in range(2)
    )
    assert first == again
    widths = [(case.lone.bodies[0].width, case.stack.bodies[1].width) for case in first]
    assert len(set(widths)) == 3
    assert all(lone != upper for lone, upper in widths)


@pytest.mark.parametrize(
    ("levels", "words"),
    [
        (
            {"statue_restitution": (1.2,)},
            "statue_restitution, 1.2, T2.*between 0 and 1",
        ),
        (
            {"statue_offset_mm": (150.0,)},
            "statue_offset_mm, 150, T2.*centre of gravity",
        ),
        ({"statue_cg_offset_mm": (70.0,)}, "statue_cg_offset_mm.*T2.*cannot stand"),
    ],
)
def test_a_level_that_cannot_be_is_named(levels, words):
    with pytest.raises(InputError, match=rf"sensitivity_analysis\.{words}"):
        factor_cases("T2", STACK, levels)


def test_restitution_is_varied_by_each_law_that_differs():
    levels = {"interface_restitution": (0.9, 1.05)}
    cases = factor_cases("T2", STACK, levels)
    found = {
        (case.factor, case.level): case.stack.contacts[1].law.name for case in cases
    }
    assert found == {
        ("interface_restitution", 0.9): "position",
        ("interface_restitution", 1.05): "position",
        ("interface_restitution_couple", 1.05): "couple",
        ("interface_restitution_ratio", 0.9): "ratio",
        ("interface_restitution_ratio", 1.05): "ratio",
    }


def test_a_perturbation_is_judged_only_where_its_laws_agree():
    names = [
        "interface_restitution",
        "interface_restitution_ratio",
        "pedestal_lean_deg",
    ]
    effects = pd.DataFrame({"factor": names * 2, "level": ["0.9"] * 3 + ["1.05"] * 3})
    said = [CHANGES, SAME, SAME, CHANGES, CHANGES, OPEN]
    judged = where_laws_agree(effects.assign(floor="all", judgement=said), LAW_OF)
    judged = judged["judgement"].tolist()
    assert judged == [OPEN, OPEN, SAME, CHANGES, CHANGES, OPEN]


def sensitivity_analysis_table(effect=0.15):
    names = ["level", "object", "earthquake", "floor", "replicate"]
    sides = (
        (0.85, 0.80, 0.75),
        ("T1", "T2", "T3"),
        list("ABCD"),
        ("GF", "F3", "F5"),
        range(3),
    )
    table = pd.MultiIndex.from_product(sides, names=names).to_frame(index=False)
    shift = table["level"].map({0.85: 0.0, 0.80: effect, 0.75: 2 * effect})
    sign = table["floor"].map({"GF": 1, "F3": -0.5, "F5": -0.5})
    d = sign * shift + np.random.default_rng(2).normal(0, 0.02, len(table))
    return table.assign(
        factor="restitution", reference=table["level"] == 0.85, ratio=np.exp(d)
    )


def test_sensitivity_analysis_recovers_the_effect_of_a_level_by_floor():
    result = explain(sensitivity_analysis_table(0.15)).set_index(["level", "floor"])
    for level, factor in ((0.80, 1), (0.75, 2)):
        for floor, sign in (("GF", 1), ("F3", -0.5)):
            row = result.loc[(level, floor)]
            assert (
                row["effect_lower"] < np.exp(sign * 0.15 * factor) < row["effect_upper"]
            )
    assert result.loc[(0.80, "GF"), "judgement"] == "changes P/NP"
    assert result.loc[(0.85, "all"), "effect"] == 1.0


def test_sensitivity_analysis_pairs_with_the_reference_and_counts_what_is_left_out():
    table = sensitivity_analysis_table()
    gone = (
        (table["level"] == 0.80)
        & (table["earthquake"] == "A")
        & (table["object"] == "T1")
    )
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


@pytest.mark.parametrize("factor", FACTORS.values(), ids=list(FACTORS))
def test_a_perturbation_reads_as_english_in_the_middle_of_a_sentence(factor):
    at = factor.at("-2.5")
    for words in (factor.title, at):
        # a noun with its article, or in the plural
        assert re.match(r"(the|a|neglecting) [a-z]|[a-z]+s of ", words), words
        # commas part one perturbed parameter from the next
        assert not re.search(r"[,:;]", words), words
    # a level has its unit, or is a factor or a coefficient
    assert re.search(
        r"−2\.5 (%|mm|cm|kg)( |$)|−2\.5°$|× −2\.5$|coefficient of −2\.5 ", at
    ), at


def test_perturbations_are_named_by_factor_and_level_in_the_order_of_the_figure():
    factors = ["table_not_counted", "statue_restitution", "statue_restitution"]
    effects = pd.DataFrame(
        {"factor": factors, "level": ["10", "1", "ideal"], "floor": "all"}
    )
    effects = effects.assign(ratio_lower=0.9, ratio=1.0, ratio_upper=1.1, p=0.5)
    assert perturbations(effects)["name"].tolist() == [
        "the object's restitution everywhere × 1",
        "neglecting the mass of a 10 kg table",
    ]


def perturbed(ratios: dict[str, float], p: float = 0.04) -> pd.DataFrame:
    """Effects of perturbations of one parameter on two floors together."""
    levels = (
        pd.Series({REFERENCE: 1.0, **ratios}, name="ratio")
        .rename_axis("level")
        .reset_index()
    )
    table = levels.merge(pd.DataFrame({"floor": ["all", "cellar", "attic"]}), "cross")
    limits = {
        "ratio_lower": 0.97 * table["ratio"],
        "ratio_upper": 1.03 * table["ratio"],
    }
    return table.assign(factor="statue_restitution", p=p, **limits)


def test_the_rule_for_many_perturbations_is_named_and_counts_all():
    simulated = perturbations(
        perturbed({"0.9": 0.9, "0.95": 0.95, "1.05": 1.0}, p=0.04)
    )
    words = adjusted_words(simulated)
    assert words.startswith(
        "2 of 3 simulated perturbations have 95 % intervals that exclude 1"
    )
    assert "Benjamini–Hochberg adjustment for 3 tests" in words
    alone = perturbations(perturbed({"0.9": 0.9}, p=0.04))
    assert "1 differs from 1" in adjusted_words(alone)


def test_the_figure_shows_the_largest_perturbations_and_says_no_row_twice():
    levels = {
        f"{0.5 + 0.02 * k:.2f}": float(np.exp(0.01 * (k - 10))) for k in range(40)
    }
    figure = sensitivity_analysis_figure(perturbed(levels), ["cellar", "attic"])
    labels = [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    assert len(labels) == len(set(labels)) == MOST_DRAWN + 1
    assert labels[0] == "Ideal model"
    width, height = figure.get_size_inches()
    assert height < 1.5 * width
    # floors stand below the mean that they belong to
    marks = [line for line in figure.axes[0].lines if line.get_marker() == "D"]
    assert len(marks) == MOST_DRAWN + 1


SHORT_TOWER = Block(0.124, 0.372, 2.172)
SHORT_STACK = Stack(Block(0.184, 0.208, 2.3), SHORT_TOWER)
COARSE_LEVELS = 0.2 * 1.15 ** np.arange(14)
PAIRS = [
    (first, two) for first in (0.3, 0.4, math.inf) for two in (0.25, 0.36, math.inf)
]


@pytest.fixture(scope="module")
def two_motions() -> list[Motion]:
    return bursts(3, "AB", "ground", 250, 1.2)


def test_amplitudes_are_those_of_each_pair_climbed_by_itself(
    two_motions: list[Motion],
) -> None:
    found = survived_amplitudes(SHORT_STACK, PAIRS, two_motions, COARSE_LEVELS)
    scales = np.array([factors_to_pga(motion, COARSE_LEVELS) for motion in two_motions])
    accelerations = [motion.acceleration for motion in two_motions]
    fell = overturns(
        [SHORT_STACK] * len(PAIRS), accelerations, 0.01, scales, friction=PAIRS
    ).overturned
    first = fell.argmax(axis=2)
    known = fell.any(axis=2) & (first > 0)
    each = np.where(known, COARSE_LEVELS[np.maximum(first - 1, 0)], np.nan)
    np.testing.assert_array_equal(found, each)
    assert (
        np.isfinite(found).sum() > 6 and len(np.unique(found[np.isfinite(found)])) > 2
    )


def test_without_end_friction_gives_what_pure_rocking_gives(
    two_motions: list[Motion],
) -> None:
    pure = level_amplitudes(
        [SHORT_TOWER.system(), SHORT_STACK.system()], two_motions, COARSE_LEVELS
    )
    rough = [
        survived_amplitudes(body, [(math.inf,) * count], two_motions, COARSE_LEVELS)[0]
        for body, count in ((SHORT_TOWER, 1), (SHORT_STACK, 2))
    ]
    np.testing.assert_array_equal(pure, rough)


def test_below_its_slenderness_an_object_has_no_amplitude(
    two_motions: list[Motion],
) -> None:
    stacks, friction = {"tower": SHORT_STACK}, {"ground": [0.3], "interface": [0.5]}
    rows = friction_ratios(stacks, two_motions, COARSE_LEVELS, **friction)
    smooth = rows[rows["ground"] == 0.3]
    assert smooth["np_g"].isna().all() and smooth["ratio"].isna().all()
    effects = friction_effects(rows, {"ground": 0})
    row = effects.query("ground == 0.3 and interface == 0.5 and object == 'all'").iloc[
        0
    ]
    assert (row["pairs"], row["left_out"], row["np_survives"]) == (0, 2, 2)
    rough = effects.query(
        "ground == inf and interface == inf and object == 'all'"
    ).iloc[0]
    assert rough["pairs"] == 2 and 0.5 < rough["ratio"] < 2


FINE_LEVELS = 0.2 * 1.01 ** np.arange(180)
PROTOCOL = Protocol(GeometricSteps(0.2, 0.05), 1.1)


def test_readings_of_a_ida_stand_or_fall_with_small_differences():
    chosen = [
        replace(SHORT_TOWER.system(), name="T1"),
        replace(SHORT_STACK.system(), name="P&T1"),
    ]
    two_motions = [Motion(polyline(seed, 1600), 0.01, f"M{seed}") for seed in range(4)]
    table = standing_definitions(chosen, two_motions, FINE_LEVELS, PROTOCOL, seed=1)
    assert len(table) == 2 * 4 * 3
    columns = [f"stands_{size:.0e}" for size in SIZES]
    stands = table[columns].mean()
    # the smaller the difference the more stand
    assert stands.is_monotonic_decreasing and stands.iloc[0] >= 0.9
    again = standing_definitions(
        chosen, two_motions, FINE_LEVELS, PROTOCOL, seed=1, threads=2
    )
    assert again.equals(table)
