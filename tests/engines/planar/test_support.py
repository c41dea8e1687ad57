"""Isolators: period, loss and stroke in closed form, what stands on them, and their stops."""

import math

import numpy as np
import pytest
from scipy import signal

from rockfrag import Block, Stack
from rockfrag.system import (
    BilinearIsolator,
    SlidingPendulum,
    Tie,
    Wall,
    as_system,
    hold,
)
from rockfrag.system.support import Support

from ...simulation.reference_bodies import random_motion
from .cases import DT, G, run

B, H, M = 0.3, 0.6, 100.0  # half width, half height [m], mass [kg]
BLOCK = Block(2 * B, 2 * H, M)
PULSE = np.concatenate([np.full(11, 2.0), np.zeros(400)])  # ends at 2 · 0.1 m/s


def isolated(support, body=BLOCK):
    return hold(as_system(body), support=support)


def turning_points(plate: np.ndarray) -> np.ndarray:
    """Displacements at which a plate turns round [m]."""
    speed = np.diff(plate)
    turns = np.flatnonzero(speed[1:] * speed[:-1] < 0) + 1
    # of the parabola through three samples
    left, middle, right = plate[turns - 1], plate[turns], plate[turns + 1]
    return middle - (right - left) ** 2 / (8 * (right - 2 * middle + left))


@pytest.mark.parametrize("mass", [50.0, 500.0])
@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_a_pendulum_swings_with_the_period_of_its_dish_whatever_it_carries(
    mass: float, radius: float
) -> None:
    """2π√(R/g)."""
    support = SlidingPendulum(mass=20.0, radius=radius)
    found = run(isolated(support, Block(2 * B, 2 * H, mass)), PULSE, friction=0.9)
    plate, frequency = found.plate, math.sqrt(G / radius)
    after = found.time > 0.12
    time = found.time[after] - found.time[after][0]
    waves = np.stack([np.cos(frequency * time), np.sin(frequency * time)], axis=1)
    parts, *_ = np.linalg.lstsq(waves, plate[after])
    assert np.abs(found.theta).max() == 0.0
    assert plate[after] == pytest.approx(waves @ parts, abs=1e-7 * np.abs(parts).max())


@pytest.mark.parametrize("mu", [0.01, 0.03])
def test_a_pendulum_loses_twice_its_friction_times_its_radius_in_half_a_cycle(
    mu: float,
) -> None:
    support = SlidingPendulum(mass=20.0, radius=1.0, friction=mu)
    motion = np.concatenate([np.full(11, 6.0), np.zeros(400)])
    found = run(isolated(support), motion, friction=0.9)
    turns = np.abs(turning_points(found.plate))
    losses = turns[:-1] - turns[1:]
    assert losses.size >= 2
    assert losses == pytest.approx(2 * mu * 1.0, rel=1e-3)
    assert found.constraints["stroke_m"][0] == pytest.approx(turns[0], rel=1e-4)


def test_a_flat_plate_slides_as_newmark_says() -> None:
    """R → ∞: V²/(2 µ g) (1 - µ g/A)."""
    pulse = np.concatenate([np.full(101, 3.0), np.zeros(600)])
    support = SlidingPendulum(mass=20.0, friction=0.1)
    found = run(isolated(support), pulse, 0.001, friction=0.9)
    speed, brake = 3.0 * 0.1005, 0.1 * G
    expected = speed**2 / (2 * brake) * (1 - brake / 3.0)
    assert found.constraints["stroke_m"][0] == pytest.approx(expected, rel=1e-3)
    assert abs(found.plate[-1]) == pytest.approx(expected, rel=1e-3)


def test_nothing_rocks_before_the_stop_where_the_isolator_pushes_less() -> None:
    """µ + U/R < b/h, whatever the vertical motion."""
    body, seen = Stack(Block(0.8, 0.3, 200.0), BLOCK), 0
    support = SlidingPendulum(mass=20.0, radius=1.0, friction=0.08)
    for seed in range(12):
        rng = np.random.default_rng(seed)
        motion, up = 1.5 * random_motion(rng), 0.5 * random_motion(rng)
        found = run(isolated(support, body), motion, friction=0.95, vertical=up)
        if 0.08 + found.constraints["stroke_m"][0] >= B / H:
            continue
        assert np.abs(found.theta).max() == 0.0
        energy = found.energy
        assert energy["residual"].abs().max() < 1e-8 * energy["potential"][0]
        free = run(body, motion, friction=0.95, vertical=up)
        seen += np.abs(free.theta).max() > 0.01
    assert seen >= 3


def stopped(speed: float):
    """Response of a block on a smooth plate that meets its stop at a speed."""
    # it ends by a ramp of one sample
    pulse = np.concatenate([np.full(21, -speed / 0.205), np.zeros(60)])
    support = SlidingPendulum(mass=1e-3, stroke=0.5 * 0.2 * speed + 0.05 * speed)
    return run(isolated(support), pulse, friction=math.inf, closing=1e-6)


def test_the_stop_topples_what_comes_at_the_critical_speed() -> None:
    """ω⁺ = m h V/I_O, of a plate without mass, and V_c of a kerb at the base."""
    radius = math.hypot(B, H)
    inertia = BLOCK.pivot_inertia()
    critical = math.sqrt(2 * G * (radius - H) * inertia / M) / H
    stays, topples = stopped(0.999 * critical), stopped(1.001 * critical)
    assert stays.constraints["hits"][0] > 0
    events = stays.contact_events
    after = max(omega for (omega,) in events["omega_after"])
    assert after == pytest.approx(M * H * 0.999 * critical / inertia, rel=1e-4)
    assert (stays.overturned, topples.overturned) == (False, True)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("friction", [2.0, 20.0])
@pytest.mark.parametrize("below", ["plate", "light plate", "pedestal at a wall"])
def test_what_is_stopped_below_sends_off_what_it_carries_at_once(
    below, friction, restitution
) -> None:
    """ω⁺ = (1 + e) m h V/I_O, and the impulse of both bodies, wherever friction holds the foot: it needs .67 here.

    No impulse between both would do as well but for the weight, and then nothing could go on.
    """
    slender, speed = Block(0.4, 1.2, M), 0.6
    pulse = np.concatenate([np.full(21, -speed / 0.1025), np.zeros(60)])
    mass = {"plate": 20.0, "light plate": 1e-3, "pedestal at a wall": 200.0}[below]
    if below == "pedestal at a wall":
        stack = as_system(Stack(Block(0.8, 0.3, mass), slender))
        wall = Wall(0.46, height=0.2, restitution=restitution)
        system, friction = hold(stack, wall), [0.0, friction]
    else:
        support = SlidingPendulum(mass=mass, stroke=0.06, restitution=restitution)
        system = hold(as_system(slender), support=support)
    found = run(system, pulse, friction=friction, closing=1e-6, dt=0.005)
    sent = (1 + restitution) * speed
    omega = M * 0.6 * sent / slender.pivot_inertia()
    hits = found.contact_events
    first = hits[hits["kind"] == "impact"].iloc[0]
    assert first["omega_after"][-1] == pytest.approx(omega, rel=1e-6)
    impulse = mass * sent + M * (sent - 0.6 * omega)
    told = found.constraints["largest_impulse_n_s"].iloc[0]
    assert told == pytest.approx(impulse, rel=1e-6)
    assert found.paradoxes == 0


def test_no_impact_on_a_plate_aside_of_its_middle_gains_energy() -> None:
    """The plate keeps its height, so that the slope of its dish may give nothing in an impact."""
    rng, met = np.random.default_rng(0), 0
    dish = SlidingPendulum(mass=8.0, radius=0.5, friction=0.08, stroke=0.2)
    system = isolated(dish, Block(0.2, 0.9, M))
    for _ in range(6):
        motion = rng.uniform(2.0, 4.0) * random_motion(rng)[:800]
        found = run(system, motion, friction=0.7, closing=1e-3)
        impacts = found.contact_events
        impacts = impacts[impacts["kind"] == "impact"]
        met += len(impacts)
        gained = impacts["energy_after"] - impacts["energy_before"]
        assert (gained <= 1e-9 * impacts["energy_before"]).all()
        assert found.paradoxes == 0
    assert met > 20


def test_a_bilinear_isolator_is_a_spring_until_it_yields_and_its_loop_is_lost() -> None:
    stiffness, strength, yields = 2000.0, 100.0, 0.005
    support = BilinearIsolator(
        mass=20.0, stiffness=stiffness, strength=strength, yield_displacement=yields
    )
    weak = np.concatenate([np.full(11, 0.3), np.zeros(200)])
    found = run(isolated(support), weak, friction=0.9)
    frequency = math.sqrt((stiffness + strength / yields) / (M + 20.0))
    # from rest under a constant acceleration
    early = found.time <= 0.1
    expected = -0.3 / frequency**2 * (1 - np.cos(frequency * found.time[early]))
    assert np.abs(found.plate).max() < yields
    assert found.plate[early] == pytest.approx(expected, abs=1e-6)
    strong = run(isolated(support), 3 * PULSE, friction=0.9)
    turns = np.abs(turning_points(strong.plate))
    assert turns[0] > 5 * yields
    assert turns[1] < turns[0]
    assert strong.energy["held"].iloc[-1] > 0.0
    for each in (found, strong):
        assert each.energy["residual"].abs().max() < 1e-7 * M * G * H


@pytest.mark.parametrize("strength", [0.0, 1e5])
def test_springs_that_never_yield_are_a_linear_oscillator(strength: float) -> None:
    """Those without strength from the start, those of much strength until they yield."""
    stiffness, yields, plate = 2000.0, 50.0, 20.0
    support = BilinearIsolator(
        mass=plate, stiffness=stiffness, strength=strength, yield_displacement=yields
    )
    motion = random_motion(np.random.default_rng(8))
    motion *= 0.3 * G / np.abs(motion).max()
    found = run(isolated(support), motion, friction=0.9)
    squared = (stiffness + strength / yields) / (M + plate)
    # u'' + ω² u = -a, a linear between samples
    system = ([[0, 1], [-squared, 0]], [[0], [-1]], [[1, 0]], [[0]])
    time = DT * np.arange(motion.size)
    _, expected, _ = signal.lsim(system, motion, time, interp=True)
    assert np.abs(found.theta).max() == 0.0
    size = np.abs(expected).max()
    shown = found.plate[: expected.size]
    assert size > 0.01
    assert shown == pytest.approx(expected, abs=1e-6 * size)


@pytest.mark.parametrize("kind", ["dish", "springs"])
def test_a_stop_that_is_never_met_changes_no_bit(kind: str) -> None:
    def isolator(stroke: float) -> Support:
        if kind == "dish":
            return SlidingPendulum(mass=20.0, radius=1.0, friction=0.05, stroke=stroke)
        return BilinearIsolator(
            mass=20.0, stiffness=900.0, strength=60.0, stroke=stroke
        )

    # it rocks on the plate too
    motion = 4 * random_motion(np.random.default_rng(3))
    free, far = (
        run(isolated(isolator(stroke)), motion, friction=0.9)
        for stroke in (math.inf, 1e3)
    )
    assert np.abs(free.theta).max() > 0.01
    assert np.array_equal(free.plate, far.plate)
    assert np.array_equal(free.theta, far.theta)


def test_the_mirror_image_of_an_isolated_stack_moves_as_its_mirror_image() -> None:
    motion = 3 * random_motion(np.random.default_rng(5))
    support = SlidingPendulum(mass=30.0, radius=1.5, friction=0.05, stroke=0.06)
    body = Stack(Block(0.6, 0.3, 200.0), Block(0.3, 1.2, 100.0))
    right, left = (
        run(isolated(support, body), side * motion, friction=0.6) for side in (1, -1)
    )
    assert right.constraints["hits"][0] > 0
    assert np.abs(right.theta).max() > 0.0
    until = right.contact_events["time"].iloc[min(8, len(right.contact_events) - 1)]
    early = right.time[: min(len(right.time), len(left.time))] < until
    assert right.theta[: early.size][early] == pytest.approx(
        -left.theta[: early.size][early], abs=1e-7
    )


def followed_by_steps(support: Support, body=BLOCK) -> object:
    """The same system with a cord that hangs loose, so that general steps follow it."""
    cord = Tie((0.0, 0.0, 0.5), (1.0, 0.0, 0.5), stiffness=1e3, slack=100.0)
    return hold(as_system(body), cord, support=support)


@pytest.mark.parametrize("kind", ["dish", "springs", "stiff springs"])
@pytest.mark.parametrize("body", [BLOCK, Stack(Block(0.8, 0.3, 200.0), BLOCK)])
def test_a_load_that_goes_with_its_plate_moves_as_by_general_steps(
    kind: str, body
) -> None:
    support = {
        "dish": SlidingPendulum(mass=20.0, radius=1.0, friction=0.05, stroke=0.2),
        "springs": BilinearIsolator(mass=20.0, stiffness=2000.0, strength=100.0),
        "stiff springs": BilinearIsolator(
            mass=20.0, stiffness=2e6, strength=500.0, yield_displacement=1e-4
        ),
    }[kind]
    rng = np.random.default_rng(11)
    motion, up = 1.2 * random_motion(rng), 0.4 * random_motion(rng)
    short, general = (
        run(held, motion, friction=0.9, vertical=up)
        for held in (isolated(support, body), followed_by_steps(support, body))
    )
    until = min(len(short.time), len(general.time))
    size = np.abs(general.plate).max()
    assert size > 1e-4
    # general steps err by 1e-9 of √(g b) each
    error = 1e-6 * size + 1e-8
    assert np.abs(short.plate[:until] - general.plate[:until]).max() < error
    for name in ("input", "lost_friction", "held"):
        expected = np.asarray(general.energy[name])[:until]
        found = np.asarray(short.energy[name])[:until]
        assert np.abs(found - expected).max() <= 1e-4 * np.abs(expected).max()


def test_a_load_leaves_its_plate_at_the_instant_at_which_general_steps_lift_it() -> (
    None
):
    support = SlidingPendulum(mass=20.0, radius=0.5, friction=0.1, stroke=0.15)
    motion = 3 * random_motion(np.random.default_rng(2))
    short, general = (
        run(held, motion, friction=0.9).contact_events
        for held in (isolated(support), followed_by_steps(support))
    )
    first = [events[events["kind"] != "stick"].iloc[0] for events in (short, general)]
    assert first[0]["kind"] == first[1]["kind"]
    assert first[0]["time"] == pytest.approx(first[1]["time"], abs=1e-7)


def test_a_plate_on_springs_swings_on_as_far_as_its_energy_reaches() -> None:
    """A² = u² + v²/ω² beyond the end of the motion, which is when its history ends."""
    stiffness, plate, ending = 2000.0, 20.0, 11
    support = BilinearIsolator(mass=plate, stiffness=stiffness)
    found = run(isolated(support), np.full(ending, 1.0), friction=0.9)
    frequency = math.sqrt(stiffness / (M + plate))
    # the motion ends by a ramp of one sample
    gone = (ending - 0.5) * DT
    # by superposition of the start and the end of a steady push
    amplitude = 2.0 / frequency**2 * math.sin(0.5 * frequency * gone)
    assert found.constraints["stroke_m"][0] == pytest.approx(amplitude, rel=1e-3)
