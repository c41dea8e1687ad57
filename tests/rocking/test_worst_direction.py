"""The worst direction of a record for a body is that of its strongest shaking, where shaking is straight."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.rocking.ensemble import overturns
from rockfrag.rocking.worst_direction import worst_direction
from rockfrag.system.blocks import Block


def straight(angle_deg):
    """Two components of a motion along one line, a few pulses long."""
    t = np.arange(0, 4, 0.01)
    pulse = 3.0 * np.sin(2 * np.pi * t) * np.exp(-(((t - 2) / 0.8) ** 2))
    angle = np.radians(angle_deg)
    return Motion(pulse * np.cos(angle), 0.01, "a"), Motion(pulse * np.sin(angle), 0.01, "b")


@pytest.mark.parametrize("angle", [20, 60, 110])
def test_a_straight_motion_is_worst_along_its_line(angle):
    first, second = straight(angle)
    found = worst_direction(Block(0.3, 1.2, 100.0), first, second, 6.0)
    assert (found.angle_deg - angle) % 180 == 0
    assert found.motion.pga == pytest.approx(
        np.hypot(first.acceleration, second.acceleration).max()
    )
    across = found.table.set_index("angle_deg").loc[(angle + 90) % 360, "first_overturning"]
    assert np.isnan(across)


def test_a_body_that_stands_in_all_directions_has_no_worst_one():
    first, second = straight(30)
    found = worst_direction(Block(0.6, 1.2, 100.0), first, second, 0.1)
    assert np.isnan(found.angle_deg)
    assert found.table["first_overturning"].isna().all()


def test_no_direction_is_no_question():
    with pytest.raises(InputError, match="directions_deg is empty"):
        worst_direction(Block(0.3, 1.2, 100.0), *straight(0), 2.0, directions_deg=())


def test_the_worst_direction_in_a_plane_is_no_bound_for_a_body_in_space():
    t = np.arange(0, 6, 0.01)
    rng = np.random.default_rng(0)

    def component():
        waves = zip(rng.uniform(0.4, 2, 3), rng.uniform(0, 6, 3), strict=True)
        return Motion(
            sum(np.sin(2 * np.pi * f * t + p) for f, p in waves) * np.sin(np.pi * t / 6) ** 2, 0.01
        )

    first, second = component(), component()
    table = worst_direction(
        Block(0.3, 1.2, 100.0), first, second, 2.0, directions_deg=range(0, 360, 30)
    ).table
    in_space = Block(0.3, 1.2, 100.0, round=True)
    both = overturns(
        in_space, GroundMotion(first, second), scales=[0.9 * table["first_overturning"].min()]
    )
    assert both.overturned.item()
