"""A column goes wherever a block goes."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.rocking import overturns, simulate
from rockfrag.rocking.ensemble import LightBodies
from rockfrag.shaketable.definitions import fallen_names, labels_of
from rockfrag.study.configurations import read_configurations, read_specimens
from rockfrag.system import Block, Column, Stack

from .cases import DT

PLINTH, BASE, STATUE = Block(0.8, 0.4, 500.0), Block(0.5, 0.3, 150.0), Block(0.3, 1.0, 100.0)
COLUMN = Column((PLINTH, BASE, STATUE))
TIME = np.arange(0, 3, DT)
MOTION = 5 * np.sin(2 * np.pi * 0.9 * TIME) * np.sin(np.pi * TIME / 3)


def test_a_column_of_two_is_the_stack() -> None:
    pair = Column((BASE, STATUE))
    found = simulate(pair, MOTION, DT, friction=0.5)
    stack = simulate(Stack(BASE, STATUE), MOTION, DT, friction=0.5)
    np.testing.assert_array_equal(found.theta, stack.theta)
    assert found.overturned == stack.overturned


def test_history_and_outcome_of_a_column_agree() -> None:
    for friction in (None, 0.5, {"ground": 0.6, "interface": [0.5, 0.4]}):
        response = simulate(COLUMN, MOTION, DT, friction=friction)
        outcomes = overturns(COLUMN, [MOTION], DT, [1.0], friction=friction and [friction])
        assert response.theta.shape[1] == 3
        assert bool(outcomes.overturned[0, 0, 0]) == response.overturned
        assert len(outcomes.table("bodies")) == len(outcomes.table("contacts")) == 3


def test_who_fell_first_and_where_the_column_parted() -> None:
    outcomes = overturns(COLUMN, [MOTION], DT, [0.2, 1.5])
    assert outcomes.overturned.ravel().tolist() == [False, True]
    assert outcomes.overturned_body.ravel().tolist() == [0, 3]
    assert outcomes.parted_contact.ravel().tolist() == [0, 3]


def test_only_bodies_that_pure_rocking_holds_are_said_to_leave_the_ground() -> None:
    upwards = 12 * np.sin(2 * np.pi * 3 * TIME)
    with pytest.warns(LightBodies):
        overturns(Stack(BASE, STATUE), [MOTION], DT, [1.0], vertical=[upwards])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        overturns(COLUMN, [MOTION], DT, [1.0, 10.0], vertical=[upwards])


def arrangements(folder: Path, row: str) -> list:
    """Read one arrangement of three blocks."""
    (folder / "blocks.csv").write_text(
        "name,width_m,height_m,mass_kg\nplinth,0.8,0.4,500\nbase,0.5,0.3,150\nvenus,0.3,1.0,100\n"
    )
    (folder / "arrangements.csv").write_text(f"name,object,pedestal\n{row}\n")
    blocks = read_specimens(folder / "blocks.csv")
    return read_configurations(folder / "arrangements.csv", blocks)[0]


def test_an_arrangement_names_another_one_as_its_counterpart(tmp_path: Path) -> None:
    (tmp_path / "blocks.csv").write_text(
        "name,width_m,height_m,mass_kg\nplinth,0.8,0.4,500\nvenus,0.3,1.0,100\n"
    )
    table, blocks = tmp_path / "arrangements.csv", read_specimens(tmp_path / "blocks.csv")
    head = "name,object,pedestal,counterpart\nalone,venus,,\n"
    table.write_text(head + "on,venus,plinth,alone\n")
    systems, counterparts = read_configurations(table, blocks)
    assert len(systems) == 2 and counterparts == {"on": "alone"}
    for wrong in ("on", "elsewhere"):
        table.write_text(head + f"on,venus,plinth,{wrong}\n")
        with pytest.raises(InputError, match="expected another arrangement"):
            read_configurations(table, blocks)


@pytest.mark.parametrize("row", ["all,venus,base|plinth", "all,venus | base | plinth,"])
def test_an_arrangement_names_its_blocks_from_above(tmp_path: Path, row: str) -> None:
    (found,) = arrangements(tmp_path, row)
    assert labels_of(found) == {"configuration": "all", "object": "venus", "pedestal": "P"}
    assert [body.width for body in found.bodies] == [0.8, 0.5, 0.3]
    assert fallen_names(found) == ("", "plinth", "base", "venus")


def test_an_arrangement_that_names_what_stands_below_twice_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="named behind it already"):
        arrangements(tmp_path, "all,venus|base,plinth")
    with pytest.raises(InputError, match="expected one of the specimens"):
        arrangements(tmp_path, "all,venus,base|socle")


def test_a_stack_with_friction_that_holds_is_answered_by_pure_rocking() -> None:
    outcomes = overturns(
        [Stack(BASE, STATUE), COLUMN], [MOTION], DT, [0.2, 1.0], friction=[5.0, 0.4]
    )
    assert set(outcomes.engines) >= {"planar contact"} and len(outcomes.engines) > 1
