"""What holds one body in space: bonds, ties and walls against statics, momentum, energy and symmetry."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag import Block, GroundMotion, Motion, overturns
from rockfrag.base.errors import InputError
from rockfrag.engines.contract import Cases, Request
from rockfrag.engines.planar.engine import run as run_planar
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial.body import kernel_body, standing
from rockfrag.engines.spatial.engine import run_case, run_scales
from rockfrag.simulation import holding
from rockfrag.system import Bond, Friction, Tie, Wall, hold
from rockfrag.system.system import turned_about_vertical

from .samples import DT, synthetic_motion

G = 9.81
BOX = Block(0.4, 1.2, 300.0, depth=0.5)
FLAT = Block(0.4, 1.2, 300.0)  # the same in a plane


def shaken(system, motion, scales=(1.0,)):
    """Outcomes of a system in space under a motion of shape (n, 3) [m/s²]."""
    x, y, z = (Motion(motion[:, k].copy(), DT, "xyz"[k]) for k in range(3))
    return overturns([system], [GroundMotion(x, y, z)], scales=scales)


def along_x(acceleration):
    """Shape (n, 3) of a motion along x alone."""
    acceleration = np.asarray(acceleration, np.float64)
    return np.stack([acceleration, 0 * acceleration, 0 * acceleration], axis=1)


def held(found):
    """Rows of the table of what holds the body: hits, impulse, force, instant of breaking."""
    names = ("hits", "largest_impulse", "largest_force", "breaking_time")
    return [[getattr(found, name)[0, 0, 0, row] for name in names] for row in range(2)]


def test_a_bonded_body_moves_with_the_ground_until_a_pad_is_torn_off():
    bond = Bond(2000.0, 1e6, (0.15, 0.2))
    ramp = along_x(np.linspace(0.0, 10.0, 201))
    found, history = run_case(
        kernel_body(hold(BOX.system(), bonds=bond)), ramp, DT, samples=300
    )
    breaks = holding.bond_breaks_at(FLAT, bond.tension, 0.15) / 10.0 * 200 * DT
    moving = np.flatnonzero(np.abs(history[:, 10:13]).max(axis=1) > 0)
    assert found.overturned
    assert moving[0] == math.ceil(breaks / DT)
    table = shaken(hold(BOX.system(), bonds=bond), ramp)
    assert table.breaking_time[0, 0, 0, 0] == pytest.approx(breaks, abs=1e-12)
    assert table.largest_force[0, 0, 0, 0] == pytest.approx(1000.0, rel=1e-12)


def test_after_it_breaks_a_bond_leaves_the_free_body_from_rest():
    rng = np.random.default_rng(3)
    motion = synthetic_motion(rng, 3) * 0.9
    bond = Bond(900.0, 1e6, (0.15, 0.2))
    system = hold(BOX.system(), bonds=bond)
    (breaks,) = shaken(system, motion).breaking_time[0, 0, 0]
    at = math.ceil(breaks / DT)
    # as strong as breaks it at that sample exactly, so that what follows is a motion of samples too
    weight, pull = G + motion[at, 2], np.abs(motion[at, :2]) * 0.6
    tension = 300.0 * (pull[0] / 0.15 + pull[1] / 0.2 - weight) * (1 - 1e-12)
    system = hold(BOX.system(), bonds=Bond(tension, 1e6, (0.15, 0.2)))
    whole, bonded = run_case(kernel_body(system), motion, DT, samples=4000)
    free, alone = run_case(kernel_body(BOX.system()), motion[at:], DT, samples=4000)
    assert whole.overturned == free.overturned
    assert whole.impacts == free.impacts
    some = min(len(alone), 60)
    assert bonded[at : at + some, 3:7] == pytest.approx(alone[:some, 3:7], abs=1e-7)


def test_what_is_out_of_reach_changes_no_bit():
    rng = np.random.default_rng(4)
    motion = synthetic_motion(rng, 2)
    far = [
        Wall(math.inf),
        Tie((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), 1e5, slack=math.inf),
    ]
    free = shaken(BOX.system(), motion, [0.5, 1.0, 1.5])
    beside = shaken(hold(BOX.system(), *far), motion, [0.5, 1.0, 1.5])
    for name in ("overturned", "certain_time", "impacts", "peak_velocity", "walk"):
        first, second = getattr(free, name), getattr(beside, name)
        assert np.array_equal(first, second, equal_nan=True), name


def test_in_a_sequence_a_bond_that_the_main_shock_broke_holds_no_more():
    pads, quiet, seen = (0.15, 0.2), np.zeros((1500, 3)), 0
    for seed in range(12):
        after = 0.45 * synthetic_motion(np.random.default_rng(seed), 2, 8.0)
        strong = shaken(hold(BOX.system(), bonds=Bond(1e6, 1e6, pads)), after)
        # so strong that it bears what follows, had it not been broken
        enough = 1.02 * 2 * float(strong.largest_force[0, 0, 0, 0])
        system = hold(BOX.system(), bonds=Bond(enough, 1e6, pads))
        alone, main = shaken(system, after), shaken(system, 1.1 * after)
        assert np.isnan(alone.breaking_time).all() and alone.peak_velocity.max() == 0
        if main.overturned.any():
            continue
        assert np.isfinite(main.breaking_time).all()
        both = shaken(system, np.concatenate([1.1 * after, quiet, after]))
        assert both.breaking_time == pytest.approx(main.breaking_time)
        assert both.overturned.any() or (both.impacts > main.impacts).all()
        seen += 1
    assert seen >= 2


def cords(stiffness, strength=math.inf, slack=0.0):
    """Cords to both sides at the height of 1 m."""
    return [
        Tie((0, 0, 1.0), (way, 0, 1.0), stiffness, slack=slack, strength=strength)
        for way in (1.0, -1.0)
    ]


def test_a_cord_bears_twice_the_steady_force_of_a_sudden_acceleration():
    a, k = 6.0, 2e6
    motion = along_x([a] * 60 + [0.0] * 5)
    found = shaken(hold(BOX.system(), *cords(k)), motion)
    twice = holding.cord_peak_force(FLAT, k, 1.0, 0.0, a)
    # samples of the steps miss the very peak by a little
    assert held(found)[0][2] == pytest.approx(twice, rel=0.02)
    assert not found.overturned.any()


def test_a_held_body_swings_with_the_frequency_of_cord_and_weight():
    a, k, z = 6.0, 2e5, 1.0
    motion = along_x([a] * 300)
    system = hold(BOX.system(), *cords(k))
    _, history = run_case(kernel_body(system), motion, DT, samples=300)
    rate = history[:, 11]
    turns = np.flatnonzero((rate[1:-1] < 0) & (rate[2:] >= 0)) + 1
    instants = turns - rate[turns] / (rate[turns + 1] - rate[turns])
    period = np.diff(instants).mean() * DT
    inertia = FLAT.centroidal_inertia + 300.0 * (0.2**2 + 0.6**2)
    square = (k * z * z - 300.0 * (G * 0.6 + a * 0.2)) / inertia
    assert 2 * math.pi / period == pytest.approx(math.sqrt(square), rel=0.02)


def test_a_cord_breaks_once_at_its_strength_and_the_body_falls():
    motion = along_x([6.0] * 100 + [0.0] * 5)
    needed = held(shaken(hold(BOX.system(), *cords(2e5)), motion))[0][2]
    weak = shaken(hold(BOX.system(), *cords(2e5, 0.9 * needed)), motion)
    assert held(weak)[0][2] == pytest.approx(0.9 * needed, rel=1e-9)
    assert 0 < held(weak)[0][3] < 0.2
    assert math.isnan(held(weak)[1][3])
    assert weak.overturned.all()
    strong = shaken(hold(BOX.system(), *cords(2e5, 1.1 * needed)), motion)
    assert not strong.overturned.any()


def turning(rate):
    """State of the box next to upright, turning towards +x about its edge there."""
    y = standing(kernel_body(BOX.system()))
    y[7], y[9], y[11] = rate * 0.6, rate * 0.2, rate
    return y


def against_wall(gap, rate, **about):
    """What the kernel says of a box that turns towards a wall on ground at rest."""
    body = kernel_body(hold(BOX.system(), Wall(0.2 + gap, **about)))
    # one interval of the ground holds the impact
    ground, start = np.zeros((2, 3)), turning(rate)
    found = run_scales(body, ground, 1e-3, np.array([1.0]), start=start)
    return found.outs[0, outcome.HELD : outcome.HELD + 4], found


def test_a_wall_gives_the_impulse_of_a_free_body():
    gap, rate = 1e-5, 0.5
    (hits, impulse, *_), _ = against_wall(gap, rate)
    assert hits >= 1
    expected = holding.wall_impulse(FLAT, 1.2, rate)
    assert 300.0 * impulse == pytest.approx(expected, rel=1e-3)
    (_, bounced, *_), _ = against_wall(gap, rate, restitution=0.5)
    assert 300.0 * bounced == pytest.approx(1.5 * expected, rel=1e-3)


@pytest.mark.parametrize("angle", [0.0, 40.0, 180.0])
def test_body_wall_and_motion_turned_together_do_the_same(angle):
    rng = np.random.default_rng(5)
    motion = along_x(synthetic_motion(rng, 1)[:, 0] * 0.8)
    rough = {"friction": Friction(0.4, 0.3), "restitution": 0.3}
    turn = math.radians(angle)
    along = np.array([[math.cos(turn), math.sin(turn)]])
    turned = motion.copy()
    turned[:, :2] = motion[:, :1] * along
    walls = [Wall(0.28, way, **rough) for way in (0.0, math.pi)]
    there = [replace(wall, direction=wall.direction + turn) for wall in walls]
    straight = hold(BOX.system(), *walls)
    aslant = hold(turned_about_vertical(BOX.system(), angle), *there)
    _, first = run_case(kernel_body(straight), motion, DT, samples=5000)
    _, other = run_case(kernel_body(aslant), turned, DT, samples=5000)
    moves = np.flatnonzero(np.abs(first[:, 10:13]).max(axis=1) > 0)[0]
    some = slice(moves, moves + 40)
    assert other[some, 2] == pytest.approx(first[some, 2], abs=1e-7)
    assert np.hypot(other[some, 10], other[some, 11]) == pytest.approx(
        np.hypot(first[some, 10], first[some, 11]), abs=1e-6
    )


def test_between_two_smooth_walls_without_a_gap_nothing_turns():
    motion = along_x([8.0] * 100 + [-8.0] * 100)
    walls = [Wall(0.2, way) for way in (0.0, math.pi)]
    found = shaken(hold(BOX.system(), *walls), motion)
    assert found.peak_velocity.max() == 0
    assert not found.overturned.any()


def test_a_shelf_leans_where_its_foot_holds_and_slides_down_where_it_does_not():
    shelf = Block(0.3, 1.8, 90.0, depth=0.9)
    gap, plane = 0.5, Block(0.3, 1.8, 90.0)
    needed = holding.leaning_friction(plane, 1.8, gap)
    system = hold(shelf.system(), Wall(0.15 + gap))
    angle = holding.leaning_angle(plane, 1.8, gap)
    arm = np.array([0.15, 0.0, -0.9])
    for part in (1.1, 0.8):
        mu = part * needed
        grips = replace(
            system, contacts=(replace(system.contacts[0], friction=Friction(mu, mu)),)
        )
        body = kernel_body(grips)
        y = standing(body)
        y[3], y[5] = math.cos(angle / 2), math.sin(angle / 2)
        c, s = math.cos(angle), math.sin(angle)
        lever = np.array([c * arm[0] + s * arm[2], 0.0, -s * arm[0] + c * arm[2]])
        y[:3] = np.array([0.15, 0.0, 0.0]) - lever
        found, history = run_case(body, np.zeros((50, 3)), DT, samples=50, start=y)
        moved = np.abs(history[-1, :3] - history[0, :3]).max()
        assert (moved < 1e-6) == (part > 1), (part, moved)
        assert found.overturned == (part < 1)


@pytest.mark.parametrize("part", [0.5, 0.9, 1.1, 2.0])
@pytest.mark.parametrize("tips", [False, True])
@pytest.mark.parametrize("is_round", [False, True])
def test_a_taut_cord_moves_what_stands_where_statics_says_so(is_round, tips, part):
    """It slides where the cord bears more than friction does, and tips where that is more than it weighs down.

    Cords lead any way from a round base, and across a side of a square one.
    """
    rng, mu, radius = np.random.default_rng(15), 0.5, 0.15
    kind = {"round": True} if is_round else {"depth": 2 * radius}
    # over the base: higher than where as much friction as there is would tip it, or lower; and one so squat that
    # it does not tip as it slides to rest either
    height, tall = (2 * radius / mu, 0.9) if tips else (0.5 * radius / mu, 0.2)
    vase = Block(2 * radius, tall, 30.0, **kind)
    limit = min(mu, radius / height) * vase.mass * G
    for _ in range(6):
        angle = (
            rng.uniform(-math.pi, math.pi)
            if is_round
            else rng.integers(4) * math.pi / 2
        )
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        stretch = rng.uniform(1e-3, 1e-2)
        cord = Tie((0.0, 0.0, height), (way[0], way[1], height), part * limit / stretch)
        held = hold(vase.system(), cord)
        grips = (replace(held.contacts[0], friction=Friction(mu, mu)),)
        body = kernel_body(replace(held, contacts=grips))
        y = standing(body)
        y[:2] -= stretch * way[:2]
        found, history = run_case(body, np.zeros((50, 3)), DT, samples=50, start=y)
        assert found.paradoxes == 0
        moved = (history[-1, :2] - y[:2]) @ way[:2]
        if part < 1:
            assert abs(history[:, :2] - y[:2]).max() < 1e-8
            assert found.peak_tilt < 1e-8
        elif tips:
            assert found.peak_tilt > 1e-4 and moved > 0
        else:
            assert found.peak_tilt < 1e-8 and moved > 1e-5


@pytest.mark.parametrize("part", [0.95, 1.3])
@pytest.mark.parametrize("is_round", [False, True])
def test_a_cord_beside_the_middle_moves_what_stands_beyond_an_ellipse(is_round, part):
    """Beside a moment friction bears less; an even pressure bears µ m g times the mean distance of the points."""
    mu, radius, aside, stretch = 0.5, 0.15, 0.1, 4e-3
    kind = {"round": True} if is_round else {"depth": 2 * radius}
    chest = Block(2 * radius, 0.2, 30.0, **kind)
    distance = 2 / 3 * radius if is_round else 0.3826 * 2 * radius
    limit = mu * chest.mass * G / math.hypot(1.0, aside / distance)
    knot, anchor = (0.0, aside, 0.1), (3.0, aside, 0.1)
    held = hold(chest.system(), Tie(knot, anchor, part * limit / stretch))
    grips = (replace(held.contacts[0], friction=Friction(mu, mu)),)
    body = kernel_body(replace(held, contacts=grips))
    y = standing(body)
    y[0] -= stretch
    found, history = run_case(body, np.zeros((50, 3)), DT, samples=50, start=y)
    assert found.paradoxes == 0
    if part < 1:
        assert abs(history[:, :2] - y[:2]).max() < 1e-8
    else:
        # its centre follows the cord, and it turns towards it
        assert history[-1, 0] > y[0] + 1e-4 and found.turn < -1e-3


@pytest.mark.parametrize(
    "cases", [2, pytest.param(60, marks=pytest.mark.slow, id="many")]
)
def test_impacts_at_rough_walls_never_gain_energy(cases):
    rng = np.random.default_rng(6)
    impacts = 0
    for _ in range(cases):
        sides = rng.uniform(0.2, 0.6, 2)
        block = Block(sides[0], rng.uniform(0.8, 1.8), 1.0, depth=sides[1])
        rough = {
            "friction": Friction(*(2 * [rng.uniform(0.1, 1.0)])),
            "restitution": rng.uniform(0.0, 1.0),
        }
        gap, turn = rng.uniform(0.01, 0.2), rng.uniform(0, 2 * math.pi)
        reach = math.hypot(*sides) / 2
        walls = [Wall(reach + gap, turn + k * math.pi / 2, **rough) for k in range(4)]
        system = hold(block.system(), *walls)
        mu = rng.uniform(0.3, 1.0)
        contacts = (replace(system.contacts[0], friction=Friction(mu, mu)),)
        body = kernel_body(replace(system, contacts=contacts))
        motion = synthetic_motion(rng, 3, seconds=6.0)
        found, _ = run_case(body, motion, DT)
        assert found.gained < 1e-6
        assert abs(found.residual) < 1e-5
        impacts += found.impacts
    assert impacts > 20 * cases


def rubbed(system, mu):
    """A body that stands on a ground of a coefficient of friction."""
    contact = replace(system.contacts[0], friction=Friction(mu, mu))
    return replace(system, contacts=(contact,))


@pytest.mark.parametrize(
    "seeds",
    [(2, 3, 6, 10, 18, 24, 29), pytest.param(range(100), marks=pytest.mark.slow)],
)
def test_beside_a_wall_an_analysis_takes_few_steps(seeds):
    """Seven in which the body is wedged, rattles or hardly slips took some 60 000 steps each, and gave up."""
    bust = Block(0.3, 0.7, 60.0, depth=0.3)
    body = kernel_body(hold(bust.system(), Wall(0.17)))
    for seed in seeds:
        motion = synthetic_motion(np.random.default_rng(seed), 2)
        found = run_scales(body, motion, DT, np.array([0.8]))
        assert found.outs[0, outcome.STEPS] < 6 * len(motion), seed
        assert found.outs[0, outcome.GAINED] < 1e-8


def test_a_state_that_is_no_number_counts_as_a_fall_and_as_a_paradox():
    """Once 4 of 60 boxes between walls went on as standing; a sample stands for what brings it about."""
    body = kernel_body(Block(0.3, 0.7, 60.0, depth=0.3).system())
    rocking = np.tile([5.0, 1.0, 0.0], (12, 1))
    stands = run_scales(body, rocking, DT, np.ones(1))
    assert stands.outs[0, outcome.FELL] == 0 < stands.outs[0, outcome.PEAK_RATIO]
    rocking[-1] = np.nan
    lost = run_scales(body, rocking, DT, np.ones(1))
    assert lost.outs[0, outcome.FELL] == 1
    assert lost.counts[0, limits.UNSOLVED] > stands.counts[0, limits.UNSOLVED]


def draw_beside_wall(rng):
    """A block under one component beside a wall along it, in the plane and as a box; ground and wall are rough."""
    width, height = rng.uniform(0.2, 0.6), rng.uniform(0.7, 1.6)
    motion = synthetic_motion(rng, 1)[:, 0] * rng.uniform(2.0, 5.0) * width / height
    gap, mu = rng.uniform(0.005, 0.08), rng.uniform(0.3, 0.8)
    rough = Friction(0.3, 0.3) if rng.integers(2) else None
    wall = Wall(width / 2 + gap, friction=rough)
    flat = rubbed(hold(Block(width, height, 100.0).system(), wall), mu)
    box = rubbed(hold(Block(width, height, 100.0, depth=0.4).system(), wall), mu)
    return flat, box, motion


@pytest.mark.parametrize(
    ("cases", "differing"), [(12, 0), pytest.param(150, 4, marks=pytest.mark.slow)]
)
def test_outcomes_beside_a_wall_along_an_axis_are_those_of_the_planar_engine(
    cases, differing
):
    rng, fell, differ = np.random.default_rng(8), 0, 0
    for _ in range(cases):
        flat, box, motion = draw_beside_wall(rng)
        shaking = (GroundMotion(Motion(motion, DT, "x")),)
        planar = run_planar(Cases((flat,), shaking, np.array([[1.0]]), Request()))
        fell += planar.overturned.sum()
        differ += (planar.overturned != shaken(box, along_x(motion)).overturned).sum()
    assert differ <= differing
    assert 0.2 < fell / cases < 0.8


@pytest.mark.parametrize("along", [4.0, 6.0])
def test_pressed_against_a_smooth_wall_a_body_slides_along_it_by_friction_of_the_ground(
    along,
):
    """µ (g + a_z) against the part along the wall alone, however hard the body is pressed."""
    mu, into, low = 0.5, 9.0, Block(0.8, 0.4, 100.0, depth=0.8)
    motion = np.zeros((60, 3))
    motion[:50, 0], motion[:50, 1] = -into, along
    system = rubbed(hold(low.system(), Wall(0.4)), mu)
    found, _ = run_case(kernel_body(system), motion, DT)
    moved = math.hypot(*found.walk)
    # half a second of acceleration, then as long as the friction takes to stop it
    spare = max(along - mu * G, 0.0)
    speed = spare * 0.5
    expected = speed * 0.25 + speed**2 / (2 * mu * G)
    assert moved == pytest.approx(expected, rel=0.03, abs=1e-9)
    assert abs(found.walk[0]) < 1e-6
    assert not found.overturned


def test_what_space_cannot_hold_is_refused_in_a_sentence():
    motion = along_x([1.0, 0.0])
    pillar = Block(0.4, 1.2, 300.0, round=True).system()
    with pytest.raises(InputError, match="corners"):
        shaken(hold(pillar, Wall(0.5)), motion)
    with pytest.raises(InputError, match="kerb"):
        shaken(hold(BOX.system(), Wall(0.5, height=0.1)), motion)
    with pytest.raises(InputError, match="stands where the body is"):
        shaken(hold(BOX.system(), Wall(0.1)), motion)
    same = Tie((0.0, 0.0, 1.0), (0.0, 0.0, 1.0), 1e5)
    with pytest.raises(InputError, match="one place"):
        shaken(hold(BOX.system(), same), motion)


@pytest.mark.parametrize("walls", [0, 1, 2])
def test_friction_beside_walls_hardly_ever_leaves_nothing_that_goes_on(walls):
    """Of 36 histories one at most lacks a force or impulse, and no wall bears more than the weight of the box."""
    beside = [Wall(BOX.width / 2 + 0.01, angle) for angle in (0.0, math.pi)[:walls]]
    without = 0
    for seed in range(40, 46):
        rng = np.random.default_rng(seed)
        for friction in (0.35, 0.5, 0.65):
            system = BOX.system().with_friction(Friction(friction, friction))
            motion = synthetic_motion(rng, 3)
            found = shaken(hold(system, *beside), motion, (0.35, 0.5))
            without += np.count_nonzero(found.paradoxes)
            assert not (found.largest_force > BOX.mass * G).any()
    assert without <= 1
