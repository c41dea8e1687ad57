"""What ends a step of a body in space, or its rest, and what follows: beside closed forms and SciPy's events.

Kernels are called one by one, as plain Python.
"""

import itertools
import math

import numpy as np
import pytest
from scipy.integrate import RK45, solve_ivp
from scipy.integrate._ivp.rk import rk_step
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from ...mutants.plain import plain_library
from .plain_space import (
    OUTLINE,
    Circle,
    Contact,
    G,
    Polygon,
    RigidBody,
    System,
    Tie,
    Wall,
    at_rest,
    attitude,
    case,
    contacts,
    delassus,
    events,
    face,
    forces,
    gaps,
    ground,
    holders,
    hops,
    impacts,
    inverse_mass,
    jacobian,
    kernel_body,
    leaning,
    limits,
    memory,
    mode,
    modes,
    outcome,
    plain,
    point,
    points,
    problem,
    rest,
    rim,
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

with plain_library():
    from rockfrag.engines.spatial import _cone as cones
    from rockfrag.engines.spatial import _hinge as hinge
    from rockfrag.engines.spatial import _pivot as pivot

DT = 0.01
CORNERS = np.array(OUTLINE) - (0.03, -0.02)


def upright(body, turn=0.0, x=0.0, z=0.0):
    """State of a body that stands at rest, turned about the vertical."""
    y = np.zeros(solid.SIZE)
    y[:3] = x, z, body.height
    y[3], y[6] = math.cos(turn / 2), math.sin(turn / 2)
    return y


def drum(off=(0.05, -0.03), radius=0.2, height=0.4):
    """A round body whose centre of mass is not over the centre of its base."""
    across = (3 * radius**2 + 4 * height**2) / 12
    tensor = np.diag([across, across, radius**2 / 2])
    made = RigidBody(1.0, tensor, (*off, height), Circle(radius), 2 * height)
    body = kernel_body(System((made,), (Contact(),)))
    body["static"], body["kinetic"] = 0.5, 0.3
    return plain(body)


def test_a_body_that_meets_walls_alone_is_held_by_no_tie():
    rng, wall = np.random.default_rng(22), Wall(2.0, 0.0)
    tie = Tie((0.0, 0.0, 1.0), (2.0, 0.0, 1.2), 1e4)
    for holding, alone in (
        ((), False),
        ((wall,), True),
        ((wall, tie), False),
        ((tie,), False),
    ):
        assert solid.meets_walls_alone(uneven(rng, *holding)) == alone


def margins_of_rest(gravity, r):
    """Moment over each edge, over the height of 0.6 m, and what friction leaves: positive while rest is kept."""
    corners = CORNERS @ r[:2, :2].T
    along = np.roll(corners, -1, axis=0) - corners
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1)
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    reach = (outward * corners).sum(axis=1)
    edges = -(outward @ gravity[:2]) - reach * gravity[2] / 0.6
    return edges, -0.5 * gravity[2] - np.hypot(*gravity[:2])


def test_rest_ends_when_the_line_of_thrust_leaves_the_base_or_friction_is_used_up():
    rng, seen = np.random.default_rng(1), set()
    for _ in range(40):
        body, s = uneven(rng), shaken(rng)
        s.field[3:6] *= 1e2
        y = upright(body, rng.uniform(0, 6), 0.4, -0.3)
        r = attitude(y)

        def least(tau, s=s, r=r):
            edges, shear = margins_of_rest(s.field[:3] + tau * s.field[3:6], r)
            return min(edges.min(), shear)

        begins, ends = least(0.001), least(DT)
        found = at_rest.rest_ends(body, y, s, 0.001, DT)
        if ends >= 0:
            seen.add("rests")
            assert found == -1.0
        elif begins <= 0:
            seen.add("at once")
            assert found == 0.001
        else:
            edges, shear = margins_of_rest(s.field[:3] + DT * s.field[3:6], r)
            seen.add("slides" if shear < edges.min() else "tips")
            assert found == pytest.approx(brentq(least, 0.001, DT, xtol=1e-15))
            assert rest.rest_margin(
                body, y, rotation(y), tuple(s.field[:3] + found * s.field[3:6]), s
            ) == pytest.approx(0, abs=1e-10)
    assert seen == {"rests", "at once", "slides", "tips"}


def thrust(at, height=0.6):
    """Effective gravity whose line through the centre of mass meets the base at a place."""
    return np.array([*(np.asarray(at) * G / height), -G])


@pytest.mark.parametrize("i", range(6))
def test_a_body_leaves_rest_over_the_edge_or_the_vertex_that_the_line_of_thrust_meets(
    i,
):
    rng = np.random.default_rng(2)
    body, s = uneven(rng), memory()
    body.static = 2.0
    y = upright(body, 0.0, 0.4, -0.3)
    j = (i + 1) % 6
    for part in (0.3, 0.7):
        s.field[:3] = thrust((1 - part) * CORNERS[i] + part * CORNERS[j])
        s.rests = 1
        at_rest.leave_rest(body, y, 0.0, s)
        assert sorted(s.closed[: s.count].tolist()) == sorted((i, j))
        assert (s.rests, s.slides[0], s.slides[1]) == (0, 0, 0)
        for k in range(2):
            place = y[:2] + CORNERS[s.closed[k]]
            assert s.anchor[k] == pytest.approx(place)
    s.field[:3] = thrust(CORNERS[i])
    at_rest.leave_rest(body, y, 0.0, s)
    assert s.closed[: s.count].tolist() == [i]


def test_a_body_leaves_rest_sliding_where_effective_gravity_takes_it():
    rng = np.random.default_rng(3)
    body, s = uneven(rng), memory()
    body.static = 0.2
    y = upright(body, 0.7)
    s.field[:3] = -0.6 * 0.2 * G, 0.8 * 0.2 * G, -G
    at_rest.leave_rest(body, y, 0.0, s)
    assert s.count == 4
    assert len(set(s.closed[:4].tolist())) == 4
    assert (s.slides[:4] == case.SLIDES).all()
    assert s.direction[:4] == pytest.approx(np.tile((-0.6, 0.8), (4, 1)))
    assert s.counters[limits.SLIDINGS] == 1


def test_a_round_body_leaves_rest_over_the_rims_point_that_the_line_of_thrust_meets():
    """About that point, which stays where it is; what the tilt lifts is work of the ground."""
    rng = np.random.default_rng(4)
    for _ in range(6):
        body, s = drum(), memory()
        body.static = 3.0
        y = upright(body, rng.uniform(0, 6), 0.4, -0.3)
        r, way = attitude(y), rng.uniform(0, 6)
        u = np.array([math.cos(way), math.sin(way)])
        at = np.array(body.centre) + body.rim * u
        s.field[:3] = thrust((r[:2, :2] @ at), body.height)
        assert rest.topple_margin(body, rotation(y), s.field[:3]) == pytest.approx(
            0, abs=1e-12
        )
        before = y.copy()
        p = np.array([*at, -body.height])
        at_rest.leave_rest(body, y, 0.0, s)
        assert s.closed[: s.count].tolist() == [body.count]
        assert (s.rests, s.slides[0]) == (0, case.STICKS)
        up = attitude(y)[2]
        assert np.hypot(*up[:2]) == pytest.approx(rim.RIM_START, rel=1e-6)
        assert -up[:2] / np.hypot(*up[:2]) == pytest.approx(u, abs=1e-6)
        touches = y[:3] + attitude(y) @ p
        assert touches == pytest.approx([*(before[:2] + r[:2, :2] @ at), 0], abs=1e-13)
        lifted = y[:3] - before[:3]
        work = (s.field[:3] @ lifted) + G * lifted[2]
        assert y[solid.WORK] == pytest.approx(work, abs=1e-15)


def test_a_round_body_keeps_rest_while_the_line_of_thrust_meets_the_disc():
    rng, kept = np.random.default_rng(5), set()
    body, s = drum(), memory()
    body.static = 3.0
    for _ in range(40):
        y = upright(body, rng.uniform(0, 6))
        gravity = np.array([*rng.uniform(-6, 6, 2), -G - rng.uniform(-3, 3)])
        meets = -body.height * gravity[:2] / gravity[2]
        centre = attitude(y)[:2, :2] @ np.array(body.centre)
        off = np.hypot(*(meets - centre))
        margin = rest.topple_margin(body, rotation(y), gravity)
        expected = (body.rim - off) * -gravity[2] / body.height
        assert margin == pytest.approx(expected, abs=1e-12)
        shear = -3.0 * gravity[2] - np.hypot(*gravity[:2])
        whole_margin = rest.rest_margin(body, y, rotation(y), gravity, s)
        assert whole_margin == pytest.approx(min(margin, shear), abs=1e-12)
        kept.add(bool(margin > 0))
    assert kept == {True, False}


def test_feet_of_a_round_body_are_a_quarter_of_a_turn_apart_the_first_ahead():
    rng = np.random.default_rng(6)
    for slides in (True, False):
        body, s = drum(), shaken(rng)
        y = upright(body, rng.uniform(0, 6))
        y[7:9] = rng.normal(size=2) * slides
        ahead = attitude(y)[:2, :2].T @ (y[7:9] if slides else s.field[:2])
        ahead /= np.hypot(*ahead)
        assert points.touching(body, y, rotation(y), s) == 4
        assert points.pick_feet(body, y, rotation(y), s) == 4
        ways = [
            (np.array(body.points[i])[:2] - body.centre) / body.rim for i in s.which
        ]
        # of 32 points the nearest one
        assert ways[0] @ ahead > math.cos(math.pi / 32) - 1e-12
        for k in range(3):
            turned = np.array([-ways[k][1], ways[k][0]])
            assert ways[k + 1] == pytest.approx(turned, abs=1e-12)
        y[2] += 1e-9
        assert points.touching(body, y, rotation(y), s) == 0


def test_a_pass_near_flat_turns_the_contact_on_and_keeps_tilt_and_its_rate():
    for slides in (case.STICKS, case.SLIDES):
        for side in (1.0, -1.0):
            body, s = drum(off=(0.0, 0.0)), memory()
            body.pass_turn, body.slide_turn = 2.1, 2.6
            y = leaning(body, 5e-9, 0.8)
            # it sinks, and its contact goes round a little
            u = np.array([math.cos(0.8), math.sin(0.8)])
            y[10:13] = [*(0.03 * np.array([u[1], -u[0]]) + side * 1e-3 * u), 0.0]
            mode(s, body.count, slides=slides)
            y[:2] = 0.3, 0.1
            gaps.settle(body, y, s)
            up = attitude(y)[2]
            sinking = np.cross(up, y[10:13])[:2]
            here = -up[:2] / np.hypot(*up[:2])
            assert sinking @ here > 0
            before = solid.energy(body, y, G)
            rim.pass_flat(body, y, s)
            up = attitude(y)[2]
            there = -up[:2] / np.hypot(*up[:2])
            angle = 2.6 if slides else 2.1
            turn = math.atan2(here[0] * there[1] - here[1] * there[0], here @ there)
            # the way in which the contact goes round already: across the rate of the vertical
            on = np.sign(here[1] * sinking[0] - here[0] * sinking[1])
            assert turn == pytest.approx(on * angle, abs=1e-6)
            assert np.hypot(*up[:2]) == pytest.approx(2 * rim.FLAT_PASS, rel=1e-6)
            rate = np.cross(up, y[10:13])[:2]
            assert rate @ up[:2] > 0
            # but for what the tilt of twice FLAT_PASS lifts
            assert np.hypot(*rate) == pytest.approx(np.hypot(*sinking), rel=1e-3)
            assert solid.energy(body, y, G) <= before * (1 + 1e-9) + 1e-15
            lowest = y[:3] + attitude(y) @ [*(0.2 * there), -0.4]
            speed = jacobian(y, np.array([*(0.2 * there), -0.4])) @ y[7:13]
            assert speed[2] == pytest.approx(0.0, abs=1e-12)
            if not slides:
                assert lowest[2] == pytest.approx(0.0, abs=1e-12)
                assert speed == pytest.approx(0.0, abs=1e-12)
            # a second time it rises already
            again = y.copy()
            rim.pass_flat(body, again, s)
            assert (again == y).all()


def test_a_body_in_the_air_lands_when_its_parabola_meets_the_ground():
    rng = np.random.default_rng(8)
    for vertical in (-0.4, 0.02):
        body, s = uneven(rng), memory()
        y = leaning(body, 0.2, 0.5)
        y[9] = vertical
        low = min(solid.gap(body, y, rotation(y)[2], i) for i in range(6))
        y[2] += 2e-4 - low
        s.field[3:6] = 0.0
        mode(s)
        step.begin(body, 0.0, y, s)
        step.attempt(body, 0.0, DT, y, s)
        touch = (vertical + math.sqrt(vertical**2 + 2 * G * 2e-4)) / G
        least, what = step.margin(body, s.new, s)
        assert (least < 0) == (touch < DT)
        assert what == limits.LANDS
        h, what = events.locate(body, 0.0, DT, y, s)
        assert what == limits.LANDS
        # half of TOUCH under the ground
        deeper = (vertical + math.sqrt(vertical**2 + 2 * G * (2e-4 + 5e-11))) / G
        assert h == pytest.approx(deeper, abs=1e-12)
        first = events.lowest_open(body, s.new, s)
        heights = [solid.gap(body, s.new, rotation(s.new)[2], i) for i in range(6)]
        assert first == np.argmin(heights)
        assert heights[first] == pytest.approx(-5e-11, abs=2e-12)


KINDS = {
    "flight": ((), ()),
    "pivot": ((2,), (0,)),
    "slider": ((1,), (1,)),
    "hinge": ((3, 4), (0, 0)),
    "edge that slides at one end": ((3, 4), (0, 1)),
}


@pytest.mark.parametrize("name", KINDS)
def test_the_first_instant_at_which_a_margin_vanishes_is_found(name):
    """On a path that SciPy finds: of a gap, of a normal force, of what a cone leaves, of a slip."""
    rng, seen = np.random.default_rng(9), set()
    for _ in range(12):
        closed, slides = KINDS[name]
        body, s = uneven(rng), shaken(rng)
        body.static, body.kinetic = 0.9, 0.3
        over = CORNERS[list(closed or (0,))].mean(axis=0)
        towards = math.atan2(over[1], over[0]) + rng.uniform(-0.1, 0.1)
        y = leaning(body, rng.uniform(0.02, 0.2), towards)
        y[7:13] = rng.normal(0, 0.3, 6)
        mode(s, *closed)
        s.slides[: len(closed)] = slides
        if closed:
            gaps.close_gaps(body, y, rotation(y), s)
            contacts.hold(body, y, rotation(y), s)
            contacts.anchor_all(body, y, s)
            gaps.settle(body, y, s)
        low = min(
            [solid.gap(body, y, rotation(y)[2], i) for i in range(6) if i not in closed]
        )
        if low < 0 and closed:
            continue
        if not closed:
            y[2] += rng.uniform(1e-3, 3e-3) - low
        s.field[3:6] = rng.normal(0, 100, 3)
        step.begin(body, 0.0, y, s)
        forces.rates(body, 0.0, y, s.slopes[0], s)

        def path(time, y, body=body, s=s):
            slope = np.zeros(solid.SIZE)
            forces.rates(body, time, y, slope, s)
            return slope

        def margin(time, y, body=body, s=s):
            path(time, y)
            return step.margin(body, y, s)[0]

        margin.terminal = True
        if margin(0.0, y) <= 0:
            continue
        given = {"rtol": 1e-12, "atol": 1e-13, "events": margin}
        first = solve_ivp(path, (0, 0.05), y, "DOP853", dense_output=True, **given)
        if not first.t_events[0].size:
            continue
        # a step that begins shortly before, so that its own error is none
        tau = max(first.t_events[0][0] - 1e-3, 0.0)
        y, h = first.sol(tau), 2e-3
        if closed:
            contacts.anchor_all(body, y, s)
        step.begin(body, tau, y, s)
        exact = solve_ivp(path, (tau, tau + h), y, "DOP853", **given)
        if step.attempt(body, tau, h, y, s) > 1e-8 or not exact.t_events[0].size:
            # slip that hardly goes on is stiff
            continue
        found, what = events.locate(body, tau, h, y, s)
        assert tau + found == pytest.approx(exact.t_events[0][0], abs=1e-8)
        assert s.new[:13] == pytest.approx(exact.y_events[0][0][:13], abs=1e-7)
        seen.add(what)
    assert seen


def test_peaks_from_each_sample_on_and_in_a_window_are_numpys():
    rng = np.random.default_rng(10)
    motion = rng.normal(size=(60, 3))
    peaks = np.zeros((60, 4))
    ground.fill_peaks(motion, peaks)
    level, lift = np.hypot(motion[:, 0], motion[:, 1]), np.abs(motion[:, 2])
    for k in range(60):
        ahead = slice(k, k + ground.WINDOW + 1)
        expected = [
            level[k:].max(),
            lift[k:].max(),
            level[ahead].max(),
            lift[ahead].max(),
        ]
        assert peaks[k] == pytest.approx(expected)
    s = memory()
    ground.note_soon(s, peaks, 20, 1.5, DT)
    assert s.soon[:2] == pytest.approx(1.5 * peaks[20, 2:])
    # intervals k to k + WINDOW - 1 end before the window's last sample
    assert s.soon[2] == pytest.approx((ground.WINDOW - 1) * DT)
    ground.note_soon(s, peaks, 60, 1.5, DT)
    assert s.soon[:2].tolist() == [0.0, 0.0]


def test_the_ground_is_linear_between_samples_and_at_rest_one_after_the_last():
    rng = np.random.default_rng(11)
    motion, field = rng.normal(size=(5, 3)), np.zeros(7)
    for k in range(7):
        ground.set_field(field, motion, k, 1.5, DT, G)
        for part in (0.0, 0.3, 1.0):
            time = (k + part) * DT
            along = [
                np.interp(time, DT * np.arange(6), [*motion[:, i], 0.0]) * 1.5
                for i in range(3)
            ]
            expected = -np.array(along) - (0, 0, G)
            found = case.effective_gravity_at(field, part * DT)
            assert found == pytest.approx(expected, abs=1e-12)
        assert field[case.GRAVITY] == G


def test_a_window_is_passed_at_rest_only_where_no_direction_of_its_peaks_moves_the_body():
    rng, seen = np.random.default_rng(12), set()
    body, s = uneven(rng), memory()
    for _ in range(30):
        peaks = rng.uniform(0, 6, (1, 4))
        level, weight = 1.5 * peaks[0, 2], G - 1.5 * peaks[0, 3]
        rests = True
        for angle in np.linspace(0, 2 * math.pi, 73):
            gravity = [level * math.cos(angle), level * math.sin(angle), -weight]
            edges, shear = margins_of_rest(np.array(gravity), np.eye(3))
            rests = rests and edges.min() > 0 and shear > 0
        assert at_rest.rests_on(body, upright(body), peaks, 0, 1.5, G, s) == rests
        seen.add(rests)
    assert seen == {True, False}


def test_what_ties_bear_is_noted_and_they_turn_and_break_as_their_force_says():
    rng = np.random.default_rng(13)
    tie = Tie((0.1, 0.0, 1.0), (1.0, 0.2, 1.1), 500.0, damping=4.0, strength=100.0)
    body, s = uneven(rng, tie), memory()
    y = upright(body)
    y[9] = 1e-3
    holders.begin_holding(body, y, s)
    assert (s.broken[0], s.hits[0]) == (0, 0.0)
    s.began, s.taut[0] = 2.0, 0
    for back, force in ((0.05, 25.0), (-0.05, 0.0), (0.2, 100.0)):
        # away from the anchor
        way = np.array([0.9, 0.2, 0.1]) / math.hypot(0.9, 0.2, 0.1)
        y[:3] = np.array([0, 0, body.height]) - back * way
        y[7:10] = 0.0
        holders.turn_ties(body, y, 0.3, False, s)
        assert s.taut[0] == (back > 0)
        holders.note_forces(body, y, s)
        assert s.force[0] == pytest.approx(max(force, 25.0))
    assert s.hits[0] == 2
    holders.turn_ties(body, y, 0.3, True, s)
    assert (s.broken[0], s.breaks[0], s.force[0]) == (1, 2.3, body.strength[0])
    # a broken one neither bears nor breaks again
    s.force[0] = 0.0
    holders.note_forces(body, y, s)
    holders.turn_ties(body, y, 0.5, True, s)
    assert (s.force[0], s.breaks[0]) == (0.0, 2.3)


def test_a_bond_is_noted_with_half_of_what_it_holds_at_most():
    rng = np.random.default_rng(14)
    body, s = uneven(rng), memory()
    y = upright(body)
    body.pads[:], body.tension = 0.2, 9.0
    s.field[:6] = 2.0, 1.0, -G, 300.0, 0.0, 0.0
    holders.note_bond(body, y, 0.0, s)
    # (-g + (|2| + |1|) h / pad) / 2
    first = 0.5 * (-G + 3.0 * 0.6 / 0.2)
    assert s.force[solid.BOND] == pytest.approx(max(first, 0.0))
    holders.note_bond(body, y, DT, s)
    assert s.force[solid.BOND] == pytest.approx(min(0.5 * (-G + 18.0), 4.5))
    # a side that bears more has parted
    s.field[3] *= 2
    holders.note_bond(body, y, DT, s)
    assert s.force[solid.BOND] == 4.5


@pytest.mark.parametrize("closed", [(2,), (2, 3), "rim"])
def test_a_state_is_settled_on_what_it_pivots_about(closed):
    """The point is where it stuck and does not move; an edge lets turn about itself alone."""
    rng = np.random.default_rng(15)
    body = drum() if closed == "rim" else uneven(rng)
    s, y = memory(), leaning(body, 0.3, 1.0)
    y[:3] += 1e-3
    y[7:13] = rng.normal(size=6)
    mode(s, *((body.count,) if closed == "rim" else closed))
    s.anchor[0] = 0.3, -0.2
    spin, plan = y[10:13].copy(), y[:2].copy()
    gaps.settle(body, y, s)
    p = np.array(solid.arm(body, rotation(y)[2], s.closed[0]))
    touches = y[:3] + attitude(y) @ p
    assert touches[2] == pytest.approx(0, abs=1e-15)
    if closed == "rim":
        assert y[:2] == pytest.approx(plan)
    else:
        assert touches[:2] == pytest.approx((0.3, -0.2))
    assert jacobian(y, p) @ y[7:13] == pytest.approx(0, abs=1e-13)
    if len(closed) == 2:
        e = point(body, 3) - point(body, 2)
        e /= np.linalg.norm(e)
        spin = (spin @ e) * e
        assert jacobian(y, point(body, 3)) @ y[7:13] == pytest.approx(0, abs=1e-13)
    assert y[10:13] == pytest.approx(spin)


def test_slips_that_have_ended_stick_and_what_is_left_of_them_is_stopped():
    rng = np.random.default_rng(16)
    for speed, sticks in ((1.9e-4, True), (2.1e-4, False)):
        body, s = uneven(rng), memory()
        y = leaning(body, 0.2, 0.4)
        mode(s, 2, slides=case.SLIDES)
        gaps.close_gaps(body, y, rotation(y), s)
        y[7], y[8] = 0.6 * speed, -0.8 * speed
        events.stop_slips(body, y, s)
        assert s.slides[0] == (case.STICKS if sticks else case.SLIDES)
        left = jacobian(y, point(body, 2)) @ y[7:13]
        kept = 0.0 if sticks else speed
        assert np.hypot(*left[:2]) == pytest.approx(kept, abs=1e-15)
        assert left[2] == pytest.approx(0, abs=1e-15)


def test_a_hop_is_closed_unseen_if_what_it_leaves_out_is_small():
    """Equation 18 with the fall of the far end while the body pivots, by Lagrange's equations."""
    rng = np.random.default_rng(17)
    seen = set()
    for _ in range(12):
        body, s = uneven(rng), shaken(rng)
        s.field[:2] *= 6
        y = leaning(body, 1e-3, rng.uniform(0, 6))
        y[10:13] = rng.normal(0, 0.3, 3)
        mode(s, 2)
        gaps.settle(body, y, s)
        s.which[:2] = 2, 3
        slope = np.zeros(solid.SIZE)
        forces.rates(body, 0.0, y, slope, s)
        q, omega = point(body, 3), y[10:13]
        turning = attitude(y) @ np.cross(omega, np.cross(omega, q))
        falls = -(jacobian(y, q) @ slope[7:13] + turning)[2]
        length = np.linalg.norm(q - point(body, 2))
        gravity = tuple(s.field[:3])

        def chatters(leaving, body=body, y=y, gravity=gravity, s=s):
            return hops.chatters(body, y, rotation(y), gravity, 0, 1, leaving, s)

        if falls <= 0:
            assert not chatters(1e-9)
            seen.add("rises")
            continue
        # leaving³ g / (0.05 falls² length height) = 1e-6
        most = (1e-6 * 0.05 * falls**2 * length * body.height / G) ** (1 / 3)
        seen.add("slow" if most < hops.FASTEST_HOP else "fast")
        assert chatters(0.99 * min(most, hops.FASTEST_HOP))
        assert not chatters(1.01 * min(most, hops.FASTEST_HOP))
    assert {"rises", "slow"} <= seen


def test_hits_of_walls_are_counted_with_the_whole_impulse_of_each():
    rng = np.random.default_rng(18)
    body, s = uneven(rng, Wall(2.0, 0.0), Wall(2.0, math.pi)), memory()
    second = solid.WALLS + solid.MOST_CORNERS
    s.which[:4] = solid.WALLS, solid.WALLS + 3, second + 1, 2
    for size in (1.0, 0.5):
        s.impulse[:12] = 0.0
        s.impulse[[2, 5, 8, 11]] = 0.1 * size, 0.2 * size, 0.4 * size, 9.0
        impacts.note_impulses(body, 4, 0b1011, s)
        # the contact of the second wall does not push
        assert s.impact[:2] == pytest.approx([0.3, 0.0])
    assert s.hits[:2].tolist() == [2.0, 0.0]
    impacts.note_impulses(body, 4, 0b0101, s)
    assert s.hits[:2].tolist() == [3.0, 1.0]
    assert s.impact[:2] == pytest.approx([0.3, 0.2])


def test_momentum_beyond_friction_is_noted_and_counted():
    body, s = uneven(np.random.default_rng(19)), memory()
    y = np.zeros(solid.SIZE)
    y[7:10] = 0.3, 0.4, 0.6
    before = (0.0, 0.8, 0.1)
    # shear of 0.5 under 0.5 x 0.5
    impacts.witness(body, y, before, s)
    assert s.beyond == pytest.approx(0.25)
    assert s.counters[limits.UNSOLVED] == 1
    y[7:10] = 0.0, 0.8 + 15e-4, 0.1 + 15e-4
    impacts.witness(body, y, before, s)
    assert s.beyond == pytest.approx(0.25)
    assert s.counters[limits.UNSOLVED] == 1


def test_against_a_wall_a_body_neither_tips_nor_needs_ground_for_what_the_wall_bears():
    """A box that stands with its side at a wall towards +x."""
    base = Polygon(((-0.2, -0.3), (0.2, -0.3), (0.2, 0.3), (-0.2, 0.3)))
    box = RigidBody(1.0, np.diag([0.3, 0.3, 0.1]), (0.0, 0.0, 0.5), base, 1.0, base)
    holders = (Wall(5.0, 1.0), Wall(0.2, 0.0, friction=0.3))
    body = kernel_body(System((box,), (Contact(),), constraints=holders))
    body["static"], body["kinetic"] = 0.5, 0.3
    body, s = plain(body), memory()
    y = upright(body)
    rows = rotation(y)
    assert rest.lies_against(body, y, rows, 1)
    assert points.meets_wall(body, y, rows)
    assert rest.backed_by_wall(body, y, rows, 1, 2)
    assert not rest.backed_by_wall(body, y, rows, 2, 3)
    assert not rest.backed_by_wall(body, y, rows, 3, 0)
    # into the wall nothing is left, away from it all
    assert rest.borne_by_ground(body, y, rows, (9.0, 1.0, -G)) == (0.0, 1.0, -G)
    assert rest.borne_by_ground(body, y, rows, (-9.0, 1.0, -G)) == (-9.0, 1.0, -G)
    margin = rest.rest_margin(body, y, rows, (50.0, 0.0, -G), s)
    assert margin == pytest.approx(min(0.5 * G, 0.3 / 0.5 * G, 0.2 / 0.5 * G))
    margin = rest.rest_margin(body, y, rows, (-4.0, 0.0, -G), s)
    assert margin == pytest.approx(min(0.5 * G - 4.0, 0.2 / 0.5 * G - 4.0))
    y[0] -= 1e-6
    assert not rest.lies_against(body, y, rows, 1)
    assert not points.meets_wall(body, y, rows)
    assert rest.borne_by_ground(body, y, rows, (9.0, 1.0, -G)) == (9.0, 1.0, -G)


def test_what_a_wall_or_the_ground_holds_is_left_out_where_a_mode_comes_again():
    """What is furthest out of its cone slides, by the friction of its own surface."""
    body, s = uneven(np.random.default_rng(20), Wall(2.0, 0.0, friction=0.1)), memory()
    body.static = 0.5
    wall = solid.WALLS + 2
    for grips, worst in (((0.5, 0.1), 1), ((0.05, 0.9), 0)):
        body.static, body.wall_static[0] = grips
        mode(s, 1, wall)
        s.lam[:2] = [(0.3, 0.0, 1.0), (0.0, -0.3, 1.0)]
        contacts.insist(body, limits.LEAVES_CONE, s)
        assert s.slides[:2].tolist() == [int(worst == k) for k in range(2)]
    # one that slides already is not asked again
    mode(s, 1, wall)
    s.slides[0] = case.SLIDES
    contacts.insist(body, limits.LEAVES_CONE, s)
    assert s.slides[:2].tolist() == [1, 1]


def test_gaps_at_ground_and_wall_are_closed():
    rng = np.random.default_rng(21)
    body, s = uneven(rng, Wall(0.5, 0.3)), memory()
    y = leaning(body, 0.15, 0.3)
    y[2] += 1e-4 - min(solid.gap(body, y, rotation(y)[2], i) for i in range(6))
    nearest = [solid.gap_of(body, y, rotation(y), solid.WALLS + k) for k in range(12)]
    wall = solid.WALLS + int(np.argmin(nearest))
    y[:2] -= (min(nearest) + 1e-4) * np.array(body.away[0])
    low = int(np.argmin([solid.gap(body, y, rotation(y)[2], i) for i in range(6)]))
    mode(s, low, wall)
    before = y.copy()
    gaps.close_gaps(body, y, rotation(y), s)
    for i in (low, wall):
        assert solid.gap_of(body, y, rotation(y), i) == pytest.approx(0, abs=1e-9)
    assert np.abs(y - before).max() < 3e-3
    # displaced as by a push at the contact: J⁻¹ (p × n) turns the body
    before, r = y.copy(), attitude(y)
    gaps.shift_at(body, y, rotation(y), wall, 1e-6)
    away = np.array([*body.away[0], 0.0])
    corner = np.array(body.corner[wall - solid.WALLS])
    turn = np.linalg.solve(body.inertia, np.cross(corner, r.T @ away)) * 1e-6
    assert y[:3] - before[:3] == pytest.approx(1e-6 * away, abs=1e-15)
    turned = r @ Rotation.from_rotvec(turn).as_matrix()
    assert attitude(y) == pytest.approx(turned, abs=1e-11)


def test_of_contacts_outside_of_a_set_the_one_that_approaches_fastest_is_missed():
    rng = np.random.default_rng(22)
    body, s = uneven(rng, Wall(2.0, 0.3)), memory()
    for _ in range(6):
        y = state(rng, body)
        set_down(y, body)
        rows, r = rotation(y), attitude(y)
        load, spin = rng.normal(size=(2, 3))
        s.which[:2] = 1, 4
        moves = (tuple(load), tuple(spin))
        for pushed in (False, True):
            speeds = {}
            for i in (0, 2, 3, 5):
                p, omega = point(body, i), y[10:13]
                u = load + np.cross(spin, p)
                if pushed:
                    u = u + np.cross(omega, np.cross(omega, p))
                leaves = (jacobian(y, p) @ y[7:13])[2] > limits.LEAVES
                speeds[i] = 0.0 if pushed and leaves else (r @ u)[2]
            fastest = min(speeds, key=speeds.get)
            expected = fastest if speeds[fastest] < -1e-9 else -1
            found = problem.missed(body, y, rows, 2, moves, 1e-9, pushed, s)
            assert found == expected
    s.after[:12] = 0.0
    s.after[[2, 5, 8, 11]] = 0.3, 0.2, 0.5, 0.4
    assert problem.least_needed(4, 0b0100, s) == 3
    assert problem.least_needed(4, 0b0101, s) == 3
    assert problem.least_needed(4, 0b1100, s) == 0
    assert problem.least_needed(4, 0b1111, s) == -1


def test_contacts_that_part_slowly_stay_closed_and_are_held():
    rng = np.random.default_rng(23)
    body, s = uneven(rng), shaken(rng)
    y = leaning(body, 0.2, 0.5)
    s.which[:3] = 1, 2, 4
    # it pushes and sticks; it leaves slowly and slides; it leaves
    s.after[:9] = 0.0, 0.0, 0.0, 0.6, -0.8, 0.5 * limits.CLOSE, 0.0, 0.0, 0.3
    hops.keep_slow_contacts(body, y, rotation(y), (0.0, 0.0, -G), 3, 0b001, True, s)
    # beside the one that pushes it hops, and sticks
    assert s.closed[: s.count].tolist() == [1, 2]
    assert s.slides[:2].tolist() == [case.STICKS, case.STICKS]
    hops.keep_slow_contacts(body, y, rotation(y), (0.0, 0.0, -G), 3, 0b101, True, s)
    assert s.closed[: s.count].tolist() == [1, 2, 4]
    assert s.slides[:3].tolist() == [case.STICKS, case.SLIDES, case.STICKS]
    assert s.rests == 0
    # not a hop beside one that slips, nor beside two that push
    s.after[:6] = 0.6, -0.8, 0.0, 0.0, 0.0, 1e-4
    gravity = (0.0, 0.0, -G)
    assert hops.hopping(body, y, rotation(y), gravity, 2, 0b01, s) == -1
    s.after[:2] = 0.0
    assert hops.hopping(body, y, rotation(y), gravity, 2, 0b11, s) == -1
    body, y = drum(), leaning(drum(), 0.2, 0.5)
    assert hops.hopping(body, y, rotation(y), gravity, 2, 0b01, s) == -1


@pytest.mark.parametrize("ratio", [0.0, 0.6])
def test_a_corner_leaves_a_smooth_wall_by_its_ratio(ratio):
    """By the impulse that stops its normal velocity (1 + e) times, and without a twist along the wall."""
    rng = np.random.default_rng(24)
    for _ in range(4):
        body, s = uneven(rng, Wall(2.0, 0.3, restitution=ratio)), shaken(rng)
        y = leaning(body, 0.3, 0.3)
        y[2] += 0.5
        away = np.array([*body.away[0], 0.0])
        gaps = [solid.gap_of(body, y, rotation(y), solid.WALLS + k) for k in range(12)]
        k = int(np.argmin(gaps))
        y[:2] -= gaps[k] * away[:2]
        y[7:13] = rng.normal(0, 0.3, 6)
        y[7:9] -= 2.0 * away[:2]
        row = away @ jacobian(y, np.array(body.corner[k]))
        before = y.copy()
        gives = row @ inverse_mass(body) @ row
        push = -(1 + ratio) * (row @ before[7:13]) / gives
        impacts.impact(body, y, tuple(s.field[:3]), 0, s)
        expected = before[7:13] + push * inverse_mass(body) @ row
        assert y[7:13] == pytest.approx(expected, abs=1e-9)
        assert s.impact[0] == pytest.approx(push)
        assert (s.hits[0], s.counters[limits.IMPACTS]) == (1.0, 1)
        assert s.closed[: s.count].tolist() == [solid.WALLS + k]
        assert s.slides[0] == case.SLIDES


def test_a_rattle_is_ended_that_lasts_no_longer_than_the_ground_is_weak():
    """Equation 19, with the moment that the strongest ground to come leaves."""
    rng = np.random.default_rng(25)
    body, s = uneven(rng), memory()
    s.soon[:] = 0.8, 0.5, 0.15
    rights = (G - 0.5) * body.nearest - 0.8 * body.height
    inertia = (
        max(body.inertia[0, 0], body.inertia[1, 1]) + body.height**2 + body.furthest**2
    )
    lasts = 0.15 * rights * body.nearest**2 / inertia
    most = min(lasts**2 / (2 * inertia), events.RATTLE * body.barrier)
    assert events.rattle_ends(body, 0.99 * most, s)
    assert not events.rattle_ends(body, 1.01 * most, s)
    for place, value in ((0, 1.01 * 0.5 * (G - 0.5)), (0, 50.0), (1, G)):
        s.soon[:2] = 0.8, 0.5
        s.soon[place] = value
        assert not events.rattle_ends(body, 1e-15, s)
    assert not events.rattle_ends(drum(), 1e-15, s)


def test_energy_noted_as_lost_keeps_what_was_gained_apart():
    out = np.zeros(outcome.OUTCOME)
    outcome.note_loss(0.3, out)
    outcome.note_loss(-0.1, out)
    assert out[[outcome.LOST, outcome.GAINED]] == pytest.approx([0.2, 0.1])


def test_the_walk_is_that_of_the_point_below_the_centre_of_mass():
    rng = np.random.default_rng(26)
    body = uneven(rng)
    y, out = state(rng, body), np.zeros(outcome.OUTCOME)
    outcome.note_walk(body, y, (0.1, -0.2), out)
    foot = y[:3] + attitude(y) @ [0, 0, -body.height]
    assert out[[outcome.WALK_X, outcome.WALK_Y]] == pytest.approx(
        foot[:2] - (0.1, -0.2)
    )


def test_a_history_keeps_state_turn_and_what_is_closed():
    rng = np.random.default_rng(27)
    body, s = uneven(rng), memory()
    y, out, history = state(rng, body), np.zeros(outcome.OUTCOME), np.zeros((2, 17))
    out[outcome.TURN] = 7.0
    before = outcome.heading(y)
    y = y.copy()
    w, z = y[3], y[6]
    # a turn about the vertical by 0.4
    c, d = math.cos(0.2), math.sin(0.2)
    q = np.array(
        [c * w - d * z, c * y[4] - d * y[5], c * y[5] + d * y[4], c * z + d * w]
    )
    y[3:7] = q
    mode(s, 3, 5)
    outcome.record(history, 1, y, before, out, s)
    assert history[1, :13] == pytest.approx(y[:13])
    assert history[1, 13:] == pytest.approx([7.4, 2, 3, 5])
    s.rests = 1
    outcome.record(history, 0, y, before, out, s)
    assert history[0, 14] == outcome.RESTS
    outcome.record(history, 2, y, before, out, s)


def test_a_small_wobble_lies_down_and_what_it_loses_is_told():
    body, s = drum(off=(0.0, 0.0)), memory()
    y = leaning(body, 1e-5, 0.4)
    mode(s, body.count)
    y[10:13] = 1e-4, 2e-4, 0.0
    gaps.settle(body, y, s)
    had = solid.energy(body, y, G)
    # of the motion that tilts it: (A ω² + v²)/2 and the lift of its rim
    part = 0.5 * body.inertia[0, 0] * (1e-8 + 4e-8) + 0.5 * y[9] ** 2
    part += G * body.rim * math.sin(1e-5)
    for small, lies in ((0.99 * part, False), (1.01 * max(part, had), True)):
        cut = small / (rim.LEAST_WOBBLE * body.barrier)
        lost = rim.small_rim(body, y, 0.0, cut, s)
        assert lost == pytest.approx(had if lies else 0.0, rel=1e-9)
        assert s.rests == lies
    assert y[7:13] == pytest.approx(0, abs=1e-15)
    assert y[2] == body.height


@pytest.mark.parametrize("way", [0.0, 2.0])
def test_a_small_wobble_that_slides_lies_down_and_slides_on(way):
    """Friction that cannot tip it: what tilts it goes, what carries it along stays, and brakes by µ g."""
    body, s = drum(off=(0.0, 0.0)), memory()
    body.kinetic = body.static = 0.1
    y = leaning(body, 1e-6, 0.4)
    mode(s, body.count, slides=case.SLIDES)
    speed = 0.5 * np.array([math.cos(way), math.sin(way)])
    s.direction[0] = speed / 0.5
    y[7:9], y[9:12] = speed, (1e-6, 2e-6, 3e-6)
    had = solid.energy(body, y, G)
    lost = rim.small_rim(body, y, 0.0, 1e-3, s)
    assert y[7:12] == pytest.approx((*speed, 0, 0, 0), abs=1e-9)
    assert lost == pytest.approx(had - solid.energy(body, y, G)) and lost > 0
    assert y[2] == body.height and points.lies_flat(body, y, rotation(y))
    assert s.jammed == 0 and s.rests == 0 and s.count > 0
    assert s.slides[: s.count].tolist() == [case.SLIDES] * s.count


def test_a_wobble_that_is_given_up_lies_flat_and_what_it_had_is_told():
    body, s = drum(off=(0.0, 0.0)), memory()
    y = leaning(body, 0.5 * whole.NEXT_TO_FLAT, 0.4)
    y[9:13] = 1e-3, 2e-3, 3e-3, 0.0
    mode(s, body.count)
    had = solid.energy(body, y, G)
    lost = whole.give_up(body, 0.0, y, s)
    assert y[7:13] == pytest.approx(0, abs=1e-12)
    assert points.lies_flat(body, y, rotation(y))
    assert lost == pytest.approx(had, rel=1e-9)
    assert s.counters[limits.UNSOLVED] == 1 and s.rests == 1


def box_at_wall(friction):
    """A box that leans against a wall towards +x, its foot an edge on the ground; and its state."""
    base = Polygon(((-0.2, -0.3), (0.2, -0.3), (0.2, 0.3), (-0.2, 0.3)))
    tensor = np.diag([0.3, 0.3, 0.1])
    made = RigidBody(1.0, tensor, (0.0, 0.0, 0.5), base, 1.0, base)
    tilt = math.atan2(0.2, 0.5) + 0.1
    c, s = math.cos(tilt), math.sin(tilt)
    foot, top = np.array([[c, s], [-s, c]]) @ np.array([[0.2, 0.2], [-0.5, 0.5]])
    # columns: the lower and the upper edge towards the wall
    low, high = (foot[0], top[0]), (foot[1], top[1])
    wall = Wall(high[0], 0.0, friction=friction)
    body = kernel_body(System((made,), (Contact(),), constraints=(wall,)))
    body["static"] = body["kinetic"] = 2.0
    y = leaning(plain(body), tilt, 0.0)
    y[2] = -low[1]
    return plain(body), y, np.array(low), np.array(high)


def test_a_box_that_leans_against_a_smooth_wall_is_held_by_the_moment_of_its_weight():
    """N h = m g a about its foot, as much along the ground, and the whole weight under it."""
    body, y, low, high = box_at_wall(0.0)
    s, rows = memory(), rotation(y)
    n, _ = modes.pick_closed(body, y, rows, limits.AT_REST, s)
    assert n == 4
    found, _ = modes.solve_forces(body, y, rows, (0.0, 0.0, -G), n, limits.AT_REST, s)
    assert found >= 0
    at_wall, at_ground = np.zeros(3), np.zeros(3)
    for k in range(n):
        push = s.impulse[3 * k : 3 * k + 3]
        if s.which[k] >= solid.WALLS:
            at_wall += push
        else:
            at_ground += push
    pressed = G * -low[0] / (high - low)[1]
    assert at_wall[2] == pytest.approx(pressed, rel=1e-6)
    assert at_ground == pytest.approx((pressed, 0.0, G), rel=1e-6, abs=1e-6)


def test_a_face_that_tips_as_it_slides_keeps_its_velocities_and_gains_nothing():
    body, s = drum(), shaken(np.random.default_rng(28))
    for sliding in (case.SLIDES, case.STICKS):
        y = upright(body, 0.3)
        y[7:9], y[12] = (0.3, -0.2), 0.5
        before, had = y.copy(), solid.balance(body, y, G)
        s.count, s.slides[:2] = 2, sliding
        s.closed[:2] = 0, 8
        rim.rim_instead_of_feet(body, y, tuple(s.field[:3]), s)
        assert s.closed[: s.count].tolist() == [body.count]
        assert s.slides[0] == sliding
        assert solid.balance(body, y, G) <= had + 1e-12
        towards = np.array(body.points[0])[:2] + np.array(body.points[8])[:2]
        towards -= 2 * np.array(body.centre)
        up = attitude(y)[2]
        way = -up[:2] / np.hypot(*up[:2])
        assert way == pytest.approx(towards / np.hypot(*towards), abs=1e-6)
        if sliding:
            assert y[7:13] == pytest.approx(before[7:13], rel=1e-5)
        else:
            p = np.array(solid.arm(body, tuple(up), body.count))
            assert jacobian(y, p) @ y[7:13] == pytest.approx(0, abs=1e-12)
    # three feet still carry
    s.count = 3
    s.closed[:3] = 0, 8, 16
    held = y.copy()
    rim.rim_instead_of_feet(body, held, tuple(s.field[:3]), s)
    assert (s.count, (held == y).all()) == (3, True)


def test_a_point_beside_an_edge_lands_where_the_turn_about_the_edge_takes_it():
    """Height of a point of a body that turns about an edge, by Rodrigues' rotation."""
    rng, found = np.random.default_rng(29), 0
    for _ in range(6):
        body, s = uneven(rng), shaken(rng)
        towards = math.atan2(*CORNERS[[3, 4]].mean(axis=0)[::-1])
        y = leaning(body, 0.02, towards)
        mode(s, 3, 4)
        gaps.close_gaps(body, y, rotation(y), s)
        e = point(body, 4) - point(body, 3)
        e /= np.linalg.norm(e)
        # back to the ground, a little past it at the end of the step
        y[10:13] = (
            -3.0 * e if np.cross(e, point(body, 0) - point(body, 3))[2] > 0 else 3 * e
        )
        contacts.anchor_all(body, y, s)
        gaps.settle(body, y, s)
        h = 0.01
        step.attempt(body, 0.0, h, y, s)

        def height(part, y=y, s=s, body=body, e=e):
            turned = sum(s.angle[k] * part**k for k in range(case.HINGE_ORDER + 1))
            r = attitude(y) @ Rotation.from_rotvec(turned * e).as_matrix()
            at = y[:3] + attitude(y) @ point(body, 3)
            return (at + r @ (point(body, 0) - point(body, 3)))[2]

        if height(1.0) > 0 or height(0.0) < 0:
            continue
        part = hinge.landing(body, y, 0, 0.9, 1e-5, s)
        assert height(part) == pytest.approx(-1e-5, abs=1e-8)
        found += 1
    assert found > 2


def test_the_error_of_a_turn_about_an_edge_is_the_last_term_of_its_velocity():
    rng = np.random.default_rng(34)
    for h in (0.01, 0.05):
        body, s = uneven(rng), shaken(rng)
        y = leaning(body, 0.1, math.atan2(*CORNERS[[3, 4]].mean(axis=0)[::-1]))
        mode(s, 3, 4)
        for _ in range(4):
            gaps.close_gaps(body, y, rotation(y), s)
        contacts.anchor_all(body, y, s)
        gaps.settle(body, y, s)
        error = step.attempt(body, 0.0, h, y, s)
        velocity = np.polynomial.Polynomial(s.angle).deriv() / h
        whole_one, short = velocity(1.0), velocity.cutdeg(velocity.degree() - 1)(1.0)
        assert velocity.degree() == case.HINGE_ORDER - 1
        assert error == pytest.approx(abs(whole_one - short), rel=1e-3)
        assert np.linalg.norm(s.new[10:13]) == pytest.approx(abs(whole_one))


def test_friction_of_a_flat_face_acts_at_the_mean_distance_of_its_points():
    """Two thirds of the radius of a disc, about its own centre."""
    body, s = drum(), memory()
    feet = [3 + 8 * k for k in range(4)]
    mode(s, *feet, slides=1)
    assert delassus.twist_of(body, s) == pytest.approx(2 / 3)
    mode(s, *feet[:2], slides=1)
    assert delassus.twist_of(body, s) == 1.0
    rng = np.random.default_rng(35)
    body = uneven(rng)
    mode(s, 0, 2, 4, slides=1)
    # even pressure, by points of the base drawn at random
    drawn = rng.uniform(-0.5, 0.5, (40_000, 2))
    ends = np.array([*OUTLINE, OUTLINE[0]])
    inside = np.ones(len(drawn), bool)
    for (x, y), (u, v) in itertools.pairwise(ends):
        inside &= (u - x) * (drawn[:, 1] - y) - (v - y) * (drawn[:, 0] - x) > 0
    middle = drawn[inside].mean(axis=0)
    mean = np.hypot(*(drawn[inside] - (0.03, -0.02)).T).mean()
    mine = np.hypot(*CORNERS[[0, 2, 4]].T).mean()
    assert np.hypot(*middle) < 0.1
    assert delassus.twist_of(body, s) * mine == pytest.approx(mean, rel=0.02)


@pytest.mark.parametrize(("part", "meets"), [(0.9, True), (1.2, False)])
@pytest.mark.parametrize("at", ["ground", "wall"])
def test_what_comes_near_and_parts_again_within_a_step_is_looked_at(at, part, meets):
    """A body that turns back at a constant acceleration comes nearer by u h/4 at most."""
    rng, speed, h = np.random.default_rng(36), 0.8, 0.02
    body, s = uneven(rng, Wall(1.0, 0.0)), memory()
    mode(s)
    corners = [solid.WALLS + k for k in range(body.corners)]
    y = leaning(body, 0.1, 0.3)
    rows = rotation(y)
    near = part * speed * h / 4
    if at == "ground":
        y[2] += near - min(solid.gap(body, y, rows[2], i) for i in range(6))
        y[9] = -speed
    else:
        y[2] += 1.0
        y[0] += min(solid.gap_of(body, y, rows, i) for i in corners) - near
        y[7] = speed
    s.new[:] = y
    s.new[7:10] *= -1
    assert step.dips(body, y, h, s) == meets
    # what only comes, or only goes, does not
    assert not step.dips(body, s.new.copy(), h, s)
    s.new[:] = y
    assert not step.dips(body, y, h, s)


def test_a_round_body_that_tips_at_once_balances_its_energy():
    """It begins under the ground of the first instant, which changes fast."""
    body = drum(off=(0.0, 0.0), radius=0.1)
    body.static = body.kinetic = 5.0
    motion = np.array([[9.0, 2.0, 0.0], [-50.0, 30.0, 60.0], [0.0, 0.0, 0.0]])
    y, s, out = upright(body), memory(), np.zeros(outcome.OUTCOME)
    history, peaks = np.zeros((3, 17)), np.zeros((3, 4))
    ground.fill_peaks(motion, peaks)
    whole.integrate(body, motion, peaks, 1.0, DT, G, 0, 1e-9, 1e-6, y, history, out, s)
    assert history[0, 14] == 1
    assert out[outcome.PEAK_TILT] > 1e-4
    # but for the tilt of 1e-7 with which it begins to roll
    tilt = rim.RIM_START * 0.1 * np.linalg.norm(motion[0] + (0.0, 0.0, G))
    assert out[outcome.ENERGY_BALANCE] == pytest.approx(0.0, abs=3 * tilt)


def test_the_error_of_a_step_about_a_contact_is_the_difference_of_the_pair():
    """Of what turns and what is integrated along, by SciPy's weights; twice of the attitude over the arm."""
    rng, h = np.random.default_rng(30), 0.02
    for name in ("vertex", "rim"):
        for _ in range(4):
            body = drum() if name == "rim" else uneven(rng)
            s, y = shaken(rng), leaning(body, 0.3, rng.uniform(0, 6))
            mode(s, body.count if name == "rim" else 2)
            y[10:13] = rng.normal(0, 2, 3)
            contacts.anchor_all(body, y, s)
            gaps.settle(body, y, s)

            def motion(time, x, body=body, s=s):
                rate, along, _ = pivot.turning_rates(body, time, tuple(x[:7]), s)
                return np.array([*rate, *along])

            start = np.array([*y[3:7], *y[10:13], 0.0, 0.0, 0.0])
            k = np.empty((7, 10))
            rk_step(
                motion, 0.0, start, motion(0.0, start), h, RK45.A, RK45.B, RK45.C, k
            )
            off = np.abs(h * (RK45.E @ k))
            p = np.linalg.norm(solid.arm(body, rotation(y)[2], s.closed[0]))
            worst = max(
                off[:4].max(), (off[4:7] / (1 + np.abs(y[10:13]))).max(), off[7:9].max()
            )
            step.begin(body, 0.0, y, s)
            found = step.attempt(body, 0.0, h, y, s)
            assert found == pytest.approx(worst * max(1, 2 * p), rel=1e-4)


@pytest.mark.parametrize("place", range(7))
def test_each_number_that_turns_has_its_part_in_the_error_of_a_step(place):
    """The attitude as it is, angular velocities over their size, both as far as the contact's arm takes them."""
    rng = np.random.default_rng(33)
    body, s = uneven(rng), memory()
    mode(s, 2)
    before, off = rng.normal(size=7), np.zeros(7)
    before[:4] /= np.linalg.norm(before[:4])
    off[place] = -0.7
    scale = 1.0 if place < 4 else 1.0 + abs(before[place])
    arm = max(1.0, 2 * np.linalg.norm(point(body, 2)))
    along = (0.0, 0.0, 9.0)
    found = pivot.error_of(body, tuple(before), tuple(off), along, s)
    assert found == pytest.approx(0.7 / scale * arm)
    # where the body goes counts too, its work does not
    for went in ((3.0, 0.0, 0.0), (0.0, -3.0, 0.0)):
        found = pivot.error_of(body, tuple(before), tuple(off), went, s)
        assert found == pytest.approx(3.0 * arm)


def test_both_ways_of_stopping_an_edge_share_its_impulse_alike():
    """In closed form about the edge, and as one set of all sets of cones."""
    rng, both = np.random.default_rng(31), 0
    for _ in range(30):
        body, s = uneven(rng), memory()
        body.static = body.kinetic = 2.0
        y = leaning(body, 0.1, 0.0)
        mode(s, 1, 2)
        for _ in range(4):
            gaps.close_gaps(body, y, rotation(y), s)
        y[7:13] = rng.normal(0, 0.5, 6)
        y[9] = -1.0
        s.which[:2] = 1, 2
        rows = rotation(y)
        momentum = stick.fill_velocities(body, y, rows, 2, s)
        problem.note_slips(body, 2, s)
        if stick.stick_alone_or_by_two(body, rows, 2, 0, momentum, s)[0] != 3:
            continue
        expected = np.array(s.impulse[:6])
        delassus.fill_delassus(body, rows, s.which, 2, s.delassus)
        problem.fill_edges(body, y, rows, s.which, 2, s)
        assert cones.solve_cones(s, 2, 0)[0] == 3
        assert s.impulse[:6] == pytest.approx(expected, abs=1e-8)
        both += 1
    assert both > 2
    # contacts of two surfaces have no edge that one could slide across
    s.edge[:] = 0.0
    cones.members(s, 2, 3)
    assert not cones.slide_one_end(s, 2, 1e-9)


def test_a_body_slides_on_its_face_while_the_centre_of_pressure_is_inside():
    """It is ahead of the centre of mass by the coefficient of friction times the height."""
    rng, kept = np.random.default_rng(32), set()
    for _ in range(16):
        body, s = uneven(rng), memory()
        # the principal axes upright, so that nothing else turns it
        body.inertia = np.diag(np.diag(body.inertia))
        body.inverse = np.linalg.inv(body.inertia)
        body.kinetic = body.static = rng.uniform(0.1, 0.9)
        y = upright(body)
        way = rng.uniform(0, 6)
        y[7:9] = math.cos(way), math.sin(way)
        ahead = body.kinetic * body.height * y[7:9]
        gravity = (0.0, 0.0, -G)
        load = rest.load_at_rest(body, y, rotation(y), gravity, s)
        stays = face.carried_flat(body, 0.0, y, rotation(y), load, s)
        for direction in s.direction[:4]:
            assert direction == pytest.approx(y[7:9])
        assert face.pressure_centre(body, s) == pytest.approx(ahead, abs=1e-9)
        along = np.roll(CORNERS, -1, axis=0) - CORNERS
        beside = ahead - CORNERS
        inside = (along[:, 0] * beside[:, 1] - along[:, 1] * beside[:, 0] > 0).all()
        assert stays == inside
        kept.add(bool(stays))
        if stays:
            assert modes.choose_mode(body, 0.0, y, s)
            assert (s.count, s.rests) == (4, 0)
            assert (s.slides[:4] == case.SLIDES).all()
    assert kept == {True, False}


def test_a_round_body_slides_on_its_face_while_friction_cannot_tip_it_over_the_rim():
    """The line of thrust meets the base within the rim whichever way it slides: µ h and the offset are below R."""
    for off in ((0.05, -0.03), (0.06, 0.0), (0.0, 0.06)):
        body, s = drum(off), memory()
        y = upright(body)
        y[7] = 1.0
        load = rest.load_at_rest(body, y, rotation(y), (0.0, 0.0, -G), s)
        for part in (0.99, 1.01):
            body.kinetic = (part * body.rim - math.hypot(*off)) / body.height
            stays = face.carried_flat(body, 0.0, y, rotation(y), load, s)
            assert stays == (part < 1)


@pytest.mark.parametrize("at_rest", [0, 40])
def test_a_box_that_is_shaken_along_its_side_rocks_as_housner_says(at_rest):
    """From any time at rest to the first impact; the history has a row for each sample, and those after."""
    half, height, dt = 0.2, 0.6, 0.02
    base = Polygon(((-half, -0.3), (half, -0.3), (half, 0.3), (-half, 0.3)))
    tensor = np.diag([0.36 + 1.44, 0.16 + 1.44, 0.16 + 0.36]) / 12
    made = RigidBody(1.0, tensor, (0.0, 0.0, height), base, 1.2, base)
    body = plain(kernel_body(System((made,), (Contact(),)), G))
    pulse = np.array([5.0, 6.0, 6.0, 4.0, 0.0, -2.0, -4.0, -2.0])
    motion = np.zeros((at_rest + pulse.size + 6, 3))
    motion[at_rest : at_rest + pulse.size, 0] = pulse
    peaks, history = np.zeros((len(motion), 4)), np.full((len(motion) + 9, 17), np.nan)
    ground.fill_peaks(motion, peaks)
    s, y, out = memory(), upright(body), np.zeros(outcome.OUTCOME)
    whole.integrate(body, motion, peaks, 1.0, dt, G, 5, 1e-8, 1e-6, y, history, out, s)
    radius, alpha = math.hypot(half, height), math.atan2(half, height)
    inertia = tensor[1, 1] + radius**2
    time = dt * np.arange(len(motion) + 1)
    pushed = np.append(motion[:, 0], 0.0)

    lifts = next(
        t for t in np.linspace(0, 9, 90001) if np.interp(t, time, pushed) >= G / 3
    )
    first = int(np.searchsorted(time, lifts, side="right"))
    # Housner's ratio of a solid box
    ratio = 1 - 1.5 * math.sin(alpha) ** 2
    known, start, spin, side = np.zeros(len(motion)), lifts, 0.0, 1.0
    while start < time[-2]:

        def housner(t, x, side=side):
            """About the edge that it stands on, by the ground's acceleration towards that."""
            off, a = alpha - x[0], side * np.interp(t, time, pushed)
            turn = radius * (a * math.cos(off) - G * math.sin(off)) / inertia
            return x[1], turn

        def lands(t, x, start=start):
            return x[0] + (t == start)

        lands.terminal, lands.direction = True, -1
        found = solve_ivp(
            housner, (start, time[-2]), (0, spin), "DOP853", events=lands,
            rtol=1e-11, atol=1e-13, dense_output=True, max_step=dt / 2,
        )  # fmt: skip
        inside = (time[:-1] > start) & (time[:-1] <= found.t[-1])
        known[inside] = side * found.sol(time[:-1][inside])[0]
        start, side = found.t[-1], -side
        spin = -ratio * found.y[1, -1]
    up = np.array([attitude(row)[2] for row in history[: len(motion)]])
    tilt = np.arctan2(up[:, 0], up[:, 2])
    assert tilt[:first] == pytest.approx(0, abs=1e-15)
    if at_rest:
        assert (history[:first, 14] == outcome.RESTS).all()
    assert tilt == pytest.approx(known * np.sign(tilt[first] * known[first]), abs=1e-6)
    assert {1.0, -1.0} <= set(np.sign(known))
    assert np.isfinite(history[:, 0]).sum() >= len(motion)
    assert out[outcome.STEPS] >= len(motion) - first
    assert out[outcome.PEAK_TILT] == pytest.approx(np.abs(known).max(), rel=0.02)
