"""Steps of a body in space beside SciPy's, and its impulses beside the conditions of contact that define them.

Kernels are called one by one, as plain Python.
"""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import RK45, solve_ivp

from ...mutants.plain import plain_library
from .plain_space import (
    Circle,
    Contact,
    G,
    RigidBody,
    System,
    Wall,
    attitude,
    case,
    contacts,
    delassus,
    forces,
    gaps,
    inverse_mass,
    jacobian,
    kernel_body,
    leaning,
    limits,
    memory,
    mode,
    modes,
    plain,
    point,
    points,
    problem,
    rest,
    rotation,
    set_down,
    shaken,
    solid,
    state,
    step,
    stick,
    uneven,
    whole,
)
from .plain_space import cone as cones

with plain_library():
    from rockfrag.engines.algebra import vectors as algebra
    from rockfrag.engines.spatial import _relax as relax

MODES = {
    "flight": ((), ()),
    "pivot": ((2,), (0,)),
    "slider": ((1,), (1,)),
    "hinge": ((3, 4), (0, 0)),
    "edge that slides at one end": ((3, 4), (0, 1)),
    "edge that slides": ((1, 2), (1, 1)),
    "face that slides": ((0, 2, 3, 5), (1, 1, 1, 1)),
}


def in_mode(rng, name):
    """A body in a mode, in a state that obeys it, on ground that moves."""
    closed, slides = MODES[name]
    body, s = uneven(rng), shaken(rng)
    y = state(rng, body)
    y[7:10] *= 3
    mode(s, *closed)
    s.slides[: len(closed)] = slides
    if closed:
        gaps.close_gaps(body, y, rotation(y), s)
        contacts.hold(body, y, rotation(y), s)
        contacts.anchor_all(body, y, s)
        gaps.settle(body, y, s)
    return body, y, s


@pytest.mark.parametrize("name", MODES)
def test_a_step_goes_where_the_equations_of_motion_lead(name):
    rng, tau, h = np.random.default_rng(1), 0.02, 2e-3
    for _ in range(2):
        body, y, s = in_mode(rng, name)

        def motion(time, y, body=body, s=s):
            slope = np.zeros(solid.SIZE)
            forces.rates(body, tau + time, y, slope, s)
            return slope

        exact = solve_ivp(motion, (0, h), y, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
        at_end = motion(h, exact)
        pushed = s.lam.copy()
        s.slopes[:], s.lam[:] = 0.0, 0.0
        step.begin(body, tau, y, s)
        error = step.attempt(body, tau, h, y, s)
        assert s.new == pytest.approx(exact, abs=1e-9)
        assert 0.0 < error < 1e-6
        n = s.count
        assert s.lam[:n] == pytest.approx(pushed[:n], abs=1e-5)
        # a body that is pushed so moves so
        assert at_end[7:10] == pytest.approx(
            s.field[:3] + (tau + h) * s.field[3:6] + s.lam[:n].sum(axis=0), abs=1e-5
        )
        gained = solid.energy(body, s.new, G) - solid.energy(body, y, G)
        work, rubbed = s.new[13:15] - y[13:15]
        assert gained == pytest.approx(work - rubbed, abs=1e-9)


def test_the_error_of_a_step_is_the_largest_part_of_the_pairs_difference():
    rng, h = np.random.default_rng(2), 5e-3
    body, y, s = in_mode(rng, "slider")
    step.begin(body, 0.0, y, s)
    error = step.attempt(body, 0.0, h, y, s)
    off = np.abs(h * (RK45.E @ s.slopes))[:13]
    scale = 1 + np.abs(y[:13])
    up = attitude(y)[2]
    # the attitude counts by as much as the body leans
    scale[3:7] = min(1.0, 1e3 * math.hypot(up[0], up[1]) + 1e-4)
    assert error == pytest.approx((off / scale).max(), rel=1e-9)


@pytest.mark.parametrize("place", range(13))
def test_each_component_has_its_part_in_the_error_of_a_step(place):
    """Over its size, places and velocities beside one; the attitude of a rim over how far it leans."""
    rng, h = np.random.default_rng(63), 5e-3
    disc = RigidBody(1.0, np.diag([0.1, 0.1, 0.02]), (0.0, 0.0, 0.4), Circle(0.2), 0.8)
    rim = plain(kernel_body(System((disc,), (Contact(),))))
    for body, leans in ((uneven(rng), 1.0), (rim, 1e3 * 1e-4 + 1e-4)):
        s, y = memory(), leaning(body, 1e-4, 0.4)
        y[:3], y[7:13] = rng.normal(0, 3, 3), rng.normal(0, 3, 6)
        s.slopes[:, place] = rng.normal(size=7)
        off = abs(h * (RK45.E @ s.slopes[:, place]))
        size = leans if 3 <= place < 7 else 1.0 + abs(y[place])
        assert step.error_of(body, h, y, s) == pytest.approx(off / size, rel=1e-3)


def test_edges_lie_between_contacts_of_one_surface():
    """Along the ground or one wall; between two surfaces there is none to split an impulse along."""
    rng = np.random.default_rng(64)
    body = uneven(rng, Wall(2.5, 0.0), Wall(2.5, 1.9))
    s, y = memory(), state(rng, body)
    first = [i for i in solid.wall_candidates(body) if solid.may_meet(body, i)]
    of_wall = [[i for i in first if solid.wall_of(i) == w] for w in (0, 1)]
    which = (1, 4, *of_wall[0][:1], of_wall[0][3], *of_wall[1][:1])
    which = (which[0], *which[2:])
    r = attitude(y)

    def place(i):
        return point(body, i) if i < 6 else np.array(solid.arm(body, rotation(y)[2], i))

    for chosen in (which, (1, 4, 0)):
        s.which[: len(chosen)] = chosen
        s.edge[:] = 7.0
        problem.fill_edges(body, y, rotation(y), s.which, len(chosen), s)
        for a, b in itertools.permutations(range(len(chosen)), 2):
            i, j = chosen[a], chosen[b]
            way = r @ (place(j) - place(i))
            found = np.array(s.edge[a, b])
            if i < 6 and j < 6:
                expected = way[:2] / np.hypot(*way[:2])
            elif min(i, j) >= 6 and solid.wall_of(i) == solid.wall_of(j):
                along = np.array(solid.in_frame(body, i, tuple(way)))[:2]
                assert np.linalg.norm(along) <= np.linalg.norm(way)
                expected = along / np.hypot(*along)
            else:
                expected = (0.0, 0.0)
            assert found == pytest.approx(expected)


def test_both_ends_of_an_edge_bear_the_same_part_of_what_they_could_along_it():
    rng = np.random.default_rng(3)
    uneven_ends = 0
    for _ in range(10):
        body, y, s = in_mode(rng, "hinge")
        body.static = 3.0
        forces.rates(body, 0.0, y, np.zeros(solid.SIZE), s)
        r = attitude(y)
        edge = r @ (point(body, 4) - point(body, 3))
        edge /= np.linalg.norm(edge)
        parts = []
        for push in s.lam[:2]:
            along = push @ edge
            across = push - along * edge
            room = (3.0 * across[2]) ** 2 - across[0] ** 2 - across[1] ** 2
            parts.append((along, math.sqrt(max(room, 0.0))))
        (first, room_first), (second, room_second) = parts
        assert first * room_second == pytest.approx(second * room_first, abs=1e-9)
        uneven_ends += abs(room_first - room_second) > 0.2 * (room_first + room_second)
        # Euler's equation about the centre
        turned = sum(
            np.cross(point(body, i), r.T @ s.lam[k]) for k, i in enumerate((3, 4))
        )
        spin = y[10:13]
        rates = np.zeros(solid.SIZE)
        forces.rates(body, 0.0, y, rates, s)
        expected = body.inertia @ rates[10:13] + np.cross(spin, body.inertia @ spin)
        assert turned == pytest.approx(expected, abs=1e-9)
    assert uneven_ends > 2


def struck(rng, touch, mu):
    """A body some of whose points touch and approach, with its small system of contacts."""
    body, s = uneven(rng), memory()
    body.static = body.kinetic = mu
    y = state(rng, body)
    if len(touch) > 2:
        set_down(y, body)
    y[9] = -abs(y[9]) - 0.2
    s.which[: len(touch)] = touch
    rows = rotation(y)
    momentum = stick.fill_velocities(body, y, rows, len(touch), s)
    problem.note_slips(body, len(touch), s)
    return body, y, rows, momentum, s


@pytest.mark.parametrize("touch", [(2,), (1, 2), (0, 3), (0, 2, 4), (0, 1, 3, 4)])
def test_impulses_obey_the_conditions_of_contact_with_coulombs_cone(touch):
    rng, n, kinds, missing = np.random.default_rng(4), len(touch), set(), 0
    for _ in range((30, 30, 12, 4)[n - 1]):
        mu = rng.uniform(0.05, 1.2)
        body, y, rows, momentum, s = struck(rng, touch, mu)
        found, solutions = problem.solve(body, y, rows, n, 0, momentum, s)
        if found < 0:
            missing += 1
            continue
        j = np.vstack([jacobian(y, point(body, i)) for i in touch])
        push = np.array(s.impulse[: 3 * n])
        u = j @ (y[7:13] + inverse_mass(body) @ j.T @ push)
        assert s.after[: 3 * n] == pytest.approx(u, abs=1e-8)
        before = j @ y[7:13]
        if (before[2::3] >= 0).all():
            assert not push.any()
            continue
        for k in range(n):
            normal, shear = push[3 * k + 2], push[3 * k : 3 * k + 2]
            apart, slip = u[3 * k + 2], u[3 * k : 3 * k + 2]
            assert normal > -1e-9 and apart > -1e-8
            assert abs(normal * apart) < 1e-8
            assert np.hypot(*shear) <= mu * normal + 1e-8
            if normal > 1e-6 and np.hypot(*slip) > 1e-6:
                assert shear == pytest.approx(
                    -mu * normal * slip / np.hypot(*slip), abs=1e-6
                )
                kinds.add("slides")
            elif normal > 1e-6:
                kinds.add("sticks")
            else:
                kinds.add("parts")
        assert solutions >= 1
        assert found == sum((push[3 * k + 2] > 0) << k for k in range(n)) or n > 2
        # nothing gains energy
        change = 0.5 * push @ (before + u)
        assert change <= 1e-12
        assert cones.change_of_energy(s, n) == pytest.approx(change, abs=1e-9)
    assert {"slides", "sticks"} <= kinds or n > 2
    assert kinds
    assert missing <= 2


@pytest.mark.parametrize("armed", [True, False])
def test_the_margin_of_a_face_that_slides_is_of_its_pressure_or_its_fastest_point(
    armed,
):
    """Friction acts nearer the centre than the points; slip that has not begun may only go forwards."""
    rng, seen = np.random.default_rng(60), set()
    for number in range(8):
        body, s, y = uneven(rng), shaken(rng), np.zeros(solid.SIZE)
        set_down_at = rng.uniform(0, 6)
        y[3], y[6] = math.cos(set_down_at / 2), math.sin(set_down_at / 2)
        y[2] = body.height
        y[7:9] = rng.normal(0, 0.003 if number % 2 else 0.3, 2)
        y[12] = 0.01 * rng.normal()
        closed = (0, 2, 3, 5)
        mode(s, *closed, slides=1)
        s.armed[:4], s.lam[:4, 2] = armed, rng.uniform(0.5, 3.0, 4)
        s.direction[:4] = (0.6, -0.8)
        s.slip[:4] = (0.6, -0.8)
        r = attitude(y)
        arms = np.array([point(body, i) for i in closed])
        arms[:, :2] *= delassus.twist_of(body, s)
        slips = np.array([jacobian(y, arm)[:2] @ y[7:13] for arm in arms])
        fastest, forwards = np.hypot(*slips.T).max(), (slips @ (0.6, -0.8)).max()
        slip = fastest - limits.AT_REST if armed else forwards + step.BACKWARD
        assert step.face_slip(body, y, rotation(y), s) == pytest.approx(slip)
        pressed = s.lam[:4, 2] @ arms[:, :2] / s.lam[:4, 2].sum()
        pressed /= delassus.twist_of(body, s)
        corners = np.array([point(body, i)[:2] for i in range(6)])
        edges = np.roll(corners, -1, axis=0) - corners
        normals = np.stack([-edges[:, 1], edges[:, 0]], axis=1)
        normals /= np.hypot(*edges.T)[:, None]
        inside = ((pressed - corners) * normals).sum(axis=1).min()
        found, what = step.margin(body, y, s)
        assert found == pytest.approx(min(inside, slip), abs=1e-6)
        assert what == (limits.OPENS if inside < slip else limits.SLIP_ENDS)
        assert r[2, 2] == pytest.approx(1.0)
        seen.add(what)
    assert seen == {limits.OPENS, limits.SLIP_ENDS} or not armed


def test_what_jams_is_stopped_and_sticks_where_it_is():
    rng = np.random.default_rng(61)
    for closed in ((2,), (1, 2), (0, 2, 4)):
        body, s = uneven(rng), memory()
        y = state(rng, body)
        if len(closed) > 2:
            set_down(y, body)
        mode(s, *closed, slides=1)
        contacts.jam(body, y, s)
        assert (s.jammed, s.count) == (1, len(closed))
        r = attitude(y)
        for k, i in enumerate(closed):
            assert s.slides[k] == case.STICKS
            assert jacobian(y, point(body, i)) @ y[7:13] == pytest.approx(0, abs=1e-8)
            assert s.anchor[k] == pytest.approx((y[:3] + r @ point(body, i))[:2])


def test_a_step_that_is_forced_goes_on_as_the_motion_is_and_is_counted():
    """In flight, by a parabola, at most to the end of the interval."""
    rng = np.random.default_rng(62)
    for left in (1.0, 0.3):
        body, s = uneven(rng), memory()
        y = state(rng, body)
        y[3:7] *= 1.001
        y[10:13] = 0.0
        before = y.copy()
        mode(s)
        h = min(whole.FORCED, left * whole.FORCED)
        after = whole.force_step(body, 0.5, 0.5 + left * whole.FORCED, y, s)
        assert after == pytest.approx(0.5 + h, abs=1e-15)
        fall = np.array([0.0, 0.0, -G])
        assert y[7:10] - before[7:10] == pytest.approx(h * fall, rel=1e-9)
        moved = h * before[7:10] + h * h / 2 * fall
        assert y[:3] - before[:3] == pytest.approx(moved, rel=1e-6)
        assert np.linalg.norm(y[3:7]) == pytest.approx(1.0, abs=1e-14)
        assert s.counters[limits.UNSOLVED] == 1


def small_system(rng, mu=0.4):
    """Three contacts of a body, one of which slips a given way, with trial impulses."""
    body, _, rows, _, s = struck(rng, (0, 2, 4), mu)
    delassus.fill_delassus(body, rows, s.which, 3, s.delassus)
    s.grip[:3] = rng.uniform(0.2, 0.9, 3)
    s.given[1], s.way[1] = 1, (0.6, -0.8)
    x = rng.normal(0, 1, 12)
    # some press and some do not
    x[2:9:3] = rng.choice([-0.5, 0.5, 1.0], 3)
    return s, x


def test_residuals_of_a_set_are_those_of_alart_and_curnier_and_slopes_their_derivative():
    """ϱ u_n, and P_t less its projection from P_t - ϱ u_t onto the disc of µ P_n; of what slips P_t + µ P_n d."""
    rng, kinds = np.random.default_rng(57), set()
    for mask in (0b111, 0b101, 0b110, 0b010, 0b001) * 4:
        s, x = small_system(rng)
        size, pace = cones.members(s, 3, mask), rng.uniform(0.5, 2.0)
        kept = [k for k in range(3) if mask >> k & 1]
        assert s.member[:size].tolist() == kept
        at = [3 * k + c for k in kept for c in range(3)]
        w, free = np.array(s.delassus)[np.ix_(at, at)], np.array(s.free)[at]

        def expected(x, at=at, w=w, free=free, s=s, kept=kept, pace=pace):
            u = free + w @ x[at]
            found = np.empty(len(at))
            for m, k in enumerate(kept):
                push, slip = x[3 * k : 3 * k + 3], u[3 * m : 3 * m + 3]
                found[3 * m + 2] = pace * slip[2]
                if s.given[k]:
                    found[3 * m : 3 * m + 2] = push[:2] + s.friction[k] * push[2] * (
                        np.array(s.way[k])
                    )
                    continue
                tried = push[:2] - pace * slip[:2]
                most = s.grip[k] * max(push[2], 0.0)
                length = np.hypot(*tried)
                kinds.add((length > most, push[2] > 0))
                found[3 * m : 3 * m + 2] = push[:2] - tried * min(1, most / length)
            return found

        out = np.zeros(12)
        worst = cones.residuals(s, size, x, pace, out)
        assert out[: 3 * size] == pytest.approx(expected(x))
        assert worst == pytest.approx(np.abs(expected(x)).max() / pace)
        cones.fill_slopes(s, size, x, pace)
        h = 1e-6
        for m, j in enumerate(at):
            aside = h * np.eye(12)[j]
            slope = (expected(x + aside) - expected(x - aside)) / (2 * h)
            found = np.array(s.matrix)[: 3 * size, m]
            assert found == pytest.approx(slope, abs=1e-6)
    assert len(kinds) == 3


def test_a_set_begins_with_each_contact_stopped_alone_and_sliding_the_way_it_came():
    """Or that way turned, or its given way; what is not in the set is left alone."""
    rng = np.random.default_rng(58)
    for turned in (0.0, math.pi / 2, 2.0):
        s, _ = small_system(rng)
        s.free[8] = 0.3
        s.impulse[:9] = 5.0
        cones.start_sliding(s, 3, 0b110, turned)
        assert not s.impulse[:3].any()
        assert not s.impulse[6:9].any()
        s.free[8] = -0.3
        cones.start_sliding(s, 3, 0b110, turned)
        c, sine = math.cos(turned), math.sin(turned)
        for k in (1, 2):
            came = np.array(s.free[3 * k : 3 * k + 3])
            normal = -came[2] / s.delassus[3 * k + 2, 3 * k + 2]
            way = np.array([[c, -sine], [sine, c]]) @ came[:2] / np.hypot(*came[:2])
            grip = s.grip[k]
            if s.given[k]:
                way, grip = np.array(s.way[k]), s.friction[k]
            expected = [*(-grip * normal * way), normal]
            assert s.impulse[3 * k : 3 * k + 3] == pytest.approx(expected)


def test_newtons_method_ends_where_residuals_vanish_or_are_good_enough(monkeypatch):
    rng, solved = np.random.default_rng(59), 0
    for _ in range(8):
        s, _ = small_system(rng)
        size, pace = cones.members(s, 3, 0b101), 0.7
        cones.start_sliding(s, 3, 0b101, 0.0)
        start, out = np.array(s.impulse), np.zeros(12)
        if cones.newton(s, size, pace, 1e-12):
            solved += 1
            assert cones.residuals(s, size, s.impulse, pace, out) <= 1e-12 * 100
        # out of steps: what is left may be some times as large
        s.impulse[:] = start
        worst = cones.residuals(s, size, s.impulse, pace, out)
        with monkeypatch.context() as patch:
            patch.setattr(cones, "NEWTON_STEPS", 0)
            assert cones.newton(s, size, pace, worst / 90)
            assert not cones.newton(s, size, pace, worst / 110)
            assert (s.impulse == start).all()
    assert solved > 4


def test_of_outcomes_of_one_size_the_one_with_the_least_energy_is_taken():
    """A body that falls flat: one contact of four does, and several are tried."""
    rng, several = np.random.default_rng(56), 0
    for _ in range(5):
        body, y, rows, momentum, s = struck(rng, (0, 1, 3, 4), 20.0)
        found, solutions = problem.solve(body, y, rows, 4, 0, momentum, s)
        assert found >= 0
        if solutions < 2:
            continue
        several += 1
        size = bin(found).count("1")
        j = np.vstack([jacobian(y, point(body, i)) for i in (0, 1, 3, 4)])
        w, free = j @ inverse_mass(body) @ j.T, j @ y[7:13]
        chosen = cones.change_of_energy(s, 4)
        for mask in range(16):
            if bin(mask).count("1") != size:
                continue
            rows_of = [3 * k + c for k in range(4) if mask >> k & 1 for c in range(3)]
            push = np.zeros(12)
            push[rows_of] = np.linalg.lstsq(
                w[np.ix_(rows_of, rows_of)], -free[rows_of], rcond=1e-10
            )[0]
            after = free + w @ push
            if (push[2::3] >= -1e-9).all() and (after[2::3] >= -1e-9).all():
                assert chosen <= 0.5 * push @ (free + after) + 1e-9
    assert several > 0


def test_directions_in_which_slips_are_looked_for_go_once_round():
    rays = cones.RAYS @ (1, 1j)
    assert abs(rays) == pytest.approx(1.0)
    turns = np.angle(np.roll(rays, -1) / rays)
    assert turns.min() > 0
    assert turns.sum() == pytest.approx(2 * math.pi)
    # a square of eight parts a side
    assert turns.max() == pytest.approx(math.atan(1 / 4))


def test_static_friction_holds_what_has_not_slipped_and_kinetic_brakes_what_has():
    """One contact, between both coefficients (Routh): a shear along the old slip is static, against it kinetic."""
    rng, seen = np.random.default_rng(6), set()
    while len(seen) < 2:
        body, y, rows, momentum, s = struck(rng, (2,), 0.0)
        j = jacobian(y, point(body, 2))
        w, free = j @ inverse_mass(body) @ j.T, j @ y[7:13]
        stuck = np.linalg.solve(w, -free)
        ratio = np.hypot(*stuck[:2]) / stuck[2]
        body.static, body.kinetic = 1.1 * ratio, 0.9 * ratio
        problem.note_slips(body, 1, s)
        # what has not slipped sticks
        s.slid[0] = 0
        problem.solve(body, y, rows, 1, 0, momentum, s)
        assert s.impulse[:3] == pytest.approx(stuck)
        s.slid[0] = 1
        problem.solve(body, y, rows, 1, 0, momentum, s)
        shear, normal = np.hypot(s.impulse[0], s.impulse[1]), s.impulse[2]
        if stuck[:2] @ free[:2] < 0:
            assert shear == pytest.approx(body.kinetic * normal)
            seen.add("against")
        else:
            seen.add("along")


def test_a_contact_that_slips_a_given_way_is_rubbed_against_it():
    rng = np.random.default_rng(14)
    for _ in range(8):
        body, y, rows, momentum, s = struck(rng, (2,), 0.3)
        if s.free[2] >= 0:
            # it parts
            continue
        s.given[0], s.way[0] = 1, (0.6, -0.8)
        found, _ = problem.solve(body, y, rows, 1, 0, momentum, s)
        normal = s.impulse[2]
        assert found == 1
        assert s.impulse[:2] == pytest.approx((-0.18 * normal, 0.24 * normal))
        j = jacobian(y, point(body, 2))
        after = j @ (y[7:13] + inverse_mass(body) @ j.T @ s.impulse[:3])
        assert after[2] == pytest.approx(0.0, abs=1e-9)


def test_shears_are_shortened_to_what_friction_allows_and_none_is_left_under_a_pull():
    s = memory()
    s.friction[:4], s.holds[:4], s.slid[:4] = 0.3, 0.5, (0, 1, 0, 0)
    s.impulse[:12] = 0.6, -0.8, 0.01, 0.6, -0.8, 0.01, 0.6, -0.8, -0.5, 0.01, 0.0, 2.0
    cones.shorten_to_cones(s, 4, 0b1111)
    sizes = np.hypot(s.impulse[0:12:3], s.impulse[1:12:3])
    assert sizes == pytest.approx([0.005, 0.003, 0.0, 0.01])
    assert s.impulse[:2] == pytest.approx((0.003, -0.004))
    assert s.impulse[2:12:3].tolist() == [0.01, 0.01, -0.5, 2.0]


def test_where_two_sets_of_contacts_would_do_this_is_counted(monkeypatch):
    rng = np.random.default_rng(17)
    body = uneven(rng)
    for solutions in (0, 1, 2):
        s, y = memory(), leaning(body, 0.3, 0.4)
        y[2] += 0.1
        solved = (-1 if solutions == 0 else 0, solutions)
        monkeypatch.setattr(modes, "solve_forces", lambda *_, solved=solved: solved)
        modes.choose_mode(body, 0.0, y, s)
        assert s.counters[limits.AMBIGUOUS] == (solutions > 1)


def test_a_rim_that_stops_at_its_lowest_point_stops_there():
    """By the least momentum, as a vertex at that place would."""
    across = (3 * 0.2**2 + 0.8**2) / 12
    tensor = np.diag([across, across, 0.02])
    rim = RigidBody(1.0, tensor, (0.0, 0.0, 0.4), Circle(0.2), 0.8)
    body = plain(kernel_body(System((rim,), (Contact(),))))
    rng, s = np.random.default_rng(15), memory()
    y = state(rng, body)
    rows, before = rotation(y), y[7:13].copy()
    lowest = np.array(solid.arm(body, rows[2], body.count))
    mode(s, body.count)
    contacts.hold(body, y, rows, s)
    j = jacobian(y, lowest)
    push = np.linalg.solve(j @ inverse_mass(body) @ j.T, -j @ before)
    expected = before + inverse_mass(body) @ j.T @ push
    assert y[7:13] == pytest.approx(expected, abs=1e-10)


def test_a_mode_is_read_off_the_impulses_that_were_found():
    """What pushes is closed; it slides where it slips and its shear is all that its friction gives."""
    body, s = uneven(np.random.default_rng(11)), memory()
    y = leaning(body, 0.0, 0.0)
    s.which[:3], s.grip[:3] = (5, 2, 4), 0.5
    s.impulse[:9] = 0.0, 0.0, 0.0, -0.3, 0.4, 1.0, 0.1, 0.0, 1.0
    s.after[:9] = 0.0, 0.0, 2.0, 0.6, -0.8, 0.0, 0.0, 0.0, 0.0
    contacts.write_mode(body, y, rotation(y), 3, 0b110, s)
    assert s.count == 2
    assert s.closed[:2].tolist() == [2, 4]
    assert s.slides[:2].tolist() == [case.SLIDES, case.STICKS]
    assert s.direction[0] == pytest.approx((0.6, -0.8))
    corners = np.array([point(body, i)[:2] for i in (2, 4)])
    assert s.anchor[:2] == pytest.approx(corners)
    assert s.counters[limits.SLIDINGS] == 1


def test_where_a_mode_comes_again_what_is_furthest_from_consistent_is_changed():
    body, s = uneven(np.random.default_rng(12)), memory()
    body.static = 0.5
    pushes = np.array([(0.1, 0.0, 0.5), (0.6, -0.8, 1.0), (0.0, 0.3, -0.2)])
    for what, left, slides in (
        (limits.OPENS, [1, 2], [0, 0]),
        (limits.LEAVES_CONE, [1, 2, 4], [0, 1, 0]),
    ):
        mode(s, 1, 2, 4)
        s.lam[:3] = pushes
        # the third pulls, and is out of its cone the less
        s.lam[2, 2] = -0.2 if what == limits.OPENS else 0.4
        s.anchor[:3] = [(1.0, 2.0), (3.0, 4.0), (5.0, 6.0)]
        contacts.insist(body, what, s)
        assert s.count == len(left)
        assert s.closed[: s.count].tolist() == left
        assert s.slides[: s.count].tolist() == slides
    # against its shear
    assert s.direction[1] == pytest.approx((-0.6, 0.8))
    # the first opens: the others and where they stick move up
    mode(s, 1, 2, 4)
    s.lam[:3, 2] = -1.0, 1.0, 1.0
    s.anchor[:3] = [(1.0, 2.0), (3.0, 4.0), (5.0, 6.0)]
    contacts.insist(body, limits.OPENS, s)
    assert s.closed[:2].tolist() == [2, 4]
    assert s.anchor[:2].tolist() == [[3.0, 4.0], [5.0, 6.0]]


def test_accelerations_under_forces_that_were_found_are_newtons_and_eulers():
    rng = np.random.default_rng(13)
    body, s = uneven(rng), memory()
    y = state(rng, body)
    r = attitude(y)
    s.which[:2] = 1, 4
    s.impulse[:6] = push = rng.normal(size=6)
    weight, moment = rng.normal(size=(2, 3))
    load, spin = modes.pushed_by(body, rotation(y), 2, tuple(weight), tuple(moment), s)
    by_push = [r.T @ push[3 * k : 3 * k + 3] for k in (0, 1)]
    assert load == pytest.approx(weight + sum(by_push))
    turned = moment + sum(
        np.cross(point(body, i), f) for i, f in zip((1, 4), by_push, strict=True)
    )
    assert spin == pytest.approx(np.linalg.solve(body.inertia, turned))


def test_systems_are_solved_and_factored_as_numpy_does():
    rng = np.random.default_rng(7)
    for size in (2, 3, 6):
        for _ in range(5):
            m, r = rng.normal(size=(size, size)), rng.normal(size=size)
            expected = np.linalg.solve(m, r)
            matrix, order, x = m.copy(), np.zeros(size, int), r.copy()
            assert algebra.factor(matrix, order, size)
            algebra.substitute(matrix, order, size, x)
            assert x == pytest.approx(expected)
    assert not algebra.factor(np.zeros((2, 2)), np.zeros(2, int), 2)
    m = rng.normal(size=(3, 3))
    m = m @ m.T
    found = algebra.solve_symmetric(
        m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2], r[:3]
    )
    assert found == pytest.approx(np.linalg.solve(m, r[:3]))


def test_a_small_turn_of_the_attitude_is_the_one_of_its_rotation_vector():
    rng = np.random.default_rng(8)
    y = state(rng, uneven(rng))
    before, angle = attitude(y), 1e-6 * rng.normal(size=3)
    algebra.turn(y, angle)
    skew = np.cross(np.eye(3), angle)
    assert attitude(y) == pytest.approx(before @ (np.eye(3) + skew), abs=1e-11)
    assert np.linalg.norm(y[3:7]) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize(("spread", "touches"), [(0.9, False), (1.2, True)])
def test_a_point_that_dips_within_a_step_is_looked_at(spread, touches):
    """A parabola with rates -1 and 1 over 0.1 s sinks by 0.025; a fiftieth of them is for safety."""
    gap = (0.025 + 0.004) / spread
    assert step.touches_between(gap, -1.0, 1.0, 0.1) == touches
    assert not step.touches_between(gap, 1.0, 1.0, 0.1)
    assert not step.touches_between(gap, -1.0, -1.0, 0.1)


def test_a_bond_bears_half_of_what_its_pads_would_have_to_on_either_side():
    """Pull and moments about both axes over the distance of the pads; shear beside friction."""
    rng = np.random.default_rng(9)
    body, y = uneven(rng), np.zeros(solid.SIZE)
    y[3] = 1.0
    for _ in range(10):
        body.tension, body.shear, body.static = (
            rng.uniform(5, 20),
            rng.uniform(1, 9),
            0.4,
        )
        body.pads[:] = rng.uniform(0.1, 0.3, 2)
        body.aside[:] = rng.normal(0, 0.02, 2)
        pull = np.array([*rng.normal(0, 3, 2), -G])
        moments = body.height * pull[:2] + G * np.array(body.aside)
        needed = 0.5 * (-G + (np.abs(moments) / body.pads).sum())
        found = rest.bond_tension(body, rotation(y), pull)
        assert found == pytest.approx(needed)
        shear = body.shear + 0.4 * G - np.hypot(*pull[:2])
        margin = rest.bond_margin(body, rotation(y), pull)
        assert margin == pytest.approx(min(body.tension - 2 * needed, shear))
        load = rest.Load(pull, pull, 0.0, False)
        assert rest.grip_margin(body, load) == pytest.approx(
            0.4 * G - np.hypot(*pull[:2])
        )


@pytest.mark.parametrize(
    ("place", "flat"), [(0, True), (9, False), (10, False), (11, False)]
)
def test_a_body_lies_flat_only_where_it_neither_leans_nor_turns_nor_rises(place, flat):
    body = uneven(np.random.default_rng(10))
    y = leaning(body, 0.0, 0.0)
    y[place] += 1e-3
    assert points.lies_flat(body, y, rotation(y)) == flat
    y = leaning(body, 1e-3, 0.4)
    assert not points.lies_flat(body, y, rotation(y))


def test_a_wall_and_the_friction_of_a_foot_share_what_neither_bears_alone():
    """A point that stands before a smooth wall and is driven into it: friction bears 0.5 of 9.81 of 12."""
    s = plain(np.zeros((), case.CASE))
    s.which[:2] = 0, solid.WALLS
    s.given[1], s.way[1, 0] = 1, 1.0
    s.holds[0] = s.friction[0] = 0.5
    rows = np.zeros((6, 3))
    rows[0, 0] = rows[1, 1] = rows[2, 2] = rows[3, 1] = rows[4, 2] = 1.0
    rows[5, 0] = -1.0  # away from the wall
    s.delassus[:6, :6] = rows @ rows.T
    s.free[:6] = rows @ (12.0, 0.0, -G)
    found, _ = cones.solve_cones(s, 2, 0)
    assert found == 0b11
    shear, normal, pressed = -s.impulse[0], s.impulse[2], s.impulse[5]
    assert abs(shear) <= 0.5 * normal * (1 + 1e-9)
    np.testing.assert_allclose([shear + pressed, normal], [12.0, G], rtol=1e-9)
    np.testing.assert_allclose(s.after[:6], 0, atol=1e-9)
    # one after the other, from no impulse at all
    s.impulse[:6], s.grip[0] = 0.0, 0.5
    assert relax.relax(s, 2, 1e-12)
    assert abs(s.impulse[0]) <= 0.5 * s.impulse[2]
    np.testing.assert_allclose(rows.T @ s.impulse[:6], (-12.0, 0.0, G), atol=1e-10)
