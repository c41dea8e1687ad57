"""The question turned round: which perturbed parameters give an effect that was asked for."""

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag_thesis.sections.inverse_problem import (
    inverse_problem,
    inverse_problem_words,
)
from rockfrag_thesis.sensitivity_analysis.inverse_problem import (
    friction_perturbations,
    hotelling,
    invert,
)
from rockfrag_thesis.settings import NAME, Settings

FLOORS = {"hall": 0, "loft": 2}
WANTED = {"ground": 1.10, "above": 0.95}
NEUTRAL = {"raises_ground": 0.0, "lowers_loft": 0.0, "raises_both": 0.0, "idle": 0.0}


def ratios(scatter=0.002):
    """One factor raises P/NP on the ground, one lowers it above, one raises both, one does nothing."""
    rng = np.random.default_rng(2)
    effects = {
        "raises_ground": (0.02, 0.0),
        "lowers_loft": (0.0, -0.01),
        "raises_both": (0.02, 0.02),
        "idle": (0.0, 0.0),
    }
    rows = []
    for earthquake, (place, floor) in itertools.product("ABCDEF", enumerate(FLOORS)):
        own = rng.normal(0, scatter)
        for (factor, effect), level in itertools.product(
            effects.items(), ("ideal", "4", "8")
        ):
            shift = 0.0 if level == "ideal" else effect[place] * float(level)
            rows.append(
                (
                    factor,
                    level,
                    level == "ideal",
                    earthquake,
                    floor,
                    np.exp(own + shift),
                )
            )
    names = ["factor", "level", "reference", "earthquake", "floor", "ratio"]
    table = pd.DataFrame(rows, columns=names)
    return table.assign(object="T", motion=table["earthquake"] + "-" + table["floor"])


def test_two_factors_that_make_up_the_effect_are_found_with_their_levels():
    table = invert(ratios(), WANTED, FLOORS, NEUTRAL)
    best = table.iloc[0]
    assert {best["factor_1"], best["factor_2"]} == {"raises_ground", "lowers_loft"}
    level = dict(
        zip(best[["factor_1", "factor_2"]], best[["level_1", "level_2"]], strict=True)
    )
    # straight lines: ln 1.1 = 0.02 x, ln 0.95 = -0.01 y, to the grid along each factor
    assert level["raises_ground"] == pytest.approx(np.log(1.10) / 0.02, abs=0.4)
    assert level["lowers_loft"] == pytest.approx(-np.log(0.95) / 0.01, abs=0.4)
    assert best["reaches"] and best["plausible"]
    assert best["ground"] == pytest.approx(1.10, rel=0.02)


def test_no_factor_alone_makes_it_and_the_words_say_so():
    table = invert(ratios(), WANTED, FLOORS, NEUTRAL)
    alone = table[(table["factor_2"] == "") & (table["acts_on"] == "all floors")]
    assert not alone["reaches"].any() and not alone["plausible"].any()
    words = " ".join(inverse_problem_words(table, WANTED))
    asked = "+10 % on the ground and −5 % above it"
    assert f"No single perturbed parameter can produce {asked}" in words
    assert "lowers_loft with raises_ground" in words
    assert (
        "No mechanism that acts on the ground alone, or above it alone, can." in words
    )


def test_factor_that_acts_on_the_ground_alone_is_a_mechanism_of_its_own():
    table = invert(ratios(), {"ground": 1.10, "above": 1.0}, FLOORS, NEUTRAL)
    rows = table[(table["factor_1"] == "raises_both") & (table["factor_2"] == "")]
    reaches = rows.set_index("acts_on")["reaches"]
    assert reaches["ground"] and not reaches["all floors"] and not reaches["above"]
    words = " ".join(inverse_problem_words(table, {"ground": 1.10, "above": 1.0}))
    assert (
        "act at one place only" in words and "raises_both on the ground alone" in words
    )


def test_scatter_between_earthquakes_and_the_intensity_levels_widen_what_is_plausible():
    def plausible(**options):
        table = invert(
            ratios(options.pop("scatter", 0.002)), WANTED, FLOORS, NEUTRAL, **options
        )
        return int(table["plausible"].sum())

    assert plausible() < plausible(resolution=0.05)
    assert plausible() < plausible(scatter=0.2)


def test_p_value_is_that_of_t_with_one_place_and_of_hotelling_with_two():
    from scipy import stats

    x = np.random.default_rng(4).normal(0.1, 0.2, (1, 7, 1))
    expected = stats.ttest_1samp(x[0, :, 0], 0.0).pvalue
    assert hotelling(x, np.zeros(1), 0.0)[0] == pytest.approx(expected, rel=1e-2)
    two = np.random.default_rng(5).normal(0, 0.2, (4000, 6, 2))
    p = hotelling(two, np.zeros(2), 0.0)
    assert np.mean(p < 0.05) == pytest.approx(0.05, abs=0.012)


def test_study_without_floors_above_asks_about_the_ground_only():
    table = invert(ratios(), {"ground": 1.10}, FLOORS, NEUTRAL)
    reached = table.loc[table["reaches"] & (table["factor_2"] == ""), "factor_1"]
    assert set(reached) == {"raises_ground", "raises_both"}
    assert set(table["acts_on"]) == {"all floors"}


def tried_friction():
    """P/NP over friction of both interfaces; on a ground of 0.3 the stout one never falls."""
    names = ["earthquake", "floor", "object", "ground", "interface"]
    sides = ("ABCDEF", FLOORS, ("stout", "slender"), (0.3, np.inf), (0.4, np.inf))
    table = pd.MultiIndex.from_product(map(list, sides), names=names).to_frame(
        index=False
    )
    smooth, stout = table["ground"] < np.inf, table["object"] == "stout"
    d = (
        np.where(stout, 0.2, -0.1)
        + 0.05 * (table["interface"] < np.inf)
        - 0.03 * smooth
    )
    motion = table["earthquake"] + "-" + table["floor"]
    return table.assign(motion=motion, ratio=np.exp(d.mask(stout & smooth)))


def test_friction_of_either_interface_is_a_perturbation_like_others():
    everything = pd.concat(
        [ratios(), friction_perturbations(tried_friction())], ignore_index=True
    )
    table = invert(everything, WANTED, FLOORS, NEUTRAL)
    everywhere = table[table["acts_on"] == "all floors"]
    pairs = everywhere[["factor_1", "factor_2"]].itertuples(index=False)
    found = {frozenset(filter(None, pair)) for pair in pairs}
    friction = {"ground_friction", "interface_friction"}
    for name, other in itertools.product(friction, NEUTRAL):
        assert {name, other} in found
    assert friction in found


def test_an_object_that_no_longer_falls_is_not_taken_for_an_effect():
    """The stout one has a higher ratio: without it the plain mean would fall by 0.18."""
    table = invert(friction_perturbations(tried_friction()), {"ground": 1.10}, FLOORS)
    alone = table[(table["factor_2"] == "")].set_index("factor_1")
    ideal = np.exp(0.05)
    assert alone.loc["ground_friction", "ground"] == pytest.approx(
        ideal * np.exp(-0.03)
    )
    assert alone.loc["interface_friction", "ground"] == pytest.approx(
        ideal * np.exp(0.05)
    )


def row(factor_1: str, factor_2: str = "", **given) -> dict[str, object]:
    """A row of the table: a perturbed parameter at its closest, or two."""
    item = {
        "factor_1": factor_1,
        "level_1": -2.0,
        "factor_2": factor_2,
        "level_2": math.nan,
    }
    item |= {"acts_on": "all floors", "ground": 1.02, "above": 0.99, "plausible": True}
    item |= {
        "reaches": False,
        "simulated_ground": math.nan,
        "simulated_above": math.nan,
    }
    return item | given


def section(rows: list[dict[str, object]], wanted: dict[str, float]):
    """The section of a study that asks for an effect and found these rows."""
    settings = Settings(sensitivity_analysis={"wanted_percent": wanted})
    study = SimpleNamespace(added={NAME: settings}, has_pairs=True)
    return inverse_problem(
        SimpleNamespace(study=study, table=lambda _: pd.DataFrame(rows))
    )


def test_what_gives_the_effect_is_named_for_a_reader():
    pair = row(
        "statue_restitution",
        "statue_offset_mm",
        level_1=0.9,
        level_2=10.0,
        reaches=True,
    )
    found = section(
        [
            pair | {"simulated_ground": 1.104, "simulated_above": 0.951},
            row("pedestal_lean_deg"),
        ],
        {"ground": 10, "above": -5},
    )
    said = " ".join([found.message, *found.paragraphs])
    assert (
        "Pairs that can: the object's restitution everywhere with the object off"
        in said
    )
    assert "1.104, 0.951" in found.parts[0]
    assert "A pedestal leaning by −2°" in found.parts[0]


@pytest.mark.parametrize("wanted", [{"ground": 10}, {"above": -5}])
def test_a_place_that_is_not_asked_for_has_no_column(wanted):
    found = section([row("pedestal_lean_deg", plausible=False)], wanted)
    assert (">above it<" in found.parts[0]) == ("above" in wanted)
    assert "rules out 1 of the 1 mechanisms" in " ".join(found.paragraphs)


def test_a_study_that_asks_for_no_effect_has_no_such_section():
    assert section([row("pedestal_lean_deg")], {}) is None
