"""What the kernels say of one state, beside the plain model of the oracle and beside NumPy's polynomials.

Kernels are called one by one, as plain Python.
"""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import RK45

from rockfrag import Block, Stack
from rockfrag.simulation import MeasuredRestitution
from rockfrag.simulation.options import system_of
from rockfrag.system import geometry

from ...oracle.rocking_model import Model, pivots
from ...simulation.reference_bodies import measured
from ..planar.cases import G, random_block
from .plain_rocking import (
    PULL,
    STATES,
    body_record,
    chatter,
    contact_states,
    demand,
    dormand_prince,
    drawn_motion,
    eq,
    impact,
    kernel_laws,
    laws,
    plain,
    record,
    roots,
    single,
    stacks,
    state_of,
    taylor,
)


@pytest.mark.parametrize("linear", [False, True])
def test_accelerations_moments_and_energies_are_those_of_the_plain_model(linear):
    for rng, body, model in stacks(1, 12, linear):
        for c in STATES:
            theta, omega = drawn_motion(rng, c)
            state = state_of(c, theta, omega)
            m11, m12, m22, f1, f2 = eq.equations(body, *pivots(c), state)
            mass, force = model.terms(pivots(c), theta, omega, PULL)
            if linear:
                # products of angles and rates are dropped
                mass, _ = model.terms(pivots(c), 0 * theta, 0 * omega, PULL)
                force = model.terms(pivots(c), theta, 0 * omega, PULL)[1]
            assert (m11, m12, m12, m22) == pytest.approx(mass.ravel())
            assert (f1, f2) == pytest.approx(force, abs=1e-9)
            if not linear:
                found = eq.accelerations(body, *c, state)
                assert found == pytest.approx(
                    model.accelerations(c, theta, omega, PULL)
                )
            energy = eq.kinetic_energy(body, state)
            assert energy == pytest.approx(model.kinetic_energy(c, theta, omega))
            new = pivots(c)[::-1]
            turn = eq.turn_between(body, state)
            k = eq.metric(body, new, pivots(c), turn)
            assert k == pytest.approx(model.products(new, pivots(c), theta).ravel())


def heights(model, c, theta):
    """Σ m y of both bodies over that at rest, at rotations of shape (n, 2)."""
    arms = model.arms(pivots(c))
    at = (arms * np.exp(-1j * np.asarray(theta))[:, None, :]).sum(axis=2)
    return (at - arms.sum(axis=1)).imag @ model.mass


def test_potential_energy_is_weight_times_height_and_the_barrier_its_least_summit():
    angles = np.linspace(0, 1.5, 1501)
    for rng, body, model in stacks(2, 10):
        summits = []
        for c in STATES:
            theta, omega = drawn_motion(rng, c)
            found = eq.potential_energy(body, state_of(c, theta, omega))
            assert found == pytest.approx(G * heights(model, c, [theta])[0], abs=1e-9)
            # about an open pivot of the ground the lower body turns, with the upper one on it where that is shut
            turns = np.array([c[0] != 0, c[0] == 0 or c[1] == 0])
            at = heights(model, c, (c[0] or c[1]) * angles[:, None] * turns)
            critical, vx, vy, inertia = eq.balance(body, *c)
            assert critical == pytest.approx(angles[at.argmax()], abs=2e-3)
            assert math.hypot(vx, vy) - vy == pytest.approx(at.max(), rel=1e-4)
            energy = model.kinetic_energy(c, np.zeros(2), turns.astype(float))
            assert inertia == pytest.approx(2 * energy)
            summits.append(at.max())
        assert eq.barrier(body) == pytest.approx(G * min(summits), rel=1e-4)


def test_the_linearised_potential_is_the_second_order_of_the_exact_one():
    for rng, body, _ in stacks(3, 5, linear=True):
        exact = plain(np.array(body).copy())
        exact.linear = 0
        for c in STATES:
            theta, omega = 1e-3 * np.array(drawn_motion(rng, c))
            state = state_of(c, theta, omega)
            found, known = (eq.potential_energy(each, state) for each in (body, exact))
            assert found == pytest.approx(known, rel=1e-5, abs=1e-9)


def test_closed_contacts_hold_as_firmly_as_the_plain_model_says_and_open_where_it_says():
    seen = set()
    for rng, body, model in stacks(4, 25):
        for c in [*STATES, (0, 0)]:
            pull = (rng.normal(0, 5), rng.uniform(5, 12))
            theta, omega = drawn_motion(rng, c)
            state = state_of(c, theta, omega, pull)
            alpha = model.accelerations(c, theta, omega, pull)
            margins = model.margins(c, theta, omega, pull)
            for contact, shut in enumerate(c):
                if shut:
                    continue
                least, corner = eq.hold(body, contact + 1, c, state, tuple(alpha))
                firm = {s: margins[contact, s] for s in (1, -1)}
                unit = model.weight[contact] * abs(model.half[contact])
                assert least == pytest.approx(
                    min(firm.values()) * unit, abs=1e-9 * unit
                )
                assert corner == min(firm, key=firm.__getitem__)
            expected = model.settled(c, theta, omega, pull)
            assert contact_states.settle(body, state) == expected
            seen.add((c, expected))
            if c == (0, 0) and expected != c:
                assert contact_states.uplift(body, state) == expected
    assert len({after for _, after in seen}) == 9


def test_a_contact_that_fails_again_at_once_opens_where_it_holds_least():
    """Whatever rounding says; if time has passed, the state that its accelerations ask for is taken."""
    seen = set()
    for rng, body, model in stacks(34, 25):
        for c in [*STATES, (0, 0)]:
            pull = (rng.normal(0, 2), rng.uniform(8, 12))
            theta, omega = drawn_motion(rng, c)
            state = state_of(c, theta, omega, pull)
            margins = model.margins(c, theta, omega, pull)
            settled = model.settled(c, theta, omega, pull)
            for contact in [k for k in (0, 1) if c[k] == 0]:
                fails = contact + 1
                assert contact_states.release(body, state, fails, False) == settled
                found = contact_states.release(body, state, fails, True)
                if settled != c:
                    assert found == settled
                    continue
                firm = {side: margins[contact, side] for side in (1, -1)}
                expected = list(c)
                expected[contact] = min(firm, key=firm.__getitem__)
                assert found == tuple(expected)
                seen.add((c, contact))
    assert len(seen) == 6


def test_a_body_rests_as_long_as_no_margin_is_below_zero():
    scratch = state_of((0, 0), (0, 0), (0, 0))
    for _, body, model in stacks(5, 20):
        low, high = contact_states.rest_interval(body, scratch)
        assert low < 0 < high
        for limit, side in ((low, -1), (high, 1)):
            for part, firm in ((0.999, True), (1.001, False)):
                margins = model.margins(
                    (0, 0), np.zeros(2), np.zeros(2), (part * limit, G)
                )
                assert (min(margins.values()) > 0) == firm
            # at the limit it opens, to the side away from which it is pushed
            state = state_of((0, 0), (0, 0), (0, 0), (limit, G))
            opened = contact_states.uplift(body, state)
            assert any(opened) and set(opened) <= {0, -side}


def test_a_lone_block_rests_up_to_the_acceleration_that_its_width_over_its_height_bears():
    rng, scratch = np.random.default_rng(6), state_of((0, 0), (0, 0), (0, 0))
    for _ in range(10):
        block = random_block(rng)
        body = plain(body_record(system_of(block), False, G))
        low, high = contact_states.rest_interval(body, scratch)
        x, y = block.shape.x, block.shape.y
        # moments about the corners
        assert (low, high) == pytest.approx(
            (-G * (block.b - x) / y, G * (block.b + x) / y)
        )
        assert eq.hold(body, eq.GROUND, (0, 0), scratch, (0.0, 0.0)) == (1.0, 1)


def accelerations_of(model, c, theta, omega, alpha):
    """Accelerations of both centres as complex numbers."""
    arms = model.arms(pivots(c)) * np.exp(-1j * np.asarray(theta))
    return (arms * (-1j * np.asarray(alpha) - np.square(omega))).sum(axis=1)


def velocities_of(model, c, theta, omega):
    """Velocities of both centres as complex numbers."""
    return (model.fields(pivots(c), theta) * np.asarray(omega)).sum(axis=1)


def resolved(model, body, theta1, pushes):
    """Normal and shear of ground and interface from what moves both bodies."""
    below, above = pushes.sum(), pushes[1]
    along = complex(body.ex, body.ey) * np.exp(-1j * theta1)
    across = above * along.conjugate()
    return below.imag, below.real, across.imag, across.real


def test_forces_and_impulses_of_contacts_are_the_changes_of_momentum_of_all_above():
    for rng, body, model in stacks(7, 12):
        asked = plain(np.zeros(1, demand.DEMAND)[0])
        demand.no_demand(asked)
        worst, least = [0.0, 0.0], [math.inf, math.inf]
        for c in STATES:
            theta, omega = drawn_motion(rng, c)
            alpha = model.accelerations(c, theta, omega, PULL)
            state = state_of(c, theta, omega)
            pushes = model.mass * (
                accelerations_of(model, c, theta, omega, alpha) + complex(*PULL)
            )
            expected = resolved(model, body, theta[0], pushes)
            assert demand.forces(body, state, *alpha) == pytest.approx(
                expected, abs=1e-9
            )
            n1, t1, n2, t2 = expected
            found = demand.ask_forces(body, state, *alpha, asked)
            assert found == pytest.approx(min(n1, n2))
            for k, (n, t) in enumerate(((n1, t1), (n2, t2))):
                worst[k] = max(worst[k], abs(t) / n if n > 0 else math.inf)
                least[k] = min(least[k], n)
        assert (asked.friction1, asked.friction2) == pytest.approx(worst)
        assert (asked.normal1, asked.normal2) == pytest.approx(least)
        # an impact from one pair of pivots to another in one attitude
        old, new = (1, -1), (-1, 1)
        theta = np.zeros(2)
        before, after = rng.normal(size=(2, 2))
        change = velocities_of(model, new, theta, after) - velocities_of(
            model, old, theta, before
        )
        n1, t1, n2, t2 = resolved(model, body, 0.0, model.mass * change)
        demand.no_demand(asked)
        demand.ask_impulses(
            body, state_of(old, theta, before), state_of(new, theta, after), asked
        )
        ratios = [abs(t) / n if n > 0 else math.inf for n, t in ((n1, t1), (n2, t2))]
        assert (asked.friction1, asked.friction2) == pytest.approx(ratios)


def test_demands_add_up_to_the_larger_friction_and_the_lesser_force():
    one, two = (plain(each) for each in np.zeros(2, demand.DEMAND))
    for each, values in ((one, (0.3, 0.9, 7.0, -2.0)), (two, (0.5, 0.8, 5.0, -1.0))):
        each.friction1, each.friction2, each.normal1, each.normal2 = values
    demand.add_demand(one, two)
    found = one.friction1, one.friction2, one.normal1, one.normal2
    assert found == (0.5, 0.9, 5.0, -2.0)


def slender_stack(rng):
    """A stack whose blocks lose but part of their speed in an impact."""
    width = rng.uniform(0.3, 0.6)
    lower = Block(width, width * rng.uniform(1.2, 2.5), 200.0, cg_offset=0.01)
    base = width * rng.uniform(0.4, 0.9)
    return Stack(lower, Block(base, base * rng.uniform(2.0, 5.0), rng.uniform(30, 200)))


@pytest.mark.parametrize("law", [None, "position", "couple", "ratio"])
def test_impacts_are_those_of_the_plain_model(law):
    rng, gave_way = np.random.default_rng(8), 0
    kinds = [((1, -1), (True, False)), ((1, 1), (False, True)), ((1, 0), (True, False))]
    kinds += [((0, 1), (False, True)), ((1, -1), (True, True)), ((1, 1), (True, False))]
    for number in range(36):
        stack = slender_stack(rng)
        restitution = measured(stack, rng.uniform(0.5, 1.4), law) if law else None
        body = plain(body_record(system_of(stack, restitution=restitution), False, G))
        model, (c, closes) = Model(stack, G, restitution), kinds[number % len(kinds)]
        c = tuple(int(rng.choice([1, -1])) * np.array(c))
        opens = np.array(c) * rng.uniform(0, 0.1, 2) * ~np.array(closes)
        opening = np.abs(rng.normal(size=2)) * np.array(c) * np.where(closes, -1, 1)
        theta, omega = opens.cumsum(), opening.cumsum()
        closing = tuple(
            int(k) if shut else 0 for k, shut in zip(c, closes, strict=True)
        )
        expected = model.impact(tuple(map(int, c)), closing, theta, omega)
        *after, w1, w2, gives = impact.impact(body, state_of(c, theta, omega), *closes)
        assert (tuple(after), bool(gives)) == (expected[0], expected[2])
        assert (w1, w2) == pytest.approx(expected[1], abs=1e-9)
        gave_way += gives
    # energy stops some of the larger ratios
    assert gave_way > 0 or law != "ratio"


@pytest.mark.parametrize("law", ["couple", "ratio"])
def test_what_was_full_opens_to_either_side_as_the_other_contact_obeys_its_law(law):
    rng, seen = np.random.default_rng(35), set()
    for number in range(80):
        stack = slender_stack(rng)
        restitution = measured(stack, rng.uniform(0.3, 1.4), law)
        body = plain(body_record(system_of(stack, restitution=restitution), False, G))
        model, side = Model(stack, G, restitution), int(rng.choice([1, -1]))
        c = (side, 0) if number % 2 else (0, side)
        closes = tuple(each != 0 for each in c)
        omega = -np.array(c) * rng.uniform(0.2, 2.0)
        theta = np.zeros(2)
        expected = model.impact(c, c, theta, omega.cumsum())
        before = state_of(c, theta, omega.cumsum())
        *after, w1, w2, gives = impact.impact(body, before, *closes)
        assert (tuple(after), bool(gives)) == (expected[0], expected[2])
        assert (w1, w2) == pytest.approx(expected[1], abs=1e-9)
        seen.add((c, tuple(after)))
    assert len(seen) > 6


def test_what_an_impact_leaves_shut_is_pushed_where_its_resultant_passes_the_base():
    seen = set()
    for rng, body, model in stacks(19, 30):
        for new in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            # the open contact changes its pivot, the other one was shut or open before
            old, theta = [-c or int(rng.choice([0, 1, -1])) for c in new], np.zeros(2)
            opening = -np.array(old) * np.abs(rng.normal(size=2))
            before = state_of(old, theta, opening.cumsum())
            after = impact.stuck(body, before, *new)
            found = impact._pushed(body, before, new, after, pivots(new))
            assert found == model._presses(
                new, tuple(old), pivots(new), theta, after, opening.cumsum()
            )
            seen.add((new, found))
    assert len(seen) == 8


def test_a_lone_block_that_comes_down_keeps_the_ratio_that_it_was_given():
    block = random_block(np.random.default_rng(9))
    for ratio in (0.3, 0.7):
        given = MeasuredRestitution(ratio, "ratio")
        body = plain(body_record(system_of(block, restitution=given), False, G))
        for side in (1, -1):
            state = state_of((0, side), (0, 0), (0, -side * 0.8))
            _, after, _, w2, gives = impact.impact(body, state, False, True)
            assert (after, gives) == (-side, 0)
            assert w2 == pytest.approx(-side * 0.8 * ratio)


@pytest.mark.parametrize("linear", [False, True])
def test_momentum_gives_a_lone_block_housners_ratio_also_where_it_is_linearised(linear):
    for seed in range(4):
        block = random_block(np.random.default_rng(seed), slenderness=(2.0, 5.0))
        body = plain(body_record(system_of(block), linear, G))
        for side in (1, -1):
            state = state_of((0, side), (0, 0), (0, -side * 0.8))
            _, after, _, w2, _ = impact.impact(body, state, False, True)
            ratio = geometry.momentum_restitution(block.shape, -side)
            assert (after, w2) == (-side, pytest.approx(-side * 0.8 * ratio))


def test_contacts_begin_open_where_bodies_lean_or_else_turn():
    first = contact_states.first_contacts
    assert first(state_of((0, 0), (0, 0), (0, 0))) == (0, 0)
    assert first(state_of((0, 0), (0.1, 0.1), (-1, -1))) == (1, 0)
    assert first(state_of((0, 0), (0, -0.1), (0, 2))) == (0, -1)
    assert first(state_of((0, 0), (0, 0), (-0.3, 0.2))) == (-1, 1)
    assert first(state_of((0, 0), (0.2, 0.1), (0, 0))) == (1, -1)


def test_series_are_polynomials():
    rng = np.random.default_rng(10)
    for _ in range(10):
        q = rng.normal(size=8)
        curve, tau = Polynomial(q), rng.uniform()
        assert roots.value(q, tau) == pytest.approx(curve(tau))
        assert roots.slope(q, tau) == pytest.approx(curve.deriv()(tau))
        assert roots.bend(q, tau) == pytest.approx(curve.deriv(2)(tau))
        rates = rng.normal(size=7)
        assert taylor.rate_at(rates, tau) == pytest.approx(Polynomial(rates)(tau))
        assert taylor.travel(rates, tau) == pytest.approx(
            Polynomial(rates).integ()(tau)
        )
        assert taylor.quick_sine_cosine(tau) == pytest.approx(
            (math.sin(tau), math.cos(tau)), abs=1e-15
        )


def first_fall(q, end, start=1e-9):
    """Where a polynomial first falls through zero behind ``start``, by its roots; None if it does not."""
    curve = Polynomial(q)
    found = [
        float(root.real)
        for root in curve.roots()
        if abs(root.imag) < 1e-12
        and start < root.real <= end
        and curve.deriv()(root.real) < 0
    ]
    return min(found, default=None)


def test_a_contact_closes_at_the_first_root_of_its_opening():
    rng, seen = np.random.default_rng(11), set()
    for number in range(300):
        q = rng.normal(size=8) * (0.4, 1, 2, 1, 0.3, 0.1, 0.03, 0.01)
        q[0] = 0.0 if number % 3 == 0 else abs(q[0])
        if q[0] == 0.0:
            q[1] = abs(q[1])
        end = rng.uniform(0.3, 1.0)
        expected = first_fall(q, end)
        found = roots.closing_time(q, end)
        seen.add((q[0] == 0.0, expected is None))
        if expected is None:
            assert found == roots.NEVER
        else:
            assert found == pytest.approx(expected, abs=1e-12)
        if Polynomial(q)(1.0) < 0:
            fall = roots.crossing_time(q)
            # one of its falls, the only one where there is one
            assert abs(Polynomial(q)(fall)) < 1e-12
            falls = [
                r
                for r in Polynomial(q).roots()
                if abs(r.imag) < 1e-12 and 1e-9 < r.real <= 1
            ]
            if len(falls) == 1:
                assert fall == pytest.approx(falls[0].real, abs=1e-12)
            assert (
                roots._halved(tuple(q), 1.0) == pytest.approx(fall, abs=1e-12)
                or len(falls) > 1
            )
    assert len(seen) == 4
    # what leaves zero downwards has closed at once, unless it has come back by the end
    down = np.array([0.0, -1.0, *6 * [0.0]])
    assert roots.crossing_time(down) == roots.closing_time(down, 1.0) == 0.0
    assert roots.closing_time(down + 2.0 * np.eye(8)[2], 1.0) == roots.NEVER
    # what leaves zero without speed, upwards, comes back where its bend has it
    back = roots.crossing_time(np.array([0.0, 0.0, 1.0, -2.0, *4 * [0.0]]))
    assert back == pytest.approx(0.5)


def test_the_first_of_two_openings_that_vanishes_is_the_one_that_closes():
    """Of the ground's and the interface's, by the roots of their polynomials; both where they vanish together."""
    rng, seen = np.random.default_rng(20), set()
    series = plain(np.zeros(1, taylor.SERIES)[0])
    for c in [c for c in STATES for _ in range(12)]:
        at, bent = rng.uniform(0.1, 1.9, 2), rng.uniform(0, 0.5, 2)
        if rng.uniform() < 0.2:
            # without rounding
            at[:], bent[:] = 0.55, 0.25
        # each falls to nothing but once
        openings = [
            2.0**-10 * Polynomial([when, -1.0]) * Polynomial([1.0, more])
            for when, more in zip(at, bent, strict=True)
        ]
        first = c[0] * openings[0] if c[0] else Polynomial([0.0])
        relative = c[1] * openings[1] if c[1] else Polynomial([0.0])
        for each, angle in ((series.one, first), (series.two, first + relative)):
            each.angle[:] = 0.0
            each.angle[: angle.degree() + 1] = angle.coef
        found = single.first_closing(*c, series)
        moments = [when if side else math.inf for side, when in zip(c, at, strict=True)]
        when = min(moments)
        if when > 1.0:
            assert found == (roots.NEVER, False, False)
        else:
            assert found == (
                pytest.approx(when),
                moments[0] == when,
                moments[1] == when,
            )
        seen.add(found[1:])
    assert len(seen) == 4


def test_kernels_ask_the_law_of_a_number():
    """Of those that have a rate; all others leave what momentum gives."""
    rng = np.random.default_rng(22)
    for law in laws():
        for given in rng.uniform(0.1, 2.0, (4, 4)):
            value, by_momentum, before, moved = given
            found = kernel_laws.rate(law.number, value, by_momentum, before, moved)
            if law.rate is None:
                assert found == by_momentum
            else:
                assert found == law.rate(value, by_momentum, before, moved)
        assert bool(kernel_laws.moves_impulse(law.number)) == law.moves_impulse
        assert bool(kernel_laws.scales_momentum(law.number)) == law.scales_momentum
    numbers = [law.number for law in laws()]
    assert len(set(numbers)) == len(numbers) > 3


def test_sines_of_a_history_are_numpys():
    angles = np.random.default_rng(21).normal(size=(3, 2))
    sine, cosine = np.empty((2, 3, 2))
    record.fill_sines(angles, sine, cosine)
    assert sine == pytest.approx(np.sin(angles))
    assert cosine == pytest.approx(np.cos(angles))


def test_a_contact_that_opens_this_instant_closes_at_its_next_root_however_short_the_time():
    """A hop of a parabola from zero, over times from a thousandth of the step to all of it."""
    for end in (1.0, 0.3, 0.02, 1e-3):
        for part in (0.05, 0.4, 0.97, 1.2):
            root = part * end
            gap = np.zeros(8)
            gap[1:3] = root, -1.0
            found = roots.closing_time(gap, end)
            if part > 1:
                assert found == roots.NEVER
            else:
                assert found == pytest.approx(root, rel=1e-9)
        # what opens again soon after has closed all the same
        first, then = 0.3 * end, 0.9 * end
        gap[1:4] = first * then, -(first + then), 1.0
        assert roots.closing_time(gap, end) == pytest.approx(first, rel=1e-9)


def test_no_gap_that_closes_between_the_ends_of_a_step_is_passed_over():
    """By its opening and rate at the start and its rate at the end, as a cubic, and not much too often."""
    rng, closes, looked = np.random.default_rng(12), 0, 0
    tau = np.linspace(0, 1, 2001)
    for _ in range(600):
        gap, out, bend = rng.uniform(0, 0.1), rng.normal(0, 0.3), rng.normal(-1, 1)
        c = rng.normal(1, 1)
        later = out + bend + c
        cubic = gap + tau * (out + tau * (bend / 2 + tau * c / 3))
        if later <= 0 or cubic[-1] < 0:
            continue
        hopped = bool(roots.hops(gap, out, later, bend))
        dipped = bool(roots.dips(gap, out, later))
        if out >= 0:
            assert not dipped
            looked += hopped
            if cubic.min() < -1e-9:
                assert hopped
                closes += 1
        else:
            assert not hopped
            # of a parabola
            parabola = gap + tau * (out + tau * (later - out) / 2)
            assert dipped or parabola.min() > 0
            # the parabola's minimum times two is still above
            assert not dipped or gap - out**2 / (later - out) < 0
    assert 3 < closes <= looked < 10 * closes


def test_a_block_that_rises_and_turns_back_touches_where_its_angle_says():
    rng, seen = np.random.default_rng(13), set()
    for _ in range(60):
        rates = np.array(
            [rng.uniform(0.5, 1.5), -rng.uniform(2.0, 4.0), *rng.normal(0, 0.1, 5)]
        )
        angle = Polynomial(rates).integ()
        tau = np.linspace(0, 1, 4001)
        turns = angle(tau).max()
        gap = -turns * rng.uniform(0.5, 1.5)
        found = roots.graze(gap, rates)
        if turns + gap < -1e-6:
            assert found == roots.NEVER
        else:
            first = tau[int(np.argmax(angle(tau) + gap >= 0))]
            assert found == pytest.approx(first, abs=3e-4)
            assert angle(found) + gap == pytest.approx(0.0, abs=1e-9)
        seen.add(found == roots.NEVER)
    assert seen == {False, True}


def test_the_bracket_of_a_hold_closes_on_the_instant_at_which_it_lets_go():
    for power in (1, 3):
        bracket = (0.0, 0.4**power, 1.0, -(0.6**power), 0)
        count = 0
        while not roots.is_narrow(bracket):
            tau = roots.guess_between(bracket)
            away = 0.4 - tau
            hold = math.copysign(abs(away) ** power, away)
            assert bracket[0] < tau < bracket[2]
            bracket = roots.narrowed(bracket, tau, hold)
            count += 1
        assert bracket[0] <= 0.4 <= bracket[2]
        assert bracket[2] - bracket[0] <= 1e-13
        # by far fewer than one after the other
        assert count < 120


def step_with_series(rng, body, c, h=0.01):
    """A step from some state, and its series."""
    theta, omega = drawn_motion(rng, c)
    step = taylor.Step(h, PULL[0], 40.0 * h, PULL[1], -25.0 * h)
    series = plain(np.zeros(1, taylor.SERIES)[0])
    state = state_of(c, theta, omega)
    taylor.fill_series(body, state, step, series)
    return state, step, series


@pytest.mark.parametrize("linear", [False, True])
def test_series_solve_their_equations_and_the_work_of_the_ground_is_the_gain_of_energy(
    linear,
):
    for rng, body, _ in stacks(14, 6, linear):
        for c in STATES:
            state, step, series = step_with_series(rng, body, c)
            later = state_of(c, (0, 0), (0, 0))
            for tau in (0.3, 1.0):
                record.move_within(step, series, tau, later)
                assert later.ground == pytest.approx(PULL[0] + 0.4 * tau)
                assert later.gravity == pytest.approx(PULL[1] - 0.25 * tau)
                alpha = [
                    roots.bend(each.angle, tau) / step.length**2
                    for each in (series.one, series.two)
                ]
                expected = eq.accelerations(body, *c, later)
                assert alpha == pytest.approx(expected, rel=1e-6, abs=1e-6)
            gained = sum(
                sign * (eq.kinetic_energy(body, each) + eq.potential_energy(body, each))
                for sign, each in ((1, later), (-1, state))
            )
            work = record.work_of(body, *c, series, 1.0, step)
            if not linear:
                assert work == pytest.approx(gained, rel=1e-7, abs=1e-9)
            half = record.work_of(body, *c, series, 0.5, step)
            assert min(0, work) - 1e-3 < half < max(0, work) + 1e-3 or linear


def test_the_closest_approach_to_balance_is_in_critical_angles_and_their_speeds():
    for rng, body, _ in stacks(15, 8):
        balances = np.zeros(9, record.BALANCE).view(np.recarray)
        record.fill_balances(body, balances)
        for c in STATES:
            theta, omega = drawn_motion(rng, c)
            theta = theta * rng.uniform(0.5, 6)
            summary = plain(np.zeros(1, record.SUMMARY)[0])
            state = state_of(c, theta, omega)
            record.begin(state, summary)
            beyond = record.track(balances, state, summary)
            ratios, distances = [0.0, 0.0], []
            for body_number, ways, angle, rate in (
                (1, (0, c[1]), theta[1], omega[1]),
                (0, c, theta[0], omega[0]),
            ):
                if c[body_number] == 0:
                    continue
                critical, vx, vy, inertia = eq.balance(body, *ways)
                ratios[body_number] = c[body_number] * angle / critical
                p = math.sqrt(G * math.hypot(vx, vy) / inertia)
                distances.append(
                    math.hypot(1 - ratios[body_number], rate / critical / p)
                )
            assert (summary.ratio1, summary.ratio2) == pytest.approx(
                np.maximum(ratios, 0)
            )
            assert beyond == (max(ratios) >= 1)
            assert summary.unstable_distance == pytest.approx(min(distances))
            assert summary.speed2 == pytest.approx(abs(omega[1]))


def test_what_brings_a_body_back_to_rest_is_linear_in_the_ground_and_in_gravity():
    scratch = state_of((0, 0), (0, 0), (0, 0))
    for rng, body, model in stacks(16, 8):
        restoring = plain(np.zeros(1, chatter.RESTORING)[0])
        chatter.fill_restoring(body, restoring, scratch)
        ground, weight = rng.normal(), rng.uniform(0.7, 1.3)
        back = []
        for c in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            alpha = model.accelerations(
                c, np.zeros(2), np.zeros(2), (ground, weight * G)
            )
            back.append(-(c[0] or c[1]) * alpha[0 if c[0] else 1])
        found = chatter._least_restoring(restoring, ground, weight)
        assert found == pytest.approx(min(back))
        _, vx, vy, inertia = eq.balance(body, 0, 1)
        p = math.sqrt(G * math.hypot(vx, vy) / inertia)
        assert restoring.frequency2 == pytest.approx(p * p)
        still = chatter._least_restoring(restoring, 0.0, 1.0)
        assert restoring.fastest == pytest.approx(0.2 * still / p)


def test_impacts_die_out_where_their_geometric_series_ends_before_the_ground_changes():
    """T = 2 v/(D (1 - e)): on a ground that is still for so long and then opens the contact."""
    block = random_block(np.random.default_rng(17))
    body = plain(body_record(system_of(block), False, G))
    restoring = plain(np.zeros(1, chatter.RESTORING)[0])
    chatter.fill_restoring(body, restoring, state_of((0, 0), (0, 0), (0, 0)))
    least = chatter._least_restoring(restoring, 0.0, 1.0)
    dt, e = 0.01, 0.8
    for quiet in (3, 10):
        samples = np.zeros(40)
        samples[quiet:] = 50.0
        ahead = chatter.Ahead(samples, np.zeros(0), 1.0, 39, 0, 0.5, dt)
        lasts = (quiet - 1 - 0.5) * dt
        for part, ends in ((0.99, True), (1.2, False)):
            speed = part * lasts * least * (1 - e) / 2
            found = chatter.dies_out(speed, e, 1.0, restoring, 1.0, ahead)
            assert found == ends
        # never where an impact leaves all, nor from flights that are followed
        small = 0.1 * lasts * least * (1 - e) / 2
        assert chatter.dies_out(small, e, 1.0, restoring, 1.0, ahead)
        assert not chatter.dies_out(small, 1.0, 1.0, restoring, 1.0, ahead)
        drop = small**2 / (2 * least)
        assert chatter.dies_out(small, e, 1.0, restoring, 1.01 * drop, ahead)
        assert not chatter.dies_out(small, e, 1.0, restoring, 0.99 * drop, ahead)


def test_the_pair_of_dormand_and_prince_is_that_of_scipy():
    assert dormand_prince.INSTANTS[:6] == pytest.approx(RK45.C)
    assert dormand_prince.INSTANTS[6] == 1.0
    assert dormand_prince.WEIGHTS[:6, :5] == pytest.approx(RK45.A)
    assert dormand_prince.WEIGHTS[6] == pytest.approx(RK45.B)
    rates = np.random.default_rng(18).normal(size=(7, 3))
    for component in range(3):
        found = dormand_prince.error_rate(rates, component)
        assert abs(found) == pytest.approx(abs(RK45.E @ rates[:, component]))
