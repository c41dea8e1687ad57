"""A system is its bodies, its contacts and its start; blocks, stacks and columns are ways to write one."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rockfrag import Block, Stack, simulate
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY as G
from rockfrag.system import Tie, geometry, hold
from rockfrag.system.blocks import Column
from rockfrag.system.body import (
    Circle,
    Interval,
    Polygon,
    RigidBody,
    checked_tensor,
)
from rockfrag.system.contact import Contact, Friction, checked_friction
from rockfrag.system.system import System, each_contact, uplift_ratios

from ..oracle.standing import upper_on_contact
from ..simulation.reference_bodies import T2, P

SIZES = st.floats(0.05, 3.0)


@given(SIZES, SIZES, st.floats(-0.2, 0.2), st.floats(-0.02, 0.02), st.floats(-0.2, 0.2))
def test_a_system_has_the_same_bits_as_the_blocks_that_wrote_it(
    width, height, aside, lean, offset
):
    # a high block that leans may have nothing under its centre of gravity
    assume(abs(aside) * width + abs(lean) * height < 0.45 * width)
    block = Block(width, height, 40.0, cg_offset=aside * width, lean=lean)
    assert block.system().shapes == (block.shape,)
    stack = Stack(Block(2 * width, 2 * width, 90.0, lean=-lean), block, offset * width)
    assert stack.system().pile == stack.pile
    assert stack.system().carried == (stack.lower.shape, stack.pile.upper)


def test_a_statue_that_reaches_beyond_its_pedestal_rocks_on_the_overlap_in_a_column_too():
    stack = Stack(Block(0.4, 0.3, 150.0), Block(0.5, 1.2, 100.0), offset=0.01)
    three = Column((stack.lower, stack.upper, Block(0.2, 0.4, 10.0)), (0.01, 0.0))
    lower, upper = three.system().carried[1], upper_on_contact(stack).shape
    assert lower.b == pytest.approx(upper.b, rel=1e-15)
    assert lower.x == pytest.approx(upper.x, rel=1e-12)


def test_a_tie_holds_the_uppermost_body_if_nothing_is_said_of_it():
    stack = Stack(Block(0.6, 0.4, 300.0), Block(0.3, 1.0, 100.0))
    tie = Tie((0.0, 0.0, 1.0), (1.0, 0.0, 1.4), 1e4)
    (held,) = hold(stack.system(), tie).constraints
    assert stack.system().bodies[held.body].mass == 100.0


def test_a_body_rocks_on_its_base_however_narrow_its_face_is():
    """A bust on a foot whose top is narrower and aside."""
    base, face = Interval(-0.3, 0.5), Interval(0.1, 0.2)
    body = RigidBody(50.0, 4.0, (0.15, 0.0, 0.4), base, 1.0, face)
    (shape,) = System((body,), (Contact(),)).shapes
    assert (shape.b, shape.x, shape.y) == pytest.approx((0.4, 0.05, 0.4))


@pytest.mark.parametrize("value", [np.eye(2), np.diag([1.0, 1.0, np.nan])])
def test_a_tensor_of_inertia_has_nine_numbers(value):
    with pytest.raises(InputError, match="or a tensor of shape"):
        checked_tensor(value)


def test_a_tensor_that_is_turned_there_and_back_is_still_one():
    """Rounding leaves it asymmetric by its last digits, where it is nothing otherwise."""
    rng, asymmetric = np.random.default_rng(5), 0
    for _ in range(10):
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        tensor = turn.T @ (turn @ np.diag([3.0, 2.5, 1.0]) @ turn.T) @ turn
        asymmetric += not np.array_equal(tensor, tensor.T)
        np.testing.assert_array_equal(checked_tensor(tensor), tensor)
    assert asymmetric > 5
    with pytest.raises(InputError, match="must be symmetric"):
        checked_tensor([[3.0, 1e-6, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 1.0]])


def test_boxes_and_cylinders_in_space_are_seen_as_planar_blocks():
    box = Block(0.3, 1.0, 50.0, depth=0.2)
    assert box.system().in_plane().shapes == (Block(0.3, 1.0, 50.0).shape,)
    assert box.body.seen_along(90.0).base == pytest.approx(Interval(-0.1, 0.1))
    assert box.body.seen_along(90.0).inertia == pytest.approx(50 * (0.2**2 + 1.0) / 12)
    drum = Block(0.4, 1.0, 50.0, round=True)
    assert drum.body.base == Circle(0.2)
    assert np.diag(drum.body.tensor) == pytest.approx(
        [50 * 1.12 / 12] * 2 + [50 * 0.04 / 2]
    )
    assert drum.body.seen_along(217.0).inertia == pytest.approx(
        drum.centroidal_inertia, rel=1e-14
    )


def test_a_body_turned_by_some_angle_is_seen_as_its_tensor_says():
    tensor = ((2.0, 0.3, 0.1), (0.3, 1.5, -0.2), (0.1, -0.2, 1.0))
    base = Polygon(((-0.9, -0.4), (0.6, -0.7), (0.8, 0.3), (-0.2, 0.9)))
    body, angle = (
        RigidBody(10.0, tensor, (0.01, 0.02, 0.5), base, 1.0),
        math.radians(37.0),
    )
    axis = np.array([-math.sin(angle), math.cos(angle), 0.0])
    seen, back = body.seen_along(37.0), body.seen_along(217.0).base
    assert seen.inertia == pytest.approx(axis @ np.array(tensor) @ axis)
    assert seen.centre[0] == pytest.approx(
        0.01 * math.cos(angle) + 0.02 * math.sin(angle)
    )
    assert (back.left, back.right) == pytest.approx((-seen.base.right, -seen.base.left))


def test_contacts_are_named_so_that_no_pair_can_be_misread():
    assert each_contact("friction", 0.4, 2) == (0.4, 0.4)
    assert each_contact("friction", {"ground": 0.6, "interface": 0.2}, 2) == (0.6, 0.2)
    assert each_contact("friction", {"ground": 0.6}, 3) == (0.6, None, None)
    assert each_contact("friction", {"interface": [0.3, 0.2]}, 3) == (None, 0.3, 0.2)
    assert checked_friction("friction", math.inf) == Friction(1e6, 1e6)
    # a number in an array without axes is a number
    assert checked_friction("friction", np.array(0.4)) == Friction(0.4, 0.4)


def test_each_contact_opens_at_the_least_width_over_height_of_what_stands_on_it():
    upper = Block(0.2, 0.8, 50.0)
    assert uplift_ratios(upper.system()) == pytest.approx((0.25,))
    # a slender pedestal goes before its statue, at the b/h of the two together
    slender = Stack(Block(0.2, 1.2, 60.0), upper)
    both = slender.rigidly_joined()
    assert uplift_ratios(slender.system()) == pytest.approx((both.b / both.h, 0.25))
    assert both.b / both.h < 0.25


def test_a_column_opens_as_the_blocks_that_it_is_made_of_do():
    blocks = (Block(0.5, 0.3, 90.0, lean=0.01), Block(0.35, 0.7, 60.0, cg_offset=0.02))
    of_two = uplift_ratios(Stack(*blocks, offset=0.03).system())
    # a light slip of a third block changes what stands on each contact by its mass alone
    column = Column((*blocks, Block(0.3, 1e-6, 1e-9)), (0.03, 0.0))
    assert uplift_ratios(column.system())[:2] == pytest.approx(of_two)


STATUE = Block(
    0.50, 1.60, 400.0, inertia=70.0, cg_height=0.62, cg_offset=0.06, lean=0.01
)


@given(SIZES, SIZES)
def test_uniform_block_has_the_textbook_properties(width: float, height: float) -> None:
    block = Block(width, height, 10.0)
    radius = math.hypot(width, height) / 2
    assert block.alpha == pytest.approx(math.atan(width / height), rel=1e-12)
    assert block.radius() == pytest.approx(radius, rel=1e-12)
    assert block.pivot_inertia() == pytest.approx(4 / 3 * 10.0 * radius**2, rel=1e-12)
    assert block.frequency() == pytest.approx(
        math.sqrt(3 * G / (4 * radius)), rel=1e-12
    )
    # 1 - 1.5 sin²α (thesis eq. 2.14)
    expected = 1 - 1.5 * math.sin(block.alpha) ** 2
    assert block.momentum_restitution() == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("number", [np.float32, np.int64, Fraction])
def test_a_block_takes_any_type_of_number(number: type) -> None:
    bodies = [Block(*map(kind, (1, 3, 500, 450, 1))) for kind in (number, float)]
    found, plain = (simulate(body, 5.0 * np.ones(50), 0.01).theta for body in bodies)
    np.testing.assert_array_equal(found, plain)


@pytest.mark.parametrize("pivot", [+1, -1])
def test_it_balances_at_its_critical_angle_and_tips_beyond(pivot: int) -> None:
    # the centre of gravity lies to the right, and the lean brings it further: it falls right first
    assert STATUE.alpha == STATUE.critical_angle(+1) < STATUE.critical_angle(-1)
    critical = pivot * STATUE.critical_angle(pivot)
    quiet = np.zeros(3)
    inside = simulate(STATUE, quiet, 0.01, theta0=0.999 * critical)
    beyond = simulate(STATUE, quiet, 0.01, theta0=1.001 * critical)
    assert inside.alpha[0, 0] * pivot < 0 < beyond.alpha[0, 0] * pivot
    assert beyond.overturned and beyond.impacts == 0
    # released on its strong side it may still fall over the weak one, after an impact
    assert not inside.overturned or inside.impacts == 1
    balanced = simulate(STATUE, quiet, 0.01, theta0=critical)
    assert abs(balanced.alpha[0, 0]) < 1e-12 * STATUE.frequency(pivot) ** 2 * 1e3


@pytest.mark.parametrize("pivot", [+1, -1])
@pytest.mark.parametrize("block", [STATUE, T2])
def test_each_side_starts_to_rock_exactly_at_its_own_acceleration(
    block, pivot: int
) -> None:
    x, y = geometry.arm(block.shape, pivot)
    # an acceleration to the left turns the block clockwise, about the right corner
    response = simulate(block, pivot * np.linspace(0.0, -6.0, 3), 1.0)
    start = response.contact_events["time"].iloc[0]
    assert start == pytest.approx(abs(x) / y * G / 3.0, rel=1e-9)
    assert np.sign(response.state[response.time > start, 0][0]) == pivot


WIDE = Block(0.30, 0.50, 5.0, cg_offset=0.01)
"""A statue that reaches 58 mm beyond the pedestal on either side."""


@pytest.mark.parametrize(
    ("stack", "width", "aside", "offset"),
    [(Stack(P, WIDE, offset=0.02), P.width, 0.03, 0.0), (Stack(P, T2, offset=0.05), 0.104, 0.01, 0.04)],
    ids=["wider than its pedestal", "over one edge"],
)  # fmt: skip
def test_a_statue_that_reaches_over_an_edge_rocks_as_one_whose_base_is_the_overlap(
    stack, width, aside, offset
):
    statue = stack.upper
    inertia = statue.centroidal_inertia
    narrow = Block(width, statue.height, statue.mass, inertia=inertia, cg_offset=aside)
    motion = 6.0 * np.sin(np.arange(200) * 0.3)
    first = simulate(stack, motion, 0.01)
    other = simulate(Stack(P, narrow, offset), motion, 0.01)
    assert first.impacts > 3
    np.testing.assert_allclose(first.theta, other.theta, atol=1e-9)
    np.testing.assert_allclose(
        first.normal_force, other.normal_force, rtol=1e-6, atol=1e-6
    )


def test_a_system_is_loose_where_a_contact_has_friction():
    stack = Stack(Block(0.6, 0.4, 300.0), Block(0.3, 1.0, 100.0)).system()
    loose = stack.with_friction(Friction(0.4, 0.3), at=1)
    assert [each.friction for each in loose.contacts] == [None, Friction(0.4, 0.3)]
    assert (stack.loose, loose.loose, loose.held().loose) == (False, True, False)
