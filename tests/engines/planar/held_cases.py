"""Random blocks beside walls and kerbs and in cords that another program knows too."""

import math
from typing import NamedTuple

import numpy as np

from rockfrag import Block
from rockfrag.system import System, Tie, Wall, as_system, hold

from ...oracle.mujoco_model import falls, held_model
from ...simulation.reference_bodies import random_motion
from .cases import DT

LEVELS = (2.0, 3.5, 6.0)  # peaks of motions over those at which a free block rocks [-]


def drawn_walls(rng, block):
    """A wall on the right, and half of the time one on the left."""
    mu = rng.uniform(0.0, 0.5)
    gaps = rng.uniform(0.05, 0.5), rng.uniform(0.3, 1.5)
    sides = [0.0, math.pi][: int(rng.integers(1, 3))]
    return [
        Wall((0.5 + gap) * block.width, direction, friction=(mu, mu))
        for gap, direction in zip(gaps, sides, strict=False)
    ]


def drawn_kerbs(rng, block):
    """A kerb on each side, below the centre of gravity."""
    high = rng.uniform(0.1, 0.45) * block.height
    return [
        Wall(wall.distance, wall.direction, high, wall.friction)
        for wall in drawn_walls(rng, block)
    ]


def drawn_cords(rng, block):
    """Two cords with slack from the middle of the top."""
    weight, top = block.mass * 9.81, block.height
    stiffness = weight * 10 ** rng.uniform(-1.0, 0.5) / top
    return [
        Tie(
            (0, 0, top),
            (side * rng.uniform(1.0, 3.0) * block.width, 0, top),
            stiffness,
            slack=rng.uniform(0.05, 0.4) * block.width,
        )
        for side in (1, -1)
    ]


DRAWN = {"walls": drawn_walls, "kerbs": drawn_kerbs, "ties": drawn_cords}


class HeldCase(NamedTuple):
    """A block, its friction, what holds it, and a motion [m/s²]."""

    block: Block
    mu: float
    holders: list[Wall | Tie]
    motion: np.ndarray

    @property
    def system(self) -> System:
        """The block with what holds it."""
        return hold(as_system(self.block), *self.holders)

    def falls_in_mujoco(self) -> bool:
        """Whether it falls there, in steps of 1 ms."""
        walls = [held for held in self.holders if isinstance(held, Wall)]
        cords = [held for held in self.holders if isinstance(held, Tie)]
        model = held_model(self.block, self.mu, walls, cords)
        # it may still be falling when the motion ends
        longer = np.append(self.motion, np.zeros(400))
        return falls(model, [self.block.mass], longer, DT)


def drawn_case(kind: str, level: float, rng: np.random.Generator) -> HeldCase:
    """Draw a case of a kind of holder at a level."""
    width, mu = rng.uniform(0.15, 0.5), rng.uniform(0.35, 0.8)
    block = Block(width, width * rng.uniform(2.5, 5.0), rng.uniform(20, 200))
    holders = DRAWN[kind](rng, block)
    motion = random_motion(rng, 800)
    peak = level * 9.81 * block.width / block.height
    return HeldCase(block, mu, holders, motion * peak / np.abs(motion).max())
