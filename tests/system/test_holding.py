"""What holds bodies is checked where it is written, and named in the tables."""

import math
from dataclasses import replace

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
from rockfrag.system.body import Circle, Interval, Polygon, RigidBody
from rockfrag.system.mounts import wall_beside
from rockfrag.system.system import Start, System, cylinder, reach_at, with_bodies

BLOCK = Block(0.3, 1.2, 100.0)
STACK = Stack(Block(0.6, 0.4, 300.0), BLOCK)
DEEP = Block(0.3, 1.2, 100.0, depth=0.2).system()
ROUND = System(
    (cylinder(0.3, 1.2, 100.0, None, (0.0, 0.0, 0.6)),), as_system(BLOCK).contacts
)
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
            lambda: hold(as_system(BLOCK), bonds=Bond(1.0, 1.0, 0.151)),
            "Bond: spread: the pads lie outside the base .* give 0.15 m at most",
        ),
        (
            lambda: hold(as_system(STACK), bonds=[Bond(1.0, 1.0, 5.0), None]),
            "give 0.3 m at most",
        ),
        (
            lambda: hold(DEEP, bonds=Bond(1.0, 1.0, (0.15, 0.15))),
            r"at ± \(0.15, 0.15\) m; \(0.1, 0.1\) m would be at its edge",
        ),
        (
            lambda: hold(ROUND, bonds=Bond(1.0, 1.0, 0.15)),
            r"\(0.106066, 0.106066\) m would be at its edge",
        ),
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


SQUARE = ((-0.3, -0.2), (0.3, -0.2), (0.3, 0.2), (-0.3, 0.2))


@pytest.mark.parametrize(
    ("base", "room"),
    [
        (Interval(-0.1, 0.3), 2.0),  # around its middle
        (Polygon(SQUARE), 1.0),
        # around the origin
        (Polygon(tuple((x + 0.25, y) for x, y in SQUARE)), 0.5),
        # |x| + |y| ≤ 0.6
        (Polygon(((0.6, 0.0), (0.0, 0.6), (-0.6, 0.0), (0.0, -0.6))), 2.0),
        (Circle(math.sqrt(0.05)), 1.0),
        # (0.1 s + 0.15)² + (0.2 s)² = 0.25²: of the pad on the far side
        (Circle(0.25, (0.15, 0.0)), (math.sqrt(0.0089) - 0.03) / 0.1),
        (Circle(0.1, (0.15, 0.0)), 0.0),
    ],
)
def test_pads_have_room_up_to_the_edge_of_a_base(base, room):
    bond = Bond(1.0, 1.0, (0.1, 0.2))
    assert bond.room_under(base) == pytest.approx(room)
    part = min(room, 1.0) or 1.0  # where none lies inside none is shifted
    assert bond.kept_under(base).pads == pytest.approx((part * 0.1, part * 0.2))


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


def test_what_is_not_said_of_a_tie_or_of_a_start_is_nothing():
    assert (CORD.damping, CORD.slack, CORD.strength) == (0.0, 0.0, math.inf)
    assert Start((0.1,), (0.0,)).plate == 0.0


def test_a_wall_keeps_its_distance_from_bodies_of_other_sizes():
    for side in (1, -1):
        wall = wall_beside(as_system(BLOCK), 0.07, side)
        held = hold(as_system(BLOCK), wall)
        for width in (0.2, 0.3, 0.5):
            body = replace(BLOCK, width=width).body
            (moved,) = with_bodies(held, [body]).constraints
            assert (moved.side, moved.distance) == (
                side,
                pytest.approx(width / 2 + 0.07),
            )


def test_a_body_in_space_reaches_as_far_as_the_wider_of_its_base_and_its_face():
    narrow, wide = ((0.2, 0.1), (-0.2, 0.1), (-0.2, -0.1), (0.2, -0.1)), SQUARE
    tensor = np.diag([3.0, 3.0, 2.0])
    for base, face in ((narrow, wide), (wide, narrow), (wide, None)):
        outlines = Polygon(base), face and Polygon(face)
        body = RigidBody(50.0, tensor, (0.0, 0.0, 0.4), outlines[0], 1.0, outlines[1])
        system = System((body,), as_system(BLOCK).contacts)
        for angle in (0.0, 0.6, 2.0):
            along = math.cos(angle), math.sin(angle)
            found = reach_at(system, Wall(2.0, angle))
            assert found == pytest.approx(np.dot(SQUARE, along).max())
