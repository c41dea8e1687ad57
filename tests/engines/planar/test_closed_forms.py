"""Sliding, rocking and flight where they can be worked out on paper."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack

from ...simulation.reference_bodies import T1, P
from .cases import run

G = 9.81
DT = 0.001
SQUAT = Block(0.4, 0.2, 5.0)


def pulse(acceleration: float, duration: float, quiet: float = 3.0) -> np.ndarray:
    """Samples of a rectangular pulse that ends within one sampling interval."""
    n = round(duration / DT)
    return np.concatenate([np.full(n, acceleration), np.zeros(round(quiet / DT))])


@pytest.mark.parametrize(
    ("mu", "a", "slope"),
    [
        (0.2, 5.0, 0),
        (0.3, 3.2, 0),
        (0.45, 9.0, 0),
        ((0.4, 0.2), 5.0, 0),
        (0.35, 6.0, 0.1),
        (0.35, 6.0, -0.15),
    ],
)
def test_a_pulse_moves_a_block_as_far_as_newmark_says(
    mu, a: float, slope: float
) -> None:
    """Gravity along a slope is an acceleration of the support: the block slides on until its speed is spent."""
    along, across = G * math.sin(slope), G * (math.cos(slope) - 1)
    motion = pulse(a, 0.4, 6.0) + along
    response = run(
        SQUAT, motion, DT, friction=mu, vertical=np.full(motion.size, across)
    )
    hold = np.atleast_1d(mu)[-1] * G * math.cos(slope)
    # relative to the support: a + along - hold drives, hold - along brakes; half of the last ramp counts
    spent = 0.4 - DT / 2
    speed = (a + along - hold) * spent
    expected = speed * spent / 2 + speed**2 / (2 * (hold - along))
    at = round(5.0 / DT)
    assert -response.slip[at, 0] == pytest.approx(
        expected, rel=2e-5 if slope == 0 else 1e-4
    )
    assert response.mode[at, 0] == "stands"


@pytest.mark.parametrize(("mu", "first"), [(0.2, "slides"), (0.5, "rocks")])
def test_a_block_on_a_plane_tilted_slowly_slides_or_topples_at_the_lesser_angle(
    mu, first
):
    slope = np.linspace(0.0, 0.5, 2001)
    response = run(
        T1, G * np.sin(slope), 0.01, friction=mu, vertical=G * (np.cos(slope) - 1)
    )
    start = response.contact_events.iloc[0]
    assert start["modes"][0].startswith(first)
    at = np.interp(start["time"], np.arange(slope.size) * 0.01, slope)
    assert math.tan(at) == pytest.approx(min(mu, T1.b / T1.h), rel=1e-5)


def test_from_rest_a_block_does_what_the_map_of_shenton_says() -> None:
    """Shenton (1996): rest, slide, rock, rock and slide under a sudden acceleration."""

    def begins(block, a, friction):
        return run(block, np.full(2, a), 1e-4, friction=friction).mode[1, 0]

    rng = np.random.default_rng(11)
    seen = set()
    for _ in range(400):
        block = Block(0.5, 0.5 * rng.uniform(0.8, 5), 10.0)
        a, mu = G * rng.uniform(0.05, 1.5), rng.uniform(0.05, 1.2)
        ratio = block.b / block.h
        turning = block.mass * (a * block.h - G * block.b) / block.pivot_inertia()
        demand = (a - block.h * turning) / (G + block.b * turning)
        if a <= min(mu, ratio) * G:
            expected = "stands"
        elif mu <= ratio:
            expected = "slides left"
        elif mu >= demand:
            expected = "rocks left"
        else:
            expected = "rocks left, slides left"
        seen.add(expected)
        assert begins(block, a, mu) == expected, (a, mu, block)
    assert len(seen) == 4
    # static friction holds longer than kinetic
    assert begins(SQUAT, 0.39 * G, (0.4, 0.2)) == "stands"
    assert begins(SQUAT, 0.41 * G, (0.4, 0.2)) == "slides left"
    assert begins(Block(0.5, 2.0, 10.0), 0.5 * G, (1.0, 0.05)) == "rocks left"


def test_a_ground_that_falls_away_leaves_the_block_on_a_parabola() -> None:
    """Down at 2 g for 0.2 s, then still: free fall above the ground, and a flat landing."""
    drop = np.concatenate([np.full(200, -2 * G), np.zeros(1500)])
    response = run(SQUAT, np.zeros(drop.size), DT, friction=0.5, vertical=drop)
    assert "flies" in response.mode[:, 0]
    t = 0.15
    k = round(t / DT)
    assert response.position[k, 0, 1] - SQUAT.h == pytest.approx(G * t**2 / 2, abs=1e-9)
    assert response.mode[-1, 0] == "stands"
    assert np.abs(response.theta).max() < 1e-12
    assert response.impacts == 1


def test_a_block_that_turns_in_flight_lands_on_a_corner() -> None:
    drop = np.concatenate([np.full(60, -3 * G), np.zeros(3000)])
    response = run(
        SQUAT, np.zeros(drop.size), DT, friction=0.5, vertical=drop, omega0=0.3
    )
    first = response.contact_events[response.contact_events.kind == "impact"].iloc[0]
    assert first["from"] == "flight"
    k = np.flatnonzero(response.mode[:, 0] == "flies")[5]
    assert np.ptp(response.omega[k : k + 20, 0]) < 1e-12
    assert response.mode[-1, 0] == "stands"


@pytest.mark.parametrize("body", [T1, Stack(P, T1)], ids=["block", "stack"])
@pytest.mark.parametrize("up", [2.0, -4.0])
def test_a_constant_vertical_acceleration_is_another_gravity(
    body: object, up: float
) -> None:
    rng = np.random.default_rng(5)
    motion = 4.0 * rng.standard_normal(200)
    lifted = run(body, motion, 0.01, friction=0.5, vertical=np.full(200, up), g=G)
    other = run(body, motion, 0.01, friction=0.5, g=G + up)
    n = min(200, lifted.theta.shape[0], other.theta.shape[0])
    assert np.abs(other.theta[:n]).max() > 1e-3
    np.testing.assert_allclose(lifted.theta[:n], other.theta[:n], atol=1e-7)
    np.testing.assert_allclose(lifted.slip[:n], other.slip[:n], atol=1e-7)


def test_a_statue_slides_off_its_pedestal() -> None:
    """A long pulse under a smooth interface: the pedestal leaves, and the statue tips over its edge."""
    body = Stack(Block(0.3, 0.1, 50.0), Block(0.1, 0.15, 2.0))
    response = run(body, pulse(3.0, 1.0), DT, friction=(1.0, 0.05))
    assert response.overturned_body == "upper body"
    assert response.slip[-2, 1] < -0.1
    events = response.contact_events
    assert (
        events[events["modes"].map(lambda to: "slides" in to[1])].iloc[0]["time"] < 0.1
    )


def test_a_statue_as_wide_as_its_pedestal_rocks_on_the_edge_without_leaving_it() -> (
    None
):
    body = Stack(Block(0.3, 0.2, 30.0), Block(0.3, 0.7, 20.0))
    motion = 5.0 * np.sin(np.linspace(0.0, 2 * math.pi, 101))
    response = run(body, motion, 0.01, friction=5.0)
    # at 1.5 s it is lying down and does slide off
    early = response.contact_events[response.contact_events["time"] < 1.0]
    modes = {mode for modes in early["modes"] for mode in modes}
    assert "rocks left" in modes
    assert "flies" not in modes
