"""Impacts with friction and measured restitution together, each contact by its own law."""

import math
from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import pytest

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.planar.impact import kinetic_energy, strike
from rockfrag.engines.planar.records import posed, system_record, working_memory
from rockfrag.engines.planar.solve import look_at
from rockfrag.laws import law_named
from rockfrag.laws import laws as all_laws
from rockfrag.simulation import MeasuredRestitution, simulate
from rockfrag.system import Block, ImpactLaw, System, geometry

from ...simulation.reference_bodies import random_motion
from .cases import (
    DT,
    G,
    imbalance,
    random_block,
    random_column,
    random_stack,
    run,
    samples_until,
    with_contacts,
)

LAWS = ("position", "couple", "ratio")


@entry_kernel
def hit(p, w):
    """Strike, and give the energy before and after."""
    look_at(p, w, w.q)
    before = kinetic_energy(p, w.v)
    strike(p, w, 0.0, 0.0, 0.0)
    return before, kinetic_energy(p, w.v)


class Impact(NamedTuple):
    """Bodies of which one comes down on the body below, where a contact closes."""

    system: System
    theta: np.ndarray  # rotations [rad]
    omega: np.ndarray  # angular velocities [rad/s]
    contact: int

    def outcome(
        self, mus: np.ndarray, laws: list[ImpactLaw]
    ) -> tuple[np.ndarray, float]:
        """Velocities after it, and the fraction of the energy that is gained."""
        v, gain, _ = self.struck(mus, laws)
        return v, gain

    def struck(
        self, mus: np.ndarray, laws: list[ImpactLaw]
    ) -> tuple[np.ndarray, float, int]:
        """Likewise, and how many laws had to give way."""
        n = self.system.count
        p, w = (
            system_record(with_contacts(self.system, list(mus), laws), G),
            working_memory(),
        )
        w["drive"][:], w["kind"][:] = -1, 1
        w["q"], w["v"] = posed(p, self.theta.tolist(), self.omega.tolist())
        for k in range(n):
            below = (self.theta[k - 1], self.omega[k - 1]) if k else (0.0, 0.0)
            turned, turning = self.theta[k] - below[0], self.omega[k] - below[1]
            full = turned == 0.0 and turning == 0.0
            w["old_closed"][k] = 1 if full else (int(turned < 0), int(turned > 0))
        w["closed"], w["touching"] = w["old_closed"], w["old_closed"]
        w["touching"][self.contact] = 1
        before, after = hit(p, w)
        given_way = int(w["outcome"]["given_way"])
        return w["v"][: 3 * n].copy(), (after - before) / before, given_way


def random_impact(rng: np.random.Generator, bodies: int) -> Impact:
    """Draw an impact: the other contacts are full or rock."""
    system = random_column(rng, bodies).system()
    contact, end = int(rng.integers(bodies)), int(rng.integers(2))
    theta, omega = np.zeros(bodies), np.zeros(bodies)
    for k in range(bodies):
        below = (theta[k - 1], omega[k - 1]) if k else (0.0, 0.0)
        theta[k], omega[k] = below
        if k == contact:
            side = 2 * end - 1
            theta[k] -= side * 1e-13
            omega[k] += side * rng.uniform(0.1, 2.0)
        elif rng.uniform() < 0.5:
            theta[k] += rng.choice([-1, 1]) * rng.uniform(0.01, 0.2)
            omega[k] += rng.normal(0, 0.7)
    return Impact(system, theta, omega, contact)


def drawn_laws(system: System, law: str, factor: float) -> list[ImpactLaw]:
    """Give every contact a multiple of its own momentum value, as far as the lone body may have it."""
    found = []
    for shape in system.carried:
        own = [
            factor * geometry.momentum_restitution(shape, pivot) for pivot in (1, -1)
        ]
        most = [geometry.largest_restitution(shape, pivot) for pivot in (1, -1)]
        values = list(map(min, own, most))
        found.append(ImpactLaw(law, *values) if min(values) > 0.05 else ImpactLaw())
    return found


def jumps(at, outcome, scale):
    """Count the intervals in which an outcome still jumps after twenty halvings."""
    found = 0
    for (x, early), (y, late) in pairwise([(x, outcome(x)) for x in at]):
        low, high, a, b = x, y, early, late
        while np.abs(a - b).max() > 0.05 * scale and high - low > 1e-6:
            middle = (low + high) / 2
            half = outcome(middle)
            if np.abs(half - a).max() > np.abs(half - b).max():
                high, b = middle, half
            else:
                low, a = middle, half
        found += np.abs(a - b).max() > 0.05 * scale
    return found


def survey(number, seed):
    """Look at random impacts of one to four bodies under every law and a series of values."""
    rng, counts = np.random.default_rng(seed), Counter()
    for _ in range(number):
        impact = random_impact(rng, int(rng.integers(1, 5)))
        law, mus = str(rng.choice(LAWS)), rng.uniform(0.1, 1.5, impact.system.count)
        laws = drawn_laws(impact.system, law, rng.uniform(0.7, 1.2))
        v, gain = impact.outcome(mus, laws)
        plastic, _ = impact.outcome(mus, [ImpactLaw()] * impact.system.count)
        counts["gains"] += gain > 1e-11  # rounding: what gives way ends within 1e-12
        moving = np.abs(impact.omega).max()
        counts["stops"] += np.abs(v).max() < 1e-9 * moving < np.abs(plastic).max()

        def by_factor(x, i=impact, law=law, mus=mus):
            return i.outcome(mus, drawn_laws(i.system, law, x))[0]

        def by_friction(x, i=impact, laws=laws, mus=mus):
            return i.outcome(x * mus, laws)[0]

        scale = float(np.abs(plastic).max() + np.abs(v).max())
        counts["jumps in e"] += jumps(
            [0.7, 0.85, 0.99, 1.0, 1.01, 1.1, 1.2], by_factor, scale
        )
        counts["jumps in mu"] += jumps([0.5, 0.8, 1.0, 1.3, 2.0], by_friction, scale)
    return counts


@pytest.mark.parametrize("pivot", [1, -1])
@pytest.mark.parametrize("measured", [0.75, 0.97])
def test_each_law_leaves_the_lone_block_the_rate_that_was_measured(measured, pivot):
    """0.75 is less than momentum leaves this block, 0.97 is more."""
    shape, before = Block(0.4, 1.2, 80.0, cg_offset=0.02).shape, 1.7

    def ratio(place: float) -> float:
        """Of the rates after and before an impulse at a point of the base, 1 at the new pivot."""
        kept = [
            shape.inertia
            + shape.mass * shape.y**2
            + shape.mass
            * (shape.x - at * shape.b)
            * (shape.x - place * pivot * shape.b)
            for at in (-pivot, pivot)
        ]
        return kept[0] / kept[1]

    by_momentum = ratio(1.0)
    assert 0.75 < by_momentum < 0.97
    for name in LAWS:
        law = law_named(name)
        number, value = law.tell(shape, measured, pivot)
        told = all_laws()[number]
        moved = ratio(value) * before if told.moves_impulse else math.nan
        after = told.rate(value, by_momentum * before, before, moved)
        assert after == pytest.approx(measured * before)
        # what the law of position cannot say a couple does
        brakes = name == "position" and measured < by_momentum
        assert told.name == ("couple" if brakes else name)
    number, value = law_named("momentum").tell(shape, measured, pivot)
    assert all_laws()[number].rate(value, by_momentum, 1.0, math.nan) == by_momentum
    assert [law.name for law in all_laws() if law.scales_momentum] == ["couple"]


@pytest.mark.parametrize("side", [1, -1])
def test_a_couple_does_not_lift_a_squat_block_that_momentum_stops(side):
    """Momentum leaves nothing to multiply where the block is wider than √2 of its height (Housner, 1963)."""
    rng = np.random.default_rng(8)
    for _ in range(5):
        height = rng.uniform(0.2, 0.6)
        block = Block(height * rng.uniform(1.5, 3.0), height, 50.0)
        came = np.array([side * rng.uniform(0.1, 1.0)])
        impact = Impact(block.system(), np.array([-side * 1e-13]), came, 0)
        law = ImpactLaw("couple", 0.5, 0.5)
        v, gain, given_way = impact.struck(np.array([1.0]), [law])
        assert (gain, given_way) == (pytest.approx(-1.0), 0)
        np.testing.assert_allclose(v, 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("impacts", "seed", "in_e", "in_mu"),
    [(300, 3, 6, 15), pytest.param(10_000, 4, 200, 500, marks=pytest.mark.slow)],
)
def test_no_impact_gains_energy_or_stops_dead(impacts, seed, in_e, in_mu):
    counts = survey(impacts, seed)
    assert counts["gains"] == 0 and counts["stops"] == 0
    assert counts["jumps in e"] <= in_e and counts["jumps in mu"] <= in_mu


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize("law", [None, *LAWS])
@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_with_much_friction_impacts_are_those_of_pure_rocking(
    stacks: bool, law: str | None
) -> None:
    rng = np.random.default_rng(11)
    compared = 0
    for _ in range(8):
        body = random_stack(rng) if stacks else random_block(rng)
        momentum = [ImpactLaw()] * body.system().count
        laws = (
            drawn_laws(body.system(), law, rng.uniform(0.8, 1.2)) if law else momentum
        )
        system = with_contacts(body, [1e6] * body.system().count, laws)
        values = [
            None if np.isnan(each.right) else (each.right, each.left) for each in laws
        ]
        value = values if stacks else values[0]
        measured = MeasuredRestitution(value, law) if any(values) else None
        motion = random_motion(rng)
        slow, fast = (
            run(system, motion),
            simulate(body, motion, DT, restitution=measured),
        )
        times = fast.contact_events["time"].to_numpy()
        if len(times) < 5 or fast.lost_contact < times[4] or slow.given_way:
            continue
        n = samples_until(fast, 4)
        np.testing.assert_allclose(slow.theta[:n], fast.theta[:n], atol=2e-7)
        compared += 1
    assert compared >= 3


@pytest.mark.parametrize("cases", [18, pytest.param(1000, marks=pytest.mark.slow)])
def test_histories_with_friction_and_restitution_gain_nothing(cases):
    """Random blocks, stacks and columns with laws of impact, and with all numbers moved a little."""
    rng = np.random.default_rng(11)
    impacts = jumped = 0
    for i in range(cases):
        bodies, law = 1 + i % 3, LAWS[i // 3 % 3]
        system = random_column(rng, bodies).system()
        laws = drawn_laws(system, law, rng.uniform(0.7, 1.0))
        mus, motion = rng.uniform(0.3, 1.2, bodies), 1.5 * random_motion(rng)
        lawful = with_contacts(system, list(mus), laws)
        found = run(lawful, motion)
        struck = found.contact_events.query("kind == 'impact'")
        before, after = struck["energy_before"], struck["energy_after"]
        unit = 1e-9 * float(system.mass * G)
        impacts += len(struck)
        assert (after <= before * (1 + 1e-9) + unit).all()
        assert imbalance(found) < 2e-8
        near = run(with_contacts(system, list(mus * (1 + 1e-9)), laws), motion)
        n = min(samples_until(found, 4), len(near.time))
        jumped += bool(np.abs(found.theta[:n] - near.theta[:n]).max() > 1e-4)
    assert impacts > 10 * cases
    assert jumped <= max(1, cases // 50)
