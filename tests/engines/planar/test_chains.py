"""What a response leaves behind is what the next motion finds."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack, simulate
from rockfrag.base.errors import InputError
from rockfrag.simulation.holding import bond_tension_needed
from rockfrag.system import (
    BilinearIsolator,
    Bond,
    Friction,
    SlidingPendulum,
    Tie,
    Wall,
    as_system,
    hold,
)

from ...simulation.reference_bodies import random_motion
from .cases import DT, run

BLOCK = Block(0.4, 1.0, 100.0)
QUIET = np.zeros(1500)
LOOSE = Friction(0.42, 0.2)  # it slides in impacts


def chained(body, first, second, **options):
    """Response to the second motion after the first, and that to both with quiet time between them."""
    before = run(body, first, friction=LOOSE, **options)
    after = run(before.system_after(), second, **options)
    whole = run(body, np.concatenate([first, QUIET, second]), friction=LOOSE, **options)
    return before, after, whole


@pytest.mark.parametrize("body", [BLOCK, Stack(Block(0.5, 0.3, 150.0), BLOCK)])
def test_a_chain_is_the_response_to_all_with_quiet_time(body) -> None:
    first, second = (
        0.8 * random_motion(np.random.default_rng(seed))[:400] for seed in (5, 6)
    )
    before, after, whole = chained(body, first, second)
    at = first.size + QUIET.size
    assert not before.overturned
    assert np.abs(before.slip[-1]).max() > 1e-4
    samples = min(len(after.theta), len(whole.theta) - at)
    assert samples > 100
    assert np.array_equal(after.theta[:samples], whole.theta[at : at + samples])
    assert np.array_equal(after.slip[:samples], whole.slip[at : at + samples])


def test_what_has_broken_is_gone_and_what_has_slid_is_nearer_to_its_wall() -> None:
    motion = 0.8 * random_motion(np.random.default_rng(5))[:400]
    cord = Tie((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), 1e5, strength=50.0)
    held = hold(as_system(BLOCK), Wall(0.4), cord, bonds=Bond(10.0, 10.0, 0.1))
    before = run(held, motion, friction=LOOSE)
    assert before.constraints["breaking_time_s"].notna().tolist() == [False, True, True]
    after = before.system_after()
    assert after.holding == ("wall 1",)
    assert run(after, motion).slip[0] == pytest.approx(before.slip[-1], abs=1e-12)


def test_a_bond_that_the_main_shock_broke_stays_broken_in_the_aftershock() -> None:
    motion = 0.8 * random_motion(np.random.default_rng(5))[:400]
    first, second = 2.0 * motion, 1.1 * motion
    # so strong that it bears what follows, had it not been broken
    needed = bond_tension_needed(BLOCK, second, 0.1)
    held = hold(as_system(BLOCK), bonds=Bond(1.02 * needed, 1e6, 0.1))
    before, after, whole = chained(held, first, second)
    at = first.size + QUIET.size
    assert not before.overturned
    assert 0 < whole.constraints["breaking_time_s"][0] < first.size * DT
    samples = min(len(after.theta), len(whole.theta) - at)
    assert np.array_equal(after.theta[:samples], whole.theta[at : at + samples])
    assert np.abs(after.theta).max() > 0
    unbroken = run(held, second, friction=LOOSE)
    assert math.isnan(unbroken.constraints["breaking_time_s"][0])
    assert np.abs(unbroken.theta).max() == 0


def test_an_isolator_begins_where_it_was_left() -> None:
    support = SlidingPendulum(mass=20.0, radius=2.0, friction=0.1)
    held = hold(as_system(Block(0.6, 1.2, 100.0)), support=support)
    motion = 3 * random_motion(np.random.default_rng(5))[:300]
    before, after, whole = chained(held, motion, motion)
    at = motion.size + QUIET.size
    assert abs(before.plate[-1]) > 1e-3
    samples = min(len(after.plate), len(whole.plate) - at)
    assert np.array_equal(after.plate[:samples], whole.plate[at : at + samples])


def test_what_leans_at_its_wall_begins_there() -> None:
    tall = Block(0.3, 1.2, 100.0)
    held = hold(as_system(tall), Wall(0.15 + 1.2 * math.sin(0.3) + 1e-3))
    first = np.zeros(1000)
    before = simulate(held, first, DT, theta0=0.3, friction=0.6)
    assert before.theta[-1, 0] > math.atan(0.25)
    second = 0.5 * random_motion(np.random.default_rng(6))[:300]
    after = simulate(before.system_after(), second, DT)
    both = np.concatenate([first, QUIET, second])
    whole = simulate(held, both, DT, theta0=0.3, friction=0.6)
    at, samples = first.size + QUIET.size, second.size
    assert np.ptp(after.theta) > 1e-3
    # what leans keeps a rate of 1e-34 rad/s, from which a start is free
    found, expected = after.theta[:samples], whole.theta[at : at + samples]
    assert found == pytest.approx(expected, abs=1e-12)


def isolated(support):
    """Response of a block on an isolator to a motion with quiet time after it."""
    motion = 3 * random_motion(np.random.default_rng(5))[:300]
    held = hold(as_system(Block(0.6, 1.2, 100.0)), support=support)
    return simulate(held, np.append(motion, QUIET), DT, friction=0.6)


@pytest.mark.parametrize("strength", [0.0, 150.0])
def test_a_bilinear_isolator_that_has_not_come_back_asks_for_both_records(
    strength,
) -> None:
    springs = BilinearIsolator(mass=50.0, stiffness=2000.0, strength=strength)
    found = isolated(springs)
    # within its yield displacement, or without one, it loses nothing
    assert found.plate is not None
    assert np.ptp(found.plate[-200:]) > 1e-4
    with pytest.raises(InputError, match="append the records, with quiet time"):
        found.system_after()


def test_a_bilinear_isolator_that_never_moved_is_as_it_was() -> None:
    springs = BilinearIsolator(mass=50.0, stiffness=2000.0, strength=150.0)
    held = hold(as_system(Block(0.6, 1.2, 100.0)), support=springs)
    found = simulate(held, np.zeros(100), DT, friction=0.6)
    start = found.system_after().start
    assert start is None or (start.plate, start.rotation) == (0.0, (0.0,))


def test_a_dish_without_friction_never_rests() -> None:
    found = isolated(SlidingPendulum(mass=50.0, radius=2.0))
    with pytest.raises(InputError, match="still move at the end"):
        found.system_after()


def test_what_still_slides_is_not_at_rest() -> None:
    # rolling resistance so small that it rolls beyond the end of the history
    found = simulate(BLOCK, np.full(30, 3.0), DT, friction=0.005)
    assert np.abs(found.omega[-1]).max() == 0
    assert found.slides[-1, 0] != 0
    with pytest.raises(InputError, match="still move at the end"):
        found.system_after()


def test_what_fell_is_not_shaken_again() -> None:
    pushed = simulate(BLOCK, np.full(200, 6.0), DT, friction=0.8)
    assert pushed.overturned
    with pytest.raises(InputError, match="the block has fallen"):
        pushed.system_after()


def test_what_never_slid_is_the_system_that_it_was() -> None:
    found = simulate(BLOCK, 4.5 * np.sin(2 * math.pi * np.arange(0, 1, DT)), DT)
    assert found.system_after() == as_system(BLOCK)
