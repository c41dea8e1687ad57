"""Short analyses of bodies that slide, rock and hit, beside the plain integrator, and seen in a mirror.

They are short enough for kernels that run as plain Python.
"""

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.engines.planar import engine
from rockfrag.system import Bond, Tie, Wall, hold

from ...oracle.contact_reference import simulate_reference
from . import cases

DT = 0.02
# of no symmetry
BLOCK = Block(0.5, 1.1, 300.0, cg_offset=0.02)
STACK = Stack(Block(0.6, 0.4, 200.0), Block(0.35, 0.8, 80.0, cg_offset=-0.01), 0.01)


@pytest.fixture(autouse=True)
def short(monkeypatch):
    """What happens on the ground at rest is not followed: it takes longer than all before."""
    shaking_of = engine.shaking_of

    def short_one(case, scale):
        return shaking_of(case, scale)._replace(free_samples=0)

    monkeypatch.setattr(engine, "shaking_of", short_one)


def pulse(count=18):
    """A motion that pulls to both sides, and one upwards of another period [m/s²]."""
    time = np.arange(count) * DT
    level, lift = 7.0 * np.sin(13 * time), 2.5 * np.sin(21 * time + 1)
    level[-3:] = lift[-3:] = 0.0
    return level, lift


@pytest.mark.parametrize(
    ("body", "friction", "slides"),
    [(BLOCK, (0.7,), False), (STACK, (0.6, 0.4), True)],
)
def test_a_body_slides_and_rocks_as_the_plain_integrator_says(body, friction, slides):
    level, lift = pulse()
    found = cases.run(cases.with_contacts(body, friction), level, DT, vertical=lift)
    known = simulate_reference(
        body,
        level,
        DT,
        friction=friction,
        vertical=lift,
        duration=DT * (level.size - 1),
    )
    n = min(len(found.time), len(known.time))
    assert n > level.size // 2
    assert np.abs(known.theta[:n]).max() >= (0 if slides else 1e-3)
    assert found.theta[:n] == pytest.approx(known.theta[:n], abs=1e-6)
    assert found.slip[:n] == pytest.approx(known.slip[:n], abs=1e-6)
    assert (np.abs(known.slip[:n]).max() > 1e-3) == slides
    assert cases.imbalance(found) < 1e-6


def held(kind, side):
    """A body that something holds, or its mirror image (``side`` -1)."""
    block = Block(0.5, 1.1, 300.0, cg_offset=0.02 * side)
    if kind == "two":
        above = Block(0.35, 0.8, 80.0, cg_offset=-0.01 * side)
        stack = Stack(Block(0.6, 0.4, 200.0), above, 0.01 * side)
        return cases.with_contacts(stack, (0.9, 0.5))
    system = cases.with_contacts(block, (0.6,))
    if kind == "wall":
        # the centre of the base is the origin
        wall = Wall(0.27, 0.0 if side > 0 else np.pi, friction=0.2, restitution=0.4)
        return hold(system, wall)
    if kind == "low wall":
        wall = Wall(0.27, 0.0 if side > 0 else np.pi, height=0.4, friction=0.2)
        return hold(system, wall)
    if kind == "bracket":
        tie = Tie(
            (0.1 * side, 0.0, 1.0), (0.8 * side, 0.0, 1.3), 6e4, damping=400.0,
            slack=0.002, bracket=True,
        )  # fmt: skip
        return hold(system, tie)
    return hold(system, bonds=Bond(900.0, 500.0, 0.2))


@pytest.mark.parametrize("kind", ["two", "wall", "low wall", "bracket", "bond"])
def test_the_mirror_image_of_a_case_does_the_same_and_its_energy_balances(kind):
    level, lift = pulse(15)
    found = cases.run(held(kind, 1), level, DT, vertical=lift)
    seen = cases.run(held(kind, -1), -level, DT, vertical=lift)
    n = min(13, len(found.time), len(seen.time))
    assert n > 10
    assert np.abs(found.theta[:n]).max() > 1e-4
    assert seen.theta[:n] == pytest.approx(-found.theta[:n], abs=1e-6)
    assert seen.slip[:n] == pytest.approx(-found.slip[:n], abs=1e-6)
    assert cases.imbalance(found) < 1e-6
