"""Time stepping of a body in space beside the conditions that define it, and beside free flight in closed form.

Kernels are called one by one, as plain Python.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ...mutants.plain import plain_library
from .plain_space import (
    G,
    Tie,
    Wall,
    attitude,
    case,
    inverse_mass,
    jacobian,
    limits,
    point,
    rotation,
    shaken,
    solid,
    state,
    uneven,
)

with plain_library():
    from rockfrag.engines.spatial import _stepping as stepping

TAU, DT = 0.003, 0.01


def gravity_at(s, tau):
    return s.field[:3] + tau * s.field[3:6]


def rows_of(body, y, i):
    """Jacobian of contact i in its own axes: two along its surface, one away from it."""
    if i < solid.WALLS:
        return jacobian(y, point(body, i))
    wall = solid.wall_of(i)
    away = np.array([*body.away[wall], 0.0])
    across, up = np.array([-away[1], away[0], 0.0]), np.array([0.0, 0.0, 1.0])
    corner = np.array(body.corner[(i - solid.WALLS) % solid.MOST_CORNERS])
    return np.stack([across, up, away]) @ jacobian(y, corner)


def beside_a_wall(rng, speed=0.2):
    """A body that comes down on the ground and against a wall, almost upright, in any direction."""
    # towards the corner 2 or the corner 0
    body, s = uneven(rng, Wall(0.5, rng.choice([0.3, 3.73]))), shaken(rng)
    y = state(rng, body)
    y[7:] *= speed
    # towards the ground and the wall, faster than it turns
    y[7:9] -= 0.15 * np.array(body.away[0])
    y[9] -= 0.15
    y[13:] = rng.normal(size=2)
    y[3:7] = np.roll(Rotation.from_rotvec([*rng.normal(0, 2e-4, 2), 0.0]).as_quat(), 1)
    y[:2] = 0.0
    y[2] = body.height
    y[2] -= min(solid.gap(body, y, rotation(y)[2], i) for i in range(body.count)) - 1e-4
    at_wall = [solid.WALLS + k for k in range(body.corners)]
    nearest = min(solid.gap_of(body, y, rotation(y), i) for i in at_wall)
    y[:2] -= (nearest - 1e-4) * np.array(body.away[0])
    return body, y, s


def test_in_the_air_a_step_is_that_of_the_body_without_contacts():
    """Velocities by the effective gravity in the middle and a tie, then places by them (symplectic Euler)."""
    rng, h = np.random.default_rng(1), 2e-3
    tie = Tie((0.1, 0.0, 1.0), (1.0, 0.2, 1.1), 500.0, damping=4.0)
    for _ in range(4):
        body, s = uneven(rng, tie), shaken(rng)
        y = state(rng, body)
        y[2] += 2.0
        before, r = y.copy(), attitude(y)
        knot = np.array(body.knot[0])
        way = np.array(body.anchor[0]) - y[:3] - r @ knot
        length = np.linalg.norm(way)
        way /= length
        rate = -way @ (jacobian(y, knot) @ y[7:13])
        stretch = length - body.natural[0]
        held = max(500.0 * stretch + 4.0 * rate, 0.0) * way if stretch > 0 else 0 * way
        load, moment = gravity_at(s, TAU + h / 2) + held, np.cross(knot, r.T @ held)
        omega = y[10:13].copy()
        moment_left = moment - np.cross(omega, body.inertia @ omega)
        assert stepping.take_step(body, TAU, h, y, s) == 0
        assert y[7:10] == pytest.approx(before[7:10] + h * load)
        assert y[10:13] == pytest.approx(
            omega + h * np.linalg.solve(body.inertia, moment_left)
        )
        assert y[:3] == pytest.approx(before[:3] + h * y[7:10], abs=1e-12)
        turned = r @ Rotation.from_rotvec(h * y[10:13]).as_matrix()
        assert attitude(y) == pytest.approx(turned, abs=1e-5)
        work = h * (load @ y[7:10] + G * y[9] + moment @ y[10:13])
        assert y[solid.WORK] - before[solid.WORK] == pytest.approx(work)


def test_after_a_step_what_is_near_obeys_the_conditions_of_contact():
    """Signorini's with the gap, and Coulomb's with the greatest loss; momentum changes by these impulses alone."""
    rng, h, kinds = np.random.default_rng(2), 6e-4, set()
    for _ in range(12):
        body, y, s = beside_a_wall(rng)
        body.static, body.kinetic = rng.uniform(0.3, 0.6), rng.uniform(0.05, 0.3)
        body.wall_static[0], body.wall_kinetic[0] = 0.4, 0.2
        rows = rotation(y)
        numbers = [
            *range(body.count),
            *(solid.WALLS + k for k in range(body.corners)),
        ]
        gaps = {i: solid.gap_of(body, y, rows, i) for i in numbers}
        near = [i for i in numbers if gaps[i] <= stepping.NEAR]
        spin = np.linalg.solve(
            body.inertia, -np.cross(y[10:13], body.inertia @ y[10:13])
        )
        free = y[7:13] + h * np.hstack([gravity_at(s, TAU + h / 2), spin])
        s.counters[:] = 0
        n = stepping.find_near(body, y, rows, h, s)
        assert s.near[:n].tolist() == near
        start = y.copy()
        n = stepping.take_step(body, TAU, h, y, s)
        y_then, pushed = start.copy(), np.zeros(6)
        rows_at = [rows_of(body, start, i) for i in near]
        for k, j in enumerate(rows_at):
            pushed += inverse_mass(body) @ j.T @ s.shove[k]
        y_then[7:13] = free + pushed
        assert y[7:13] == pytest.approx(y_then[7:13], abs=1e-11)
        total = 0.0
        for k, (i, j) in enumerate(zip(near, rows_at, strict=True)):
            u, slip = j @ y_then[7:13], j @ free
            shear, normal = s.shove[k, :2], s.shove[k, 2]
            closes = max(gaps[i], 0.0) / h
            assert normal >= 0.0
            assert u[2] + closes > -1e-6
            assert normal * abs(u[2] + closes) < 1e-6
            wall = i >= solid.WALLS
            static = 0.4 if wall else body.static
            kinetic = 0.2 if wall else body.kinetic
            mu = kinetic if np.hypot(*slip[:2]) > limits.AT_REST else static
            assert s.rubs[k] == pytest.approx(mu)
            assert np.hypot(*shear) <= mu * normal * (1 + 1e-12)
            if normal > 1e-4 and np.hypot(*u[:2]) > 1e-4:
                against = -mu * normal * u[:2] / np.hypot(*u[:2])
                assert shear == pytest.approx(against, abs=1e-5)
                kinds.add((wall, "slides"))
            elif normal > 1e-4:
                kinds.add((wall, "sticks"))
            else:
                kinds.add((wall, "parts"))
            total += normal * wall
        assert s.impact[0] == pytest.approx(total)
    assert {(False, "slides"), (True, "slides"), (False, "parts")} <= kinds


def test_after_a_step_what_was_pressed_touches_and_nothing_lies_behind_its_wall():
    rng, h, touching = np.random.default_rng(3), 6e-4, 0
    for _ in range(12):
        body, y, s = beside_a_wall(rng)
        body.wall_static[0] = body.wall_kinetic[0] = 0.3
        n = stepping.take_step(body, TAU, h, y, s)
        rows = rotation(y)
        for k in range(n):
            gap = solid.gap_of(body, y, rows, s.near[k])
            assert gap > -1e-8
            if s.shove[k, 2] > 0:
                # moved as far as the gaps of others allow
                assert gap < 1e-8 or n > 3
                touching += 1
        pressed = [int(s.near[k]) for k in range(n) if s.shove[k, 2] > 0]
        stepping.close_pressed(body, y, n, s)
        assert s.closed[: s.count].tolist() == pressed[: case.MOST]
        assert (s.slides[: s.count] == case.SLIDES).all()
    assert touching > 12


def test_an_interval_in_the_air_is_passed_as_galilei_says():
    """Velocities exactly, as the ground's acceleration is linear; places to the first order of sixteen steps."""
    rng = np.random.default_rng(4)
    body, s = uneven(rng), shaken(rng)
    y = state(rng, body)
    y[2] += 2.0
    y[10:13] = 0.0
    before, t = y.copy(), DT - TAU
    s.rests = s.jammed = s.goes_on = 1
    lost = stepping.pass_interval(body, TAU, DT, y, s)
    first, last = gravity_at(s, TAU), gravity_at(s, DT)
    assert y[7:10] == pytest.approx(before[7:10] + t * (first + last) / 2, abs=1e-9)
    place = before[:3] + t * before[7:10] + t * t * (2 * first + last) / 6
    # h t g / 2
    h = 2 * np.abs(y[:3] - place).max() / (t * np.abs(first + last).max() / 2)
    assert DT / 24 < h < DT / 16
    assert (s.count, s.rests, s.jammed, s.goes_on) == (0, 0, 0, 0)
    gained = solid.energy(body, y, G) - solid.energy(body, before, G)
    assert lost == pytest.approx(y[13] - before[13] - gained, abs=1e-12)


def test_what_is_near_and_parts_is_left_where_it_is():
    rng, h = np.random.default_rng(8), 6e-4
    body, y, s = beside_a_wall(rng)
    y[7:13] *= 0
    y[7:10] = 0.1 * np.array([*body.away[0], 1.0])
    before = y.copy()
    n = stepping.take_step(body, TAU, h, y, s)
    assert n > 1
    assert not s.shove[:n].any()
    assert y[7:10] == pytest.approx(before[7:10] + h * gravity_at(s, TAU + h / 2))
    assert y[:3] == pytest.approx(before[:3] + h * y[7:10], abs=1e-15)
    assert y[3:7] == pytest.approx(before[3:7], abs=1e-15)


@pytest.mark.parametrize(("seed", "tau"), [(5, TAU), (6, 0.6 * DT), (6, 0.94 * DT)])
def test_an_interval_with_contacts_loses_what_the_balance_says_and_gains_nothing(
    seed, tau
):
    """In one step a contact goes on to close at its gap over the step, and is stopped by the mode that follows."""
    rng = np.random.default_rng(seed)
    body, y, s = beside_a_wall(rng)
    before = y.copy()
    s.jammed = 1
    lost = stepping.pass_interval(body, tau, DT, y, s)
    gained = solid.energy(body, y, G) - solid.energy(body, before, G)
    assert lost == pytest.approx(y[13] - before[13] - gained, abs=1e-12)
    assert lost >= -1e-15
    assert s.impact[0] > 0
    # it goes on in a mode that holds: nothing that is closed moves away from its surface or into it
    rows = rotation(y)
    for i in s.closed[: s.count]:
        assert solid.gap_of(body, y, rows, i) == pytest.approx(0, abs=1e-7)
        assert solid.approach_of(body, y, rows, i) == pytest.approx(0, abs=1e-9)


def test_energy_that_was_gained_is_taken_from_the_velocities():
    rng = np.random.default_rng(7)
    body, s = uneven(rng), shaken(rng)
    y = state(rng, body)
    had = solid.energy(body, y, G) - y[13]
    velocities = y[7:13].copy()
    assert stepping.loss_since(body, had - 0.01, y, s) == pytest.approx(0.0, abs=1e-12)
    assert y[7:13] / velocities == pytest.approx(np.full(6, y[7] / velocities[0]))
    left = solid.energy(body, y, G) - y[13]
    assert left == pytest.approx(had - 0.01, abs=1e-12)
    assert stepping.loss_since(body, left + 0.02, y, s) == pytest.approx(0.02)
