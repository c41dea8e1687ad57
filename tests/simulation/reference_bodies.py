"""Bodies and motions that tests of rocking, free and with friction, share."""

import math

import numpy as np

from rockfrag import Block, Stack
from rockfrag.simulation import MeasuredRestitution
from rockfrag.simulation.rocking_spectra import uniform_block
from rockfrag.system import geometry

from ..oracle.standing import upper_on_contact

# the thesis's specimens (Table 3.1)
T1 = Block(0.124, 0.372, 2.172)
T2 = Block(0.124, 0.496, 2.790)
T3 = Block(0.124, 0.620, 3.456)
P = Block(0.184, 0.208, 2.300)


def uniform(p: float, alpha: float, g: float = 9.81) -> Block:
    """Uniform block with this frequency parameter [1/s] and critical angle [rad]."""
    return uniform_block(alpha, 2 * math.pi / p, g)


def random_motion(
    rng: np.random.Generator, samples: int = 300, dt: float = 0.01
) -> np.ndarray:
    """Eight sines under a half-sine window, peak 0.2 to 1 g [m/s²]."""
    t = np.arange(samples) * dt
    waves = sum(
        rng.normal() * np.sin(2 * math.pi * f * t + rng.uniform(0, 2 * math.pi))
        for f in rng.uniform(0.3, 6, 8)
    )
    motion = waves * np.sin(math.pi * t / t[-1])
    return 9.81 * rng.uniform(0.2, 1.0) * motion / np.abs(motion).max()


def polyline(seed: int, samples: int) -> np.ndarray:
    """Straight lines between normal draws eight samples apart [m/s²]."""
    coarse = np.random.default_rng(seed).normal(size=samples // 8 + 1)
    return np.interp(np.arange(samples) / 8, np.arange(coarse.size), coarse)


def measured(body: Block | Stack, factor: float, law: str) -> MeasuredRestitution:
    """Every contact at a factor on what conserves momentum, as far as a lone block allows it."""
    blocks = (
        (body,) if isinstance(body, Block) else (body.lower, upper_on_contact(body))
    )

    def of(block: Block, pivot: int) -> float:
        wanted = factor * max(0.05, block.momentum_restitution(-pivot))
        return min(wanted, geometry.largest_restitution(block.shape, pivot))

    values = tuple((of(block, 1), of(block, -1)) for block in blocks)
    return MeasuredRestitution(values if len(values) > 1 else values[0], law)
