"""Newton's, Euler's and Coulomb's laws in one sample of a history in the plane, by differences of what it tells.

A column is statically determinate: the bodies above a contact are pushed by it and by nothing else.
"""

import math

import numpy as np
import pytest

from rockfrag.outcomes.response import FLIGHT

from ..oracle import witness
from .planar.cases import G

STEP = 1e-3  # [s]
SLIPS = 1e-3  # speed above which a contact slides before and after a sample [m/s]


def pushes_of(column, found, ground, k):
    """Resultants (horizontal, vertical) through each contact in sample k, and their moments about the origin.

    Shapes (n, 2) and (n,); from differences of positions and of angular velocities.
    """
    place = found.position
    rate = (place[k + 1] - 2 * place[k] + place[k - 1]) / STEP**2
    alpha = (found.omega[k + 1] - found.omega[k - 1]) / (2 * STEP)
    assert alpha == pytest.approx(found.alpha[k], abs=2e-3 * G)
    masses = np.array([body.mass for body in column.bodies])
    inertias = np.array([body.inertia for body in column.bodies])
    forces = masses[:, None] * (rate + ground[k] + (0.0, G))
    moments = forces[:, 0] * place[k, :, 1] - forces[:, 1] * place[k, :, 0]
    moments = moments + inertias * alpha
    # of all that is above
    return forces[::-1].cumsum(axis=0)[::-1], moments[::-1].cumsum()[::-1]


def check_contact(column, found, k, number, force, moment) -> str:
    """Check that a contact can push so, and that the response tells the same; say what it does."""
    q = np.column_stack([found.position[k], found.theta[k]])
    ends = witness.ends_of(column, q, number)
    state, slides = int(found.state[k, number]), int(found.slides[k, number])
    unit = column.mass * G
    if state == FLIGHT:
        assert np.abs(force).max() < 2e-3 * unit
        return "flies"
    closed = ends if state == 0 else [ends[(state + 1) // 2]]
    assert max(abs(end.gap) for end in closed) < 1e-9
    normal, tangent = closed[0].normal, closed[0].tangent
    pressed, along = force @ normal, force @ tangent
    assert pressed > -2e-3 * unit
    assert found.normal_force[k, number] == pytest.approx(pressed, abs=2e-3 * unit)
    assert found.friction_force[k, number] == pytest.approx(along, abs=2e-3 * unit)
    if pressed > 0.1 * unit:
        assert found.friction_demand[number] >= abs(along) / pressed - 0.05
    arms = [end.point[0] * force[1] - end.point[1] * force[0] for end in closed]
    turned = [moment + arm for arm in arms]
    small = 2e-3 * unit * column.size
    if len(closed) == 1:
        assert abs(turned[0]) < small
    else:
        # pushed somewhere between both ends
        assert turned[0] <= small and turned[1] >= -small
    speed = (found.slip[k + 1, number] - found.slip[k - 1, number]) / (2 * STEP)
    if slides == 0:
        assert abs(speed) < 1e-6
        assert abs(along) <= column.static[number] * pressed + 2e-3 * unit
        return "stands" if state == 0 else "rocks"
    if abs(speed) < SLIPS:
        return "between"
    assert slides == math.copysign(1, speed)
    braked = -math.copysign(column.kinetic[number], speed) * pressed
    assert along == pytest.approx(braked, abs=2e-3 * unit)
    return "slides" if state == 0 else "rocks and slides"
