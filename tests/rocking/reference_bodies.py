"""Bodies and motions of the tests around the reference integrator."""

import math

import numpy as np

from rockfrag.rocking import Block, Stack

# the thesis's specimens (Table 3.1)
T1 = Block(0.124, 0.372, 2.172)
T2 = Block(0.124, 0.496, 2.790)
T3 = Block(0.124, 0.620, 3.456)
P = Block(0.184, 0.208, 2.300)
TOWERS = (T1, T2, T3)


def uniform(p: float, alpha: float, g: float = 9.81) -> Block:
    """Uniform block with this frequency parameter [1/s] and critical angle [rad]."""
    radius = 3 * g / (4 * p**2)
    return Block(2 * radius * math.sin(alpha), 2 * radius * math.cos(alpha), 100.0)


def random_stack(rng: np.random.Generator) -> Stack:
    """General stack: any inertia, centres of gravity off the middle, an uneven base, an offset."""
    lower = Block(
        rng.uniform(0.3, 0.6),
        rng.uniform(0.2, 0.8),
        rng.uniform(20, 200),
        cg_offset=rng.uniform(-0.02, 0.02),
        lean=rng.uniform(-0.01, 0.01),
    )
    width = rng.uniform(0.3, 0.9) * lower.width
    height = width * rng.uniform(2, 5)
    upper = Block(
        width,
        height,
        rng.uniform(5, 100),
        cg_height=height * rng.uniform(0.35, 0.6),
        cg_offset=rng.uniform(-0.1, 0.1) * width,
    )
    return Stack(lower, upper, offset=rng.uniform(-0.01, 0.01))


def random_motion(rng: np.random.Generator, samples: int = 300, dt: float = 0.01) -> np.ndarray:
    """Eight sines under a half-sine window, peak 0.2 to 1 g [m/s²]."""
    t = np.arange(samples) * dt
    waves = sum(
        rng.normal() * np.sin(2 * math.pi * f * t + rng.uniform(0, 2 * math.pi))
        for f in rng.uniform(0.3, 6, 8)
    )
    motion = waves * np.sin(math.pi * t / t[-1])
    return 9.81 * rng.uniform(0.2, 1.0) * motion / np.abs(motion).max()
