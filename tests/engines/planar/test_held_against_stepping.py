"""Outcomes of held blocks beside a time stepping that shares nothing with the engine."""

import math

import numpy as np
import pytest

from rockfrag import Block, overturns
from rockfrag.system import Bond, SlidingPendulum, Tie, Wall, as_system, hold

from ...oracle.held_stepping import Held, outcome
from ...simulation.reference_bodies import random_motion
from .cases import DT

NONE = np.zeros((0, 5))
NO_CORDS = np.zeros((0, 9))


def drawn_walls(rng, block):
    """Walls or a kerb beside a block, for both."""
    walls, rows = [], []
    for side in (1, -1) if rng.uniform() < 0.5 else (1,):
        gap = rng.uniform(0.0, 0.4) * block.width
        height = (
            math.inf if rng.uniform() < 0.7 else rng.uniform(0.1, 0.8) * block.height
        )
        mu, ratio = rng.uniform(0.0, 0.5), rng.choice([0.0, 0.4])
        at = block.width / 2 + gap
        walls.append(
            Wall(at, 0.0 if side > 0 else math.pi, height, (mu, mu), float(ratio))
        )
        rows.append((side * at, side, height, mu, ratio))
    return hold(as_system(block), *walls), {"walls": np.array(rows)}


def drawn_ties(rng, block):
    """Cords at the top of a block, slack or not, some weak, for both."""
    ties, rows = [], []
    weight = block.mass * 9.81
    for side in (1, -1):
        slack = rng.choice([0.0, rng.uniform(0.0, 0.1) * block.width])
        stiffness = weight * 10 ** rng.uniform(1.0, 2.5) / block.height
        strength = rng.choice([math.inf, weight * rng.uniform(0.1, 0.8)])
        damping = 0.02 * math.sqrt(stiffness * block.mass)
        top = block.height
        end = side * rng.uniform(1.0, 3.0) * block.width
        ties.append(
            Tie((0, 0, top), (end, 0, top), stiffness, damping, slack, strength)
        )
        long = abs(end) + slack
        rows.append((0, top, end, top, stiffness, damping, long, strength, 0.0))
    return hold(as_system(block), *ties), {"cords": np.array(rows)}


def drawn_brackets(rng, block):
    """A bracket at the top of a block, with play or not, strong or weak, for both."""
    weight, top = block.mass * 9.81, block.height
    play = rng.choice([0.0, rng.uniform(0.0, 0.1) * block.width])
    stiffness = weight * 10 ** rng.uniform(1.5, 2.5) / block.height
    strength = rng.choice([math.inf, weight * rng.uniform(0.1, 0.8)])
    damping = 0.02 * math.sqrt(stiffness * block.mass)
    end = rng.choice([-1, 1]) * rng.uniform(1.0, 3.0) * block.width
    tie = Tie(
        *((0, 0, top), (end, 0, top), stiffness, damping, play, strength), bracket=True
    )
    lengths = abs(end) + play, abs(end) - play
    row = (0, top, end, top, stiffness, damping, lengths[0], strength, lengths[1])
    return hold(as_system(block), tie), {"cords": np.array([row])}


def drawn_plate(rng, block):
    """A plate in a dish under a block, which meets its stops or not, for both."""
    mass, radius = block.mass * rng.uniform(0.05, 0.3), rng.uniform(0.4, 2.0)
    mu, stroke, ratio = rng.uniform(0.03, 0.12), rng.uniform(0.02, 0.15), 0.0
    if rng.uniform() < 0.5:
        ratio = 0.4
    dish = SlidingPendulum(
        mass=mass, radius=radius, friction=mu, stroke=stroke, restitution=ratio
    )
    plate = np.array([mass, radius, mu, stroke, ratio])
    return hold(as_system(block), support=dish), {"plate": plate}


def drawn_bond(rng, block):
    """Wax under a block, for both."""
    tension = block.mass * 9.81 * rng.uniform(0.1, 1.5)
    spread = rng.uniform(0.3, 1.0) * block.width / 2
    shear = block.mass * 9.81 * rng.uniform(0.2, 1.0)
    wax = Bond(tension, shear, spread)
    pads = np.array([spread, tension / 2, shear])
    return hold(as_system(block), bonds=wax), {"bond": pads}


DRAWN = {
    "walls": drawn_walls,
    "ties": drawn_ties,
    "brackets": drawn_brackets,
    "bonds": drawn_bond,
    "plates": drawn_plate,
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRAWN)
def test_outcomes_are_those_of_a_plain_time_stepping(kind: str) -> None:
    rng, same, fell = np.random.default_rng(12), 0, 0
    for _ in range(60):
        width = rng.uniform(0.15, 0.5)
        block = Block(width, width * rng.uniform(2.5, 5.0), rng.uniform(20, 200))
        motion = rng.uniform(1.0, 4.0) * random_motion(rng)[:600]
        mu = rng.uniform(0.35, 0.8)
        held, rows = DRAWN[kind](rng, block)
        plain = {"walls": NONE, "cords": NO_CORDS, "bond": np.zeros(0)} | rows
        oracle = outcome(
            Held(block.width, block.height, block.mass, mu, **plain), motion, DT
        )
        found = overturns(held, motion, DT, friction=mu)
        same += oracle[0] == bool(found.overturned[0, 0, 0])
        fell += oracle[0]
    assert 5 < fell < 55
    assert same >= 54
