"""What the kernels say of a body in one state, beside Newton's and Euler's equations in matrices of numpy.

Kernels are called one by one, as plain Python.
"""

import math

import numpy as np
import pytest

from .plain_space import (
    OUTLINE,
    Circle,
    Contact,
    G,
    RigidBody,
    System,
    Tie,
    Wall,
    attitude,
    case,
    cone,
    contacts,
    delassus,
    engine,
    events,
    face,
    forces,
    gaps,
    inverse_mass,
    jacobian,
    kernel_body,
    leaning,
    limits,
    memory,
    mode,
    outcome,
    plain,
    point,
    points,
    problem,
    rest,
    rotation,
    set_down,
    solid,
    state,
    step,
    stick,
    ties,
    uneven,
    whole,
)


def test_points_are_where_and_as_fast_as_the_attitude_says():
    rng = np.random.default_rng(1)
    for _ in range(5):
        body = uneven(rng)
        y = state(rng, body)
        rows = rotation(y)
        assert np.array(rows) == pytest.approx(attitude(y), abs=1e-14)
        for i in range(body.count):
            p = point(body, i)
            here = y[:3] + attitude(y) @ p
            u = jacobian(y, p) @ y[7:13]
            assert solid.gap(body, y, rows[2], i) == pytest.approx(here[2], abs=1e-14)
            assert solid.position_of_base(y, rows, tuple(p)) == pytest.approx(here[:2])
            assert solid.velocity_of(body, y, rows, i) == pytest.approx(u, abs=1e-14)


def test_energy_is_that_of_centre_and_spin():
    rng = np.random.default_rng(2)
    body = uneven(rng)
    y = state(rng, body)
    expected = 0.5 * (y[7:10] @ y[7:10] + y[10:13] @ body.inertia @ y[10:13])
    assert solid.kinetic_energy(body, y) == pytest.approx(expected, rel=1e-14)
    expected += G * (y[2] - body.height)
    assert solid.energy(body, y, G) == pytest.approx(expected, rel=1e-13)


def test_compliances_and_velocities_of_contacts_are_those_of_their_jacobian():
    rng = np.random.default_rng(3)
    body, s = uneven(rng), memory()
    y = state(rng, body)
    rows, which = rotation(y), [4, 1, 2]
    rows_of = np.vstack([jacobian(y, point(body, i)) for i in which])
    for k, i in enumerate(which):
        s.which[k] = s.closed[k] = i
    delassus.fill_delassus(body, rows, s.which, 3, s.delassus)
    compliance = rows_of @ inverse_mass(body) @ rows_of.T
    assert s.delassus[:9, :9] == pytest.approx(compliance, abs=1e-12)
    delassus.fill_velocities(body, y, rows, s.which, 3, s.free)
    assert s.free[:9] == pytest.approx(rows_of @ y[7:13], abs=1e-13)
    s.impulse[:9] = rng.normal(0, 1, 9)
    cone.fill_after(s, 3)
    expected = s.free[:9] + compliance @ s.impulse[:9]
    assert s.after[:9] == pytest.approx(expected, abs=1e-12)
    before = rows_of @ y[7:13]
    for k, i in enumerate(which):
        delassus.push_at(body, y, rows, i, tuple(s.impulse[3 * k : 3 * k + 3]))
    assert rows_of @ y[7:13] - before == pytest.approx(expected - before, abs=1e-12)
    largest = delassus.largest_compliance(s, 3)
    assert largest == pytest.approx(np.diag(compliance).max())


def test_an_edge_of_contacts_has_the_direction_from_one_to_the_other():
    rng = np.random.default_rng(4)
    body, s = uneven(rng), memory()
    y = state(rng, body)
    which = [5, 0, 3]
    problem.fill_edges(body, y, rotation(y), which, 3, s)
    for i, first in enumerate(which):
        for j, second in enumerate(which):
            way = attitude(y) @ (point(body, second) - point(body, first))
            length = np.hypot(way[0], way[1])
            if first != second:
                assert s.edge[i, j] == pytest.approx(way[:2] / length, abs=1e-13)


def test_of_six_points_that_touch_the_four_that_approach_fastest_are_looked_at():
    rng = np.random.default_rng(5)
    for _ in range(20):
        body, s = uneven(rng), memory()
        y = state(rng, body)
        set_down(y, body)
        rows = rotation(y)
        assert points.touching(body, y, rows, s) == 4
        speeds = [(jacobian(y, point(body, i)) @ y[7:13])[2] for i in range(6)]
        assert sorted(s.which) == sorted(np.argsort(speeds)[:4])
        assert points.count_touching(body, y, rows) == 6
        y[2] += 1e-3
        assert points.touching(body, y, rows, s) == 0
        # of those that are as fast as each other the first
        n = 0
        for i in range(6):
            n = points.keep_fastest(i, -1.0, n, s)
        assert (n, s.which.tolist()) == (4, [0, 1, 2, 3])


def test_slips_before_an_impact_have_their_direction():
    body, s = uneven(np.random.default_rng(6)), memory()
    s.which[:2] = 0, 1
    s.free[:6] = 3.0, -4.0, -1.0, 1e-6, 1e-6, -1.0
    problem.note_slips(body, 2, s)
    assert (s.slid[0], s.slid[1]) == (1, 0)
    assert s.came[0] == pytest.approx([0.6, -0.8])
    assert (s.friction[0], s.holds[0], s.given[0]) == (0.3, 0.5, 0)


def test_the_margin_of_pressure_is_its_distance_from_the_nearest_edge():
    rng = np.random.default_rng(7)
    body, s = uneven(rng), memory()
    s.count, corners = 4, np.array(OUTLINE) - (0.03, -0.02)
    s.closed[:4] = 0, 2, 3, 5
    signs = set()
    for _ in range(40):
        pressed = rng.normal(0.25, 0.6, 4)
        pressed += (1 - pressed.sum()) / 4
        s.lam[:, 2] = pressed
        x = pressed @ corners[[0, 2, 3, 5]]
        assert face.pressure_centre(body, s) == pytest.approx(x, abs=1e-12)
        along = np.roll(corners, -1, axis=0) - corners
        inward = np.stack([-along[:, 1], along[:, 0]], axis=1)
        inward /= np.linalg.norm(inward, axis=1)[:, None]
        expected = ((x - corners) * inward).sum(axis=1).min()
        found = face.pressure_margin(body, s)
        assert found == pytest.approx(expected, abs=1e-12)
        signs.add(found > 0)
    assert signs == {True, False}


def test_rest_is_kept_while_the_line_of_thrust_meets_the_base():
    rng = np.random.default_rng(8)
    body, s = uneven(rng), memory()
    y = np.zeros(solid.SIZE)
    y[3] = 1.0
    set_down(y, body)
    corners = np.array(OUTLINE) - (0.03, -0.02)
    kept = set()
    for _ in range(60):
        pull = np.array([*rng.uniform(-6, 6, 2), -G - rng.uniform(-2, 2)])
        q = -body.height * pull[:2] / pull[2]
        along = np.roll(corners, -1, axis=0) - corners
        side = along[:, 0] * (q - corners)[:, 1] - along[:, 1] * (q - corners)[:, 0]
        stands = (side > 0).all() and np.hypot(*pull[:2]) < -0.5 * pull[2]
        assert (rest.rest_margin(body, y, rotation(y), pull, s) > 0) == stands
        kept.add(bool(stands))
    assert kept == {True, False}


@pytest.mark.parametrize("closed", [(), (2,), (3, 4)])
def test_what_sticks_has_the_accelerations_of_lagranges_equations(closed):
    """M a = f + Jᵀ F with J a + J̇ u = 0 where the mode is closed."""
    rng = np.random.default_rng(9)
    body, s = uneven(rng), memory()
    s.field[:6] = rng.normal(0, 2, 6)
    s.field[2] -= G
    y = state(rng, body)
    mode(s, *closed)
    if closed:
        contacts.anchor_all(body, y, s)
        gaps.settle(body, y, s)
    r, omega, tau = attitude(y), y[10:13], 0.03
    pull = s.field[:3] + tau * s.field[3:6]
    rows = np.vstack([np.zeros((0, 6))] + [jacobian(y, point(body, i)) for i in closed])
    bias = [r @ np.cross(omega, np.cross(omega, point(body, i))) for i in closed]
    free = inverse_mass(body) @ np.hstack(
        [pull, -np.cross(omega, body.inertia @ omega)]
    )
    push = np.zeros(0)
    if closed:
        needed = -(rows @ free + np.hstack(bias))
        compliance = rows @ inverse_mass(body) @ rows.T
        push = np.linalg.lstsq(compliance, needed, rcond=1e-10)[0]
    rates = np.zeros(solid.SIZE)
    forces.rates(body, tau, y, rates, s)
    expected = free + inverse_mass(body) @ rows.T @ push
    assert rates[7:13] == pytest.approx(expected, abs=1e-9)
    assert rates[:3] == pytest.approx(y[7:10])
    work = pull @ y[7:10] + G * y[9]
    assert rates[solid.WORK] == pytest.approx(work, rel=1e-12)
    told = s.lam[: len(closed)].sum(axis=0)
    assert told == pytest.approx(push.reshape(-1, 3).sum(axis=0), abs=1e-9)
    # the quaternion's rate keeps its length and turns as the body does
    assert rates[3:7] @ y[3:7] == pytest.approx(0, abs=1e-13)
    h = 1e-6
    later = y + h * rates
    turned = (attitude(later) - r) / h
    spin = np.cross(np.eye(3), omega)
    assert turned == pytest.approx(r @ spin, abs=1e-4)


def test_what_slides_is_rubbed_against_its_slip():
    rng = np.random.default_rng(10)
    body, s = uneven(rng), memory()
    for closed in ((1,), (1, 2)):
        y = state(rng, body)
        y[7:10] *= 4
        mode(s, *closed, slides=case.SLIDES)
        gaps.close_gaps(body, y, rotation(y), s)
        contacts.hold(body, y, rotation(y), s)
        rates = np.zeros(solid.SIZE)
        forces.rates(body, 0.0, y, rates, s)
        lost = 0.0
        for k, i in enumerate(closed):
            u = jacobian(y, point(body, i)) @ y[7:13]
            assert u[2] == pytest.approx(0, abs=1e-9)
            normal = s.lam[k, 2]
            against = -0.3 * normal * u[:2] / np.hypot(u[0], u[1])
            assert s.lam[k, :2] == pytest.approx(against, abs=1e-9)
            lost -= against @ u[:2]
        assert rates[solid.FRICTION] == pytest.approx(lost, rel=1e-9)
        # the normal acceleration of a closed point is none
        r, omega = attitude(y), y[10:13]
        for i in closed:
            p = point(body, i)
            a = jacobian(y, p) @ rates[7:13] + r @ np.cross(omega, np.cross(omega, p))
            assert a[2] == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("which", [(2,), (2, 3)])
def test_an_impact_that_sticks_stops_its_points_by_the_least_momentum(which):
    rng = np.random.default_rng(11)
    body, s = uneven(rng), memory()
    body.static = body.kinetic = 20.0
    y = state(rng, body)
    rows = rotation(y)
    before = y.copy()
    mode(s, *which)
    contacts.hold(body, y, rows, s)
    rows_of = np.vstack([jacobian(y, point(body, i)) for i in which])
    compliance = rows_of @ inverse_mass(body) @ rows_of.T
    push = np.linalg.lstsq(compliance, -rows_of @ before[7:13], rcond=1e-10)[0]
    expected = before[7:13] + inverse_mass(body) @ rows_of.T @ push
    assert y[7:13] == pytest.approx(expected, abs=1e-10)
    n = len(which)
    s.which[:n] = which
    momentum = stick.fill_velocities(body, before, rows, n, s)
    assert s.free[: 3 * n] == pytest.approx(rows_of @ before[7:13], abs=1e-12)
    assert momentum == pytest.approx(body.inertia @ before[10:13])


def test_accelerations_of_points_are_those_without_contact():
    rng = np.random.default_rng(12)
    body, s = uneven(rng), memory()
    y = state(rng, body)
    r, omega = attitude(y), y[10:13]
    weight = r.T @ np.array([0.5, -1.0, -G])
    s.which[:2] = 1, 4
    stick.fill_accelerations(body, y, rotation(y), tuple(weight), 2, s)
    spin = -np.linalg.solve(body.inertia, np.cross(omega, body.inertia @ omega))
    for k, i in enumerate((1, 4)):
        p = point(body, i)
        a = weight + np.cross(spin, p) + np.cross(omega, np.cross(omega, p))
        assert s.free[3 * k : 3 * k + 3] == pytest.approx(r @ a, abs=1e-12)


def test_a_wall_is_met_by_the_nearest_corner_at_the_speed_towards_it():
    rng = np.random.default_rng(13)
    body, s = uneven(rng, Wall(2.5, 0.7)), memory()
    y = state(rng, body)
    y[2] += 1.0
    r, rows = attitude(y), rotation(y)
    away = -np.array([math.cos(0.7), math.sin(0.7), 0.0])
    for k in range(body.corners):
        i = solid.WALLS + k
        p = np.array(body.corner[k])
        # the wall's distance counts from the origin of the base, which is not below the centre of mass
        gap = 2.5 + away[:2] @ (y[:2] + (r @ p)[:2] + (0.03, -0.02))
        u = jacobian(y, p) @ y[7:13]
        assert solid.may_meet(body, i)
        assert solid.gap_of(body, y, rows, i) == pytest.approx(gap, abs=1e-12)
        assert solid.approach_of(body, y, rows, i) == pytest.approx(away @ u)
        back = solid.from_frame(body, i, solid.in_frame(body, i, tuple(u)))
        assert back == pytest.approx(u)
    assert not solid.may_meet(body, solid.WALLS + body.corners)
    least, what = step.margin(body, y, s)
    gaps = [
        solid.gap_of(body, y, rows, i)
        for i in [*range(6), *(solid.WALLS + k for k in range(body.corners))]
    ]
    assert least == pytest.approx(min(gaps), abs=1e-9)
    assert what == limits.LANDS


def test_a_tie_pulls_from_its_knot_to_its_anchor_by_stretch_and_rate():
    rng = np.random.default_rng(14)
    tie = Tie((0.1, 0.0, 1.0), (1.0, 0.2, 1.1), 5e3, damping=40.0, slack=0.01)
    body, s = uneven(rng, tie), memory()
    for _ in range(6):
        y = state(rng, body)
        r, knot = attitude(y), np.array(body.knot[0])
        at = y[:3] + r @ knot
        there = np.array(body.anchor[0])
        length = np.linalg.norm(there - at)
        way = (there - at) / length
        rate = -way @ (jacobian(y, knot) @ y[7:13])
        natural = math.dist((0.1, 0.0, 1.0), (1.0, 0.2, 1.1)) + 0.01
        size = 5e3 * (length - natural) + 40.0 * rate if length > natural else 0.0
        pull = max(size, 0.0) * way
        ties.fill_tie_forces(body, y, rotation(y), s)
        assert r @ s.pulled == pytest.approx(pull, abs=1e-9)
        assert s.twisted == pytest.approx(np.cross(knot, r.T @ pull), abs=1e-9)
        margin = ties.tie_margin(body, length, rate, 0)
        stretch = length - natural
        assert margin == pytest.approx(min(stretch, stretch + 40.0 * rate / 5e3))


@pytest.mark.parametrize("bracket", [False, True])
def test_a_tie_is_beyond_its_other_state_exactly_where_it_bears_something(bracket):
    """Its margin is positive where its force, by stretch and rate, is none."""
    rng, told = np.random.default_rng(24), set()
    tie = Tie(
        (0.1, 0.0, 1.0),
        (1.0, 0.2, 1.1),
        500.0,
        damping=8.0,
        slack=0.02,
        bracket=bracket,
    )
    body = uneven(rng, tie)
    for _ in range(200):
        length = body.natural[0] + rng.uniform(-0.1, 0.05)
        rate = rng.normal(0, 3.0)
        force = ties.tie_force(body, length, rate, 0)
        assert (ties.tie_margin(body, length, rate, 0) > 0) == (force != 0)
        told.add(int(np.sign(force)))
    assert told == ({-1, 0, 1} if bracket else {0, 1})


def test_contacts_that_may_be_are_those_of_the_ground_and_of_each_corner_with_each_wall():
    rng, walls = np.random.default_rng(25), (Wall(2.0, 0.3), Wall(3.0, 2.0))
    tensor = np.diag([0.2, 0.2, 0.1])
    made = RigidBody(1.0, tensor, (0.0, 0.0, 0.4), Circle(0.2), 0.8)
    drum = plain(kernel_body(System((made,), (Contact(),))))
    for body, ground, there in (
        (uneven(rng), [*range(6)], 0),
        (uneven(rng, *walls), [*range(6)], 2),
        (drum, [drum.count], 0),
    ):
        assert [*solid.candidates(body)] == ground
        found = [solid.meeting(body, k) for k in range(solid.meetings(body))]
        corners = [
            solid.WALLS + wall * solid.MOST_CORNERS + corner
            for wall in range(there)
            for corner in range(body.corners)
        ]
        assert found == ground + corners


def test_a_body_slides_if_any_of_its_contacts_does():
    s = memory()
    for slides in ((), (0,), (1,), (0, 1), (1, 0), (0, 0, 1)):
        mode(s, *range(len(slides)))
        s.slides[: len(slides)] = slides
        assert events.slides_any(s) == any(slides)


def test_what_holds_a_body_is_followed_as_long_as_it_moves():
    """Energy of motion over that of overturning, of a body that something holds."""
    rng = np.random.default_rng(26)
    body, free = uneven(rng, Wall(2.0, 0.0)), uneven(rng)
    y = np.zeros(solid.SIZE)
    y[3], y[7] = 1.0, math.sqrt(2 * 1e-4 * body.barrier)
    for cut, hardly in ((0.9e-4, False), (1.1e-4, True)):
        assert whole.hardly_moves(body, y, cut) == hardly
        assert not whole.hardly_moves(free, y, cut)


def test_a_body_is_beyond_its_balance_where_its_centre_leaves_the_base():
    body = uneven(np.random.default_rng(15))
    corners = np.array(OUTLINE) - (0.03, -0.02)
    for towards in np.linspace(0, 2 * math.pi, 13):
        u = np.array([math.cos(towards), math.sin(towards)])
        critical = math.atan2((corners @ u).max(), body.height)
        for part in (0.99, 1.01):
            y = leaning(body, part * critical, towards)
            assert outcome.is_beyond(body, y) == (part > 1)
            assert outcome.stands_within_balance(body, rotation(y)) == (part < 1)
            out = np.zeros(outcome.OUTCOME)
            outcome.note_peaks(body, y, attitude(y), out)
            assert out[outcome.PEAK_RATIO] == pytest.approx(part)
            assert out[outcome.PEAK_TILT] == pytest.approx(part * critical)


def test_a_fall_is_certain_only_beyond_all_that_the_ground_may_still_do():
    """Beyond the furthest point the moment of gravity rights nothing; the ground's pull must not either."""
    body = uneven(np.random.default_rng(16))
    furthest = max(np.hypot(*(np.array(c) - (0.03, -0.02))) for c in OUTLINE)
    balance = math.atan2(furthest, body.height)
    steepest = math.atan2(2.0, G - 1.0)
    for part, falls in ((-0.01, False), (0.01, True)):
        y = leaning(body, balance + steepest + part, 0.0)
        y[11] = 0.1
        peaks, rows = np.array([2.0, 1.0]), attitude(y)
        assert outcome.fall_is_certain(body, y, rows, peaks, 1.0, G) == falls
        assert not outcome.fall_is_certain(body, y, rows, peaks, 1.2, G)
        y[11] = -0.1
        assert not outcome.fall_is_certain(body, y, rows, peaks, 1.0, G)


def test_a_fall_is_over_contacts_with_the_ground():
    """A corner that touches a wall is closed too, and is no vertex of the base."""
    y, s, out = np.zeros(solid.SIZE), memory(), np.zeros(outcome.OUTCOME)
    y[3] = 1.0
    wall = solid.WALLS + 1
    for closed, expected in (
        ((), (-1, -1)),
        ((2,), (2, -1)),
        ((2, 3), (2, 3)),
        ((wall, 2), (2, -1)),
        ((1, wall, 2), (1, 2)),
    ):
        mode(s, *closed)
        outcome.note_fall(y, s, 1.0, out)
        assert (out[outcome.FALL_FIRST], out[outcome.FALL_SECOND]) == expected


def test_turns_about_the_vertical_are_counted_whole():
    y, out, turn = np.zeros(solid.SIZE), np.zeros(outcome.OUTCOME), 0.0
    before = (1.0, 0.0)
    for turn in np.linspace(0, 9.0, 50):
        y[3], y[6] = math.cos(turn / 2), math.sin(turn / 2)
        before = outcome.note_turn(y, before, out)
        since = outcome.turn_since(before, y)
        assert out[outcome.TURN] + since == pytest.approx(turn)
        assert abs(since) < 1.2


def test_a_round_body_touches_at_its_lowest_point_which_goes_round_as_the_axis_does():
    across = (3 * 0.2**2 + 0.8**2) / 12
    tensor = np.diag([across, across, 0.02])
    drum = RigidBody(1.0, tensor, (0.0, 0.0, 0.4), Circle(0.2), 0.8)
    body = plain(kernel_body(System((drum,), (Contact(),))))
    rng = np.random.default_rng(17)
    y = state(rng, body)
    r, omega = attitude(y), y[10:13]
    angles = np.linspace(0, 2 * math.pi, 20001)
    rim = np.stack([0.2 * np.cos(angles), 0.2 * np.sin(angles), 0 * angles - 0.4])
    heights = y[2] + r[2] @ rim
    lowest = solid.arm(body, tuple(r[2]), body.count)
    assert solid.gap(body, y, tuple(r[2]), body.count) == pytest.approx(heights.min())
    assert lowest == pytest.approx(rim[:, heights.argmin()], abs=1e-4)
    # ω × (velocity of the point over the ground's), from the rate of the lowest point in the body
    h = 1e-6
    up = r[2] + h * np.cross(r[2], omega)
    moved = (np.array(solid.arm(body, tuple(up), body.count)) - lowest) / h
    expected = np.cross(omega, np.cross(omega, lowest) + moved)
    found = solid.bias(body, tuple(r[2]), tuple(omega), lowest, body.count)
    assert found == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize(
    ("closed", "said"),
    [
        ((2,), "vertex 3"),
        ((2, 1), "edge 2-3"),
        ((solid.WALLS + 7,), "flight"),
        ((1, solid.WALLS + 7), "vertex 2"),
        ((solid.WALLS + 7, 0, solid.WALLS + 6, 1), "edge 1-2"),
        ((), "flight"),
    ],
)
def test_a_body_falls_over_what_is_on_the_ground_whatever_wall_it_touches(closed, said):
    """Corners at walls have numbers from 1000 on: a body fell over "vertex 1008"."""
    body, s, out = uneven(np.random.default_rng(3)), memory(), np.zeros(outcome.OUTCOME)
    s.count = len(closed)
    s.closed[: s.count] = closed
    outcome.note_fall(state(np.random.default_rng(4), body), s, 1.0, out)
    assert engine._named(body, out) == said
