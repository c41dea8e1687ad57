"""The section on what would give a wanted effect says what its table says."""

import math
from types import SimpleNamespace

import pandas as pd
import pytest

from rockfrag_thesis.sections.inverse_problem import INVERSE_PROBLEM
from rockfrag_thesis.settings import NAME, Settings


def row(factor_1: str, factor_2: str = "", **given) -> dict[str, object]:
    """A row of the table: a perturbed parameter at its closest, or two."""
    item = {"factor_1": factor_1, "level_1": -2.0, "factor_2": factor_2, "level_2": math.nan}
    item |= {"acts_on": "all floors", "ground": 1.02, "above": 0.99, "plausible": True}
    return (
        item | {"reaches": False, "simulated_ground": math.nan, "simulated_above": math.nan} | given
    )


def asking(wanted: dict[str, float]) -> SimpleNamespace:
    settings = Settings(sensitivity_analysis={"wanted_percent": wanted})
    return SimpleNamespace(added={NAME: settings}, has_pairs=True)


def section(rows: list[dict[str, object]], wanted: dict[str, float]):
    study = asking(wanted)
    assert INVERSE_PROBLEM.asked(study) == bool(wanted)
    return INVERSE_PROBLEM.section(
        SimpleNamespace(study=study, table=lambda name: pd.DataFrame(rows))
    )


def test_what_gives_the_effect_is_named_for_a_reader():
    pair = row("statue_restitution", "statue_offset_mm", level_1=0.9, level_2=10.0, reaches=True)
    found = section(
        [pair | {"simulated_ground": 1.104, "simulated_above": 0.951}, row("pedestal_lean_deg")],
        {"ground": 10, "above": -5},
    )
    said = " ".join([found.message, *found.paragraphs])
    assert "Pairs that can: the object's restitution everywhere with the object off" in said
    assert "1.104, 0.951" in found.parts[0]
    assert "A pedestal leaning by −2°" in found.parts[0]


@pytest.mark.parametrize("wanted", [{"ground": 10}, {"above": -5}])
def test_a_place_that_is_not_asked_for_has_no_column(wanted):
    found = section([row("pedestal_lean_deg", plausible=False)], wanted)
    assert (">above it<" in found.parts[0]) == ("above" in wanted)
    assert "rules out 1 of the 1 mechanisms" in " ".join(found.paragraphs)


def test_a_study_that_asks_for_no_effect_has_no_such_section():
    assert not INVERSE_PROBLEM.asked(asking({}))
