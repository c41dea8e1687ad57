"""Thresholds, structural resurrections, and outcomes that hang on the step or on a small perturbation."""

import math

import numpy as np
import pytest

from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.robustness import (
    find_step_size_sensitive,
    outcome_robustness,
    perturbed,
)
from rockfrag.simulation.thresholds import find_thresholds
from rockfrag.system import Bond, Wall, as_system, hold
from rockfrag.system.blocks import Block, Stack

from ..oracle import cases as benchmark_cases
from .reference_bodies import T1, P, polyline, random_motion, uniform

DT = 0.01


def test_the_survival_window_of_a_sine_pulse_between_its_two_modes_of_overturning():
    """Overturning with one impact from 3.032, survival from 6.743, overturning above 7.493 αg."""
    # p = 2.14, α = .25, ωp = 5 p, and a peak of αg
    p, alpha, dt = 2.14, 0.25, 0.001
    time = np.arange(math.ceil(2 * math.pi / (5 * p) / dt)) * dt
    pulse = np.append(alpha * 9.81 * np.sin(5 * p * time), np.zeros(8000))

    def searched(highest: float, narrowest: float):
        spacing = {"tolerance": 1e-3, "narrowest_resurrection": narrowest}
        return find_thresholds(
            uniform(p, alpha), pulse, dt, highest=highest, **spacing, restitution=[0.9]
        )

    found = searched(9.0, 0.25)
    row = found.table.iloc[0]
    assert row.resurrections == 1
    assert row.first_overturning == pytest.approx(3.032, rel=2e-3)
    assert row.always_overturning == pytest.approx(7.493, rel=2e-3)
    assert row.first_overturning_pga_g == pytest.approx(3.032 * 0.25, rel=2e-3)
    window = found.resurrections.iloc[0]
    assert (window.lower, window.upper) == pytest.approx((6.743, 7.493), rel=2e-3)
    # a window narrower than promised can be missed, and a finer grid finds it
    assert len(searched(12.0, 4.0).resurrections) == 0
    assert len(searched(12.0, 0.7).resurrections) == 1


@pytest.fixture(scope="module")
def ensemble():
    return benchmark_cases.blocks(4, seed=2), [
        m[:2500] for m in benchmark_cases.motions(3, seed=2)
    ]


def test_thresholds_are_those_of_the_grid(ensemble):
    # nothing topples the last one
    bodies, motions = [*ensemble[0], Block(10.0, 5.0, 1.0)], ensemble[1]
    spacing, tolerance = 0.02, 0.002
    # the first power of two that makes it no wider than the tolerance
    width = spacing / 16
    found = find_thresholds(
        bodies,
        motions,
        DT,
        highest=1.2,
        tolerance=tolerance,
        narrowest_resurrection=spacing,
    )
    grid = spacing * np.arange(1, 61)
    fallen = overturns(bodies, motions, DT, grid).overturned
    checked = 0
    for row in found.table.itertuples():
        outcomes, first = fallen[row.body, row.motion], row.first_overturning
        assert math.isnan(first) is not outcomes.any()
        assert math.isnan(row.always_overturning) is not outcomes[-1]
        if outcomes.any():
            assert 0 <= grid[outcomes.argmax()] - first + 1e-12 < spacing
        if outcomes[-1]:
            late = (
                grid[outcomes.size - outcomes[::-1].argmin()]
                if not outcomes.all()
                else grid[0]
            )
            assert 0 <= late - row.always_overturning + 1e-12 < spacing
        for scale in (first, row.always_overturning):
            if not math.isnan(scale):
                case = bodies[row.body], motions[row.motion], DT, [scale - width, scale]
                assert overturns(*case).overturned[0, 0].tolist() == [False, True]
                checked += 1
    assert checked > 4 and found.table["first_overturning"].isna().any()


def test_both_ends_of_every_window_survive_and_it_overturns_just_outside(ensemble):
    bodies, motions = ensemble
    found = find_thresholds(
        bodies, motions, DT, highest=1.5, tolerance=0.004, narrowest_resurrection=0.01
    )
    assert len(found.resurrections) > 3
    width = 0.01 / 4
    for row in found.resurrections.itertuples():
        scales = [row.lower - width, row.lower, row.upper, row.upper + width]
        fallen = overturns(
            bodies[row.body], motions[row.motion], DT, scales
        ).overturned[0, 0]
        assert fallen[:3].tolist() == [True, False, False]
        assert fallen[3] or row.upper == 1.5
    assert len(found.resurrections) == found.table["resurrections"].sum()


@pytest.mark.parametrize(("kind", "gate"), [("lone", 0.001), ("stack", 0.005)])
@pytest.mark.parametrize(
    "count", [1000, pytest.param(10_000, marks=pytest.mark.slow, id="10000")]
)
def test_few_outcomes_change_when_the_step_is_halved(kind, gate, count):
    cases = benchmark_cases.cases(kind, count)
    fragile = find_step_size_sensitive(
        cases.bodies, cases.accelerations, cases.dt, cases.scales, sample=cases.count
    )
    assert fragile.sampled == cases.count
    # the gate is for 10⁴ cases; a thousand may by chance hold two more than their share
    assert fragile.changed < gate * fragile.sampled + (2 if count < 10_000 else 0)


def test_outcomes_taken_with_long_steps_are_fragile_and_those_looked_at_follow_from_the_seed():
    """The count is not zero by construction: steps of p h up to 1 leave more outcomes open."""
    cases = benchmark_cases.cases("lone", 1000)
    rough = [motion[::10] for motion in cases.accelerations]
    fragile, again = (
        find_step_size_sensitive(
            cases.bodies,
            rough,
            0.1,
            cases.scales,
            sample=800,
            seed=4,
            step=3.0,
            threads=threads,
        )
        for threads in (1, 2)
    )
    assert fragile.sampled == 800 and fragile.fraction > 0.005
    assert fragile.cases.shape == (fragile.changed, 3)
    np.testing.assert_array_equal(fragile.cases, again.cases)


STACK = Stack(P, T1)
SCALES = np.linspace(1.5, 5.0, 250)


def test_what_is_sure_does_not_flip_and_what_is_not_does():
    """Predict, with one set of copies, the flips of another."""
    case = [T1, STACK], [polyline(seed, 2000) for seed in range(4)], DT, SCALES
    sure, other = (
        outcome_robustness(*case, perturbation=0.01, copies=copies, seed=seed)
        for copies, seed in ((12, 1), (4, 2))
    )
    flips = 1 - other
    assert (sure < 1).sum() > 20
    assert flips[sure == 1].mean() < 0.02 < 0.1 < flips[sure < 0.8].mean()


def test_copies_of_what_is_held_keep_their_gap_and_their_pads():
    """Also of what touches its wall, or has its pads at the ends of its base."""
    block = Block(0.3, 1.2, 100.0)
    motion = 2.0 * random_motion(np.random.default_rng(5))
    for held in (
        hold(as_system(block), Wall(0.15)),
        hold(as_system(block), Wall(0.17, height=0.4)),
        hold(as_system(block), bonds=Bond(500.0, 500.0, 0.15)),
    ):
        same = outcome_robustness(
            held, motion, 0.01, perturbation=0.01, copies=4, friction=0.6
        )
        assert 0 <= same[0, 0, 0] <= 1
        rng = np.random.default_rng(1)
        for _ in range(4):
            near = perturbed(held, 0.01, rng)
            width = near.bodies[0].width
            assert width != 0.3
            assert near.holding == held.holding
            for wall, given in zip(near.constraints, held.constraints, strict=True):
                gap = given.distance - 0.15
                assert wall.distance - width / 2 == pytest.approx(gap, abs=1e-12)
                assert wall.height == given.height
            for _, bond in near.bonds:
                assert bond.pads[0] == pytest.approx(min(0.15, width / 2))


def test_a_smaller_perturbation_leaves_more_outcomes_as_they_are():
    case = STACK, polyline(0, 2000), DT, SCALES
    tiny, small, large = (
        outcome_robustness(*case, perturbation=size, copies=12)
        for size in (1e-9, 1e-5, 1e-2)
    )
    assert 1 >= tiny.mean() >= small.mean() >= large.mean() < 1
    # most outcomes that do flip have kept away from every unstable equilibrium
    assert (large < 1).sum() > 3
    assert np.median(overturns(*case).unstable_distance[large < 1]) > 1e-3
