"""A column goes wherever a block goes."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.shaketable.definitions import fallen_names, labels_of
from rockfrag.simulation import overturns, simulate
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.study.configurations import read_configurations, read_specimens
from rockfrag.system import Block, Column, Stack

from .cases import DT

PLINTH, BASE, STATUE = (
    Block(0.8, 0.4, 500.0),
    Block(0.5, 0.3, 150.0),
    Block(0.3, 1.0, 100.0),
)
COLUMN = Column((PLINTH, BASE, STATUE))
TIME = np.arange(0, 3, DT)
MOTION = 5 * np.sin(2 * np.pi * 0.9 * TIME) * np.sin(np.pi * TIME / 3)


def test_history_and_outcome_of_a_column_agree() -> None:
    for friction in (None, 0.5, {"ground": 0.6, "interface": [0.5, 0.4]}):
        response = simulate(COLUMN, MOTION, DT, friction=friction)
        outcomes = overturns(
            COLUMN, [MOTION], DT, [1.0], friction=friction and [friction]
        )
        assert response.theta.shape[1] == 3
        assert bool(outcomes.overturned[0, 0, 0]) == response.overturned
        assert len(outcomes.table("bodies")) == len(outcomes.table("contacts")) == 3
    # a column of two is the stack
    pair, stack = (
        simulate(body, MOTION, DT, friction=0.5)
        for body in (Column((BASE, STATUE)), Stack(BASE, STATUE))
    )
    np.testing.assert_array_equal(pair.theta, stack.theta)


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


def arrangements(folder: Path, *rows: str) -> tuple:
    """Read arrangements of three blocks."""
    (folder / "blocks.csv").write_text(
        "name,width_m,height_m,mass_kg\nplinth,0.8,0.4,500\nbase,0.5,0.3,150\nvenus,0.3,1.0,100\n"
    )
    table = folder / "arrangements.csv"
    table.write_text("\n".join(["name,object,pedestal,counterpart", *rows]))
    return read_configurations(table, read_specimens(folder / "blocks.csv"))


@pytest.mark.parametrize(
    "row", ["all,venus,base|plinth,", "all,venus | base | plinth,,"]
)
def test_an_arrangement_names_its_blocks_from_above(tmp_path: Path, row: str) -> None:
    ((found,), _) = arrangements(tmp_path, row)
    assert labels_of(found) == {
        "configuration": "all",
        "object": "venus",
        "pedestal": "P",
    }
    assert [body.width for body in found.bodies] == [0.8, 0.5, 0.3]
    assert fallen_names(found) == ("", "plinth", "base", "venus")


def test_an_arrangement_names_another_one_as_its_counterpart(tmp_path: Path) -> None:
    alone = "alone,venus,,"
    systems, counterparts = arrangements(tmp_path, alone, "on,venus,plinth,alone")
    assert len(systems) == 2 and counterparts == {"on": "alone"}
    for row, said in (
        ("on,venus,plinth,on", "expected another arrangement"),
        ("on,venus,plinth,elsewhere", "expected another arrangement"),
        ("all,venus|base,plinth,", "named behind it already"),
        ("all,venus,base|socle,", "expected one of the specimens"),
    ):
        with pytest.raises(InputError, match=said):
            arrangements(tmp_path, alone, row)


def test_a_stack_with_friction_that_holds_is_answered_by_pure_rocking() -> None:
    outcomes = overturns(
        [Stack(BASE, STATUE), COLUMN], [MOTION], DT, [0.2, 1.0], friction=[5.0, 0.4]
    )
    assert set(outcomes.engines) >= {"planar contact"} and len(outcomes.engines) > 1
