"""What holds bodies is checked where it is written, and named in the tables."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.base.errors import InputError
from rockfrag.outcomes.limit_states import limit_state_named
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.system import (
    BilinearIsolator,
    Bond,
    SlidingPendulum,
    Tie,
    Wall,
    as_system,
    hold,
)

BLOCK = Block(0.3, 1.2, 100.0)
STACK = Stack(Block(0.6, 0.4, 300.0), BLOCK)
CORD = Tie((0.0, 0.0, 1.2), (0.5, 0.0, 1.2), 1e4)


def test_what_holds_a_system_is_named_in_one_order():
    bond = Bond(100.0, 50.0, 0.1)
    support = SlidingPendulum(mass=20.0, radius=2.0, friction=0.05)
    held = hold(as_system(STACK), Wall(0.4), CORD, bonds=bond, support=support)
    assert held.holding == ("wall 1", "tie 2", "bond 2", "support")
    assert held.free() == as_system(STACK)
    assert bond.spread == (0.1, 0.1)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Wall("near"), "Wall: distance: expected a finite number of metres"),
        (lambda: Wall(1.0, restitution=1.1), "expected a ratio from 0 to 1"),
        (lambda: Wall(1.0, height=0.0), "Wall: height: expected a positive number"),
        (
            lambda: Wall(1.0, friction=-1.0),
            "Wall: friction: a coefficient is 0 or more",
        ),
        (lambda: Tie((0, 0), (1, 0, 1), 1e4), r"Tie: point: expected \(x, y, z\)"),
        (lambda: Tie((0, 0, 1), (1, 0, 1), 0.0), "Tie: stiffness: expected a positive"),
        (lambda: Bond(-1.0, 0.0, 0.1), "Bond: tension: expected a number of newtons"),
        (lambda: Bond(1.0, 0.0, (0.1,)), r"Bond: spread: expected \(x, y\)"),
        (
            lambda: SlidingPendulum(mass=0.0),
            "SlidingPendulum: mass: expected a positive",
        ),
        (
            lambda: BilinearIsolator(mass=1.0, stiffness=-1.0),
            "BilinearIsolator: stiffness: expected a number of N/m",
        ),
        (
            lambda: hold(as_system(BLOCK), Wall(0.1)),
            "Wall: at 0.1 m it stands where the bodies are; they reach to 0.15 m",
        ),
        (
            lambda: hold(as_system(BLOCK), Wall(0.3, direction=1.0)),
            "give the direction 0 or π",
        ),
        (
            lambda: hold(as_system(BLOCK), Tie((0, 0, 1), (1, 0, 1), 1e4, body=1)),
            "Tie: body 1 is none of 1 from below",
        ),
        (
            lambda: hold(as_system(BLOCK), bonds=[None, None]),
            "bonds: expected one entry for each of 1 contacts, got 2",
        ),
    ],
)
def test_what_cannot_hold_is_refused_in_one_sentence(make, says):
    with pytest.raises(InputError, match=says):
        make()


def test_a_layer_breaks_where_its_edge_reaches_its_strength():
    # a/g = (w/6h)(1 + f_t w d/(m g)) against (c/h)(1 + F/(m g))
    width, depth, strength = 0.3, 0.2, 5e4
    bond = Bond.of_layer(width, depth, strength, 1e5)
    assert bond.spread == pytest.approx((width / 6, depth / 6))
    assert bond.tension == pytest.approx(strength * width * depth)


def test_outcomes_have_a_row_for_all_that_holds_and_none_where_nothing_does():
    names, holding = [("block",), ("block",)], [(), ("wall 1", "bond 1")]
    found = empty_outcomes(names, np.ones((1, 2)), ("an engine",), holding=holding)
    table = found.table("constraints")
    assert list(table["name"]) == ["wall 1", "bond 1"] * 2
    assert list(table.columns[5:]) == [
        *("constraint", "name", "hits", "largest_impulse_n_s", "largest_force_n"),
        *("breaking_time_s", "stroke_m"),
    ]
    assert math.isnan(table["breaking_time_s"][0])
    assert "hits_constraint_2" in found.wide(1, ["hits"])
    found.leaning[1, 0, 1] = True
    assert limit_state_named("leans").reached(found).sum() == 1
    assert not limit_state_named("leans").counted(as_system(BLOCK))
    assert limit_state_named("leans").counted(hold(as_system(BLOCK), Wall(1.0)))


def test_one_bond_is_that_of_the_uppermost_contact_and_others_keep_theirs():
    below, above = Bond(50.0, 5.0, 0.2), Bond(20.0, 2.0, 0.1)
    held = hold(hold(as_system(STACK), bonds=[below, None]), bonds=above)
    assert [contact.bond for contact in held.contacts] == [below, above]
