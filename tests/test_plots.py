"""Motions and responses draw themselves."""

import numpy as np
import pytest

from rockfrag import Block, Motion, Stack, simulate
from rockfrag.units import GRAVITY

STATUE = Block(0.3, 1.2, 200.0)
STACK = Stack(Block(0.4, 0.3, 100.0), STATUE)
T = np.arange(0, 5, 0.01)
MOTION = Motion(3.5 * np.sin(np.pi * T / 5) * np.sin(2 * np.pi * T), 0.01, "burst")


def test_a_motion_shows_acceleration_velocity_and_displacement() -> None:
    constant = Motion(np.full(201, 2.0), 0.01).plot()
    assert [panel.get_ylabel() for panel in constant.axes] == [
        "Acceleration [g]",
        "Velocity [cm/s]",
        "Displacement [cm]",
    ]
    last = [panel.lines[1].get_ydata()[-1] for panel in constant.axes]
    # a, a t and a t²/2 after 2 s
    assert last == pytest.approx([2.0 / GRAVITY, 400.0, 400.0])


def test_a_motion_is_drawn_as_it_is_between_its_samples() -> None:
    # t³/6 of an acceleration t, which a velocity taken for linear between samples would miss by an eighth
    drawn = Motion(np.array([0.0, 1.0, 2.0]), 1.0).plot().axes[2].lines[1].get_ydata()
    assert drawn == pytest.approx([0.0, 100 / 6, 800 / 6])


def test_a_response_shows_rotations_over_the_critical_angle_and_every_impact() -> None:
    response = simulate(STACK, MOTION.acceleration, MOTION.dt)
    ground, rotation, _ = response.plot().axes
    lines = {line.get_label(): line for line in rotation.lines}
    statue = np.asarray(lines["upper body"].get_ydata())
    assert statue == pytest.approx(response.theta[:, 1] / STATUE.alpha)
    assert (
        len(lines["impact"].get_xdata()) == (response.contact_events["kind"] == "impact").sum() > 0
    )
    assert ground.get_ylabel() == "Ground [g]"
