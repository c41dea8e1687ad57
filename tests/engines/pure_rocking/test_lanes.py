"""What lanes know of one state, beside the plain model of the oracle; when rest ends; and hops that are closed.

Kernels are called one by one, as plain Python.
"""

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rockfrag import Block, Stack
from rockfrag.simulation.options import system_of

from ...mutants.plain import plain_library
from ...oracle.rocking_model import Model, pivots
from ..planar.cases import G
from .plain_rocking import (
    STATES,
    body_record,
    chatter,
    drawn_motion,
    eq,
    impact,
    plain,
    stacks,
    state_of,
    taylor,
)

with plain_library():
    from rockfrag.engines.pure_rocking.ensembles import _extremes, write_rocking
    from rockfrag.engines.pure_rocking.kernels.lanes import (
        block,
        series,
        stack_case,
        stack_constants,
        stack_one,
        stack_two,
    )
    from rockfrag.engines.pure_rocking.kernels.lanes import case as cases
    from rockfrag.outcomes.outcomes import empty_outcomes

H = 0.004  # interval of the samples [s]


def constants_of(body, h=H):
    """What lanes know of the nine contact states of a body."""
    made = [
        np.zeros(9, kind).view(np.recarray)
        for kind in (stack_constants.ONE, stack_constants.TWO, stack_constants.IMPACT)
    ]
    scratch = state_of((0, 0), (0, 0), (0, 0))
    stack_constants.fill_constants(body, h, *made, scratch)
    return made


def test_what_turns_alone_holds_the_other_contact_as_the_plain_model_says():
    for rng, body, model in stacks(21, 6):
        one, _, _ = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            theta, omega = drawn_motion(rng, c)
            weight, ground = rng.uniform(0.5, 1.5), rng.normal(0, 3)
            pull = (ground, weight * G)
            margins = model.margins(c, theta, omega, pull)
            shut = c.index(0)
            unit = model.weight[shut] * abs(model.half[shut])
            expected = min(margins[shut, s] for s in (1, -1)) * unit * H**2
            at = one[eq.number_of(*c)]
            turn = theta[1] if shut == 0 else theta[0]
            rate = omega[1] if shut == 0 else omega[0]
            found = stack_one.least_hold(at, turn, rate * H, (ground, weight), G)
            assert found == pytest.approx(expected, rel=1e-6, abs=1e-9 * unit * H**2)
            # what has just landed is settled if that holds it
            case = SimpleNamespace(c1=c[0], c2=c[1], slot=0, omega2=rate * H)
            case.ground, case.weight = ground, weight
            holds = stack_one.least_hold(at, 0.0, rate * H, (ground, weight), G) > 0
            worker = SimpleNamespace(ones=one.reshape(1, 9))
            assert stack_case._is_settled(case, worker, G) == holds
            # how near balance: of the critical angle, and of its speed
            critical, vx, vy, inertia = eq.balance(body, *c)
            frequency = math.sqrt(G * math.hypot(vx, vy) / inertia)
            side = c[0] + c[1]
            assert at.per_angle == pytest.approx(side / critical)
            speed = 1.0 / (critical * frequency * H) ** 2
            assert at.per_speed == pytest.approx(speed)


def test_the_other_contact_lets_go_where_the_plain_model_would_have_it_pull():
    seen = set()
    for rng, body, model in stacks(25, 6):
        one, _, _ = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            side = np.array(c)
            theta, omega = (side * 0.1).cumsum(), (side * rng.normal()).cumsum()
            ends = (0.0, rng.normal(0, 40.0))
            series = plain(np.zeros(1, taylor.SERIES)[0])
            ramp = taylor.Step(H, ends[0], ends[1] - ends[0], G, 0.0)
            taylor.fill_series(body, state_of(c, theta, omega, (0.0, G)), ramp, series)
            lane = plain(np.zeros(1, stack_one.LANE)[0])
            lane.flag[0], lane.was_left[0] = cases.NEARS, 1.0
            lane.was_ground[0], lane.ground_end[0] = ends
            lane.was_weight[0] = lane.weight_end[0] = 1.0
            if c[0] == 0:
                series.one.angle = series.two.angle
            angle = Polynomial(series.one.angle)
            series.gap = side.sum() * series.one.angle

            def margin(tau, c=c, angle=angle, ends=ends, model=model):
                turns = np.array([c[0] != 0, True])
                at, rate = angle(tau) * turns, angle.deriv()(tau) / H * turns
                return min(model.margins(c, at, rate, (ends[1] * tau, G)).values())

            found = stack_one.next_contact_event(
                one[eq.number_of(*c)], lane, 0, series, G
            )
            if margin(0.0) < 0:
                continue
            lets_go = margin(1.0) < 0
            seen.add((c, lets_go))
            assert found[1] == lets_go
            if lets_go:
                assert found[0] == pytest.approx(brentq(margin, 0.0, 1.0), abs=1e-9)
    assert {(c, True) for c in STATES if 0 in c} < seen


def test_the_landing_of_what_turns_alone_is_the_impact_of_unit_speed():
    for _, body, model in stacks(22, 10):
        _, _, impacts = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            at = impacts[eq.number_of(*c)]
            # towards the ground, at a unit of speed
            omega = np.array([-1.0 * c[0], -1.0 * (c[0] + c[1])])
            state = state_of(c, (0, 0), omega)
            found = impact.impact(body, state, c[0] != 0, c[1] != 0)
            assert (at.next1, at.next2) == found[:2]
            assert (at.after1, at.after2) == pytest.approx(found[2:4])
            before = model.kinetic_energy(c, np.zeros(2), omega)
            after = model.kinetic_energy(
                (at.next1, at.next2), np.zeros(2), np.array([at.after1, at.after2])
            )
            assert at.fraction == pytest.approx(math.sqrt(after / before))
            assert at.fraction <= 1.0


def test_extremes_of_a_lane_are_those_of_the_phase_plane():
    lane = plain(np.zeros(1, stack_one.LANE)[0])
    lane.per_angle[2], lane.per_speed[2] = -1 / 0.3, 4.0
    lane.was_ratio[2], lane.was_fast[2], lane.was_near[2] = 0.1, 0.05, 2.0
    ratio, fast, near = stack_one.nearest(lane, 2, -0.15, 0.2)
    assert (ratio, fast, near) == pytest.approx((0.5, 0.2, 0.25 + 4.0 * 0.04))
    lane.was_ratio[2], lane.was_fast[2], lane.was_near[2] = 0.7, 0.3, 0.1
    assert stack_one.nearest(lane, 2, -0.15, 0.2) == pytest.approx((0.7, 0.3, 0.1))
    # of two bodies it is the nearer one's distance
    lane = plain(np.zeros(1, stack_two.LANE)[0])
    lane.per_angle1[2], lane.per_speed1[2] = -1 / 0.3, 4.0
    lane.per_angle2[2], lane.per_speed2[2] = 1 / 0.2, 9.0
    lane.was_near[2] = 2.0
    for angle, rate in ((0.02, 0.0), (0.19, 0.05)):
        *ratios, fast, near = stack_two.nearest(lane, 2, (-0.15, 0.2, angle, rate))
        assert (*ratios, fast) == pytest.approx((0.5, 5 * angle, rate))
        nearer = min(0.25 + 4.0 * 0.04, (1 - 5 * angle) ** 2 + 9.0 * rate**2)
        assert near == pytest.approx(nearer)
    # a lone block's angle is counted from balance
    lane = plain(np.zeros(1, block.LANE)[0])
    lane.per_angle[2], lane.per_speed[2] = 1 / 0.3, 4.0
    lane.low[2], lane.fast[2], lane.near[2] = 1.0, 0.05, 2.0
    block._keep_extremes(lane, 2, 0.15, -0.2)
    found = lane.low[2], lane.fast[2], lane.near[2]
    assert found == pytest.approx((0.5, 0.2, 0.25 + 4.0 * 0.04))


def hop_of(rng, c, contact, speed):
    """A contact that has come down on its other side and off again while the other one is open."""
    theta, omega = drawn_motion(rng, c)
    # where it touches: the pedestal stands, or both are turned alike
    theta = np.array([0.0, theta[1]]) if contact == 0 else np.full(2, theta[0])
    omega = H * np.array(omega)
    # it opens to its side
    if contact == 0:
        omega[0] = speed * c[0]
    else:
        omega[1] = omega[0] + speed * c[1]
    hop = chatter.Hop(
        contact == 0,
        c[contact],
        -1.6 * speed,
        math.cos(theta[1]),
        math.sin(theta[1]),
        *omega,
    )
    return hop, theta, omega


def closing(model, state, contact, theta, omega, pulls):
    """Acceleration that closes a contact, by the plain model [rad per sample²]."""
    # rates by the second, as the model counts
    alpha = model.accelerations(state, theta, omega / H, pulls)
    relative = -alpha[0] if contact == 0 else -(alpha[1] - alpha[0])
    return state[contact] * relative * H**2


@pytest.mark.parametrize("upward", [0.0, 0.02])
@pytest.mark.parametrize("contact", [0, 1])
def test_hops_of_a_geometric_series_are_closed_if_it_ends_in_time(contact, upward):
    """T = 3 v (1/D + b/D') / (1 - l), with accelerations by Newton's laws on either side of the contact."""
    told = set()
    for rng, body, model in stacks(23, 12):
        _, two, _ = constants_of(body)
        for c in [c for c in STATES if 0 not in c]:
            hop, theta, omega = hop_of(rng, c, contact, 1e-5 * H)
            old = tuple(-s if k == contact else s for k, s in enumerate(c))
            weight, ground = 1.0 + upward, rng.normal(0, 0.5)
            opens, parts = [], []
            for state in (c, old):
                pulls = (ground, weight * G)
                opens.append(closing(model, state, contact, theta, omega, pulls))
                mass, _ = model.terms(pivots(state), theta, 0 * omega, (0.0, G))
                # inertia of the relative turn while the other momentum stays
                if contact == 0:
                    parts.append(np.linalg.det(mass) / mass[1, 1])
                else:
                    parts.append(np.linalg.det(mass) / mass.sum())
            samples = np.full(60, ground)
            lift = np.full(60, upward) if upward else np.zeros(0)
            ahead = chatter.Ahead(samples, lift, 1.0, 59, 3, 0.4, H)
            before = two[eq.number_of(*old)]
            after = two[eq.number_of(*c)]

            def closes(longest, hop=hop, before=before, after=after, ahead=ahead):
                return chatter.may_close(hop, before, after, longest, G, ahead)

            e = 1 / 1.6
            left = e * e * parts[0] / parts[1]
            if min(opens) <= 0 or left > 0.98:
                told.add("stays open")
                assert not closes(1e9)
                continue
            lasts = 3 * 1e-5 * H * (1 / opens[0] + left / e / opens[1]) / (1 - left)
            if lasts > 0.02 / H:
                continue
            told.add("closes")
            assert closes(1.001 * lasts)
            assert not closes(0.999 * lasts)
            # of what loses hardly anything in two impacts no end is foreseen
            old_speed = 1e-5 * H * math.sqrt(parts[0] / parts[1] / 0.99)
            assert not closes(1e9, hop=hop._replace(old=-old_speed))
            # a ground that changes at a steady rate: what the least of both give is within twice the time
            if 2 * lasts < 0.5:
                told.add("changes")
                pulls = (ground + 1.0, weight * G)
                per = [
                    closing(model, state, contact, theta, omega, pulls) - now
                    for state, now in zip((c, old), opens, strict=True)
                ]
                # what takes all of the first one away by then
                whole = -opens[0] / per[0] / (2 * lasts)
                for part in (0.1, 0.4, 0.6, 0.8, 0.95):
                    rate = part * whole
                    samples[3:] = ground + rate * (np.arange(57) - 0.4)
                    least = [
                        min(now, now + by * rate * 2 * lasts)
                        for now, by in zip(opens, per, strict=True)
                    ]
                    more = 3 * 1e-5 * H / (1 - left)
                    more *= 1 / least[0] + left / e / least[1]
                    assert closes(1e9) == (min(least) > 0 and more < 2 * lasts)
                samples[:] = ground
            # the ground that pulls it open comes within the time, twice over
            samples[4:] = 1e4
            later = closes(1e9)
            samples[4:] = -1e4
            assert not (later and closes(1e9))
            # closed, the momentum of what rocks on stays
            rates = np.array(chatter.closed(hop, after))
            mass, _ = model.terms(pivots(c), theta, 0 * omega, (0.0, G))
            if contact == 0:
                assert rates[0] == 0.0
                assert mass[1, 1] * rates[1] == pytest.approx(mass[1] @ omega)
            else:
                assert rates[0] == rates[1]
                assert mass.sum() * rates[0] == pytest.approx(mass.sum(axis=0) @ omega)
    assert told == {"stays open", "closes", "changes"}


@pytest.mark.parametrize("upward", [False, True])
@pytest.mark.parametrize("factor", [1.0, -0.7])
def test_rest_ends_where_the_ground_leaves_what_the_weight_can_hold(factor, upward):
    rng, seen = np.random.default_rng(24), set()
    for _ in range(24):
        count = 4 * cases.BLOCK
        samples = rng.normal(0, 1.0, count) * np.linspace(
            0.1, rng.uniform(0.1, 1.5), count
        )
        samples[-1] = 0.0
        k, tau = int(rng.integers(0, 30)), rng.uniform(0, 1)
        if rng.uniform() < 0.5:
            # more than it can hold, but that is over by now
            samples[k], tau = 4.0, rng.uniform(0.9, 1)
        vertical = 0.2 * rng.normal(size=count) if upward else np.zeros(0)
        blocks = samples.reshape(-1, cases.BLOCK)
        up = vertical.reshape(-1, cases.BLOCK)

        def ends(each, what):
            found = [what(block, initial=0.0) for block in each]
            accumulate = np.maximum if what is np.max else np.minimum
            return np.array(found), accumulate.accumulate(found[::-1])[::-1]

        high, ahead_high = ends(blocks, np.max)
        low, ahead_low = ends(blocks, np.min)
        _, up_high = ends(up, np.max) if upward else (0, np.zeros(4))
        _, up_low = ends(up, np.min) if upward else (0, np.zeros(4))
        motions = cases.Motions(
            samples, vertical, high, low, ahead_high, ahead_low, up_high, up_low,
            np.array([0, count]), np.array([count - 1]),
        )  # fmt: skip
        least, most = -1.1, 1.4
        fine = np.linspace(0, 1, 100)
        first = None
        for j in range(k, count - 1):
            for part in fine if j > k else fine[fine >= tau]:
                a = factor * (samples[j] + part * (samples[j + 1] - samples[j]))
                w = 1.0
                if upward:
                    w += factor * (vertical[j] + part * (vertical[j + 1] - vertical[j]))
                if not least * w <= a <= most * w:
                    first = j + part
                    break
            if first is not None:
                break
        at, part, ground, weight = cases.next_uplift(
            motions, k, tau, count - 1, factor, (least, most)
        )
        if first is None:
            assert at == -1
            seen.add("stays")
            continue
        assert at + part == pytest.approx(max(first, k + tau), abs=1 / 80)
        if at + part > k + tau + 1e-6:
            assert ground == pytest.approx(weight * (most if ground > 0 else least))
            seen.add("leaves")
        else:
            seen.add("at once")
    assert {"stays", "leaves"} <= seen


def test_contact_events_are_counted_by_sample():
    case, counts = SimpleNamespace(counted_sample=-1, contact_events=9), []
    for case.k in (3, 3, 4, 7, 7, 7):
        stack_case._count_contact_event(case)
        counts.append(case.contact_events)
    assert counts == [1, 2, 1, 1, 2, 3]


def test_what_comes_into_a_lane_is_what_comes_out_of_it():
    """A case in which one contact is open, with the peaks of both bodies so far."""
    still = SimpleNamespace(samples=np.zeros(9), vertical=np.zeros(0))
    for rng, body, _ in stacks(26, 2):
        ones = constants_of(body)[0].reshape(1, 9)
        for c in [c for c in STATES if 0 in c]:
            case = plain(np.zeros(1, stack_case.CASE)[0])
            case.c1, case.c2, case.last = *c, 8
            case.theta2, case.omega2 = rng.normal(size=2)
            case.peak1, case.peak2, case.fast, case.near = rng.uniform(size=4)
            before = case.copy()
            lane = plain(np.zeros(1, stack_one.LANE)[0])
            stack_case.place_one(1, case, SimpleNamespace(one=lane, ones=ones), still)
            stack_case.store_one(1, case, lane)
            for name in ("theta2", "omega2", "peak1", "peak2", "fast", "near"):
                assert case[name] == before[name]
            assert case.theta1 == (case.theta2 if c[1] == 0 else 0.0)


def test_a_lone_block_falls_for_certain_only_as_it_opens():
    """Its energy of motion is beyond the barrier; one that comes back rocks over to the other side."""
    lane = plain(np.zeros(1, block.LANE)[0])
    lane.barrier[1], lane.heavy[1], lane.bound[1] = 1.1, 1.0, 0.1
    lane.kappa[1] = 0.01
    turn = math.sin(0.2), math.cos(0.2)
    needed = math.sqrt(2 * 0.01 * (1.1 - turn[1] + 0.1 * turn[0]))
    for omega, falls in (
        (-1.01 * needed, True),
        (-0.99 * needed, False),
        (1.01 * needed, False),
    ):
        assert block._is_certain(lane, 1, turn, omega, 0.5 * omega) == falls


def lane_of(gap):
    """A lane of a block over a step in which ψ less its critical angle is this polynomial."""
    lane = plain(np.zeros(1, block.LANE)[0])
    rates = np.zeros(7)
    rates[: gap.degree()] = gap.deriv().coef
    lane.angle[0], lane.kappa[0], lane.was_left[0] = 0.3, 0.01, 1.0
    lane.was_psi[0], lane.was_omega[0] = 0.3 + gap(0.0), rates[0]
    lane.psi[0], lane.omega[0] = 0.3 + gap(1.0), gap.deriv()(1.0)
    lane.rates[:, 0] = rates[1:]
    tally = SimpleNamespace(peak2=0.0, fast=0.0, unstable_distance=1.0)
    return lane, tally


def test_a_block_that_falls_back_and_is_thrown_open_within_a_step_lands_in_between():
    x = Polynomial([0.0, 1.0])
    gap = -0.001 - 0.002 * x + 0.06 * (x * (1 - x)) ** 2
    lane, tally = lane_of(gap)
    t, psi, _, stays = block._contact_event(lane, 0, tally)
    assert t == pytest.approx(brentq(gap, 0.0, 0.4), abs=1e-9)
    assert psi == 0.3 and not stays


def test_a_peak_is_noted_where_a_block_turns_back_and_at_the_end_where_it_does_not():
    x = Polynomial([0.0, 1.0])
    turns, opens = -0.05 - 0.02 * x + 0.03 * x**2, -0.05 - 0.03 * x + 0.005 * x**2
    for gap in (turns, opens):
        lane, tally = lane_of(gap)
        block._contact_event(lane, 0, tally)
        least = gap(np.linspace(0, 1, 3001)).min()
        assert tally.peak2 == pytest.approx(-least / 0.3, rel=1e-6)


def test_what_is_ahead_of_a_block_of_samples_is_of_its_own_motion():
    rng, sizes = np.random.default_rng(27), (3, 1, 2)
    offsets = cases.BLOCK * np.concatenate([[0], np.cumsum(sizes)])
    samples = rng.normal(size=offsets[-1])
    found = _extremes(samples, offsets)
    for n in range(sum(sizes)):
        own = slice(n * cases.BLOCK, (n + 1) * cases.BLOCK)
        end = offsets[np.searchsorted(offsets, n * cases.BLOCK, side="right")]
        ahead = samples[n * cases.BLOCK : end]
        expected = samples[own].max(), samples[own].min(), ahead.max(), ahead.min()
        assert [each[n] for each in found] == list(expected)


@pytest.mark.parametrize("upward", [False, True])
def test_the_series_of_a_lone_block_is_that_of_its_equation(upward):
    """ψ'' = κ (W sin ψ + A cos ψ), coefficient by coefficient, by products of series."""
    rng = np.random.default_rng(28)
    for _ in range(5):
        psi, w, kappa = rng.uniform(0.1, 0.5), rng.normal(), rng.uniform(0.5, 1)
        ground = Polynomial(rng.normal(size=2))
        weight = Polynomial([rng.uniform(0.5, 1.5), 0.4] if upward else [1.0])
        angle = np.zeros(8)
        angle[:2] = psi, w
        sine, cosine = np.zeros(8), np.zeros(8)
        sine[0], cosine[0] = math.sin(psi), math.cos(psi)
        for n in range(6):
            torque = weight * Polynomial(sine) + ground * Polynomial(cosine)
            angle[n + 2] = kappa * torque.coef[n] / ((n + 1) * (n + 2))
            rate = Polynomial(angle).deriv()
            sine[n + 1] = (rate * Polynomial(cosine)).coef[n] / (n + 1)
            cosine[n + 1] = -(rate * Polynomial(sine)).coef[n] / (n + 1)
        lift = (weight.coef[0], 0.4 * upward, upward)
        found = series.rates_of_one(
            (math.sin(psi), math.cos(psi)), w, kappa, tuple(ground.coef), lift
        )
        assert found == pytest.approx(Polynomial(angle).deriv().coef)


def test_hops_of_a_lone_block_end_where_the_ground_stays_still_for_as_long():
    """T = 2 w (1/D + e/D') / (1 - e²), on a ground that is still and then opens it."""
    pivot = SimpleNamespace(sine=0.3, cosine=0.95, swing=0.01, restitution=0.8)
    drop = pivot.swing * pivot.sine
    for quiet in (4, 12):
        samples = np.zeros(64)
        samples[quiet:] = 50.0
        ahead = chatter.Ahead(samples, np.zeros(0), 1.0, 63, 0, 0.0, 1.0)
        for part, ends in ((0.9, True), (1.2, False)):
            speed = part * (quiet - 1) * drop * (1 - 0.64) / (2 * 1.8)
            for side in (1, -1):
                found = chatter.block_dies_out(speed, side, pivot, pivot, ahead)
                assert found == ends
        # on a still ground not from flights that are too high to be left out
        still = ahead._replace(samples=np.zeros(64))
        high = 0.2 * drop / math.sqrt(pivot.swing)
        assert not chatter.block_dies_out(1.01 * high, 1, pivot, pivot, still)


@pytest.mark.parametrize(("left", "part"), [(1.0, 1.0), (0.6, 0.25)])
def test_two_rotations_come_to_a_contact_event_with_ground_and_weight_of_that_instant(
    left, part
):
    """Both contacts close at once; ground and weight are linear in the sample."""
    lane = plain(np.zeros(1, stack_two.LANE)[0])
    lane.was_left[0], lane.part[0], lane.when[0] = left, part, 0.3
    lane.closes1[0] = lane.closes2[0] = 1
    ground, weight = Polynomial([2.0, -3.0]), Polynomial([0.8, 0.4])
    begins = 1.0 - left
    lane.was_ground[0], lane.ground_end[0] = ground(begins), ground(1.0)
    lane.was_weight[0], lane.weight_end[0] = weight(begins), weight(1.0)
    series = plain(np.zeros(1, taylor.SERIES)[0])
    worker = SimpleNamespace(two=lane, series=[series])
    case = plain(np.zeros(1, stack_case.CASE)[0])
    bodies = [SimpleNamespace(measured=1)]
    ensemble, none = SimpleNamespace(bodies=bodies), None
    found = stack_case.contact_event_of_two(0, case, worker, ensemble, none, G)
    assert found == (True, True)
    at = begins + 0.3 * part
    assert (case.tau, case.ground, case.weight) == pytest.approx(
        (at, ground(at), weight(at))
    )


def test_both_rotations_are_measured_by_their_critical_angles_and_the_speeds_there():
    """The pedestal with what it carries in that contact state, and the statue on a pedestal that stands."""
    for _, body, _ in stacks(29, 6):
        _, two, _ = constants_of(body)
        for c in [c for c in STATES if 0 not in c]:
            at = two[eq.number_of(*c)]
            for k, state in enumerate((c, (0, c[1]))):
                critical, vx, vy, inertia = eq.balance(body, *state)
                frequency2 = G * math.hypot(vx, vy) / inertia
                speed = 1.0 / (critical**2 * frequency2 * H**2)
                assert at[f"per_angle{k + 1}"] == pytest.approx(c[k] / critical)
                assert at[f"per_speed{k + 1}"] == pytest.approx(speed)


def test_a_fall_is_as_far_from_balance_as_the_speed_that_a_still_ground_leaves():
    """Before balance by ψ'' = κ sin ψ up to there, beyond it by what it has; never more than before."""
    kappa, critical = 0.02, 0.3
    for psi, before in ((0.2, 9.0), (0.2, 0.1), (-0.15, 9.0), (-0.15, 0.05)):
        lane = plain(np.zeros(1, block.LANE)[0])
        i = 5
        lane.angle[i], lane.kappa[i] = critical, kappa
        omega = -0.05
        lane.was_psi[i], lane.was_omega[i] = psi, omega
        lane.was_low[i], lane.was_fast[i], lane.was_near[i] = 0.4, 0.07, 0.5
        lane.low[i], lane.fast[i], lane.near[i] = 0.1, 0.2, 0.3
        tally = SimpleNamespace(unstable_distance=before)
        if psi > 0:

            def upright(_, y):
                return y[0]

            upright.terminal = True
            path = solve_ivp(
                lambda _, y: (y[1], kappa * math.sin(y[0])),
                (0.0, 100.0),
                (psi, omega),
                events=upright,
                rtol=1e-10,
                atol=1e-12,
            )
            at, rate = path.y_events[0][0]
        else:
            at, rate = psi, omega
        distance = math.hypot(at, rate / math.sqrt(kappa)) / critical
        block._fall(lane, i, tally)
        assert tally.unstable_distance == pytest.approx(min(before, distance))
        assert lane.fell[i] == 1
        # without what the step would have reached
        assert (lane.low[i], lane.fast[i], lane.near[i]) == (0.4, 0.07, 0.5)
    # what does not get as far as balance on a still ground has no distance from it
    lane.was_psi[i], lane.was_omega[i] = 0.2, -1e-3
    block._fall(lane, i, tally)
    assert tally.unstable_distance == 0.0


def test_what_kernels_say_of_cases_is_written_by_systems_and_bodies():
    """A lone body is the kernels' second; of what fell the peak is infinite, and nothing slips."""
    rng, shape = np.random.default_rng(30), (3, 2, 2)
    names = [("vase",), ("pedestal", "bust"), ("urn",)]
    into = empty_outcomes(names, np.ones((2, 2)))
    found = np.zeros(shape, cases.OUTCOME)
    for name in ("peak1", "peak2", "unstable_distance"):
        found[name] = rng.uniform(size=shape)
    for name in ("impacts", "given_way"):
        found[name] = rng.integers(0, 9, shape)
    found["fallen"][0, 1, 0] = found["fallen"][1, 0, 1] = 2
    found["fallen"][1, 1, 1] = 1
    write_rocking(into, found)
    for at in np.ndindex(*shape):
        two = at[0] == 1
        fallen = int(found["fallen"][at])
        number = fallen if two else int(fallen > 0)
        assert into.overturned[at] == (fallen > 0)
        assert into.overturned_body[at] == number
        peaks = [found["peak1"][at], found["peak2"][at]][1 - two :]
        for k, peak in enumerate(peaks):
            expected = math.inf if number == k + 1 else peak
            assert into.peak_rotation[at][k] == expected
            assert into.slip[at][k] == into.peak_slip[at][k] == 0.0
        for name in ("impacts", "given_way", "unstable_distance"):
            assert getattr(into, name)[at] == found[name][at]


def rocking_alone(rng, body, c, gap):
    """A lane of what turns alone over a step in which its contact opens by this polynomial."""
    lane = plain(np.zeros(1, stack_one.LANE)[0])
    side = sum(c)
    angle = np.zeros(8)
    angle[: gap.degree() + 1] = side * gap.coef
    left = rng.uniform(0.3, 1.0)
    lane.was_left[0], lane.side[0] = left, side
    lane.was_theta[0], lane.was_omega[0] = angle[0], angle[1] / left
    lane.rates[:, 0] = angle[2:] * np.arange(2, 8)
    lane.per_angle[0], lane.per_speed[0], lane.was_near[0] = side / 0.3, 4.0, 9.0
    return lane


def test_what_turns_alone_is_moved_to_its_contact_event_or_the_end_of_its_step(
    monkeypatch,
):
    """Its state is that of its series there, the ground and the weight are linear in between."""
    # the other contact holds
    monkeypatch.setattr(stack_one, "least_hold", lambda *_: 1.0)
    x, seen = Polynomial([0.0, 1.0]), set()
    gaps = {"opens": 0.1 + 0.02 * x + 0.01 * x**3, "closes": 1e-3 * (0.6 - x)}
    gaps["at the end"] = 1e-3 * (1.0 - x)
    for rng, body, _ in stacks(31, 3):
        ones, _, impacts = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            for kind, gap in gaps.items():
                lane = rocking_alone(rng, body, c, gap)
                lane.flag[0] = cases.QUIET if kind == "opens" else cases.CLOSES
                lane.was_ground[0], lane.ground_end[0] = 0.01, 0.02
                lane.was_weight[0], lane.weight_end[0] = 0.9, 1.1
                case = plain(np.zeros(1, stack_case.CASE)[0])
                case.c1, case.c2, case.interval, case.near = *c, H, 9.0
                made = plain(np.zeros(1, taylor.SERIES)[0])
                worker = SimpleNamespace(
                    one=lane,
                    series=[made],
                    ones=ones.reshape(1, 9),
                    impacts=impacts.reshape(1, 9),
                    state=state_of((0, 0), (0, 0), (0, 0)),
                )
                ensemble = SimpleNamespace(bodies=[body])
                motions = SimpleNamespace(vertical=np.zeros(0), samples=np.zeros(9))
                # as if another contact event had to be ended by a general impact
                case.contact_events, case.counted_sample = 10**6, 0
                found = stack_case.contact_event_of_one(
                    0, case, worker, ensemble, motions, G
                )
                at = 0.6 if kind == "closes" else 1.0
                assert found == (
                    kind != "opens" and c[0] != 0,
                    kind != "opens" and c[1] != 0,
                )
                left = lane.was_left[0]
                assert case.tau == pytest.approx(1.0 - left * (1.0 - at))
                rate = sum(c) * gap.deriv()(at) / left
                assert case.omega2 == pytest.approx(rate)
                assert case.omega1 == pytest.approx(rate if c[1] == 0 else 0.0)
                if kind == "opens":
                    assert case.theta2 == pytest.approx(sum(c) * gap(1.0))
                    assert case.impacts == 0
                    continue
                assert case.theta1 == case.theta2 == 0.0
                assert case.impacts == 1
                assert case.ground == pytest.approx(0.01 + 0.01 * at)
                assert case.weight == pytest.approx(0.9 + 0.2 * at)
                peak = case.peak1 if c[1] == 0 else case.peak2
                assert peak == pytest.approx(0.0, abs=1e-12)
                seen.add((c, kind))
    assert len(seen) == 8


def test_what_let_go_in_the_sample_before_is_moved_to_its_contact_event_there(
    monkeypatch,
):
    monkeypatch.setattr(stack_one, "least_hold", lambda *_: 1.0)
    x = Polynomial([0.0, 1.0])
    for rng, body, _ in stacks(33, 2):
        ones, _, impacts = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            for before in (0.0, 1.0):
                lane = rocking_alone(rng, body, c, 0.1 + 0.02 * x)
                lane.flag[0], lane.has_before[0] = cases.RELEASE, before
                lane.before_theta[0], lane.before_left[0] = 0.07 * sum(c), 1.0
                lane.was_weight[0] = lane.before_weight[0] = lane.weight_end[0] = 1.0
                case = plain(np.zeros(1, stack_case.CASE)[0])
                case.c1, case.c2, case.interval, case.near, case.k = *c, H, 9.0, 7
                worker = SimpleNamespace(
                    one=lane,
                    series=[plain(np.zeros(1, taylor.SERIES)[0])],
                    ones=ones.reshape(1, 9),
                    impacts=impacts.reshape(1, 9),
                    state=state_of((0, 0), (0, 0), (0, 0)),
                )
                stack_case.contact_event_of_one(
                    0,
                    case,
                    worker,
                    SimpleNamespace(bodies=[body]),
                    SimpleNamespace(vertical=np.zeros(0), samples=np.zeros(9)),
                    G,
                )
                # nothing lets go, so that it has come to the end of this sample
                assert (case.k, case.tau) == (7 - before, 1.0)
                was = 0.07 if before else 0.1
                assert abs(lane.was_theta[0]) == pytest.approx(was)


def test_of_a_closing_and_a_contact_that_lets_go_before_the_first_is_taken():
    """The ground grows from nothing to what the other contact cannot hold by the time of the closing, or later."""
    rng, x, seen = np.random.default_rng(32), Polynomial([0.0, 1.0]), set()
    slender = Stack(Block(0.3, 1.5, 360.0), Block(0.25, 0.3, 70.0, cg_offset=0.01))
    squat = Stack(Block(0.6, 0.5, 360.0), Block(0.25, 0.8, 70.0, cg_offset=0.01))
    for stack in (slender, squat):
        body, model = plain(body_record(system_of(stack), False, G)), Model(stack, G)
        one, _, _ = constants_of(body)
        for c in [c for c in STATES if 0 in c]:
            gap = 1e-5 * (0.5 - x)
            lane = rocking_alone(rng, body, c, gap)
            lane.was_left[0], lane.flag[0] = 1.0, cases.CLOSES
            lane.was_weight[0] = lane.weight_end[0] = 1.0
            made = plain(np.zeros(1, taylor.SERIES)[0])
            made.one.angle[:2] = sum(c) * gap.coef
            made.gap[:2] = gap.coef
            for begin, end in itertools.product((0.0, 2.0, -2.0), (0.0, 30.0, -30.0)):
                lane.was_ground[0], lane.ground_end[0] = begin, end

                def margin(tau, c=c, gap=gap, ramp=(begin, end - begin), model=model):
                    turns = np.array([c[0] != 0, True]) * sum(c)
                    at, rate = gap(tau) * turns, gap.deriv()(tau) / H * turns
                    pull = (ramp[0] + ramp[1] * tau, G)
                    return min(model.margins(c, at, rate, pull).values())

                if margin(0.0) < 0:
                    continue
                found = stack_one.next_contact_event(
                    one[eq.number_of(*c)], lane, 0, made, G
                )
                lets_go = margin(0.5) < 0
                first = brentq(margin, 0.0, 0.5) if lets_go else 0.5
                assert found == (pytest.approx(first, abs=1e-9), lets_go)
                seen.add((c, lets_go))
    assert len(seen) == 8


@pytest.mark.parametrize("upward", [False, True])
def test_what_turns_alone_advances_by_its_equation_and_goes_back_to_the_same_bits(
    upward,
):
    """θ'' = W (gx cos θ + gy sin θ) - a/g (gy cos θ - gx sin θ) over what is left of a sample."""
    rng, flags = np.random.default_rng(33), set()
    lane = plain(np.zeros(1, stack_one.LANE)[0])
    n = cases.LANES
    lane.gx[:], lane.gy[:] = rng.normal(0, 2e-4, n), rng.uniform(1e-4, 4e-4, n)
    lane.theta[:], lane.omega[:] = rng.normal(0, 0.2, n), rng.normal(0, 2e-3, n)
    lane.theta[:4] = 1.5 * np.pi / 3 * np.array([1.001, -1.001, 0.999, -0.999])
    lane.omega[:4] = 0.0
    lane.side[:] = np.where(lane.theta < 0, -1.0, 1.0)
    # some come down
    lane.theta[4:8] *= 1e-3
    lane.omega[4:8] = -2e-3 * lane.side[4:8]
    lane.ground[:], lane.ground_end[:] = rng.normal(0, 3, (2, n))
    lane.weight[:], lane.weight_end[:] = rng.uniform(0.5, 1.5, (2, n))
    lane.part_left[:] = rng.uniform(0.2, 1.0, n)
    # some cannot be held
    lane.right[stack_constants.OF_GRAVITY, 8:10] = -1.0
    lane.left[stack_constants.OF_GRAVITY, 10:12] = -1.0
    lane.was_weight[:] = lane.before_weight[:] = 1.0
    before = lane.copy()
    stack_one.advance(lane, G, upward)
    first = lane.rates.copy()
    for i in range(n):
        left = before.part_left[i]

        def rates(t, y, i=i, left=left):
            a = before.ground[i] + (before.ground_end[i] - before.ground[i]) * t / left
            w = 1.0
            if upward:
                w = before.weight[i]
                w += (before.weight_end[i] - before.weight[i]) * t / left
            gx, gy = before.gx[i], before.gy[i]
            c, s = math.cos(y[0]), math.sin(y[0])
            return y[1], w * (gx * c + gy * s) - a / G * (gy * c - gx * s)

        y = before.theta[i], before.omega[i]
        end = solve_ivp(rates, (0, left), y, rtol=1e-12, atol=1e-15).y[:, -1]
        assert (lane.theta[i], lane.omega[i]) == pytest.approx(end, abs=1e-11)
        flag = cases.QUIET
        if abs(end[0]) >= np.pi / 2:
            flag = cases.NEARS
        if before.side[i] * end[0] < 0:
            flag = cases.CLOSES
        if 8 <= i < 12:
            flag = cases.RELEASE
        assert lane.flag[i] == flag
        flags.add(float(flag))
        assert (lane.ground[i], lane.part_left[i]) == (before.ground_end[i], 1.0)
    assert len(flags) == 4
    lane.ground_end[:] = rng.normal(0, 3, n)
    lane.weight_end[:] = rng.uniform(0.5, 1.5, n)
    stack_one.advance(lane, G, upward)
    assert (lane.rates != first).any(axis=0).all()
    for i in range(n):
        stack_one.go_back(lane, i, G, upward)
    assert (lane.rates == first).all()
    for name in ("theta", "omega", "ground"):
        assert (lane["was_" + name] == before[name]).all()
    assert (lane.was_left == before.part_left).all()
    assert (lane.ground_end == before.ground_end).all()
