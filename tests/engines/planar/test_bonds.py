"""Bonds: the exact instant at which they break, and what they are with no strength and with any."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.system import Bond, Contact, System, as_system, hold
from rockfrag.system.body import Interval

from ...simulation.reference_bodies import random_motion
from .cases import DT, G, run

B, H, M = 0.15, 0.6, 100.0  # half width, half height [m], mass [kg]
BLOCK = Block(2 * B, 2 * H, M)
RISE = 10.0  # rate of a rising acceleration [m/s³]
RAMP = RISE * np.arange(0.0, 1.2, 0.1)
STRONG = 1e9  # capacity that nothing reaches [N]


def bonded(bond: Bond, body=BLOCK):
    return hold(as_system(body), bonds=bond)


def breaking(bond: Bond, up: float = 0.0, mu: float = 0.9) -> float:
    """Acceleration at which a bond breaks under one that rises slowly."""
    vertical = np.full(RAMP.size, up)
    found = run(bonded(bond), RAMP, 0.1, friction=mu, vertical=vertical)
    (row,) = found.constraints.itertuples()
    return RISE * row.breaking_time_s


@pytest.mark.parametrize("up", [0.0, 2.0, -3.0])
@pytest.mark.parametrize(("spread", "tension"), [(0.15, 200.0), (0.05, 800.0)])
def test_a_bond_breaks_where_its_pads_are_overloaded(
    spread: float, tension: float, up: float
) -> None:
    """a/(g + a_v) = (c/h)(1 + 2 F_t/(m (g + a_v))), F_t half of the capacity."""
    expected = spread / H * (G + up + tension / M)
    assert breaking(Bond(tension, STRONG, spread), up) == pytest.approx(
        expected, rel=1e-10
    )


@pytest.mark.parametrize("aside", [0.0, 0.1])
def test_pads_of_what_is_wider_than_its_pedestal_lie_around_the_middle_of_what_it_stands_on(
    aside: float,
) -> None:
    """As under a base as wide as the face below, with the centre of gravity ``aside`` of its middle."""
    half, wide = 0.1, Block(6 * B, 2 * H, M)
    foot, body = as_system(Stack(Block(2.0, 0.2, 900.0), wide, offset=aside)).bodies
    narrow = replace(foot, face=Interval(-half, half))
    contacts = Contact(), Contact(offset=(aside, 0.0))
    system = hold(System((narrow, body), contacts), bonds=Bond(200.0, STRONG, half))
    (row,) = run(system, RAMP, 0.1, friction=0.9).constraints.itertuples()
    # towards the left it is lifted at the right
    expected = (half * (G + 200.0 / M) + aside * G) / H
    assert RISE * row.breaking_time_s == pytest.approx(expected, rel=1e-9)


def test_a_bond_breaks_by_shear_at_friction_and_its_own() -> None:
    """a = µ (g + a_v) + F_s/m."""
    found = breaking(Bond(STRONG, 150.0, 0.15), 1.0, mu=0.2)
    assert found == pytest.approx(0.2 * (G + 1.0) + 150.0 / M, rel=1e-10)


def test_a_layer_breaks_at_its_edge() -> None:
    """a/g = (w/6h)(1 + f_t w d/(m g))."""
    width, depth, strength = 0.3, 0.2, 2e4
    bond = Bond.of_layer(width, depth, strength, 1e9)
    expected = width / (6 * H) * (G + strength * width * depth / M)
    assert breaking(bond) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("body", [BLOCK, Stack(Block(0.6, 0.3, 200.0), BLOCK)])
def test_a_bond_without_strength_at_the_ends_of_the_base_is_none(body) -> None:
    motion = 2 * random_motion(np.random.default_rng(3))
    free = run(body, motion, friction=0.6)
    found = run(bonded(Bond(0.0, 0.0, B), body), motion, friction=0.6)
    assert len(free.contact_events) > 10
    assert not math.isnan(found.constraints["breaking_time_s"][0])
    # the forces of pads at the ends of a base are those of its ends, but for rounding
    until = free.contact_events["time"].iloc[8]
    early = free.time < until
    assert found.theta[: early.size][early] == pytest.approx(
        free.theta[early], abs=1e-9
    )


def test_after_its_break_a_block_moves_as_one_that_was_never_bonded() -> None:
    """To the motion muted before, which is to say from rest at that instant."""
    # the bond breaks within rounding at the last sample at rest, where the motion jumps up
    level = 0.1 / H * (G + 300.0 / M)
    motion = np.concatenate([np.linspace(0, level * (1 + 1e-12), 11), np.full(30, 5.0)])
    found = run(bonded(Bond(300.0, STRONG, 0.1)), motion, DT, friction=0.6)
    muted = run(BLOCK, motion[10:], DT, friction=0.6)
    assert found.constraints["breaking_time_s"][0] == pytest.approx(0.1, abs=1e-9)
    samples = min(len(muted.theta), len(found.theta) - 10)
    assert np.abs(found.theta[:11]).max() == 0.0
    assert found.theta[10 : 10 + samples] == pytest.approx(
        muted.theta[:samples], abs=1e-9
    )


def test_a_bond_that_breaks_as_the_motion_begins_leaves_every_bit() -> None:
    motion = 5.0 + random_motion(np.random.default_rng(4))[:200]
    free = run(BLOCK, motion, friction=0.6)
    found = run(bonded(Bond(300.0, STRONG, 0.1)), motion, friction=0.6)
    assert found.constraints["breaking_time_s"][0] == 0.0
    assert np.abs(free.theta).max() > 0.1
    assert np.array_equal(found.theta, free.theta)
    assert np.array_equal(found.normal_force[1:], free.normal_force[1:])


def test_bodies_that_are_bonded_for_ever_move_as_one() -> None:
    stack = Stack(Block(0.5, 0.3, 150.0), Block(0.4, 0.9, 120.0))
    motion = 1.5 * random_motion(np.random.default_rng(3))
    found = run(bonded(Bond(STRONG, STRONG, 0.1), stack), motion, friction=0.9)
    joined = run(stack.rigidly_joined(), motion, friction=0.9)
    until = found.contact_events["time"].iloc[min(8, len(joined.contact_events) - 1)]
    early = found.time < until
    assert np.abs(joined.theta).max() > 1e-3
    # an impact asks an impulse of the bond, which breaks where it would pull
    end = found.constraints["breaking_time_s"][0]
    early &= ~(found.time >= end)
    assert early.sum() > 20
    assert found.theta[early] == pytest.approx(
        np.repeat(joined.theta[: early.sum()], 2, axis=1), abs=1e-7
    )


def test_what_a_bond_needs_is_told_where_it_holds() -> None:
    """2 (N/2 - m a h/(2 c)) below zero: m (a h/c - g)."""
    motion = np.concatenate([np.linspace(0, 4.0, 20), np.linspace(4.0, 0, 20)])
    found = run(bonded(Bond(2000.0, STRONG, 0.1)), motion, DT, friction=0.6)
    needed = M * (4.0 * H / 0.1 - G)
    assert found.constraints["largest_force_n"][0] == pytest.approx(needed, rel=1e-9)
    assert math.isnan(found.constraints["breaking_time_s"][0])
    weaker = run(bonded(Bond(0.99 * needed, STRONG, 0.1)), motion, friction=0.6)
    assert weaker.constraints["breaking_time_s"][0] > 0.0
    assert weaker.constraints["largest_force_n"][0] == pytest.approx(0.99 * needed)
