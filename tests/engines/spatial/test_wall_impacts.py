"""Impacts of a body in space at rough walls: explained by pushes within friction, and without a gain of energy."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rockfrag import Block
from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial import engine
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.system import Friction, Wall, hold
from rockfrag.system.body import Polygon, RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import System

from ...oracle.cones import Touch, spatial_rays, unexplained
from .checks import turned_by

BRIEF = 1e-7  # in which an impact is over, and next to nothing else happens [s]
NEAR = 1e-9  # gap of what is about to touch [m]


class Meeting(NamedTuple):
    """A body that is about to meet walls, and perhaps the ground: its record, state, and where it touches."""

    body: np.void
    state: np.ndarray
    touches: list[Touch]
    size: float


def drawn_attitude(rng: np.random.Generator, kind: str) -> np.ndarray:
    """Rotation vector: any, about an edge towards the wall, or about the vertical alone."""
    if kind == "edge":
        return np.array([0.0, rng.uniform(0.01, 0.5), 0.0])
    turn = np.array([0.0, 0.0, rng.uniform(0, math.pi / 2)])
    return turn if kind == "upright" else turn + rng.normal(0, 0.2, 3)


def drawn_walls(rng: np.random.Generator) -> list[Wall]:
    """Draw one wall or two across each other, rough and as often plastic as not."""
    # a body that is turned stands within its wall
    directions = [0.0, math.pi / 2][: int(rng.integers(1, 3))]
    return [
        Wall(
            1.0,
            direction,
            friction=Friction(*(2 * [rng.uniform(0.0, 1.0)])),
            restitution=float(rng.choice([0.0, rng.uniform(0.1, 1.0)])),
        )
        for direction in directions
    ]


def brought_near(
    state: np.ndarray, arms: np.ndarray, walls: list[Wall], mu: float, lift: float
) -> list[Touch]:
    """Shift a body to where its furthest corners, at ``arms`` from its centre, all but touch; return where.

    It is ``lift`` above the ground [m], whose coefficient of friction is ``mu``.
    """
    outwards = [
        np.array([math.cos(wall.direction), math.sin(wall.direction), 0.0])
        for wall in walls
    ]
    for away in outwards:
        state[:3] += (1.0 - NEAR - (arms @ away).max()) * away
    state[2] = NEAR - arms[:, 2].min() + lift
    places = state[:3] + arms
    touches = [
        Touch(place, -away, wall.friction.static)
        for away, wall in zip(outwards, walls, strict=True)
        for place in places
        if 1.0 - place @ away < 1e-6
    ]
    return touches + [
        Touch(place, np.array([0.0, 0.0, 1.0]), mu)
        for place in places
        if place[2] < 1e-6
    ]


def drawn_meeting(rng: np.random.Generator) -> Meeting:
    """Draw a box whose furthest corners all but touch one wall or two, and mostly the ground."""
    width, depth = rng.uniform(0.2, 0.6, 2)
    block = Block(width, rng.uniform(0.3, 1.8), 1.0, depth=depth)
    kind = str(rng.choice(["any", "any", "edge", "upright"]))
    walls = drawn_walls(rng)
    mu = rng.uniform(0.1, 1.0)
    system = hold(block.system(), *walls)
    contact = replace(system.contacts[0], friction=Friction(mu, mu))
    body = kernel_body(replace(system, contacts=(contact,)))
    state, attitude = turned_by(drawn_attitude(rng, kind))
    sides = np.array([width, depth, block.height]) / 2
    signs = np.array(np.meshgrid(*3 * [[-1, 1]])).reshape(3, -1).T
    arms = (signs * sides) @ attitude.T
    lift = 0.3 if rng.uniform() < 0.2 else 0.0
    touches = brought_near(state, arms, walls, mu, lift)
    state[7:10] = rng.normal(0, 0.5, 3)
    state[10:13] = rng.normal(0, 1.0, 3)
    return Meeting(body, state, touches, float(np.linalg.norm(sides)))


def flat_meeting(rng: np.random.Generator) -> Meeting:
    """Draw a hexagonal prism that all but stands, and touches one wall or two with edges or sides."""
    radius, height = rng.uniform(0.15, 0.4), rng.uniform(0.3, 1.5)
    around = np.arange(6) * math.pi / 3
    outline = radius * np.column_stack([np.cos(around), np.sin(around)])
    lying = height**2 / 12 + 5 * radius**2 / 24
    inertia = np.diag([lying, lying, 5 * radius**2 / 12])
    walls = drawn_walls(rng)
    mu = rng.uniform(0.1, 1.0)
    base = Polygon(tuple(map(tuple, outline.tolist())))
    prism = RigidBody(1.0, inertia, (0.0, 0.0, height / 2), base, height, base)
    contact = Contact(Friction(mu, mu))
    body = kernel_body(System((prism,), (contact,), constraints=tuple(walls)))
    state, attitude = turned_by(np.array([0.0, 0.0, rng.choice([0.0, math.pi / 6])]))
    ends = [
        np.column_stack([outline, np.full(6, z)]) for z in (-height / 2, height / 2)
    ]
    arms = np.vstack(ends) @ attitude.T
    touches = brought_near(state, arms, walls, mu, 0.0)
    state[7:10] = rng.normal(0, 0.5, 3)
    state[10:13] = rng.normal(0, 1.0, 3)
    return Meeting(body, state, touches, math.hypot(radius, height / 2))


def energy(body: np.void, row: np.ndarray) -> float:
    """Energy of a unit of mass [J/kg]."""
    spin = row[10:13]
    motion = float(row[7:10] @ row[7:10] + spin @ body["inertia"] @ spin) / 2
    return motion + GRAVITY * float(row[2])


@pytest.mark.parametrize(
    ("drawn", "impacts", "seed"),
    [
        (drawn_meeting, 300, 6),
        (flat_meeting, 600, 21),
        pytest.param(drawn_meeting, 10_000, 6, marks=pytest.mark.slow),
    ],
)
def test_impacts_at_walls_gain_nothing_and_push_within_friction(
    drawn: Callable[[np.random.Generator], Meeting],
    impacts: int,
    seed: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Impacts without an outcome are counted, 3 of 1000 at most, and nothing else breaks a law."""
    # nothing is followed beyond the impact
    monkeypatch.setattr(engine, "AFTER", 0.0)
    rng, seen, unsolved, worst = np.random.default_rng(seed), 0, 0, []
    still = np.zeros((4, 3))
    while seen < impacts:
        meeting = drawn(rng)
        body, start = meeting.body, meeting.state.copy()
        before = start.copy()
        found, history = engine.run_case(body, still, BRIEF, start=start, samples=4)
        if not found.impacts:
            continue
        seen += found.impacts
        unsolved += found.paradoxes
        after = history[-1]
        assert energy(body, after) - energy(body, before) < 1e-11
        # gaps are shut where it touches
        assert found.gained <= GRAVITY * NEAR
        unit = math.sqrt(GRAVITY * meeting.size)
        units = np.repeat([unit, unit * meeting.size], 3)
        attitude = Rotation.from_quat(np.roll(before[3:7], -1)).as_matrix()
        spin = attitude @ body["inertia"] @ (after[10:13] - before[10:13])
        change = np.concatenate([after[7:10] - before[7:10], spin]) / units
        rays = [spatial_rays(touch, before[:3]) / units for touch in meeting.touches]
        if not found.paradoxes:
            worst.append(unexplained(np.concatenate(rays), change))
    assert max(worst) < 1e-5
    assert unsolved <= 0.003 * impacts


@pytest.mark.parametrize("theta", [0.3, 0.45, 0.6])
def test_a_body_that_falls_against_a_wall_leans_there_beyond_its_balance(
    theta: float,
) -> None:
    """Its energy may be that of a body that stands: beyond twice the angle of its balance it is less."""
    block, angle = Block(0.36, 1.8, 100.0, depth=0.4), theta - 0.01
    wall = Wall(0.18 + 1.8 * math.sin(theta), friction=Friction(0.3, 0.3))
    system = hold(block.system(), wall)
    contact = replace(system.contacts[0], friction=Friction(0.9, 0.9))
    body = kernel_body(replace(system, contacts=(contact,)))
    state, attitude = turned_by(np.array([0.0, angle, 0.0]))
    arm = attitude @ np.array([0.18, 0.0, -0.9])
    state[:3] = np.array([0.18, 0.0, 0.0]) - arm
    state[10:13] = spin = np.array([0.0, 0.6, 0.0])
    state[7:10] = -np.cross(spin, arm)
    still = np.zeros((400, 3))
    found, history = engine.run_case(body, still, 0.01, start=state, samples=400)
    ends = math.acos(1 - 2 * float(history[-1, 4:6] @ history[-1, 4:6]))
    assert theta > math.atan(0.18 / 0.9)
    assert not found.overturned
    assert ends == pytest.approx(theta, abs=0.005)
