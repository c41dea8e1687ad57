"""Random bodies, what holds them and what is asked: each combination works, or is refused in a sentence."""

import math
from typing import Any

import numpy as np
import pytest

from rockfrag import Block, Column, Stack, overturns, simulate
from rockfrag.base.errors import InputError
from rockfrag.engines.spatial.engine import SpatialResponse
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation import find_thresholds
from rockfrag.simulation.options import system_of
from rockfrag.system import (
    BilinearIsolator,
    Friction,
    SlidingPendulum,
    System,
    Tie,
    Wall,
    as_system,
    hold,
)
from rockfrag.system.mounts import (
    bracket_at_top,
    cords_at_top,
    on_casters,
    putty_under,
    wall_beside,
)

from .reference_bodies import random_motion

LONGEST = 240  # letters of a refusal
NUMBERS, PLANAR = ("peak_rotation", "hits"), ("peak_velocity", "peak_slip", "slip")
"""Columns that are numbers whatever became of a body, infinite where it fell, and more of one in a plane."""


def some_body(rng: np.random.Generator) -> System:
    """A block, a stack or a column in a plane, or a block in space, as wide below as above or not."""
    width = rng.uniform(0.2, 0.6)
    top = Block(width, width * rng.uniform(1.5, 4.0), rng.uniform(20, 200))
    low = Block(rng.uniform(0.8, 1.8) * width, rng.uniform(0.1, 0.5), 150.0)
    deep = Block(top.width, top.height, top.mass, depth=rng.uniform(0.2, 0.6))
    bodies = (top, deep, Stack(low, top), Column((low, low, top)))
    return as_system(bodies[rng.integers(len(bodies))])


def some_holders(rng: np.random.Generator, system: System) -> System:
    """Up to three things that hold it, some of which no engine meets."""
    gap = rng.choice([0.0, rng.uniform(0.0, 0.3)])
    springs = (10 ** rng.uniform(3, 7), rng.choice([0.0, 0.005]))
    strength = float(rng.choice([math.inf, 10 ** rng.uniform(1, 4)]))
    ways: list[Any] = [
        lambda s: hold(s, wall_beside(s, gap, restitution=rng.uniform(0, 0.9))),
        lambda s: hold(s, wall_beside(s, gap, -1, friction=Friction(0.4, 0.4))),
        lambda s: hold(s, wall_beside(s, gap, height=rng.uniform(0.01, 0.3))),
        lambda s: hold(s, *cords_at_top(s, *springs, strength)),
        lambda s: hold(s, bracket_at_top(s, *springs, strength)),
        lambda s: hold(s, bonds=putty_under(s, 10 ** rng.uniform(0, 4))),
        lambda s: on_casters(s, str(rng.choice(["free", "locked"]))),
        lambda s: hold(s, support=SlidingPendulum(mass=20.0, radius=2.0, friction=0.1)),
        lambda s: hold(
            s,
            support=BilinearIsolator(
                mass=20.0,
                stiffness=3e3,
                strength=100.0,
                yield_displacement=0.002,
                stroke=0.1,
            ),
        ),
        lambda s: hold(s, Wall(1.0, direction=0.7)),
        lambda s: hold(s, Tie((0, 0, 0.1), (1, 0.5, 0.1), 1e4)),
    ]
    for way in rng.choice(len(ways), rng.integers(1, 4), replace=False):
        system = ways[way](system)
    return system


def asked_at_some_door(rng: np.random.Generator, system: System) -> None:
    """Ask something of it: a history, outcomes or thresholds, with what else may be asked."""
    samples = 2.0 * random_motion(rng)[:150]
    ground: Any = Motion(samples, 0.01, "x")
    if rng.uniform() < 0.3 or not system.planar:
        ground = GroundMotion(ground, Motion(samples[::-1].copy(), 0.01, "y"))
    if rng.uniform() < 0.2:
        ground = GroundMotion(Motion(samples, 0.01, "x"), z=Motion(0.3 * samples, 0.01))
    options: dict[str, Any] = {}
    if rng.uniform() < 0.7:
        options["friction"] = rng.uniform(0.2, 0.9)
    if rng.uniform() < 0.2:
        options["restitution"] = rng.uniform(0.5, 0.95)
    door = rng.integers(3)
    if door == 0:
        found = simulate(system, ground, **options)
        if isinstance(found, SpatialResponse):
            assert np.isfinite(found.history["tilt_rad"]).all()
            return
        assert np.isfinite(found.theta).all()
        told = found.constraints
        assert (0 if told is None else len(told)) == len(system.holding)
    elif door == 1:
        outcomes = overturns([system], [ground], scales=[0.5, 1.5], **options)
        table = outcomes.table("constraints")
        assert len(table) == 2 * len(system.holding)
        assert (table["largest_force_n"].fillna(0.0) >= 0.0).all()
        for name in (*NUMBERS, *(PLANAR if system.planar else ())):
            assert not np.isnan(getattr(outcomes, name)).any(), name
        if system.support is not None:
            assert np.isfinite(outcomes.stroke[..., -1]).all()
    else:
        width = {"tolerance": 0.5, "narrowest_resurrection": 1.0}
        found = find_thresholds([system], [ground], highest=2.0, **width, **options)
        assert len(found.table) == 1


def test_what_nobody_said_may_slide_is_rough_without_jamming_where_it_is_held() -> None:
    stack = as_system(Stack(Block(0.5, 0.3, 150.0), Block(0.36, 0.8, 80.0)))
    dish = SlidingPendulum(mass=17.0, radius=2.0, friction=0.06)
    held = hold(stack, bracket_at_top(stack, 1e6), support=dish)
    assert [each.friction for each in system_of(stack).contacts] == [None, None]
    assert {each.friction for each in system_of(held).contacts} == {Friction(20, 20)}
    stated = system_of(held, 0.4)
    assert {each.friction for each in stated.contacts} == {Friction(0.4, 0.4)}


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize(
    ("draws", "least"), [(12, 2), pytest.param(1000, 300, marks=pytest.mark.slow)]
)
def test_what_holds_a_body_is_simulated_at_every_door_or_refused_in_a_sentence(
    draws: int, least: int
) -> None:
    rng, answered = np.random.default_rng(53), 0
    for _ in range(draws):
        try:
            asked_at_some_door(rng, some_holders(rng, some_body(rng)))
        except InputError as error:
            said = str(error)
            assert len(said) < LONGEST and "\n" not in said, said
            assert said.rstrip()[-1] in ".)", said
            continue
        answered += 1
    assert answered >= least
