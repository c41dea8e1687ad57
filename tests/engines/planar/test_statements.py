"""What the kernels say of a column in one state, beside Newton's and Euler's equations and plain geometry.

Kernels are called one by one, as plain Python. Motion at a contact is the change of a corner's place over the face
(or of an edge's under the base) as the bodies go on by their velocities and accelerations, by differences.
"""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import RK45, solve_ivp
from scipy.optimize import brentq

import rockfrag
import rockfrag.system

from ...mutants.plain import plain_library
from ...oracle import witness as other_witness
from ...oracle.standing import StandingBody, standing, turn
from .cases import G, random_column, with_contacts

with plain_library():
    from rockfrag.engines.planar import (
        bonds,
        carried,
        equations,
        holding,
        integrate,
        routh,
        solve,
        step,
        support,
        ties,
        walls,
        witness,
    )
    from rockfrag.engines.planar import impact as impacts
    from rockfrag.engines.planar.engine import VELOCITY_STEP
    from rockfrag.engines.planar.records import posed, system_record, working_memory
    from rockfrag.engines.planar.search import (
        NONE,
        SEEN,
        Trial,
        _change_to_neighbour,
        _try_anew,
        _try_slips,
        prepare,
        take_mode,
        try_mode,
    )
    from rockfrag.system import (
        BilinearIsolator,
        Block,
        Bond,
        Column,
        SlidingPendulum,
        Tie,
        Wall,
        as_system,
        hold,
    )
    from rockfrag.system.system import Start

H = 1e-4  # step of differences [s]
RIGHT, UP = 1.7, -0.8  # accelerations of the ground [m/s²]


def plain(record):
    """A record whose fields are attributes."""
    return np.array([record]).view(np.recarray)[0]


@dataclass
class State:
    """A column in some state and mode: its records and its bodies as they stand."""

    p: np.record
    w: np.record
    bodies: list[StandingBody]
    over: dict[tuple[int, int], bool]  # whether a corner is over its face

    @property
    def count(self) -> int:
        return len(self.bodies)

    @property
    def masses(self) -> np.ndarray:
        """Of each coordinate, shape (n, 3)."""
        return np.array([[b.mass, b.mass, b.inertia] for b in self.bodies])

    def closed(self) -> list[tuple[int, int]]:
        """Closed ends as (contact, end)."""
        ends = itertools.product(range(self.count), (0, 1))
        return [(k, end) for k, end in ends if self.w.closed[k, end]]

    def first(self, k: int) -> int:
        """First closed end of a contact."""
        return 0 if self.w.closed[k, 0] else 1


def rows(flat: np.ndarray, count: int) -> np.ndarray:
    """The coordinates of some bodies, shape (n, 3)."""
    return np.array(flat[: 3 * count]).reshape(count, 3)


def sight(state: State, q: np.ndarray, k: int, end: int) -> np.ndarray:
    """Place along and across the face (or the base, where the corner is beyond its edge), and axes and point."""
    body = state.bodies[k]
    corner = q[k, :2] + turn(q[k, 2]) @ body.corners[end]
    if k == 0:
        return np.array([*corner, 1.0, 0.0, 0.0, 1.0, *corner])
    below = state.bodies[k - 1]
    edge = q[k - 1, :2] + turn(q[k - 1, 2]) @ below.edges[end]
    over = state.over[k, end]
    angle = q[k - 1, 2] + below.face if over else q[k, 2] + body.base
    tangent, normal = turn(angle).T
    way = corner - edge
    return np.array(
        [way @ tangent, way @ normal, *tangent, *normal, *(corner if over else edge)]
    )


def rates(state: State, q, v, a, k: int, end: int) -> tuple[np.ndarray, np.ndarray]:
    """Rates of the places along and across, and the rates of these."""
    before, now, after = (
        sight(state, q + v * h + a * h * h / 2, k, end)[:2] for h in (-H, 0.0, H)
    )
    return (after - before) / (2 * H), (after - 2 * now + before) / H**2


def drawn(rng: np.random.Generator, impact: bool, stands: int) -> State:
    """Draw a column of which the lowest bodies stand, in a mode of which each contact that is shut stays level."""
    n = int(rng.integers(max(1, stands), 5))
    mus = rng.uniform(0.1, 1.0, n).tolist()
    column = random_column(rng, n)
    system = with_contacts(column, mus)
    p, w = plain(system_record(system, G)), plain(working_memory())
    bodies = standing(system)
    theta, omega = np.zeros(n), np.zeros(n)
    w.drive[:] = -1
    modes = []
    for k in range(n):
        ends = (
            3 if k < stands else int(rng.choice([0, 1, 2, 3], p=[0.15, 0.3, 0.3, 0.25]))
        )
        modes.append(ends)
        w.closed[k] = ends & 1, ends >> 1
        if ends and k >= stands:
            w.slides[k] = rng.choice([-1, 0, 1])
        below = (theta[k - 1], omega[k - 1]) if k else (0.0, 0.0)
        if ends == 3:
            theta[k], omega[k] = below
        else:
            side = {1: -1, 2: 1}.get(ends, rng.choice([-1, 1]))
            theta[k] = below[0] + side * rng.uniform(0.01, 0.3)
            omega[k] = rng.normal()
    flat, rate = posed(p, theta.tolist(), omega.tolist())
    q, v = rows(flat, n), rows(rate, n)
    # what slides has slid, some of it beyond the edge, and goes on; what is open is somewhere
    for k in range(stands, n):
        shift = rng.uniform(-0.1, 0.1, 2) * (w.slides[k] != 0 or modes[k] == 0)
        if k:
            shift[0] += 2.2 * p.half[k] * rng.choice([-1, 0, 1]) * (modes[k] in (1, 2))
            tangent = turn(q[k - 1, 2] + bodies[k - 1].face)[:, 0]
        else:
            tangent = np.array([1.0, 0.0])
        q[k:, :2] += shift[0] * tangent
        if modes[k] != 3:
            v[k, :2] += rng.normal(0, 0.5, 2)
    w.q[: 3 * n], w.v[: 3 * n] = q.ravel(), v.ravel()
    solve.look_at(p, w, w.q)
    over = {}
    for k in range(n):
        for end in (0, 1):
            w.kind[k, end] = solve.end_of(p, w, w.q, k, end, -1)[6]
            over[k, end] = bool(w.kind[k, end] == 1)
    if impact:
        w.v[: 3 * n] = rng.normal(0, 1, 3 * n)
    return State(p, w, bodies, over)


def pushed(state: State) -> np.ndarray:
    """Forces and moments of the contacts on each body, with those that the kernels have left, shape (n, 3)."""
    w, q = state.w, rows(state.w.q, state.count)
    total = np.zeros((state.count, 3))
    for k in range(state.count):
        for end in (0, 1):
            seen = sight(state, q, k, end)
            force = w.normal[k, end] * seen[4:6]
            if w.slides[k] != 0:
                # each end rubs by what it is pushed
                rubs = w.slides[k] * state.p.kinetic[k]
                force = force - rubs * w.normal[k, end] * seen[2:4]
            elif w.closed[k].any() and end == state.first(k):
                force = force + w.shear[k] * seen[2:4]
            for body, sign in ((k, 1), (k - 1, -1)):
                if body >= 0:
                    arm = seen[6:8] - q[body, :2]
                    # clockwise
                    moment = force[0] * arm[1] - force[1] * arm[0]
                    total[body] += sign * np.array([*force, moment])
    return total


def test_ends_are_where_geometry_has_them():
    rng, kinds = np.random.default_rng(1), set()
    for _ in range(40):
        state = drawn(rng, False, 0)
        p, w, n = state.p, state.w, state.count
        q, v, still = rows(w.q, n), rows(w.v, n), np.zeros((n, 3))
        for k in range(state.count):
            for end in (0, 1):
                x, y, tx, ty, gap, beyond, kind = solve.end_of(p, w, w.q, k, end, -1)
                _, across, *axes, px, py = sight(state, q, k, end)
                assert (x, y) == pytest.approx((px, py), abs=1e-12)
                assert (tx, ty, -ty, tx) == pytest.approx(axes, abs=1e-12)
                assert gap == pytest.approx(across, abs=1e-12)
                # the witness of impacts sees the same
                seen = witness._place(p, w.q, k, end)
                assert seen == pytest.approx((px, py, *axes[:2], across), abs=1e-12)
                found = [
                    solve.rate(p, w.q, w.v, k, x, y, dx, dy)
                    for dx, dy in ((tx, ty), (-ty, tx))
                ]
                assert found == pytest.approx(
                    rates(state, q, v, still, k, end)[0], abs=1e-5
                )
                kinds.add(kind)
                if k == 0:
                    assert beyond == -math.inf
                    continue
                state.over[k, end] = True
                reach = (2 * end - 1) * sight(state, q, k, end)[0]
                state.over[k, end] = bool(kind == 1)
                assert beyond == pytest.approx(reach, abs=1e-12)
                assert (kind == 1) == (beyond <= 1e-9 * p.size)
    assert kinds == {0, 1}


@pytest.mark.parametrize("stands", [0, 1, 2])
def test_a_motion_keeps_its_mode_and_obeys_newton_and_euler(stands):
    rng, seen = np.random.default_rng(2 + stands), set()
    for _ in range(60):
        state = drawn(rng, False, stands)
        p, w, n = state.p, state.w, state.count
        if not solve.solve_motion(p, w, w.q, w.v, RIGHT, UP):
            continue
        q, v, a = (rows(each, n) for each in (w.q, w.v, w.out))
        assert np.abs(a[:stands]).max(initial=0.0) < 1e-12
        net = state.masses * (a + np.array([RIGHT, UP + G, 0.0]))
        unit = np.abs(net).max()
        assert pushed(state) == pytest.approx(net, abs=1e-9 * unit)
        for k in range(n):
            if not w.closed[k].any():
                assert not w.normal[k].any() and w.shear[k] == 0.0
                continue
            seen.add(
                (
                    min(k, 1),
                    *w.closed[k].tolist(),
                    abs(int(w.slides[k])),
                    state.over[k, state.first(k)],
                )
            )
            for end in np.flatnonzero(w.closed[k]).tolist():
                _, (along, across) = rates(state, q, v, a, k, end)
                small = 1e-5 * (1 + np.abs(a).max() + np.square(v).max())
                assert abs(across) < small
                if w.slides[k] == 0 and end == state.first(k):
                    assert abs(along) < small
            if w.slides[k] != 0:
                rubs = -w.slides[k] * p.kinetic[k] * w.normal[k].sum()
                assert w.shear[k] == pytest.approx(rubs, abs=1e-9 * unit)
            assert not w.normal[k][w.closed[k] == 0].any()
    assert len(seen) >= 6


def test_an_impact_brings_about_what_is_asked_and_keeps_momentum():
    rng, laws = np.random.default_rng(5), set()
    for _ in range(120):
        state = drawn(rng, True, 0)
        p, w, n = state.p, state.w, state.count
        w.back[:n] = rng.uniform(0, 0.3, (n, 2)) * rng.integers(0, 2)
        driven, departs = None, 0.0
        for k in range(n):
            if w.closed[k].sum() != 1:
                continue
            law = rng.choice(["none", "place", "couple"])
            laws.add(law)
            if law == "place":
                w.fraction[k, state.first(k)] = rng.uniform(0.05, 0.4)
            if law == "couple" and driven is None:
                driven, departs = k, rng.uniform(0.1, 1.0)
                w.drive[k], w.depart[k] = 1 - state.first(k), departs
        if not solve.solve_impact(p, w):
            continue
        q, before, after = (rows(each, n) for each in (w.q, w.v, w.out))
        change = state.masses * (after - before)
        missing = change - pushed(state)
        unit = np.abs(change).max() + 1e-12
        if driven is not None:
            # a couple between two bodies: all else is explained
            couple = missing[driven, 2]
            missing[driven, 2] = 0.0
            if driven:
                assert missing[driven - 1, 2] == pytest.approx(-couple, abs=1e-9 * unit)
                missing[driven - 1, 2] = 0.0
        assert np.abs(missing).max() < 1e-9 * unit
        still = np.zeros((n, 3))
        for k in range(n):
            closed = np.flatnonzero(w.closed[k]).tolist()
            for end in closed:
                (along, across), _ = rates(state, q, after, still, k, end)
                assert across == pytest.approx(
                    w.back[k, end], abs=1e-6 * (1 + np.abs(after).max())
                )
                if w.slides[k] == 0 and end == closed[0]:
                    assert abs(along) < 1e-6 * (1 + np.abs(after).max())
            if k == driven:
                (_, across), _ = rates(state, q, after, still, k, int(w.drive[k]))
                assert across == pytest.approx(
                    departs, abs=1e-6 * (1 + np.abs(after).max())
                )
            if closed and w.slides[k] != 0:
                rubs = -w.slides[k] * p.kinetic[k] * w.normal[k].sum()
                assert w.shear[k] == pytest.approx(rubs, abs=1e-9 * unit)
            if len(closed) == 1:
                given, other = w.normal[k, closed[0]], w.normal[k, 1 - closed[0]]
                assert other == pytest.approx(
                    w.fraction[k, closed[0]] * given, abs=1e-9 * unit
                )
    assert laws == {"none", "place", "couple"}


def test_the_nearest_velocities_are_those_of_the_least_change_of_energy():
    rng, compared = np.random.default_rng(6), 0
    for _ in range(40):
        state = drawn(rng, True, 0)
        p, w, n = state.p, state.w, state.count
        wished = rng.normal(0, 1, w.v.size)
        wished[3 * n :] = 0.0
        if not solve.solve_nearest(p, w, wished):
            continue
        q, still = rows(w.q, n), np.zeros((n, 3))
        jacobian = []
        for k, end in state.closed():
            moved = [
                rates(state, q, unit.reshape(n, 3), still, k, end)[0]
                for unit in np.eye(3 * n)
            ]
            jacobian.append([each[1] for each in moved])
            if w.slides[k] == 0 and end == state.first(k):
                jacobian.append([each[0] for each in moved])
        expected = wished[: 3 * n].copy()
        if jacobian:
            j, inverse = np.array(jacobian), 1 / state.masses.ravel()
            push = np.linalg.solve(j * inverse @ j.T, j @ expected)
            expected -= inverse * (j.T @ push)
        assert w.out[: 3 * n] == pytest.approx(expected, abs=1e-5)
        compared += 1
    assert compared > 30


def test_margins_of_a_trial_are_forces_and_motions_over_their_units():
    """A mode is as far from consistent as its worst force, friction or motion is, by the plain solution."""
    rng, what = np.random.default_rng(7), set()
    for _ in range(50):
        state = drawn(rng, False, 0)
        p, w, n = state.p, state.w, state.count
        w.touching[:n] = w.closed[:n]
        for k in range(n):
            if w.closed[k].any():
                w.touching[k] = 1 if w.closed[k].all() else w.touching[k]
        w.moves[:n] = w.slides[:n]
        w.along[:n] = w.against[:n] = p.static[:n]
        prepare(p, w, Trial(RIGHT, UP, False, p.weight, G))
        found = try_mode(p, w, Trial(RIGHT, UP, False, p.weight, G))
        if not math.isfinite(found) or not solve.solve_motion(
            p, w, w.q, w.v, RIGHT, UP
        ):
            continue
        margins = [math.inf]
        for k, end in state.closed():
            stiff = max(1.0, p.kinetic[k]) if w.slides[k] else 1.0
            margins.append(stiff * w.normal[k, end] / p.weight)
        for k in range(n):
            if w.closed[k].any() and w.slides[k] == 0:
                left = p.static[k] * w.normal[k].sum() - abs(w.shear[k])
                margins.append(left / (max(1.0, p.static[k]) * p.weight))
        assert found == pytest.approx(
            min(margins), abs=1e-9 * max(1.0, abs(min(margins)))
        )
        if math.isfinite(found):
            what.add(int(w.flip[1]))
    assert what == {0, 1, 2}


def moving(rng: np.random.Generator) -> State:
    """Draw a column whose closed ends neither part nor approach, and some of which slide."""
    while True:
        state = drawn(rng, False, 0)
        w = state.w
        if w.slides.any() and solve.solve_nearest(state.p, w, w.v):
            w.v = w.out
            return state


def motion_of(state: State, y: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Rates of coordinates and velocities of a state."""
    p, w, size = state.p, state.w, 3 * state.count
    q, v = np.zeros(w.q.size), np.zeros(w.q.size)
    q[:size], v[:size] = y[:size], y[size:]
    solve.look_at(p, w, q)
    solve.solve_motion(p, w, q, v, *ground)
    return np.concatenate([y[size:], w.out[:size]])


def test_a_step_is_that_of_dormand_and_prince_and_its_books_close():
    rng, rise = np.random.default_rng(8), np.array([150.0, -100.0])
    for _ in range(3):
        state = moving(rng)
        p, w, n = state.p, state.w, state.count
        size, h = 3 * n, 2e-3
        q, v = w.q.copy(), w.v.copy()
        start = np.concatenate([q[:size], v[:size]])
        rates = []
        for c, row in zip(RK45.C, RK45.A, strict=True):
            y = start + h * sum((a * k for a, k in zip(row, rates, strict=False)), 0.0)
            rates.append(motion_of(state, y, (RIGHT, UP) + c * h * rise))
        end = start + h * (RK45.B @ rates)
        rates.append(motion_of(state, end, (RIGHT, UP) + h * rise))
        off = np.abs(h * (RK45.E @ rates))[size:].reshape(n, 3) * (1, 1, p.size)
        w.q, w.v, w.a[:size] = q, v, rates[0][size:]
        solve.look_at(p, w, w.q)
        step.start_step(p, w)
        stretch = step.Stretch(h, RIGHT, UP, *h * rise)
        work, lost, tied = step.take_step(p, w, stretch, True)
        found = np.concatenate([w.q1[:size], w.v1[:size]])
        assert found == pytest.approx(end, abs=1e-12 * np.abs(end).max())
        assert w.a1[:size] == pytest.approx(rates[-1][size:], rel=1e-9, abs=1e-9)
        assert step.step_error(p, w, h) == pytest.approx(off.max() / p.speed, rel=1e-4)

        def energy(y, state=state, n=n):
            q, v = y.reshape(2, n, 3)
            motion = (state.masses * v * v).sum() / 2
            return motion + G * (state.masses[:, 1] * q[:, 1]).sum()

        gained = energy(end) - energy(start)
        assert gained == pytest.approx(work - lost - tied, rel=1e-6, abs=1e-9)
        assert tied == 0.0 != lost
        ahead = step.ground_at(step.beginning(stretch, 0.25), 0.4)
        assert ahead == pytest.approx((RIGHT, UP) + 0.1 * h * rise)


def test_margins_of_a_motion_are_gaps_forces_slips_and_turns_over_their_units():
    rng, seen = np.random.default_rng(14), set()
    for _ in range(60):
        state = drawn(rng, False, 0)
        p, w, n = state.p, state.w, state.count
        if not solve.solve_motion(p, w, w.q, w.v, RIGHT, UP):
            continue
        q, v, still = rows(w.q, n), rows(w.v, n), np.zeros((n, 3))
        margins, forces = [], []
        for k in range(n):
            for end in (0, 1):
                seen_there = sight(state, q, k, end)
                beyond = solve.end_of(p, w, w.q, k, end, -1)[5]
                if not w.closed[k, end]:
                    margins.append((step.GAP + end, k, seen_there[1] / p.size))
                    if k and beyond < -2 * p.half[k]:
                        margins.append((None, k, (2 * p.half[k] + beyond) / p.size))
                    continue
                stiff = max(1.0, p.kinetic[k]) if w.slides[k] else 1.0
                forces.append((step.GAP + end, k, stiff * w.normal[k, end] / p.weight))
                if k and w.slides[k]:
                    inside = (-1) ** (not state.over[k, end]) * (1e-9 - beyond / p.size)
                    margins.append((step.EDGE + end, k, inside))
            closed = w.closed[k].any()
            if closed and w.slides[k]:
                slip = rates(state, q, v, still, k, state.first(k))[0][0]
                margins.append((step.FRICTION, k, w.slides[k] * slip / p.speed))
            elif closed:
                left = p.static[k] * w.normal[k].sum() - abs(w.shear[k])
                left /= p.weight * max(p.static[k], 1.0)
                forces.append((step.FRICTION, k, left))
            turned = [abs(q[k, 2])] + [abs(q[k, 2] - q[k - 1, 2])] * (k > 0)
            margins.append((step.FALL, k, math.pi / 2 - max(turned)))
        for with_forces, listed in ((False, margins), (True, margins + forces)):
            found = step.least_margin(p, w, w.q, w.v, with_forces)
            assert found == pytest.approx(min(each[2] for each in listed), abs=1e-6)
            for channel, k, margin in listed:
                if channel is None or abs(margin) < 1e-6:
                    continue
                if channel != step.FALL:
                    assert w.fails[k, channel] == (margin < 0)
                    seen.add((channel, margin < 0))
        assert step.force_fails(p, w) == any(each[2] < 0 for each in forces)
    # forces and slips of either sign, gaps of one that is open, corners on their side of an edge
    assert len(seen) == 8


def test_a_stretch_of_time_is_cut_in_two():
    """Its ground is linear over it; the second part begins where the first one ends."""
    whole = step.Stretch(0.04, 1.5, -0.5, 2.0, 3.0)
    first, rest = step.beginning(whole, 0.3), step.rest_of(whole, 0.3)
    assert first == pytest.approx((0.012, 1.5, -0.5, 0.6, 0.9))
    assert rest == pytest.approx((0.028, 2.1, 0.4, 1.4, 2.1))
    assert step.ground_at(first, 1.0) == pytest.approx((rest.ah, rest.av))


def test_what_slides_off_its_face_or_turns_too_far_falls():
    stack = Column((Block(0.4, 0.2, 30.0), Block(0.3, 0.6, 20.0)))
    p = plain(system_record(as_system(stack), G))
    for shift in (0.0, 0.34, 0.36, -0.34, -0.36):
        w = plain(working_memory())
        w.q, w.closed[:2], w.slides[1] = p.standing, 1, 1
        w.q[3] += shift
        solve.look_at(p, w, w.q)
        for k, end in itertools.product((0, 1), (0, 1)):
            w.kind[k, end] = solve.end_of(p, w, w.q, k, end, -1)[6]
        step.least_margin(p, w, w.q, w.v, False)
        gone = abs(shift) > 0.35
        assert step.off_the_edge(p, w, w.q, 1) == gone
        assert w.fails[1, step.FALL] == gone
        # where both corners were over the face, the one that has passed its edge is looked at anew
        w.kind[1] = solve.CORNER
        step.least_margin(p, w, w.q, w.v, False)
        assert w.fails[1, [step.EDGE, step.EDGE + 1]].tolist() == [shift < 0, shift > 0]
        w.slides[1] = 0
        step.least_margin(p, w, w.q, w.v, False)
        assert w.fails[1, step.FALL] == 0


def test_a_gap_that_narrows_and_widens_again_is_looked_at():
    rng, seen = np.random.default_rng(15), set()
    for _ in range(40):
        state = drawn(rng, False, 0)
        p, w, n = state.p, state.w, state.count
        q, v, still = rows(w.q, n), rows(w.v, n), np.zeros((n, 3))
        step.start_step(p, w)
        w.q1, w.v1 = w.q, w.v * rng.choice([-1.0, 1.0], w.v.size)
        later, expected = rows(w.v1, n), False
        for k, end in itertools.product(range(n), (0, 1)):
            if not w.closed[k, end]:
                before, after = (
                    rates(state, q, each, still, k, end)[0][1] for each in (v, later)
                )
                assert w.early[k, end] == pytest.approx(before, abs=1e-6)
                expected = expected or (before < 0 < after)
            else:
                assert w.early[k, end] == 0.0
        assert step.comes_near(p, w, 0.01) == expected
        seen.add(expected)
    assert seen == {False, True}


def test_a_body_that_turns_back_before_a_wall_is_looked_at_if_it_may_have_come_so_far():
    block = as_system(Block(0.4, 1.0, 80.0))
    for side, away, later in itertools.product((1, -1), (0.01, 0.03), (1.0, 0.0, -1.0)):
        wall = Wall(0.2 + away, 0.0 if side > 0 else math.pi)
        p, w = plain(system_record(hold(block, wall), G)), plain(working_memory())
        w.q[:3], w.v[0], w.drive[:] = (0.0, 0.6, 0.0), side, -1
        solve.look_at(p, w, w.q)
        step.start_step(p, w)
        w.q1, w.v1[0] = w.q, -side * later
        # it moves at 1 m/s for 0.02 s at most
        assert step.comes_near(p, w, 0.02) == (away < 0.02 and later > 0)


def test_the_first_failure_of_a_flight_is_where_a_corner_comes_down():
    """A body that is thrown up: the gap of its lower corner is a parabola and a sine."""
    block = Block(0.4, 1.0, 80.0)
    p, w = plain(system_record(as_system(block), G)), plain(working_memory())
    w.q0[:3], w.v0[:3] = (0.0, 0.56, 0.0), (0.0, 0.2, 1.5)
    w.a0[:3] = w.a1[:3] = 0.0, -G, 0.0
    h = 0.16
    w.q1[:3] = w.q0[:3] + h * w.v0[:3] + h * h / 2 * w.a0[:3]
    w.v1[:3] = w.v0[:3] + h * w.a0[:3]

    def gap(t):
        theta = 1.5 * t
        return (
            0.56
            + 0.2 * t
            - G * t * t / 2
            - 0.5 * math.cos(theta)
            - 0.2 * math.sin(theta)
        )

    expected = brentq(gap, 0.0, h, xtol=1e-15)
    stretch = step.Stretch(h, 0.0, 0.0, 0.0, 0.0)
    at_end = step.margin_at(p, w, 1.0, stretch, True)
    assert at_end == pytest.approx(gap(h) / p.size)
    found = step.first_failure(p, w, (1.0, at_end, False), stretch)
    assert found * h == pytest.approx(expected, abs=1e-12)
    assert w.fails[0].tolist() == [0, 1, 0, 0, 0, 0, 0]


def test_between_the_ends_of_a_step_all_lies_on_the_quintic_of_both_ends():
    rng = np.random.default_rng(9)
    state = drawn(rng, False, 0)
    p, w, n = state.p, state.w, state.count
    h = 0.3
    curve = np.polynomial.Polynomial
    each = [curve(rng.normal(0, 1, 6)) for _ in range(3 * n)]
    for ends, at in (("0", 0.0), ("1", h)):
        for name, order in (("q", 0), ("v", 1), ("a", 2)):
            w[name + ends][: 3 * n] = [
                c.deriv(order)(at) if order else c(at) for c in each
            ]
    for tau in (0.0, 0.3, 0.8, 1.0):
        step.margin_at(p, w, tau, step.Stretch(h, 0.0, 0.0, 0.0, 0.0), False)
        assert w.q[: 3 * n] == pytest.approx([c(tau * h) for c in each], abs=1e-11)
        assert w.v[: 3 * n] == pytest.approx(
            [c.deriv()(tau * h) for c in each], abs=1e-11
        )


def test_pads_bear_what_the_ends_of_their_contact_bear_and_break_where_one_is_overloaded():
    """The same force and moment about the middle; N/2 ± M/(2 c)."""
    rng = np.random.default_rng(10)
    for _ in range(20):
        state = drawn(rng, False, 2)
        p, w, k = state.p, state.w, 1
        w.whole[k], p.is_bonded[k], p.bond_spread[k] = 1, 1, rng.uniform(0.05, 0.3)
        p.bond_tension[k], p.bond_shear[k] = rng.uniform(10, 500, 2)
        w.normal[k], w.shear[k] = rng.normal(0, 300, 2), rng.normal(0, 300)
        left, right = bonds.pad_forces(p, w, k)
        width = np.linalg.norm(np.subtract(*state.bodies[k].corners))
        assert left + right == pytest.approx(w.normal[k].sum())
        moment = (w.normal[k, 1] - w.normal[k, 0]) * width / 2
        assert (right - left) * p.bond_spread[k] == pytest.approx(moment)
        assert bonds.pad_force(p, w, k) == min(left, right)
        holds = p.bond_shear[k] + p.static[k] * (left + right) - abs(w.shear[k])
        least = min(p.bond_tension[k] + min(left, right), holds)
        assert bonds.bond_margin(p, w, k) == pytest.approx(least / p.weight, abs=1e-11)
        bonds.fill_rest_margins(p, w, k, 0)
        rest = w.rest[4 * k : 4 * k + 4, 0]
        assert rest.min() == pytest.approx(least / p.weight, abs=1e-11)
        assert rest[1] - rest[0] == pytest.approx((right - left) / p.weight)
        assert rest[3] - rest[2] == pytest.approx(2 * w.shear[k] / p.weight)
        # twice what one pad bears
        at = p.bond_number[k] = 3
        bonds.note_loads(p, w)
        needed = max(0.0, -2 * min(left, right))
        assert w.outcome.largest_force[at] == pytest.approx(needed)


ANCHORS = ((0.9, 0.5, 1.4), (-0.7, 0.2, 0.2))


def tied(rng: np.random.Generator, bracket: bool):
    """A block that is tied to two anchors, somewhere in flight."""
    block = Block(0.4, 1.0, 80.0)
    made = [
        Tie(
            (0.1, 0.0, 0.9),
            (x, 0.0, z),
            4e3,
            damping=60.0,
            slack=0.05,
            strength=900.0,
            bracket=bracket,
        )
        for x, _, z in ANCHORS
    ]
    system = hold(as_system(block), *made)
    p, w = plain(system_record(system, G)), plain(working_memory())
    w.q[:3] = np.array([0.0, 0.5, 0.0]) + rng.normal(0, 0.1, 3)
    w.v[:3] = rng.normal(0, 1.0, 3)
    solve.look_at(p, w, w.q)
    return p, w


@pytest.mark.parametrize("bracket", [False, True])
def test_ties_pull_from_their_knot_to_their_anchor_by_stretch_and_rate(bracket):
    rng, changes = np.random.default_rng(11), set()
    for _ in range(40):
        p, w = tied(rng, bracket)
        q, v = w.q[:3].copy(), w.v[:3].copy()
        expected, taken = np.zeros(3), 0.0
        w.taut[:2] = rng.choice(
            [ties.SLACK, ties.TAUT, ties.BROKEN] + [ties.PUSHED] * bracket, 2
        )
        for t, (ax, _, az) in enumerate(ANCHORS):

            def way(h, q=q, v=v, ax=ax, az=az):
                at = q + h * v
                knot = at[:2] + turn(at[2]) @ (0.1, 0.4)
                return np.array([ax, az]) - knot

            length = np.linalg.norm(way(0.0))
            speed = (np.linalg.norm(way(H)) - np.linalg.norm(way(-H))) / (2 * H)
            start = math.dist((0.1, 0.9), (ax, az))
            natural = {ties.TAUT: start + 0.05, ties.PUSHED: start - 0.05}.get(
                int(w.taut[t])
            )
            force = 0.0
            if natural is not None:
                force = 4e3 * (length - natural) + 60.0 * speed
            found, rate = ties.tension(p, w, w.q, w.v, t)
            assert found == pytest.approx(force, abs=1e-4)
            assert rate == pytest.approx(speed, abs=1e-6)
            unit, arm = way(0.0) / length, turn(q[2]) @ (0.1, 0.4)
            expected += force * np.array([*unit, unit[0] * arm[1] - unit[1] * arm[0]])
            taken += force * speed
        ties.fill_tie_accelerations(p, w, w.q, w.v)
        masses = 1 / np.array(p.inverse[:3])
        assert w.drift[:3] * masses == pytest.approx(expected, abs=1e-3)
        assert ties.power(p, w, w.q, w.v) == pytest.approx(taken, abs=1e-3)
        # what the ties take is what they do not give to the bodies
        assert ties.power(p, w, w.q, w.v) == pytest.approx(
            -(w.drift[:3] * masses) @ v, abs=1e-9
        )
        states = w.taut[:2].copy()
        forces = [ties.tension(p, w, w.q, w.v, t)[0] for t in (0, 1)]
        ties.least_tie_margin(p, w, w.q, w.v)
        fails = w.tie_fails[:2].copy()
        ties.change_ties(p, w, 3.0)
        for t in (0, 1):
            before, after = int(states[t]), int(w.taut[t])
            changes.add((before, after))
            length = ties._stretched(p, w, w.q, w.v, t)[4]
            if before == ties.SLACK:
                # taut where it is longer than its slack lets it and would pull, and likewise shorter
                now = []
                for state in (ties.TAUT, *[ties.PUSHED] * bracket):
                    w.taut[t] = state
                    natural = p.tie_long[t] if state == ties.TAUT else p.tie_short[t]
                    force = ties.tension(p, w, w.q, w.v, t)[0]
                    if state * (length - natural) > 1e-9 and state * force > 1e-9:
                        now.append(state)
                assert [after] == (now or [ties.SLACK])
                assert bool(fails[t]) == bool(now)
            elif before == ties.BROKEN:
                assert after == ties.BROKEN
            else:
                expected_state = before
                if before * forces[t] < -1e-9:
                    expected_state = ties.SLACK
                if abs(forces[t]) > 900.0:
                    expected_state = (
                        ties.BROKEN
                        if before * forces[t] > 0 or abs(forces[t]) >= 900
                        else before
                    )
                assert after == expected_state
    assert len(changes) >= 6 + bracket


def test_a_tie_moves_the_body_that_it_holds_and_no_other():
    """Two bodies in flight: both fall, and one is drawn towards the anchor."""
    stack = Column((Block(0.4, 0.3, 30.0), Block(0.3, 0.6, 20.0)))
    tie = Tie((0.0, 0.0, 0.6), (2.0, 0.0, 0.9), 500.0, slack=0.02)
    p = plain(system_record(hold(as_system(stack), tie), G))
    w = plain(working_memory())
    w.q, w.drive[:] = p.standing, -1
    w.q[3] -= 0.1
    w.taut[0] = ties.TAUT
    solve.look_at(p, w, w.q)
    assert solve.solve_motion(p, w, w.q, w.v, 0.0, 0.0)
    force = 500.0 * 0.08
    expected = [[0.0, -G, 0.0], [force / 20.0, -G, force * 0.3 / p.inertia[1]]]
    assert rows(w.out, 2) == pytest.approx(np.array(expected))


def held_margins(p, w, forces=True):
    """Least margin of a state of what is held, and the flags of its contacts."""
    solve.look_at(p, w, w.q)
    return step.least_margin(p, w, w.q, w.v, forces), w.fails.copy()


def test_what_holds_a_body_has_margins_of_its_own():
    block = as_system(Block(0.4, 1.0, 80.0))
    bond = Bond(100.0, 1e9, 0.1)
    p, w = plain(system_record(hold(block, bonds=bond), G)), plain(working_memory())
    w.q, w.closed[0], w.kind[:], w.whole[0] = p.standing, 1, 1, 1
    solve.look_at(p, w, w.q)
    for left, holds in ((-45.0, True), (-55.0, False)):
        # both pads at half of the ends' distance from the middle
        w.normal[0] = 100.0 + left / 2, 300.0 - left / 2
        assert min(bonds.pad_forces(p, w, 0)) == pytest.approx(left)
        least, fails = held_margins(p, w)
        assert (least > 0) == holds
        assert fails[0, step.BREAK] == (not holds)
        assert step.force_fails(p, w) == (not holds)
        assert held_margins(p, w, forces=False)[0] > 0
    # a tie that is as long as it may be, beside a contact that is far from failing
    tie = Tie((0.0, 0.0, 1.0), (1.0, 0.0, 1.0), 1e4, slack=0.01)
    p, w = plain(system_record(hold(block, tie), G)), plain(working_memory())
    for aside, slack in ((-0.005, True), (-0.015, False)):
        w.q, w.closed[0], w.kind[:] = p.standing, 1, 1
        w.q[0] += aside
        w.normal[0] = 400.0
        least, _ = held_margins(p, w)
        assert (least > 0) == slack
        longer = -0.01 - aside
        expected = max(-longer / p.size, -1e4 * longer / p.weight)
        assert least == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("side", [1, -1])
def test_a_body_passes_a_kerb_once_its_whole_side_is_above_it_and_beyond(side):
    kerb = Wall(0.3, 0.0 if side > 0 else math.pi, 0.2)
    block = as_system(Block(0.4, 1.0, 80.0))
    p, w = plain(system_record(hold(block, kerb), G)), plain(working_memory())
    for up, aside, above, over in (
        *(
            (0.1, 0.05, False, False),
            (0.25, 0.05, True, False),
            (0.25, 0.15, True, True),
        ),
    ):
        w.q, w.closed[:], w.kind[:] = p.standing, 0, 1
        w.q[:2] += side * aside, up
        _, fails = held_margins(p, w)
        assert walls.is_above(p, w, w.q, 1) == above
        assert walls.climbs(p, w, w.q, 1) == over
        assert fails[1, step.FALL] == over
        assert fails[1, step.BREAK] == 0
        # what rested on its edge has left it
        w.closed[1, 1 if side > 0 else 0] = 1
        assert held_margins(p, w)[1][1, step.BREAK] == above


@pytest.mark.parametrize(("early", "late"), [(1, 1), (1, -1), (-1, 1), (-1, -1)])
@pytest.mark.parametrize("bracket", [False, True])
@pytest.mark.parametrize("near", [-0.04, 0.0, 0.04])
def test_a_slack_tie_that_turns_back_near_its_length_is_looked_at(
    early, late, bracket, near
):
    """Its slack is 0.05 m to either side; it may move by 0.02 m in the step."""
    block = Block(0.4, 1.0, 80.0)
    tie = Tie((0.0, 0.0, 0.5), (2.0, 0.0, 0.5), 4e3, slack=0.05, bracket=bracket)
    p = plain(system_record(hold(as_system(block), tie), G))
    w = plain(working_memory())
    w.q[:3], w.v[:3] = (-near, 0.5, 0.0), (-early, 0.0, 0.0)
    solve.look_at(p, w, w.q)
    w.a[:] = 0.0
    step.start_step(p, w)
    w.q1, w.v1[:3] = w.q, (-late, 0.0, 0.0)
    may = near > 0 or (bracket and near < 0)
    assert ties.turns_back(p, w, 0.02) == (may and early != late)
    # its ends on the ground neither part nor come closer
    assert step.comes_near(p, w, 0.02) == (may and early != late)


def test_a_low_wall_is_met_by_a_corner_below_its_top_and_by_its_edge_above():
    """Gaps by geometry, whatever the side of the wall, and none once the whole side is above its top."""
    rng, kinds = np.random.default_rng(12), set()
    block = Block(0.4, 1.0, 80.0, lean=0.1)
    for _ in range(60):
        side, top = float(rng.choice([-1.0, 1.0])), float(rng.choice([math.inf, 0.6]))
        wall = Wall(0.5, 0.0 if side > 0 else math.pi, top)
        p = plain(system_record(hold(as_system(block), wall), G))
        w = plain(working_memory())
        w.q[:3] = rng.normal(0, 0.1), 0.5 + rng.uniform(0, 0.3), rng.normal(0, 0.4)
        solve.look_at(p, w, w.q)
        q, x_wall = w.q[:3], 0.5 * side
        ends = tuple(q[:2] + turn(q[2]) @ p.edge[1, end] for end in (0, 1))
        lower, upper = ends if side > 0 else ends[::-1]
        # the side leans with its block
        assert abs(np.subtract(*p.edge[1])[0]) > 0.05
        for end, corner in enumerate(ends):
            x, y, tx, ty, gap, beyond, kind = solve.end_of(p, w, w.q, 1, end, -1)
            normal = np.array([-ty, tx])
            is_upper = corner is upper
            if lower[1] > top:
                assert gap == math.inf
                continue
            if (
                not is_upper
                or top == math.inf
                or (upper[1] <= top and side * (x_wall - upper[0]) > -1e-9)
            ):
                assert kind == 1
                assert (x, y) == pytest.approx(corner)
                assert normal == pytest.approx((-side, 0.0))
                assert gap == pytest.approx(side * (x_wall - corner[0]))
            elif kind == 0:
                # the edge's distance from the line of the side
                flank = (upper - lower) / np.linalg.norm(upper - lower)
                outwards = side * np.array([flank[1], -flank[0]])
                assert (x, y) == pytest.approx((x_wall, top))
                assert normal == pytest.approx(-outwards)
                assert gap == pytest.approx(
                    outwards @ (np.array([x_wall, top]) - lower)
                )
                over = max(upper[1] - top, side * (upper[0] - x_wall))
                assert beyond == pytest.approx(over)
            kinds.add((side, int(kind)))
            assert walls.is_above(p, w, w.q, 1) == (lower[1] > top)
    assert kinds == {(s, k) for s in (-1.0, 1.0) for k in (0, 1)}


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("slides", [(1, 1), (-1, 1), (1, -1), (0, 1), (-1, 0)])
def test_what_leans_at_a_wall_is_pushed_there_and_at_its_foot(side, slides):
    """Newton's and Euler's equations of a leaning block, and friction where it slides."""
    block = as_system(Block(0.4, 1.0, 80.0))
    wall = Wall(5.0, 0.0 if side > 0 else math.pi, friction=(0.3, 0.3))
    p, w = plain(system_record(hold(block, wall), G)), plain(working_memory())
    p.static[0] = p.kinetic[0] = 0.5
    flat, _ = posed(p, [side * 0.3], [0.0])
    w.q, w.drive[:], w.kind[:] = flat, -1, 1
    foot, top = (1, 1) if side > 0 else (0, 0)
    w.closed[0, foot] = w.closed[1, top] = 1
    w.slides[:2] = slides
    solve.look_at(p, w, w.q)
    q = w.q[:3]
    points = [
        q[:2] + turn(q[2]) @ corner for corner in (p.corner[0, foot], p.edge[1, top])
    ]
    p.wall_x[1] = points[1][0]
    assert solve.solve_motion(p, w, w.q, w.v, RIGHT, UP)
    normals = np.array([(0.0, 1.0), (-side, 0.0)])
    tangents = np.array([(1.0, 0.0), (0.0, side)])
    a, net = w.out[:3], np.zeros(3)
    for k, end in ((0, foot), (1, top)):
        force = w.normal[k, end] * normals[k] + w.shear[k] * tangents[k]
        arm = points[k] - q[:2]
        net += (*force, force[0] * arm[1] - force[1] * arm[0])
        at = a[:2] + a[2] * np.array([arm[1], -arm[0]])
        assert at @ normals[k] == pytest.approx(0.0, abs=1e-9)
        if slides[k] == 0:
            assert at @ tangents[k] == pytest.approx(0.0, abs=1e-9)
        else:
            rubs = -slides[k] * p.kinetic[k] * w.normal[k, end]
            assert w.shear[k] == pytest.approx(rubs)
    masses = np.array([80.0, 80.0, p.inertia[0]])
    assert net == pytest.approx(masses * (a + np.array([RIGHT, UP + G, 0.0])), abs=1e-7)


def test_a_bilinear_spring_yields_at_its_strength_and_unloads_along_its_first_stiffness():
    isolator = BilinearIsolator(
        mass=20.0, stiffness=400.0, strength=50.0, yield_displacement=0.01
    )
    block = as_system(Block(0.4, 1.0, 80.0))
    p = plain(system_record(hold(block, support=isolator), G))
    w = plain(working_memory())
    rise = p.spring_rise
    assert p.spring_strength == pytest.approx(50.0)
    path = np.concatenate([np.linspace(0, 0.1, 101), np.linspace(0.1, -0.1, 201)])
    for before, at in itertools.pairwise(path):
        w.q[0] = p.standing[0] + at
        w.v[0] = at - before
        if support.least_support_margin(p, w, w.q, w.v) < 0:
            support.change_spring(p, w)
        force = support.hysteretic_force(p, w, w.q)
        assert abs(force) <= 50.0 + rise * 0.0011
        assert support.spring_force(p, w, w.q) == pytest.approx(
            p.spring_stiffness * at + force
        )
    assert w.yields == -1


def test_a_plate_stays_in_its_dish_while_its_friction_bears_the_slope_and_the_ground():
    """µ N ≥ |M a + N u/R| (``docs/holding.md``, 4)."""
    dish = SlidingPendulum(mass=20.0, radius=1.0, friction=0.1)
    block = as_system(Block(0.4, 0.5, 80.0))
    p = plain(system_record(hold(block, support=dish), G))
    p.static[1] = 0.9
    told = set()
    for u, ground in itertools.product((-0.15, -0.05, 0.05, 0.15), (-0.8, 0.0, 0.8)):
        w = plain(working_memory())
        w.q, w.drive[:], w.kind[:] = p.standing, -1, 1
        w.q[[0, 3]] += u
        w.whole[0], w.closed[:2], w.touching[:2] = support.GUIDED, 1, 1
        w.along[:2] = w.against[:2] = p.static[:2]
        trial = Trial(ground, 0.0, False, p.weight, G)
        solve.look_at(p, w, w.q)
        prepare(p, w, trial)
        stays = try_mode(p, w, trial) >= 0
        assert stays == (abs(ground / G + u) <= 0.1)
        told.add((u < 0, ground < 0, stays))
    assert len(told) >= 6


def test_forces_that_no_motion_can_tell_apart_are_not_solved_for():
    """A block shut at both ends at the ground and at a wall: six unknowns, three motions."""
    block = as_system(Block(0.4, 1.0, 80.0))
    wall = Wall(0.2, 0.0, friction=0.3)
    p, w = plain(system_record(hold(block, wall), G)), plain(working_memory())
    w.q, w.drive[:], w.kind[:], w.closed[0] = p.standing, -1, 1, 1
    for ends, told in ((0, True), (1, False)):
        w.closed[1] = ends
        solve.look_at(p, w, w.q)
        assert solve.solve_motion(p, w, w.q, w.v, RIGHT, UP) == told


def test_joint_equations_are_solved_with_rows_exchanged_unless_two_ask_for_the_same():
    rng, w = np.random.default_rng(16), plain(working_memory())
    for m in (1, 2, 3, 5):
        for again in (False, True):
            a, b = rng.normal(size=(m, m)), rng.normal(size=m)
            if m > 1:
                # no equation can begin as it stands
                np.fill_diagonal(a, 0.0)
            if again:
                a[-1] = 2 * a[0] if m > 1 else 0.0
            w.matrix[:m, :m], w.joint[:m] = a, b
            w.largest[:m] = np.abs(a).max(axis=1)
            assert equations._eliminate(w, m, 1e-12) != again
            if not again:
                assert w.joint[:m] == pytest.approx(np.linalg.solve(a, b))


def test_what_no_motion_can_bring_about_is_not_solved():
    rng = np.random.default_rng(44)
    p = plain(system_record(as_system(Block(0.4, 1.0, 80.0)), G))
    w = plain(working_memory())
    for size in (1, 2, 3):
        for again in (False, True):
            w.unknowns[0], w.right[:3] = size, 1.0
            w.row[:3, 3:] = w.column[:3, 3:] = rng.normal(size=(3, 3))
            if again:
                # none takes part in it, or two take the same part
                w.row[size - 1] = 0.0 if size == 1 else w.row[0]
            solved = equations._eliminate_contact(p, w, p.standing, 0, False)
            assert solved != again


def test_an_impact_is_of_one_contact_alone_where_one_end_is_closed():
    column = with_contacts(random_column(np.random.default_rng(17), 3), [0.5] * 3)
    p = plain(system_record(column, G))
    ends = list(itertools.product(range(3), (0, 1)))
    for count in (0, 1, 2):
        for closed in itertools.combinations(ends, count):
            w = plain(working_memory())
            for k, end in closed:
                w.closed[k, end] = 1
            expected = closed[0] if count == 1 else (-1, -1)
            assert routh.contact_alone(p, w) == expected


def test_a_case_begins_at_its_start_and_knows_nothing_of_the_one_before():
    column = with_contacts(random_column(np.random.default_rng(19), 2), [0.5] * 2)
    p = plain(system_record(column, G))
    ledgers = "work friction_loss impact_loss tied"
    counts = "leaning hits largest_impulse largest_force peak_rotation peak_velocity"
    counts += " peak_slip slid flights impacts paradoxes overturned_body given_way"
    for theta, shut in (
        ([0.0, 0.0], [3, 3]),
        ([0.2, 0.2], [2, 3]),
        ([0.0, -0.2], [3, 1]),
    ):
        w, start = plain(working_memory()), np.array(posed(p, theta, [0.0, 0.1]))
        for record, names in ((w, ledgers), (w.outcome, counts)):
            for name in names.split():
                record[name] = 7
        integrate._begin(p, w, start)
        assert np.array_equal(w.q, start[0]) and np.array_equal(w.v, start[1])
        assert (w.closed[:2] @ (1, 2)).tolist() == shut
        for record, names in ((w, ledgers), (w.outcome, counts)):
            assert not any(np.any(record[name]) for name in names.split())


@pytest.mark.parametrize("projects", [False, True])
def test_what_touches_is_shut_by_moving_all_above_it_and_goes_on_without_parting(
    projects,
):
    rng, shut = np.random.default_rng(18), 0
    for _ in range(25):
        state = drawn(rng, True, 0)
        p, w, n = state.p, state.w, state.count
        w.touching[:n] = w.closed[:n]
        q, still = rows(w.q, n), np.zeros((n, 3))
        w.q[: 3 * n] = (q + rng.normal(0, 1e-3, (n, 3))).ravel()
        spins = rows(w.v, n)[:, 2]
        if projects:
            impacts.project(p, w)
        else:
            integrate._shut(p, w)
        q, v = rows(w.q, n), rows(w.v, n)
        for k, end in state.closed():
            assert sight(state, q, k, end)[1] == pytest.approx(0.0, abs=1e-12)
            shut += 1
            if projects:
                (along, across), _ = rates(state, q, v, still, k, end)
                assert abs(across) < 1e-5
                assert abs(along) < 1e-5 or w.slides[k] or end != state.first(k)
        # only what stands level on its face turns, with that
        free = ~w.closed[:n].all(axis=1)
        assert v[free, 2] == pytest.approx(spins[free])
    assert shut > 30


def rocking():
    """A slender block that turns about a corner, at its start."""
    p = plain(system_record(as_system(Block(0.4, 1.0, 80.0)), G))
    w = plain(working_memory())
    p.static[0] = p.kinetic[0] = 2.0
    integrate._begin(p, w, np.array(posed(p, [0.1], [0.3])))
    return p, w


def test_a_step_after_contact_events_on_the_spot_is_the_same_and_counted():
    still, dt = step.Instant(0.0, 0.0, 0.0), 0.01
    interval = integrate.Interval(
        0, still, still, step.Stretch(dt, 0.0, 0.0, 0.0, 0.0), 1
    )
    kept = integrate.Kept(
        np.zeros(0, integrate.SAMPLE), np.zeros(0, integrate.CONTACT_EVENT)
    )
    ends = []
    for idle in (0, integrate.MOST_IDLE, integrate.MOST_IDLE + 1):
        p, w = rocking()
        w.tau, w.idle = 0.0, idle
        integrate._step(p, w, interval, 0.0, kept)
        assert w.forced == (idle > integrate.MOST_IDLE)
        ends.append([*w.q[:3], *w.v[:3], w.tau])
    assert ends[0] == ends[1] == ends[2]
    assert ends[0][2] > 0.1


def test_what_turns_does_not_rest_where_its_slip_ends():
    for way in (-1, 1):
        p, w = rocking()
        now = step.Instant(0.0, 0.0, 0.0)
        w.slides[0], spin = way, w.v[2]
        slip = way * 1e-6
        w.v[0] += slip
        w.fails[0, step.FRICTION] = 1
        assert integrate._change_contact(p, w, 0, now) == (False, False)
        assert (w.slides[0], w.resting) == (0, 0)
        assert not integrate._stays(p, w)
        # its corner stands
        assert impacts.slip_speed(p, w, w.v, 0, False) == pytest.approx(0.0, abs=1e-12)
        assert w.v[2] == pytest.approx(spin, rel=1e-4)


def test_of_what_falls_the_contact_that_is_open_furthest_has_parted():
    rng, w = np.random.default_rng(26), plain(working_memory())
    for _ in range(20):
        theta = rng.normal(0, 0.5, 4)
        w.q[2:12:3] = theta
        apart = np.abs(np.diff(theta, prepend=0.0))
        for body in range(4):
            expected = 1 + np.argmax(apart[: body + 1])
            assert integrate._parted(w, body) == expected


def test_what_is_held_lies_still_where_it_neither_moves_nor_accelerates():
    column = as_system(Column((Block(0.4, 0.3, 30.0), Block(0.3, 0.6, 20.0))))
    for holders, held in (((Wall(0.5, 0.0),), True), ((), False)):
        p = plain(system_record(hold(column, *holders), G))
        for place in range(6):
            for record in ("v", "a"):
                for part, still in ((0.9, True), (1.1, False)):
                    w = plain(working_memory())
                    unit = p.speed if record == "v" else G
                    w[record][place] = -part * 1e-9 * unit
                    assert integrate._lies_still(p, w) == (still and held)
                    # a column at rest stays, and so does this
                    w.is_stale = 0
                    assert integrate._stays(p, w) == (still and held)
                    w.is_stale = 1
                    assert not integrate._stays(p, w)
                    w.resting = 1
                    assert integrate._stays(p, w)
            assert integrate._fastest(p, w) == pytest.approx(abs(w.v[place]))


def test_kinds_of_contact_events_are_told_apart():
    names = "CHANGE IMPACT PARADOX FALLEN PASSING AT_WALL TIED BROKEN"
    kinds = [getattr(integrate, name) for name in names.split()] + [VELOCITY_STEP]
    assert len(set(kinds)) == len(kinds)


def test_kinetic_energy_is_that_of_all_bodies():
    rng = np.random.default_rng(13)
    state = drawn(rng, True, 0)
    v = rows(state.w.v, state.count)
    expected = (state.masses * v * v).sum() / 2
    assert impacts.kinetic_energy(state.p, state.w.v) == pytest.approx(expected)


def test_an_outline_is_left_to_the_side_to_which_a_body_is_turned():
    """A body whose centre is aside falls sooner to that side."""
    block = Block(0.4, 1.0, 80.0, cg_offset=0.05)
    p, w = plain(system_record(as_system(block), G)), plain(working_memory())
    for angle, arm in ((0.02, 0.15), (-0.02, 0.25)):
        w.q[2] = angle
        assert integrate._critical(p, w, 0) == pytest.approx(math.atan(arm / 0.5))


def test_pads_of_a_bond_are_apart_along_the_plane():
    bond = Bond(900.0, 500.0, (0.15, 0.1))
    p = system_record(hold(as_system(Block(0.4, 1.0, 80.0)), bonds=bond), G)
    assert p["bond_spread"][0] == 0.15


@pytest.mark.parametrize("way", [1, -1])
def test_what_slid_before_an_event_slides_on_the_same_way(way):
    """Its ends touch as it comes down, none of them shut yet; friction µ m g brakes it."""
    p = plain(system_record(as_system(Block(0.4, 0.3, 80.0)), G))
    w = plain(working_memory())
    p.static[0] = p.kinetic[0] = 0.5
    w.q, w.drive[:], w.kind[:], w.touching[0] = p.standing, -1, 1, 1
    w.v[0] = 0.8 * way
    solve.look_at(p, w, w.q)
    impacts.settle(p, w, 0.0, 0.0, False)
    assert w.closed[0].all() and w.slides[0] == way
    assert w.out[:3] == pytest.approx((-way * 0.5 * G, 0.0, 0.0), abs=1e-9)


def test_a_corner_that_hangs_beside_its_face_is_no_fall_as_long_as_the_edge_bears():
    """The body has slid over the edge and leans there; the corner is lower than the face."""
    column = Column((Block(0.4, 0.2, 30.0), Block(0.6, 0.4, 20.0)))
    p, w = plain(system_record(as_system(column), G)), plain(working_memory())
    theta = 0.2
    flat, _ = posed(p, [0.0, theta], [0.0, 0.0])
    w.q, w.closed[0], w.closed[1, 1], w.slides[1] = flat, 1, 1, 1
    # its corner lies on the edge then; it goes on along its base
    w.q[3:5] += 0.05 * np.array([math.cos(theta), -math.sin(theta)])
    w.normal[:] = 50.0
    solve.look_at(p, w, w.q)
    w.kind[1, 1] = solve.end_of(p, w, w.q, 1, 1, -1)[6]
    assert w.kind[1, 1] == 0
    assert step._margin_of_closed_end(p, w, w.q, 1, 1, True) >= 0.0
    assert not w.fails[1].any()


@pytest.mark.parametrize("side", [1, -1])
def test_what_touches_ground_and_wall_is_shut_at_both(side):
    block = as_system(Block(0.4, 1.0, 80.0))
    wall = Wall(0.5, 0.0 if side > 0 else math.pi, friction=0.3)
    p, w = plain(system_record(hold(block, wall), G)), plain(working_memory())
    flat, _ = posed(p, [side * 0.2], [0.0])
    w.q, w.drive[:], w.kind[:] = flat, -1, 1
    foot = top = int(side > 0)
    w.closed[0, foot] = w.closed[1, top] = 1
    w.slides[:2] = 1
    q = w.q[:3]
    q[:2] += (side * (0.5 + 1e-4) - (q[:2] + turn(q[2]) @ p.edge[1, top])[0], 2e-4)
    w.v[:3] = 0.01, -0.02, 0.03
    impacts.project(p, w)
    assert (q[:2] + turn(q[2]) @ p.corner[0, foot])[1] == pytest.approx(0.0, abs=1e-8)
    assert (q[:2] + turn(q[2]) @ p.edge[1, top])[0] == pytest.approx(0.5 * side)


SPRING = BilinearIsolator(
    mass=20.0, stiffness=400.0, strength=50.0, yield_displacement=0.01
)
DISH = SlidingPendulum(mass=20.0, radius=1.5, friction=0.05)
# what carries, which way its spring has yielded, and by how much for good [m]
HELD_BY = {
    "elastic": (SPRING, 0, 0.002),
    "yields": (SPRING, 1, 0),
    "dish": (DISH, 0, 0),
}


@pytest.mark.parametrize("kind", HELD_BY)
def test_a_plate_and_its_load_move_as_one_coordinate_and_its_books_close(kind):
    """Equation 11 of ``docs/holding.md``, integrated by another method; what it carries stands still on it."""
    isolator, yields, plastic = HELD_BY[kind]
    block = as_system(Block(0.4, 0.5, 80.0))
    p = plain(system_record(hold(block, support=isolator), G))
    w = plain(working_memory())
    w.q, w.drive[:], w.kind[:], w.closed[:2] = p.standing, -1, 1, 1
    w.yields, w.plastic, w.slides[0] = yields, plastic, 1
    u, v, mass = 0.01, 0.2, 100.0
    w.q[[0, 3]] += u
    w.v[[0, 3]] = v
    solve.look_at(p, w, w.q)
    h, rise = 0.01, (30.0, -20.0)
    stretch = step.Stretch(h, RIGHT, UP, h * rise[0], h * rise[1])

    def force(u: float) -> float:
        """Of spring and dish, without friction and a rise of the ground [N]."""
        held = 50.0 if yields else p.spring_rise * (u - plastic)
        return p.spring_stiffness * u + held

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        """Of displacement, speed, work of the ground, and what friction and springs have taken."""
        u, v = y[:2]
        ah, av = RIGHT + rise[0] * t, UP + rise[1] * t
        rubs = p.kinetic[0] * mass * (G + av)
        back = force(u) + mass * (G + av) * u / p.dish_radius
        a = -ah - (rubs + back) / mass
        return np.array([v, a, -mass * ah * v, rubs * v, back * v])

    known = solve_ivp(rates, (0, h), [u, v, 0, 0, 0], rtol=1e-11, atol=1e-14).y[:, -1]
    assert carried._fill_series(p, w, stretch)
    felt = carried._acceleration(w, 1.0, h)
    assert felt == pytest.approx(rates(h, known)[1], rel=1e-8)
    w.rest[:] = (1.0, 0.0, 0.0)
    state = w.q.copy(), w.v.copy()
    assert carried.carry_along(p, w, stretch)
    for first in (0, 3):
        assert w.q[first] - p.standing[first] == pytest.approx(known[0], rel=1e-9)
        assert w.v[first : first + 3] == pytest.approx((known[1], 0.0, 0.0), rel=1e-9)
    assert carried.carried_energies(p, w, stretch) == pytest.approx(known[2:], rel=1e-7)
    # a step of the whole column goes there too
    w.q, w.v = state
    w.whole[0] = support.GUIDED
    solve.look_at(p, w, w.q)
    assert solve.solve_motion(p, w, w.q, w.v, RIGHT, UP)
    w.a[:] = w.out
    step.start_step(p, w)
    energies = step.take_step(p, w, stretch, True)
    assert energies == pytest.approx(known[2:], rel=1e-7)
    for first in (0, 3):
        assert w.q1[first] - p.standing[first] == pytest.approx(known[0], rel=1e-9)
        assert w.v1[first : first + 3] == pytest.approx((known[1], 0.0, 0.0), rel=1e-9)


def test_a_plate_is_carried_with_what_sticks_flat_on_it_and_is_held_by_nothing_else():
    stack = as_system(Column((Block(0.4, 0.3, 30.0), Block(0.3, 0.6, 20.0))))
    tie = Tie((0.0, 0.0, 0.6), (2.0, 0.0, 0.9), 500.0, slack=0.02)
    wall = Wall(2.0, 0.0)

    def carries(*holders, supported=True, **changed):
        held = hold(stack, *holders, support=SPRING if supported else None)
        p, w = plain(system_record(held, G)), plain(working_memory())
        w.closed[: p.count], w.slides[0] = 1, 1
        for name, (at, value) in changed.items():
            w[name][at] = value
        return bool(carried.is_carried(p, w))

    assert carries()
    assert not carries(supported=False)
    assert not carries(tie)
    assert carries(wall)
    assert not carries(wall, closed=((3, 0), 1))
    assert carries(slides=(0, -1))
    assert not carries(slides=(0, 0))
    for k in (1, 2):
        assert not carries(slides=(k, 1))
        for end in (0, 1):
            assert not carries(closed=((k, end), 0))


def test_a_plate_is_put_under_all_bodies_and_what_an_earlier_response_left():
    """It stands at its displacement; bodies begin as they were, raised by its height, which is next to none."""
    left = Start((0.1, 0.2), (0.3, 0.4), ((0.01, 0.15), (0.02, 0.6)), 0.07)
    stack = as_system(Column((Block(0.4, 0.3, 30.0), Block(0.3, 0.6, 20.0))))
    for start in (None, left, replace(left, position=None)):
        for support in (None, SPRING, DISH):
            system = replace(stack, start=start, support=support)
            found = holding.with_plate(system)
            if support is None:
                assert found is system
                continue
            assert [b.mass for b in found.bodies] == [20.0, 30.0, 20.0]
            plate, first = found.bodies[:2]
            assert plate.base.left == -plate.base.right < -10
            assert plate.height < 1e-5 and first == system.in_plane().bodies[0]
            slides = found.contacts[0].friction
            assert slides == ((0.05, 0.05) if support is DISH else (0.0, 0.0))
            if start is None:
                assert found.start is None
                continue
            assert found.start.rotation == (0.0, 0.1, 0.2)
            assert found.start.velocity == (0.0, 0.3, 0.4)
            assert found.start.plate == 0.07
            if start.position is None:
                assert found.start.position is None
                continue
            at = np.array(found.start.position)
            assert at[0] == pytest.approx((0.07, 0.0))
            assert at[1:] == pytest.approx(np.array(left.position), abs=1e-5)
            assert at[1:, 1] - np.array(left.position)[:, 1] == pytest.approx(
                plate.height
            )


@pytest.mark.parametrize("kind", ["spring", "dish"])
@pytest.mark.parametrize("part", [0.97, 1.03])
def test_a_plate_swings_on_if_its_load_stands_where_it_turns_back(kind, part):
    """At an amplitude A it is accelerated by ω² A, about where its spring is at rest; b/h or friction bears it."""
    # which does not yield
    strong = replace(SPRING, strength=5e5, yield_displacement=100.0)
    isolator = strong if kind == "spring" else replace(DISH, friction=0.0)
    for width, rough, plastic, told in (
        (0.4, 0.9, 0.003, "tips"),
        (0.9, 0.3, -0.003, "slides"),
    ):
        block = as_system(Block(width, 0.8, 80.0))
        p = plain(system_record(hold(block, support=isolator), G))
        p.static[1] = p.kinetic[1] = rough
        w = plain(working_memory())
        w.q, w.drive[:], w.kind[:], w.closed[:2] = p.standing, -1, 1, 1
        w.whole[0], w.slides[0], w.outcome.stroke[:] = support.GUIDED, 1, 0.0
        square, middle = G / 1.5, 0.0
        if kind == "spring":
            w.plastic = plastic
            rise = p.spring_rise
            square = (p.spring_stiffness + rise) / 100.0
            middle = rise * plastic / (p.spring_stiffness + rise)
        most = (width / 0.8 if told == "tips" else rough) * G
        amplitude = part * most / square
        w.q[[0, 3]] += middle + 0.6 * amplitude
        w.v[[0, 3]] = 0.8 * amplitude * math.sqrt(square)
        integrate._rest_margins(p, w)
        swings = carried.swings_on(p, w)
        assert swings == (part < 1)
        stroke = w.outcome.stroke[p.support_number]
        expected = abs(middle) + amplitude if swings else 0.0
        assert stroke == pytest.approx(expected)
        # friction, or a spring that yields, would end it
        kept, p.kinetic[0] = p.kinetic[0], 0.01
        assert not carried.swings_on(p, w)
        p.kinetic[0], w.yields = kept, 1
        assert not carried.swings_on(p, w)


def test_ties_act_while_one_is_taut_or_pushed_or_a_spring_is_there():
    block = as_system(Block(0.4, 1.0, 80.0))
    made = [
        Tie((0.1, 0.0, 0.9), (x, 0.0, 0.5), 4e3, slack=0.05, bracket=True)
        for x in (0.9, -0.7, 0.8)
    ]
    p, w = plain(system_record(hold(block, *made), G)), plain(working_memory())
    for states in itertools.product(
        (ties.SLACK, ties.TAUT, ties.PUSHED, ties.BROKEN), repeat=3
    ):
        w.taut[:3] = states
        expected = bool({ties.TAUT, ties.PUSHED} & set(states))
        assert bool(ties.is_any_taut(p, w)) == expected
    p, w = plain(system_record(hold(block, support=SPRING), G)), plain(working_memory())
    assert ties.is_any_taut(p, w)


def test_a_bond_is_broken_by_an_impulse_that_pulls_a_pad_or_shears_beyond_friction():
    rng, seen = np.random.default_rng(21), set()
    for _ in range(40):
        state = drawn(rng, True, 2)
        p, w, n = state.p, state.w, state.count
        p.is_bonded[:n], p.bond_number[:n] = 1, range(n)
        whole = rng.integers(0, 2, n)
        w.whole[:n], p.bond_spread[:n] = whole, rng.uniform(0.1, 0.4, n)
        w.closed[:n] = 1
        w.normal[:n], w.shear[:n] = rng.normal(30, 10, (n, 2)), rng.normal(0, 20, n)
        pulled = []
        for k in range(n):
            width = np.linalg.norm(np.subtract(*state.bodies[k].corners))
            if k:
                # along the face, where a corner is beyond it
                first, last = (sight(state, rows(w.q, n), k, end) for end in (0, 1))
                width = abs((last[6:8] - first[6:8]) @ first[2:4])
            moment = (w.normal[k, 1] - w.normal[k, 0]) * width / 2
            pressed = w.normal[k].sum()
            least = pressed / 2 - abs(moment) / (2 * p.bond_spread[k])
            pulled.append(least < 0 or abs(w.shear[k]) > p.static[k] * pressed)
        breaks = whole.astype(bool) & pulled
        assert bonds.break_pulled(p, w, 1.0) == breaks.any()
        assert w.whole[:n].tolist() == (whole.astype(bool) & ~breaks).tolist()
        # those without one count as broken here, as all are said to be bonded
        assert bonds.count_broken(p, w) == n - w.whole[:n].sum()
        w.outcome.breaking_time[:n] = np.nan
        w.outcome.breaking_time[0] = 1.5
        bonds.note_breaking(p, w, 2.0)
        times = w.outcome.breaking_time[:n]
        assert times[0] == 1.5
        assert times[1:].tolist() == pytest.approx(
            np.where(w.whole[1:n], np.nan, 2.0), nan_ok=True
        )
        seen |= set(zip(whole.tolist(), breaks.tolist(), strict=True))
    assert len(seen) == 3


def test_rows_of_contacts_are_what_each_coordinate_moves_there():
    """Normal and tangent of both ends, and a couple between the bodies; without forces all fall and ties draw."""
    rng, seen = np.random.default_rng(22), 0
    for impact in (False, True):
        for _ in range(15):
            state = drawn(rng, impact, 0)
            p, w, n = state.p, state.w, state.count
            w.touching[:n] = w.closed[:n]
            w.basis[:] = w.free[:] = 7.0
            prepare(p, w, Trial(RIGHT, UP, impact, p.weight, G))
            q, v, still = rows(w.q, n), rows(w.v, n), np.zeros((n, 3))
            fall = np.tile((-RIGHT, -UP - G, 0.0), (n, 1))
            for k in range(n):
                # three coordinates of the body below, if there is one, and of the body above
                below = [0.0, 0.0, -1.0] if k else [0.0] * 3
                assert (
                    w.basis[k, 4, 3 * (k == 0) :].tolist()
                    == ([*below, 0.0, 0.0, 1.0][3 * (k == 0) :])
                )
                for end in np.flatnonzero(w.touching[k]).tolist():
                    for unit in np.eye(3 * n)[max(0, 3 * k - 3) : 3 * k + 3]:
                        moved = rates(state, q, unit.reshape(n, 3), still, k, end)[0]
                        at = int(unit.argmax()) - 3 * k + 3
                        found = w.basis[k, 2 * end : 2 * end + 2, at]
                        assert found == pytest.approx(moved[::-1], abs=1e-5)
                    velocity, bent = rates(state, q, v, fall, k, end)
                    expected = velocity if impact else bent
                    found = w.free[k, 2 * end : 2 * end + 2]
                    assert found == pytest.approx(expected[::-1], abs=1e-3)
                    seen += 1
    assert seen > 50


def test_ties_and_springs_draw_what_touches_as_they_draw_its_bodies():
    rng = np.random.default_rng(25)
    block = as_system(Block(0.4, 1.0, 80.0))
    for impact, kind in itertools.product((False, True), ("ties", "spring")):
        p, w = tied(rng, False)
        if kind == "spring":
            p = plain(system_record(hold(block, support=SPRING), G))
            w = plain(working_memory())
            w.q[:6] = p.standing[:6]
            w.q[[0, 3]] += 0.004
        w.touching[: p.count] = w.kind[:] = 1
        solve.look_at(p, w, w.q)
        trial, pulled = Trial(RIGHT, UP, impact, p.weight, G), np.zeros(12)
        w.taut[:2] = ties.TAUT
        ties.fill_tie_accelerations(p, w, w.q, w.v)
        pulled[: 3 * p.count] = w.drift[: 3 * p.count]
        assert np.abs(pulled).max() > 0.01
        w.drift[:] = 5.0
        prepare(p, w, trial)
        drawn_by = np.array(w.free[: p.count])
        # without them
        w.taut[:2] = ties.SLACK
        p.spring_stiffness = p.spring_rise = 0.0
        prepare(p, w, trial)
        for k in range(p.count):
            first = 0 if k else 3
            both = pulled[3 * k - 3 + first : 3 * k + 3]
            expected = w.basis[k, :4, first:] @ both
            found = drawn_by[k, :4] - w.free[k, :4]
            assert found == pytest.approx(expected * (not impact), abs=1e-9)


def lying(friction):
    """A block that lies on the ground and does not move, in a mode that it has just come to."""
    p = plain(system_record(as_system(Block(0.4, 0.3, 80.0)), G))
    w = plain(working_memory())
    p.static[0] = p.kinetic[0] = w.along[0] = w.against[0] = friction
    w.q, w.drive[:], w.kind[:] = p.standing, -1, 1
    w.touching[0] = w.closed[0] = 1
    solve.look_at(p, w, w.q)
    return p, w


def test_a_mode_is_tried_once():
    p, w = lying(0.5)
    trial = Trial(0.0, 0.0, False, p.weight, G)
    prepare(p, w, trial)
    for number in range(3):
        w.closed[0] = number != 1, True
        assert _try_anew(p, w, trial, NONE) != SEEN
        assert w.count == number + 1
        assert _try_anew(p, w, trial, NONE) == SEEN
        assert w.count == number + 1
        w.slides[0] = number


@pytest.mark.parametrize("pulls", [0.0, 1.0, -1.0])
def test_what_may_stick_as_well_as_slide_sticks(pulls):
    """Without friction, on a ground that is still, it may do either, and on one that moves only slide."""
    p, w = lying(0.0)
    trial = Trial(pulls, 0.0, False, p.weight, G)
    prepare(p, w, trial)
    w.slides[0] = way = -1 if pulls >= 0 else 1
    found = _try_anew(p, w, trial, NONE)
    assert found == 0
    taken, several = _try_slips(p, w, trial, found)
    assert several == (pulls == 0.0)
    take_mode(p, w, w.tried[taken])
    assert w.slides[0] == (way if pulls else 0)
    assert w.closed[0].all()


def test_a_neighbour_of_a_mode_differs_in_one_thing_that_may_change():
    """An end that touches opens or closes, and what is closed slides otherwise, if nothing else gives its way."""
    w, seen = plain(working_memory()), set()
    trials = [Trial(0.0, 0.0, impact, 1.0, G) for impact in (False, True)]
    names = itertools.product((0, 1), (0, 1), (0, 1), (-1, 0, 1), (-1, 1), (0, 1))
    for trial, (left, right, whole, moves, drive, touch) in itertools.product(
        trials, names
    ):
        for what in range(5):
            k = 1
            w.closed[:] = w.slides[:] = w.moves[:] = w.whole[:] = 0
            w.closed[k], w.touching[k] = (left, right), (1, touch)
            w.whole[k], w.moves[k], w.drive[k] = whole, moves, drive
            changes = _change_to_neighbour(w, trial, k, what)
            seen.add(bool(changes))
            given = 0 if trial.impact else moves
            if what < 2:
                may = not whole and drive < 0 and (1, touch)[what] == 1
                ends = [left, right]
                ends[what] = 1 - ends[what] if may else ends[what]
                assert changes == may
                assert w.closed[k].tolist() == ends
                begins = may and not (left or right)
                assert w.slides[k] == (given if begins else 0)
                continue
            way = what - 3
            may = not whole and (left or right) and given in (0, way)
            assert bool(changes) == bool(may)
            assert w.slides[k] == (way if may else 0)
            assert w.closed[k].tolist() == [left, right]
    assert seen == {False, True}


def test_beside_a_wall_only_what_is_slow_can_be_held_at_once():
    """A block that slides along the ground stops at its wall by no more than a slow speed."""
    block = as_system(Block(0.4, 1.0, 80.0))
    p = plain(system_record(hold(block, Wall(0.2, 0.0, friction=0.3)), G))
    w = plain(working_memory())
    w.q, w.drive[:], w.kind[:], w.closed[0], w.slides[0] = p.standing, -1, 1, 1, 1
    w.slides[1] = 1
    solve.look_at(p, w, w.q)
    for still in (0.0, 1e-4):
        most = impacts.SHUT * max(still, impacts.STILL * p.speed)
        for part, holds in ((0.9, True), (1.1, False)):
            w.closed[1], w.v[0] = 0, part * most
            # no wall: all can be held
            assert impacts._can_hold(p, w, still)
            w.closed[1, 0] = 1
            assert impacts._can_hold(p, w, still) == holds
            w.v[0] = -part * most
            assert impacts._can_hold(p, w, still) == holds
    # what sticks to the ground has nothing left that the wall could hold
    w.v[0], w.slides[0] = 0.0, 0
    assert not impacts._can_hold(p, w, 1.0)
    # so that what the wall has stopped goes on as what slides; with none it sticks
    for beside, way in itertools.product((1, 0), (-1, 1)):
        w.closed[1, 0], w.slides[0] = beside, way
        impacts.read_slip(p, w, 0, 1e-4)
        assert w.slides[0] == way * beside


def test_laws_of_impacts_are_looked_for_at_contacts_and_walls(monkeypatch):
    """Plastic is what has none: there ends that are pushed may not part."""
    told = []
    monkeypatch.setattr(integrate, "breaks_a_law", lambda *given: told.append(given[3]))
    stack = as_system(Column((Block(0.4, 0.3, 30.0), Block(0.3, 0.6, 20.0))))
    walls_of = [Wall(2.0, 0.0), Wall(2.0, np.pi)]
    p, w = plain(system_record(hold(stack, *walls_of), G)), plain(working_memory())
    integrate._is_unlawful(p, w, 1e-6)
    assert told.pop()
    for k, end in itertools.product((0, 1), (0, 1)):
        kept, p.law[k, end] = p.law[k, end], 2
        integrate._is_unlawful(p, w, 1e-6)
        assert not told.pop()
        p.law[k, end] = kept
    for k in (2, 3):
        p.bounce[k] = 0.4
        integrate._is_unlawful(p, w, 1e-6)
        assert not told.pop()
        p.bounce[k] = 0.0


@pytest.mark.parametrize("side", [1, -1])
def test_a_corner_leaves_a_smooth_wall_by_its_ratio(side):
    """One push along the normal of the wall, through the corner that meets it."""
    rng = np.random.default_rng(27)
    block = as_system(Block(0.4, 1.0, 80.0))
    for _ in range(5):
        ratio, theta = rng.uniform(0.1, 0.9), side * rng.uniform(0.05, 0.3)
        wall = Wall(0.5, 0.0 if side > 0 else math.pi, restitution=ratio)
        p, w = plain(system_record(hold(block, wall), G)), plain(working_memory())
        w.drive[:], w.kind[:] = -1, 1
        flat, _ = posed(p, [theta], [0.0])
        w.q, end = flat, int(side > 0)
        corner = turn(theta) @ p.edge[1, end]
        w.q[:2] = side * 0.5 - corner[0], 1.0
        came = rng.normal(0, 0.3, 3)
        came[0] += 2.0 * side
        w.v[:3], w.touching[1, end] = came, 1
        solve.look_at(p, w, w.q)
        impacts.strike(p, w, 0.0, 0.0, 0.0)
        jump = w.v[:3] - came
        assert jump[1] == pytest.approx(0.0, abs=1e-9)
        # of a push to the right above the centre the moment is clockwise
        assert jump[2] * p.inertia[0] == pytest.approx(80.0 * jump[0] * corner[1])
        before, after = (v[0] + v[2] * corner[1] for v in (came, w.v[:3]))
        assert side * before > 0
        assert after == pytest.approx(-ratio * before)


def come_down(block, law, side):
    """A block after it has come down at .4 rad/s on the corner of a side, by a law."""
    p = plain(system_record(with_contacts(block, [5.0], [law]), G))
    w = plain(working_memory())
    w.drive[:], w.kind[:] = -1, 1
    w.q, w.v = posed(p, [-side * 1e-13], [side * 0.4])
    w.old_closed[0] = w.closed[0] = side > 0, side < 0
    w.touching[0] = 1
    solve.look_at(p, w, w.q)
    impacts.strike(p, w, 0.0, 0.0, 0.0)
    return w


@pytest.mark.parametrize("law", ["position", "couple", "ratio"])
@pytest.mark.parametrize("side", [1, -1])
def test_a_block_comes_down_by_the_law_of_its_contact(law, side):
    """Its rate is a part of the one before: of that by momentum or its own, as far as no energy is gained."""
    rng, gave_way = np.random.default_rng(23), 0
    for number in range(8):
        block = rockfrag.Block(rng.uniform(0.2, 0.4), 1.0, 80.0)
        h, b = 0.5, block.width / 2
        own = 1 - 1.5 * b**2 / (h**2 + b**2)
        # Housner (1963); more than it came with it cannot have
        value = own * rng.uniform(0.8, 0.95) if number else 1.01
        w = come_down(block, rockfrag.system.ImpactLaw(law, value, value), side)
        gave_way += w.outcome.given_way
        expected = min(value, 1.0)
        assert w.v[2] == pytest.approx(side * 0.4 * expected, rel=1e-6)
    assert gave_way == 1


@pytest.mark.parametrize("side", [1, -1])
def test_a_squat_block_lies_flat_where_its_law_has_no_rate_to_multiply(side):
    """Lower than its width over √2 (Housner, 1963): by momentum both ends stay shut, and no law gives way."""
    law = rockfrag.system.ImpactLaw("couple", 0.9, 0.9)
    w = come_down(rockfrag.Block(1.0, 0.4, 80.0), law, side)
    assert w.closed[0].all()
    assert w.v[:3] == pytest.approx(np.zeros(3), abs=1e-9)
    assert w.outcome.given_way == 0


def test_witnesses_see_the_same_in_impacts_and_in_what_no_contact_could_have_done():
    """Impacts of random columns, some of them with a jump of one body that nothing has given."""
    rng, told = np.random.default_rng(20), set()
    for _ in range(20):
        state = drawn(rng, True, 0)
        p, w, n = state.p, state.w, state.count
        w.touching[:n], w.old_v[:] = w.closed[:n], w.v
        impacts.strike(p, w, 0.0, 0.0, 0.0)
        # as small as what shuts slow ends may ask, and more
        jump = rng.choice([0.0, 0.1 * witness.SHUT * 1e-6 * p.speed, 0.1])
        w.v[rng.integers(3 * n)] += jump * rng.choice([-1, 1])
        frictions = p.static[:n], p.kinetic[:n]
        column = other_witness.Column(state.bodies, *frictions, p.size, p.speed)
        seen = (rows(each, n) for each in (w.q, w.old_v, w.v))
        laws = other_witness.violations(column, other_witness.Impact(*seen))
        laws.pop("direction")
        worst = max(laws.values()) / (witness.SHUT * 1e-6)
        if not 0.3 < worst < 3:
            broken = witness.breaks_a_law(p, w, 1e-6, True)
            assert broken == (worst > 1), laws
            told.add((n, bool(broken)))
    assert len(told) >= 6


@pytest.mark.parametrize("side", [1, -1])
def test_a_witness_takes_what_a_wall_gives_and_no_more(side):
    """A block in flight whose upper corner is stopped by a wall, by the normal and the moment of one push."""
    block = as_system(Block(0.4, 1.0, 80.0))
    wall = Wall(0.5, 0.0 if side > 0 else math.pi, friction=0.3)
    p = plain(system_record(hold(block, wall), G))
    theta = 0.2 * side
    for pulls, rubs, spins, lawful in (
        (1, 0.0, 0.0, True),
        (1, 0.29, 0.0, True),
        (1, 0.31, 0.0, False),
        (-1, 0.0, 0.0, False),
        (1, 0.0, 0.5, False),
    ):
        w = plain(working_memory())
        flat, _ = posed(p, [theta], [0.0])
        w.q = flat
        end = int(side > 0)
        corner = turn(theta) @ p.edge[1, end]
        w.q[:2] = side * 0.5 - corner[0], 1.0
        push = 7.0 * pulls * np.array([-side, 0.0]) + 7.0 * rubs * np.array([0.0, side])
        jump = push / 80.0
        turned = (push[0] * corner[1] - push[1] * corner[0]) / p.inertia[0]
        # the body turns about the corner, which rests, and the foot of its side comes closer
        spin = -0.3 * side
        w.v[:3] = -spin * corner[1], spin * corner[0], spin
        w.old_v[:3] = w.v[:3] - (*jump, turned)
        w.v[2] += spins * side
        w.old_v[2] += spins * side
        w.hit[1, end], w.hit_shear[1] = 7.0 * pulls, 7.0 * rubs
        assert witness.breaks_a_law(p, w, 1e-6, True) != lawful
