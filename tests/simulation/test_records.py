"""What a record means to blocks: rocking spectra, its worst direction, and the rules of engineers."""

import math

import numpy as np
import pytest

from rockfrag import Block, simulate
from rockfrag.base.errors import InputError
from rockfrag.motions import half_sine, scale_to_pga
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.rocking_spectra import rocking_spectrum, uniform_block
from rockfrag.simulation.rules_of_thumb import RULES, asce_43, static
from rockfrag.simulation.thresholds import worst_direction

from ..conftest import shaking

ALPHA = math.atan(1 / 4)
PERIODS = np.linspace(0.8, 4.0, 9)


@pytest.fixture(scope="module")
def motion() -> Motion:
    """A decaying chirp that rocks every block and overturns some of the small ones."""
    t = np.arange(800) * 0.01
    return Motion(
        4.5 * np.exp(-t / 4) * np.sin(2 * np.pi * (0.5 * t + 0.1 * t**2)), 0.01, "chirp"
    )


def test_block_has_the_wanted_period_and_slenderness() -> None:
    block = uniform_block(ALPHA, 1.7)
    assert 2 * math.pi / block.frequency() == pytest.approx(1.7, rel=1e-12)
    assert block.alpha == pytest.approx(ALPHA, rel=1e-12)
    assert block.slenderness == pytest.approx(4, rel=1e-12)


def test_each_ordinate_is_the_peak_of_a_simulation(motion: Motion) -> None:
    spectrum = rocking_spectrum(motion, PERIODS, [ALPHA])
    assert 0 < spectrum.overturned.sum() < PERIODS.size
    for k, period in enumerate(PERIODS):
        block = uniform_block(ALPHA, period)
        response = simulate(block, motion.acceleration, motion.dt)
        assert response.overturned == spectrum.overturned[0, k]
        if response.overturned:
            assert math.isinf(spectrum.velocity[0, k])
            continue
        rotation = np.abs(response.theta).max() / ALPHA
        velocity = np.abs(response.omega).max() / block.frequency()
        # the ensemble finds peaks between samples, the history has samples only
        assert rotation <= spectrum.rotation[0, k] * (1 + 1e-9)
        assert spectrum.rotation[0, k] == pytest.approx(rotation, rel=1e-3)
        # the largest velocity is at an impact, just before which no sample need lie
        assert velocity <= spectrum.velocity[0, k] * (1 + 1e-9)
        assert spectrum.velocity[0, k] == pytest.approx(velocity, rel=0.05)


def straight(angle_deg):
    """Two components of a motion along one line, a few pulses long."""
    t = np.arange(0, 4, 0.01)
    pulse = 3.0 * np.sin(2 * np.pi * t) * np.exp(-(((t - 2) / 0.8) ** 2))
    angle = np.radians(angle_deg)
    return Motion(pulse * np.cos(angle), 0.01, "a"), Motion(
        pulse * np.sin(angle), 0.01, "b"
    )


@pytest.mark.parametrize("angle", [20, 110])
def test_a_straight_motion_is_worst_along_its_line(angle):
    first, second = straight(angle)
    found = worst_direction(Block(0.3, 1.2, 100.0), first, second, 6.0)
    assert (found.angle_deg - angle) % 180 == 0
    assert found.motion.pga == pytest.approx(
        np.hypot(first.acceleration, second.acceleration).max()
    )
    across = found.table.set_index("angle_deg").loc[
        (angle + 90) % 360, "first_overturning"
    ]
    assert np.isnan(across)


def test_a_body_that_stands_in_all_directions_has_no_worst_one():
    found = worst_direction(Block(0.6, 1.2, 100.0), *straight(30), 0.1)
    assert np.isnan(found.angle_deg)
    assert found.table["first_overturning"].isna().all()
    with pytest.raises(InputError, match="directions_deg is empty"):
        worst_direction(Block(0.3, 1.2, 100.0), *straight(0), 2.0, directions_deg=())


def test_the_worst_direction_in_a_plane_is_no_bound_for_a_body_in_space():
    first, second = (shaking(seed, 0.4, 2, 0.3, 600) for seed in (18, 19))
    table = worst_direction(
        Block(0.3, 1.2, 100.0), first, second, 2.0, directions_deg=range(0, 360, 30)
    ).table
    in_space = Block(0.3, 1.2, 100.0, round=True)
    both = overturns(
        in_space,
        GroundMotion(first, second),
        scales=[0.9 * table["first_overturning"].min()],
    )
    assert both.overturned.item()


COLUMN = Block(0.6, 3.0, 2700.0)


def test_static_rule_is_b_over_h(noise):
    motion = scale_to_pga(noise(1, 800), 0.1)
    assert static(COLUMN, motion) == pytest.approx(2.0)


@pytest.mark.parametrize("name", RULES)
def test_every_rule_scales_inversely_with_the_motion(noise, name):
    motion = noise(2, 800, tapered=True)
    twice = Motion(2 * motion.acceleration, motion.dt)
    assert RULES[name](COLUMN, twice) == pytest.approx(
        RULES[name](COLUMN, motion) / 2, rel=1e-6
    )


def test_for_a_slow_push_asce_43_bears_twice_b_over_h():
    # its capacity 2 g (f - 1) / θ falls from 2 g b/h with the rotation, and a slow push has no spectrum
    slow = half_sine(1.0, 100.0, 0.05)
    found = asce_43(COLUMN, slow) * slow.pga / 9.81
    assert found == pytest.approx(2 * math.tan(COLUMN.alpha), rel=0.03)


def test_larger_blocks_of_one_shape_bear_more_in_all_rules_but_the_static_one(noise):
    motion = noise(3, 2000, tapered=True)
    large = Block(1.8, 9.0, 72900.0)
    for name, rule in RULES.items():
        if name == "static b/h":
            assert rule(large, motion) == pytest.approx(rule(COLUMN, motion))
        else:
            assert rule(large, motion) > rule(COLUMN, motion)
