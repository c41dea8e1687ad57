"""Blocks and stacks of any shape: arms, critical angles, thresholds."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rockfrag import Block, Stack, simulate
from rockfrag.system import geometry
from rockfrag.units import GRAVITY as G

from .reference_bodies import T2, P

STATUE = Block(0.50, 1.60, 400.0, inertia=70.0, cg_height=0.62, cg_offset=0.06, lean=0.01)

lengths = st.floats(0.05, 3.0)


@given(lengths, lengths)
def test_uniform_block_has_the_textbook_properties(width: float, height: float) -> None:
    block = Block(width, height, 10.0)
    radius = math.hypot(width, height) / 2
    assert block.alpha == pytest.approx(math.atan(width / height), rel=1e-12)
    assert block.radius() == pytest.approx(radius, rel=1e-12)
    assert block.pivot_inertia() == pytest.approx(4 / 3 * 10.0 * radius**2, rel=1e-12)
    assert block.frequency() == pytest.approx(math.sqrt(3 * G / (4 * radius)), rel=1e-12)
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
def test_each_side_starts_to_rock_exactly_at_its_own_acceleration(block, pivot: int) -> None:
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
    np.testing.assert_allclose(first.normal_force, other.normal_force, rtol=1e-6, atol=1e-6)
