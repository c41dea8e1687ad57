"""Short analyses of bodies that slide, rock and hit, beside the plain integrator, and seen in a mirror.

They are short enough for kernels that run as plain Python.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rockfrag import Block, GroundMotion, Motion, Stack
from rockfrag.engines import velocity_pieces
from rockfrag.engines.contract import Case, Cases, Request
from rockfrag.engines.planar import engine, records, velocity_steps
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.records.velocity_steps import VelocitySteps
from rockfrag.simulation.inputs import ground_motion
from rockfrag.simulation.options import system_of
from rockfrag.system import (
    BilinearIsolator,
    Bond,
    SlidingPendulum,
    Tie,
    Wall,
    as_system,
    hold,
)

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
    monkeypatch.setattr(engine, "free_samples", lambda *_: np.zeros(2, np.int64))
    monkeypatch.setattr(velocity_pieces, "free_samples", lambda *_: 0)


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


def test_cases_of_a_grid_are_those_of_each_history_alone():
    """The scale runs fastest, then the motion; each has its own samples, friction and start."""
    level, lift = pulse(7)
    motions = (
        ground_motion(level, DT, lift),
        ground_motion(-0.7 * level[:4], 0.03, lift[:4]),
    )
    systems = (
        cases.with_contacts(STACK, (0.6, 0.3)),
        hold(cases.with_contacts(BLOCK, (0.5,)), Wall(0.27, friction=0.2)),
    )
    scales = np.array([[0.4, 1.1], [1.2, 0.8]])
    grid = Cases(systems, motions, scales, Request(g=cases.G))
    found = engine.contact_outcomes(grid)
    wanted = np.zeros(grid.shape, bool)
    wanted[0, 1, 1] = wanted[1, 1, 0] = True
    some = engine.contact_outcomes(grid, wanted)
    assert not some["peak_velocity"][~wanted].any()
    slid = set()
    for at in np.ndindex(*grid.shape):
        i, j, k = at
        case = Case(systems[i], motions[j], float(scales[j, k]), grid.request)
        run = engine.ContactRun(case)
        alone = run.work["outcome"]
        for name in set(alone.dtype.names) - {"slip"}:
            np.testing.assert_array_equal(found[at][name], alone[name])
            if wanted[at]:
                np.testing.assert_array_equal(found[at][name], some[at][name])
        slip = run.response().slip[-1]
        assert found[at]["slip"][: slip.size] == pytest.approx(slip, abs=1e-12)
        slid.add((i, bool(np.abs(slip).max() > 1e-4)))
    assert len(slid) >= 3


def test_contact_is_written_where_pure_rocking_does_not_answer():
    """Where something slid, flew or had no consistent mode; bodies and holders by their places."""
    rng, shape = np.random.default_rng(24), (2, 4)
    found = np.zeros(shape, records.OUTCOME)
    for name in (
        "peak_rotation",
        "peak_velocity",
        "slip",
        "peak_slip",
        "hits",
        "stroke",
    ):
        found[name] = rng.integers(1, 9, found[name].shape)
    for name in ("impacts", "given_way", "parted_contact", "several_modes"):
        found[name] = rng.integers(1, 9, shape)
    found["slid"][0, 1, 1] = found["flights"][0, 2, 0] = found["paradoxes"][0, 3] = 1
    found["overturned_body"][0, 1], found["overturned_body"][1, 2] = 2, 1
    found["leaning"][1, 0] = found["leaning"][0, 1] = 1
    for everything in (False, True):
        into = empty_outcomes(
            [("a",), ("b", "c")],
            np.ones(shape),
            ("one", "two"),
            holding=[(), ("w", "t")],
        )
        into.engine[:], into.peak_rotation[:] = 1, 0.5
        into.certain_time[:] = into.unstable_distance[:] = 0.3
        engine.write_contact(into, 1, 2, found, everything)
        for at in np.ndindex(*shape):
            written = everything or (at[0] == 0 and at[1] > 0)
            here, fell = (1, *at), int(found["overturned_body"][at])
            assert into.engine[here] == (0 if written else 1)
            assert math.isnan(into.certain_time[here]) == written
            assert math.isnan(into.unstable_distance[here]) == written
            if not written:
                assert (into.peak_rotation[here] == 0.5).all()
                continue
            assert into.overturned[here] == (fell > 0)
            assert into.leaning[here] == found["leaning"][at]
            assert into.flights[here] == found["flights"][at].sum()
            for name in ("impacts", "given_way", "parted_contact", "overturned_body"):
                assert getattr(into, name)[here] == found[name][at]
            for k in (0, 1):
                peak = math.inf if fell == k + 1 else found["peak_rotation"][at][k]
                assert into.peak_rotation[here][k] == peak
                for name in ("peak_velocity", "slip", "peak_slip"):
                    assert getattr(into, name)[here][k] == found[name][at][k]
                for name in ("hits", "stroke"):
                    assert getattr(into, name)[here][k] == found[name][at][k]
        assert (into.engine[0] == 1).all()


def test_what_is_told_of_a_plate_is_left_out_of_bodies():
    system = hold(as_system(STACK), support=SlidingPendulum(mass=20.0, radius=1.0))
    found = np.zeros((1, 1), records.OUTCOME)
    found["slip"][0, 0, :3] = found["flights"][0, 0, :3] = 7, 8, 9
    found["overturned_body"], found["parted_contact"] = 3, 2
    assert engine.without_plate(found, as_system(STACK)) is found
    own = engine.without_plate(found, system)[0, 0]
    for name in ("slip", "flights"):
        assert own[name][:3].tolist() == [8, 9, 0] and not own[name][3:].any()
    assert (own["overturned_body"], own["parted_contact"]) == (2, 1)
    found["overturned_body"] = found["parted_contact"] = 0
    own = engine.without_plate(found, system)[0, 0]
    assert (own["overturned_body"], own["parted_contact"]) == (0, 0)


ISOLATORS = {
    "dish": (SlidingPendulum(mass=20.0, radius=1.5), cases.G / 1.5, 0.0),
    "rough dish": (
        SlidingPendulum(mass=20.0, radius=1.5, friction=0.03),
        cases.G / 1.5,
        0.03 * cases.G,
    ),
    "spring": (
        # stiff enough not to yield
        BilinearIsolator(
            mass=20.0, stiffness=400.0, strength=1e5, yield_displacement=10.0
        ),
        (400.0 + 1e4) / 320.0,
        0.0,
    ),
}


@pytest.mark.parametrize("kind", ISOLATORS)
def test_a_plate_with_its_load_is_an_oscillator_and_its_energy_balances(kind):
    """u'' = -a - ω² u - µ g sgn u', with what stands on it still."""
    support, square, brake = ISOLATORS[kind]
    level = np.array([1.5, 0.5, -1.0, -2.0, 0.0, 1.0, 0.0])
    system = hold(cases.with_contacts(BLOCK, (0.9,)), support=support)
    found = cases.run(system, level, DT)

    def rates(t, y):
        a = np.interp(t, DT * np.arange(level.size), level)
        way = np.sign(y[1]) or -np.sign(a)
        return y[1], -a - square * y[0] - brake * way

    time = DT * np.arange(len(found.time))
    path = solve_ivp(
        rates,
        (0, time[-1]),
        (0.0, 0.0),
        t_eval=time,
        rtol=1e-9,
        atol=1e-12,
        max_step=1e-3,
    )
    assert found.plate == pytest.approx(path.y[0], abs=1e-6 if brake else 1e-9)
    assert not found.theta.any()
    assert np.abs(found.plate).max() > 1e-4
    assert cases.imbalance(found) < 1e-9
    stroke = found.constraints["stroke_m"][0]
    assert stroke == pytest.approx(np.abs(path.y[0]).max(), rel=1e-3)


def jumped(body, friction, level, lift, steps, scale=1.0):
    """Response of a body under a record and jumps, and the case."""
    ground = GroundMotion(Motion(level, DT), z=Motion(lift, DT), steps=steps)
    case = Case(system_of(body, friction), ground, scale, Request(g=cases.G))
    return velocity_steps.JumpedRun(case).response(), case


def test_a_block_that_slides_is_left_behind_by_jumps_of_its_base():
    """Each takes its velocity off that of the block, which friction µ (g + a_v) brakes then."""
    mu, level, lift = 0.3, np.zeros(9), np.full(9, 0.5)
    lift[-1] = 0.0
    steps = VelocitySteps([0.03, 0.07], [0.2, -0.1])
    found, _ = jumped(Block(0.8, 0.4, 50.0), mu, level, lift, steps)
    brake = mu * (cases.G + 0.5)
    first = 0.2 * 0.04 - brake * 0.04**2 / 2
    # it would stop after the second
    speed = -0.2 + brake * 0.04 + 0.1
    assert speed > 0
    second = speed**2 / (2 * brake)
    for at, slip in ((0.02, 0.0), (0.06, -(0.2 * 0.03 - brake * 0.03**2 / 2))):
        assert np.interp(at, found.time, found.slip[:, 0]) == pytest.approx(
            slip, abs=1e-9
        )
    assert found.slip[-1, 0] == pytest.approx(-first + second, abs=1e-7)
    assert not found.theta.any()
    assert found.impacts == 0
    assert cases.imbalance(found) < 1e-9
    events = found.contact_events
    told = events[events["kind"] == "velocity step"]
    assert told["time"].to_numpy() == pytest.approx([0.03, 0.07])
    energies = 50.0 / 2 * np.array([0.2**2, speed**2])
    assert told["energy_after"].to_numpy() == pytest.approx(energies, rel=1e-6)
    ledgers = found.energy[["input", "lost_friction", "lost_contact_1"]]
    assert not ledgers.iloc[0].any()
    rubbed = 50.0 * brake * (first + second)
    assert ledgers["lost_friction"].iloc[-1] == pytest.approx(rubbed, rel=1e-6)


def test_a_base_that_drops_leaves_its_block_in_flight_and_one_that_jumps_up_does_not():
    level = lift = np.zeros(9)
    drop = VelocitySteps([0.01], [0.0], [-0.4])
    found, _ = jumped(Block(0.8, 0.4, 50.0), 0.5, level, lift, drop)
    lands = found.contact_events.query("kind == 'impact'")["time"].iloc[0]
    assert lands == pytest.approx(0.01 + 2 * 0.4 / cases.G, rel=1e-6)
    flight = found.time - 0.01
    above = 0.4 * flight - cases.G * flight**2 / 2
    inside = (flight > 1e-9) & (found.time < lands)
    height = found.position[:, 0, 1] - found.position[0, 0, 1]
    assert height[inside] == pytest.approx(above[inside], abs=1e-9)
    up = VelocitySteps([0.01], [0.0], [0.4])
    found, _ = jumped(Block(0.8, 0.4, 50.0), 0.5, level, lift, up)
    assert found.position[:, 0, 1] == pytest.approx(found.position[0, 0, 1])


@pytest.mark.parametrize("side", [1, -1])
def test_a_rough_base_that_jumps_starts_a_slender_block_by_its_momentum(side):
    """ω = 3 v h / 4 (b² + h²) about the corner that it is thrown on, then by its energy."""
    b, h, v = 0.05, 0.4, 0.25
    level = lift = np.zeros(6)
    steps = VelocitySteps([0.03], [-side * v])
    found, case = jumped(Block(2 * b, 2 * h, 50.0), 9.0, level, lift, steps)
    starts = side * 3 * v * h / (4 * (b**2 + h**2))

    def rates(_, y):
        x = h * np.sin(y[0]) - b * np.cos(y[0])
        return y[1], cases.G * x / (4 / 3 * (b**2 + h**2))

    after = found.time > 0.03 + 1e-9
    time, ends = found.time[after], (0.03, found.time[-1])
    path = solve_ivp(
        rates, ends, (0.0, abs(starts)), dense_output=True, rtol=1e-10, atol=1e-12
    )
    assert time.size > 2
    assert found.theta[after, 0] == pytest.approx(side * path.sol(time)[0], abs=1e-7)
    assert found.omega[after, 0] == pytest.approx(side * path.sol(time)[1], abs=1e-6)
    assert not found.theta[found.time < 0.03 - 1e-9].any()
    assert found.paradoxes == 0
    # what a grid tells of it
    cases_of = Cases(
        (case.system,), (case.motion,), np.array([[1.0, 0.1]]), case.request
    )
    told = velocity_steps.run(cases_of)
    assert told.peak_velocity[0, 0, 0, 0] == pytest.approx(abs(starts), rel=1e-6)
    assert told.peak_velocity[0, 0, 1, 0] == pytest.approx(abs(starts) / 10, rel=1e-6)
    peak = np.abs(path.y[0]).max() / math.atan2(b, h)
    assert told.peak_rotation[0, 0, 0, 0] == pytest.approx(peak, rel=1e-4)
    assert told.slip[0, 0, 0, 0] == pytest.approx(0.0, abs=1e-9)
    assert not told.paradoxes.any() and not told.overturned.any()
    assert told.impacts[0, 0, 0] == found.impacts
