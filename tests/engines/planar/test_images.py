"""Small systems of every kind beside their images: in a mirror, in another scale, under finer samples.

Histories are short, so that they end soon as plain Python too (``tests/mutants``).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from rockfrag import Block, Column, Stack
from rockfrag.outcomes.response import Response
from rockfrag.system import (
    BilinearIsolator,
    Bond,
    SlidingPendulum,
    System,
    Tie,
    Wall,
    hold,
)

from .cases import G, imbalance, run, samples_until, with_contacts

STEP = 0.02  # sampling interval [s]


@dataclass(frozen=True)
class Image:
    """Which side right is on, what lengths are multiplied by, and in how many parts each sample interval is."""

    side: int = 1
    ratio: float = 1.0
    parts: int = 1

    def block(
        self, width: float, height: float, aside: float, lean: float = 0.0
    ) -> Block:
        """Block of 800 kg/m³, a metre deep, whose centre of gravity is beside the middle."""
        w, h = self.ratio * width, self.ratio * height
        aside, lean = self.side * self.ratio * aside, self.side * lean
        return Block(w, h, 800 * w * h * self.ratio, None, 0.45 * h, aside, lean)

    def wall(self, distance: float, height: float = math.inf) -> Wall:
        """Wall with friction from which bodies bounce, on the right where the distance is positive."""
        side = self.side if distance > 0 else -self.side
        direction = 0.0 if side > 0 else math.pi
        far, high = self.ratio * abs(distance), self.ratio * height
        return Wall(far, direction, high, (0.4, 0.3), 0.3)

    def tie(self, x: float, end: float, *, bracket: bool = False) -> Tie:
        """Cord from a point at a height of 1 m to one of the ground, damped and with slack."""
        (x, end, z), r = (self.ratio * v for v in (x, end, 1.0)), self.ratio
        ends = (self.side * x, 0.0, z), (self.side * end, 0.0, 0.2 * r)
        slack, strength = 0.004 * r, 900.0 * r**3
        return Tie(*ends, 2e4 * r**2, 90.0 * r**2.5, slack, strength, bracket)

    @property
    def time(self) -> float:
        """What times are multiplied by."""
        return math.sqrt(self.ratio)

    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Two sines of a fading motion and a vertical one [m/s²], straight between the same instants."""
        at = np.arange(0.0, 0.6, STEP)
        rises = 6.0 * np.sin(2 * np.pi * at / 0.45) * np.exp(-at)
        up = 2.0 * np.sin(2 * np.pi * at / 0.2)
        # what follows the last sample takes one interval, whatever its length
        rises[-1] = up[-1] = 0.0
        finer = np.arange((at.size - 1) * self.parts + 1) * STEP / self.parts
        return (
            self.side * np.interp(finer, at, rises),
            np.interp(finer, at, up),
        )


def shaken_block(image: Image) -> System:
    """A block on a base that leans, whose friction falls where it slides."""
    return with_contacts(image.block(0.3, 1.0, 0.02, 0.004), [(0.5, 0.3)])


def shaken_stack(image: Image) -> System:
    """A statue beside the middle of a pedestal that slides."""
    pedestal, statue = image.block(0.5, 0.4, -0.02), image.block(0.24, 0.9, 0.01)
    aside = 0.03 * image.side * image.ratio
    return with_contacts(Stack(pedestal, statue, offset=aside), [0.3, 0.6])


def shaken_column(image: Image) -> System:
    """Three blocks, each narrower than the one below."""
    sizes = (0.6, 0.3, 0.01), (0.4, 0.4, -0.02), (0.25, 0.8, 0.01)
    offsets = tuple(image.side * image.ratio * aside for aside in (0.02, -0.03))
    column = Column(tuple(image.block(*size) for size in sizes), offsets)
    return with_contacts(column, [0.4, 0.35, 0.6])


def block_at_a_wall(image: Image) -> System:
    """A block, its base beside the origin's middle, between a wall and a kerb."""
    free = with_contacts(image.block(0.3, 1.0, 0.03), [0.6])
    return hold(free, image.wall(0.2), image.wall(-0.19, 0.3))


def stack_at_a_wall(image: Image) -> System:
    """A statue on a pedestal beside a wall."""
    return hold(shaken_stack(image), image.wall(0.3))


def block_in_cords(image: Image) -> System:
    """A block between a bracket and a cord."""
    free = with_contacts(image.block(0.3, 1.0, 0.01), [0.5])
    bracket = image.tie(0.14, 0.5, bracket=True)
    return hold(free, bracket, image.tie(-0.1, -0.8))


def stack_on_wax(image: Image) -> System:
    """A statue on wax that breaks."""
    strength = 800.0 * image.ratio**3
    bond = Bond(strength, strength, 0.1 * image.ratio)
    return hold(shaken_stack(image), bonds=bond)


def stack_on_a_pendulum(image: Image) -> System:
    """A stack on a dish with friction, whose plate meets its stop."""
    support = SlidingPendulum(
        mass=60.0 * image.ratio**3,
        radius=1.2 * image.ratio,
        friction=(0.06, 0.04),
        stroke=0.03 * image.ratio,
        restitution=0.2,
    )
    return hold(shaken_stack(image), support=support)


def block_on_springs(image: Image) -> System:
    """A block on a bilinear isolator."""
    support = BilinearIsolator(
        mass=60.0 * image.ratio**3,
        stiffness=3e3 * image.ratio**2,
        strength=300.0 * image.ratio**3,
        yield_displacement=0.002 * image.ratio,
    )
    return hold(shaken_block(image), support=support)


KINDS = (
    *(shaken_block, shaken_stack, shaken_column, block_at_a_wall, stack_at_a_wall),
    *(block_in_cords, stack_on_wax, stack_on_a_pendulum, block_on_springs),
)


@cache
def history(kind: Callable[[Image], System], image: Image) -> Response:
    """Response of an image of a system to the same image of the motion."""
    motion, up = image.motion()
    dt = image.time * STEP / image.parts
    return run(kind(image), motion, dt, vertical=up)


@pytest.mark.parametrize("kind", KINDS)
def test_the_balance_of_energy_closes(kind) -> None:
    found = history(kind, Image())
    assert len(found.contact_events) > 3
    assert imbalance(found) < 1e-7


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("image", "off"),
    [(Image(side=-1), 1e-9), (Image(ratio=4.0), 1e-7), (Image(parts=2), 1e-6)],
    ids=["mirrored", "larger", "finer"],
)
def test_an_image_moves_as_its_original(kind, image: Image, off: float) -> None:
    """Lengths times λ, times times √λ, forces times λ³ and speeds times √λ, the same accelerations."""
    found, other = history(kind, Image()), history(kind, image)
    n = min(samples_until(found, 6), (len(other.time) - 1) // image.parts)
    assert n > 5
    seen = slice(0, (n - 1) * image.parts + 1, image.parts)
    close = {"rtol": 0.0, "atol": off}
    np.testing.assert_allclose(image.side * other.theta[seen], found.theta[:n], **close)
    slip = image.side * other.slip[seen] / image.ratio
    np.testing.assert_allclose(slip, found.slip[:n], **close)
    omega = image.side * image.time * other.omega[seen]
    np.testing.assert_allclose(omega, found.omega[:n], rtol=0.0, atol=100 * off)
    pressed = other.normal_force[seen] / image.ratio**3
    weight = G * sum(body.mass for body in found.system.bodies)
    np.testing.assert_allclose(
        pressed[1:], found.normal_force[1:n], rtol=0.0, atol=1e3 * off * weight
    )
