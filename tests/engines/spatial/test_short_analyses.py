"""Short analyses of bodies in space of no symmetry, whole: what must be the same, and the balance of energy.

What the engine makes of a grid or a case is asked of the library as it is, kernels by themselves as plain Python.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.engines.contract import Case, Cases, Request
from rockfrag.engines.spatial import engine
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system import Bond, Tie, Wall
from rockfrag.system.body import Circle, Polygon, RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import System

from .plain_space import (
    OUTLINE,
    G,
    attitude,
    ground,
    limits,
    memory,
    outcome,
    plain,
    solid,
    whole,
)

DT = 0.02
COARSE = 0.03  # sampling interval of what is small and falls soon [s]
KINDS = {"free": 22, "bonded": 22, "round": 22}
"""What holds a body, or what it is, and how many samples tell."""


def made(kind, mirrored):
    """A body, or its mirror image in the plane x = 0."""
    flip = -1.0 if mirrored else 1.0
    centre = np.array([0.03 * flip, -0.02, 0.6])
    tensor = np.diag([0.27, 0.23, 0.25])
    tensor[0, 1] = tensor[1, 0] = 0.02 * flip
    tensor[0, 2] = tensor[2, 0] = 0.015 * flip
    tensor[1, 2] = tensor[2, 1] = 0.01
    outline = [(flip * x, y) for x, y in OUTLINE][:: -1 if mirrored else 1]
    base: Circle | Polygon = Polygon(tuple(outline))
    face = base
    if kind == "round":
        base = face = Circle(0.25, (0.02 * flip, 0.01))

    body = RigidBody(1.0, tensor, tuple(centre), base, 1.3, face)
    record = kernel_body(System((body,), (Contact(),)))
    record["static"], record["kinetic"] = 0.9, 0.8
    if kind == "bonded":
        record["bonded"], record["tension"], record["shear"] = 1, 6.0, 2.0
        record["pads"], record["aside"] = (0.2, 0.15), (0.01 * flip, -0.01)
    return plain(record)


def shaken(kind, mirrored=False, turned=0.0):
    """History and outcome of a body, all turned about the vertical or seen in a mirror."""
    body = made(kind, mirrored)
    count = KINDS[kind]
    time = np.arange(count) * DT
    motion = np.stack(
        [
            9.0 * np.sin(14 * time),
            6.0 * np.sin(9 * time + 0.4) * np.exp(-2 * time),
            2.0 * np.sin(23 * time),
        ],
        axis=1,
    )
    motion[0] = motion[-1] = 0.0
    motion[:, 0] *= -1.0 if mirrored else 1.0
    c, s = math.cos(turned), math.sin(turned)
    motion[:, :2] = motion[:, :2] @ np.array([[c, s], [-s, c]])
    y, kept, out = np.zeros(solid.SIZE), memory(), np.zeros(outcome.OUTCOME)
    y[2], y[3], y[6] = body.height, math.cos(turned / 2), math.sin(turned / 2)
    peaks, history = np.zeros((count, 4)), np.full((count, 17), np.nan)
    ground.fill_peaks(motion, peaks)
    whole.integrate(
        body, motion, peaks, 1.0, DT, G, 0, 1e-9, 1e-6, y, history, out, kept
    )
    return history, out, kept, body


@pytest.mark.parametrize("kind", KINDS)
def test_turned_or_seen_in_a_mirror_a_case_is_the_same_and_its_energy_balances(kind):
    history, out, kept, body = shaken(kind)
    known = np.isfinite(history[:, 0])
    assert known.sum() == KINDS[kind]
    axes = np.array([attitude(row)[:, 2] for row in history[known]])
    assert np.hypot(*axes[:, :2].T).max() > 1e-2
    assert out[outcome.ENERGY_BALANCE] == pytest.approx(0, abs=1e-7)
    assert out[outcome.GAINED] < 1e-7
    assert out[outcome.LOST] > 0
    place, spin = history[known, :3], history[known, 10:13]
    turned, then, _, _ = shaken(kind, turned=0.7)
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    # rounding grows with each impact
    near = {"abs": 1e-5}
    assert turned[known, :3] == pytest.approx(place @ turn.T, **near)
    assert turned[known, 10:13] == pytest.approx(spin, abs=1e-4)
    assert turned[known, 13:15] == pytest.approx(history[known, 13:15], **near)
    of_axes = np.array([attitude(row)[:, 2] for row in turned[known]])
    assert of_axes == pytest.approx(axes @ turn.T, **near)
    seen, there, _, _ = shaken(kind, mirrored=True)
    flip = np.array([-1.0, 1.0, 1.0])
    assert seen[known, :3] == pytest.approx(place * flip, **near)
    assert seen[known, 10:13] == pytest.approx(spin * (1.0, -1.0, -1.0), abs=1e-4)
    assert seen[known, 13] == pytest.approx(-history[known, 13], **near)
    for other in (then, there):
        alike = [
            outcome.PEAK_RATIO,
            outcome.PEAK_TILT,
            outcome.LOST,
            *range(outcome.HELD, outcome.OUTCOME),
        ]
        assert other[alike] == pytest.approx(
            out[alike], rel=1e-3, abs=1e-5, nan_ok=True
        )
    if kind == "bonded":
        tension, breaks = out[outcome.HELD + 4 * solid.BOND + 2 :][:2]
        assert tension == pytest.approx(0.5 * body.tension)
        assert 0 < breaks < 0.1
    assert kept.counters[limits.UNSOLVED] == 0


@pytest.fixture
def soon_over(monkeypatch):
    """What happens on the ground at rest is followed for three intervals alone."""
    monkeypatch.setattr(engine, "AFTER", 2.5 * COARSE)


def slender(mass=2.0, holders=(), bond=None, friction=0.8):
    """A body of no symmetry, all of whose moments and strengths are for its mass."""
    tensor = mass * 1e-2 * (np.diag([0.7, 0.6, 0.1]) + 0.01)
    outline = ((-0.03, -0.025), (0.035, -0.02), (0.025, 0.03), (-0.035, 0.03))
    base = Polygon(outline)
    body = RigidBody(mass, tensor, (0.003, -0.002, 0.12), base, 0.24, base)
    contact = Contact(friction=(friction, friction), bond=bond)
    return System((body,), (contact,), constraints=tuple(holders))


def shove(level, count=10):
    """A motion of three components that pushes to one side for some time [m/s²]."""
    time = np.arange(count) * COARSE
    fades = np.exp(-((time / 0.1) ** 2))
    parts = level * fades, 0.4 * level * fades, 0.5 * np.sin(20 * time)
    return GroundMotion(*(Motion(part, COARSE) for part in parts))


def test_outcomes_of_a_grid_are_those_of_each_analysis_alone(soon_over):
    """By the same names, at each of several scales; peaks of a body that falls are infinite."""
    systems, motions = (slender(), slender(friction=0.2)), (shove(5.0), shove(-4.0))
    scales = np.array([[0.2, 1.6], [1.7, 0.3]])
    cases = Cases(systems, motions, scales, Request(g=G))
    found, seen = engine.run(cases), set()
    for i, j, k in np.ndindex(*cases.shape):
        at, scale = (i, j, k), float(scales[j, k])
        one = engine.history(Case(systems[i], motions[j], scale, Request(g=G))).outcome
        assert found.overturned[at] == found.overturned_body[at] == one.overturned
        names = "certain_time impacts flights paradoxes"
        told = [getattr(found, name)[at] for name in names.split()]
        expected = [getattr(one, name) for name in names.split()]
        names = "peak_rotation peak_velocity turn fall_direction"
        told += [getattr(found, name)[at][0] for name in names.split()]
        expected += [getattr(one, name) for name in names.split()]
        assert told == pytest.approx(expected, nan_ok=True, rel=1e-12)
        assert found.several_modes[at] == one.ambiguous
        assert found.walk[at][0] == pytest.approx(math.hypot(*one.walk))
        assert found.fell_over[at][0] == one.fell_over
        assert math.isnan(found.unstable_distance[at])
        assert not found.leaning[at]
        lightest = scale * motions[j].z.acceleration.min()
        assert found.minimum_gravity_ratio[at] == pytest.approx(1 + lightest / G)
        assert one.overturned == math.isinf(one.peak_rotation)
        assert one.overturned != math.isnan(one.fall_direction)
        assert one.overturned == bool(one.fell_over)
        if one.overturned:
            # away from where the ground goes
            east, north, _ = -scale * motions[j].accelerations[0]
            assert math.cos(one.fall_direction - math.atan2(north, east)) > 0.7
        seen.add((i, one.overturned))
    assert {(0, False), (0, True), (1, False)} <= seen


def test_what_the_kernel_leaves_is_told_by_its_name():
    rng, body = np.random.default_rng(1), kernel_body(slender())
    outs, counts = rng.normal(size=(2, outcome.OUTCOME)), rng.integers(0, 9, (2, 9))
    outs[:, outcome.FELL], outs[:, outcome.LEANS] = (0, 1), (1, 0)
    outs[:, outcome.FALL_FIRST], outs[:, outcome.FALL_SECOND] = 2, -1
    y = rng.normal(size=solid.SIZE)
    found = engine.Found(outs, counts, np.tile(y, (2, 1)))
    into = engine.empty_outcomes([("vase",)], np.ones((1, 2)))
    engine._write(into, (0, 0), body, found)
    assert into.leaning[0, 0].tolist() == [1, 0]
    for k, (out, count) in enumerate(zip(outs, counts, strict=True)):
        told = engine._outcome(body, out, count, y)
        problems = count[limits.UNSOLVED] + count[limits.JAMS]
        assert into.paradoxes[0, 0, k] == told.paradoxes == problems
        assert into.several_modes[0, 0, k] == told.ambiguous == count[limits.AMBIGUOUS]
        assert into.flights[0, 0, k] == told.flights == count[limits.FLIGHTS]
        assert told.dissipated == (out[outcome.LOST], y[solid.FRICTION])
        assert told.residual == out[outcome.ENERGY_BALANCE]
        assert told.gained == out[outcome.GAINED]
        assert told.beyond_friction == out[outcome.BEYOND]
        assert told.fell_over == into.fell_over[0, 0, k, 0] == ["", "vertex 3"][k]
    disc = RigidBody(1.0, np.diag([0.1, 0.1, 0.1]), (0, 0, 0.1), Circle(0.2), 0.2)
    for rim, first, second, said in (
        (0, 3, 0, "edge 1-4"),
        (0, 0, 1, "edge 1-2"),
        (0, 0, -1, "vertex 1"),
        (0, -1, -1, "flight"),
        (1, 5, -1, "rim"),
        (1, -1, -1, "flight"),
    ):
        outs[1, outcome.FALL_FIRST], outs[1, outcome.FALL_SECOND] = first, second
        fallen = kernel_body(System((disc,), (Contact(),))) if rim else body
        assert engine._outcome(fallen, outs[1], counts[1], y).fell_over == said


def test_a_history_tells_where_axis_and_base_are(soon_over):
    system, motion = slender(), shove(4.5, 8)
    response = engine.history(Case(system, motion, 1.2, Request(g=G)))
    table, told = response.history, response.outcome
    body = kernel_body(system, G)
    _, rows = engine.run_case(
        body, motion.accelerations, COARSE, 1.2, g=G, samples=len(table)
    )
    # it is not at rest yet
    assert len(table) == len(rows) == len(motion.x.acceleration) + 4
    axes = np.array([attitude(row)[:, 2] for row in rows])
    assert table[["x_m", "y_m", "z_m"]].to_numpy() == pytest.approx(rows[:, :3])
    assert table[["axis_x", "axis_y"]].to_numpy() == pytest.approx(axes[:, :2])
    tilts = np.arccos(np.minimum(axes[:, 2], 1.0))
    assert table.tilt_rad.to_numpy() == pytest.approx(tilts, abs=1e-7)
    below = rows[:, :3] - 0.12 * axes
    assert table[["base_x_m", "base_y_m"]].to_numpy() == pytest.approx(below[:, :2])
    spins = table[[f"omega_{name}_rad_s" for name in "xyz"]]
    assert spins.to_numpy() == pytest.approx(rows[:, 10:13])
    assert table.time_s.to_numpy() == pytest.approx(COARSE * np.arange(len(table)))
    assert table.contacts.isna().to_numpy() == pytest.approx(rows[:, 14] == 99)
    assert tilts.max() > 0.01
    assert told.peak_tilt >= tilts.max() - 1e-9
    assert told.peak_velocity >= np.linalg.norm(rows[:, 10:13], axis=1).max() - 1e-9
    # the base at first, from below the centre of mass
    base = np.array(system.bodies[0].base.vertices) - (0.003, -0.002)
    assert response.outline == pytest.approx(base)


HOLDERS = {
    "wall": lambda mass: {"holders": [Wall(0.05, 0.3, friction=0.2, restitution=0.5)]},
    "cord": lambda mass: {
        "holders": [
            Tie(
                (0, 0, 0.2),
                (-0.2, 0.1, 0.3),
                900.0 * mass,
                damping=5.0 * mass,
                slack=0.001,
                strength=2.5 * mass,
            )
        ]
    },
    "bond": lambda mass: {"bond": Bond(14.0 * mass, 4.0 * mass, (0.025, 0.02))},
}


@pytest.mark.parametrize("kind", HOLDERS)
def test_what_holds_a_body_of_thrice_the_mass_bears_thrice_as_much(kind, soon_over):
    """If it is thrice as stiff and as strong, all moves as it did."""
    found = {}
    for mass in (2.0, 6.0):
        system = slender(mass, **HOLDERS[kind](mass))
        scales = np.array([[1.4] if kind == "wall" else [0.6, 1.4]])
        found[mass] = engine.run(
            Cases((system,), (shove(-5.0, 6),), scales, Request(g=G))
        )
    light, heavy = found[2.0], found[6.0]
    for name in ("peak_rotation", "peak_velocity", "walk", "hits", "breaking_time"):
        one, other = (getattr(each, name) for each in (light, heavy))
        assert other == pytest.approx(one, nan_ok=True, rel=1e-6), name
    for name in ("largest_impulse", "largest_force"):
        one, other = (getattr(each, name) for each in (light, heavy))
        assert other == pytest.approx(3 * one, nan_ok=True, rel=1e-6), name
    borne = light.largest_impulse if kind == "wall" else light.largest_force
    assert borne.max() > 0
    assert (light.hits.max() > 0) == (kind != "bond")
    broken = np.isfinite(light.breaking_time[0, 0, :, 0])
    assert broken.tolist() == [0, 1] or kind == "wall"


EMPTY = engine.Found(
    np.zeros((1, outcome.OUTCOME)),
    np.zeros((1, limits.COUNTERS), int),
    np.zeros((1, solid.SIZE)),
)


def test_a_base_that_is_spread_is_drawn_anew_for_each_case(monkeypatch):
    """Each vertex within the spread times the width, and the body turned by no more."""
    system, size = slender(), 0.05
    rng = np.random.default_rng(3)
    disc = Circle(0.2, (0.01, 0.02))
    body = RigidBody(1.0, np.diag([0.1, 0.1, 0.04]), (0.0, 0.0, 0.5), disc, 1.0)
    vertices, centres, turns = [], [], []
    for _ in range(40):
        moved, turned = engine.perturbed(system, size, rng)
        vertices.append(moved.bodies[0].base.vertices)
        turns.append([turned])
        moved, turned = engine.perturbed(replace(system, bodies=(body,)), size, rng)
        centres.append(moved.bodies[0].base.centre)
        turns.append([turned])
    for drawn, middle, most in (
        (vertices, system.bodies[0].base.vertices, size * 0.07),
        (centres, disc.centre, size * 0.4),
        (turns, 0.0, size),
    ):
        away = np.subtract(drawn, middle)
        # evenly, to either side
        assert np.abs(away).max() <= most
        assert away.max() > 0.9 * most
        assert away.min() < -0.9 * most
    # a grid draws one for each system and motion, by its seed, and a history the first
    still = GroundMotion(*(Motion(np.zeros(2), COARSE) for _ in "xyz"))
    request = Request(g=G, spread=1e-3, seed=5)
    drawn = []
    monkeypatch.setattr(
        engine, "run_scales", lambda *_, start, **__: drawn.append(start) or EMPTY
    )
    grid = Cases((system,) * 2, (still,) * 2, np.ones((2, 1)), request)
    for asked in (grid, replace(grid, request=replace(request, seed=6))):
        engine.run(asked)
    turns = [2 * math.atan2(y[6], y[3]) for y in drawn]
    assert len(set(turns)) == 8 and np.abs(turns).max() <= 1e-3
    engine.history(Case(system, still, 1.0, request))
    assert 2 * math.atan2(drawn[-1][6], drawn[-1][3]) == turns[0]


def test_a_body_that_stands_turned_about_the_vertical_has_that_attitude():
    body = kernel_body(slender())
    for angle in (0.0, 0.4, -2.0):
        y = engine.standing(body, angle)
        c, s = math.cos(angle), math.sin(angle)
        assert attitude(y) == pytest.approx(
            np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        )
        assert y[:3].tolist() == [0, 0, 0.12] and not y[7:].any()
