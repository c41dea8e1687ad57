"""A body that spins flat comes to rest as a face does that is pressed evenly."""

import math

import numpy as np
import pytest

from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial.body import standing
from rockfrag.engines.spatial.engine import run_case

from .samples import DT, box, cylinder

SPIN = 6.0  # [rad/s]


def spun(body, spin=SPIN, velocity=(0.0, 0.0)):
    """Outcome of a body that spins, and moves, flat on a ground at rest."""
    start = standing(body)
    start[12] = spin
    start[7:9] = velocity
    outcome, _ = run_case(body, np.zeros((1500, 3)), DT, start=start)
    return outcome


def mean_distance(width, depth, cells=2000):
    """Mean distance of a rectangle's points from its middle, by sums [m]."""
    x = ((np.arange(cells) + 0.5) / cells - 0.5) * width
    y = ((np.arange(cells) + 0.5) / cells - 0.5) * depth
    return float(np.hypot(x[:, None], y).mean())


@pytest.mark.parametrize("friction", [0.15, 0.3])
@pytest.mark.parametrize(
    ("width", "depth"), [(0.8, 0.8), (0.5, 1.0), (1.2, 0.3), (0.0, 0.0)]
)
def test_a_face_is_twisted_by_friction_at_the_mean_distance_of_its_points(
    width, depth, friction
):
    """Under µ N times that distance a spin ends after an angle of J ω² / (2 µ g times it)."""
    if width:
        body, arm = box(width, depth, 0.3, friction), mean_distance(width, depth)
    else:
        body, arm = cylinder(0.5, 0.3, friction), 2 * 0.5 / 3
    expected = body["inertia"][2, 2] * SPIN**2 / (2 * friction * GRAVITY * arm)
    outcome = spun(body)
    assert outcome.turn == pytest.approx(expected, rel=1e-3)
    assert math.hypot(*outcome.walk) < 1e-6
    assert outcome.peak_tilt < 1e-6
    assert abs(outcome.residual) < 1e-7


def test_the_square_and_the_disc_have_their_known_arms():
    square, disc = box(0.8, 0.8, 0.3), cylinder(0.5, 0.3)
    assert square["twist"] == pytest.approx(0.3826 * 0.8, rel=1e-4)
    assert disc["twist"] == pytest.approx(2 * 0.5 / 3)


@pytest.mark.parametrize("is_round", [False, True])
def test_a_face_that_slides_without_spin_stops_after_newmarks_way(is_round):
    body = cylinder(0.5, 0.3, 0.2) if is_round else box(0.8, 0.5, 0.3, 0.2)
    outcome = spun(body, 0.0, (1.2, 0.5))
    expected = (1.2**2 + 0.5**2) / (2 * 0.2 * GRAVITY)
    assert math.hypot(*outcome.walk) == pytest.approx(expected, rel=1e-3)
    assert abs(outcome.turn) < 1e-6


@pytest.mark.parametrize("seed", range(4))
def test_a_face_that_slides_and_spins_loses_all_it_had_and_stays_flat(seed):
    rng = np.random.default_rng(seed)
    body = box(0.8, rng.uniform(0.4, 1.2), 0.3, 0.2)
    velocity, spin = rng.uniform(-1, 1, 2), rng.uniform(-4, 4)
    outcome = spun(body, spin, velocity)
    had = (velocity @ velocity + body["inertia"][2, 2] * spin**2) / 2
    assert outcome.dissipated[1] == pytest.approx(had, rel=1e-4)
    assert outcome.peak_tilt < 1e-6
    assert outcome.paradoxes == 0
