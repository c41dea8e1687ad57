"""Bodies, motions and comparisons of the tests with friction."""

import numpy as np

from rockfrag.rocking import Block, Body, Stack

STILL = np.zeros(50)
DT = 0.01


def random_block(rng: np.random.Generator) -> Block:
    """Block of any slenderness, its centre of gravity off the middle."""
    width = rng.uniform(0.1, 1.0)
    height = width * rng.uniform(1.2, 5.0)
    return Block(
        width,
        height,
        rng.uniform(5, 500),
        cg_height=height * rng.uniform(0.4, 0.6),
        cg_offset=rng.uniform(-0.1, 0.1) * width,
    )


def random_stack(rng: np.random.Generator) -> Stack:
    """General stack: centres of gravity off the middle, an uneven base, an offset."""
    lower = Block(
        rng.uniform(0.3, 0.6),
        rng.uniform(0.2, 0.8),
        rng.uniform(20, 200),
        cg_offset=rng.uniform(-0.02, 0.02),
        lean=rng.uniform(-0.01, 0.01),
    )
    width = rng.uniform(0.3, 0.9) * lower.width
    height = width * rng.uniform(1.5, 5)
    upper = Block(
        width,
        height,
        rng.uniform(5, 100),
        cg_height=height * rng.uniform(0.35, 0.6),
        cg_offset=rng.uniform(-0.1, 0.1) * width,
    )
    return Stack(lower, upper, offset=rng.uniform(-0.01, 0.01))


def random_frictions(rng: np.random.Generator, body: Body) -> tuple[float, ...]:
    """Coefficients of 0.15 to 0.9 for each interface."""
    mus = rng.uniform(0.15, 0.9, 2)
    return (float(mus[0]),) if isinstance(body, Block) else (float(mus[0]), float(mus[1]))


def as_friction(mus: tuple[float, ...]) -> float | tuple[float, ...]:
    """Frictions as `simulate` takes them."""
    return mus[0] if len(mus) == 1 else mus
