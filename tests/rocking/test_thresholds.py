"""Thresholds, structural resurrections, and outcomes that hang on the step or on a small perturbation."""

import math

import numpy as np
import pytest

from rockfrag.rocking.ensemble import overturned_cases, overturns, prepared
from rockfrag.rocking.robustness import find_step_size_sensitive, outcome_robustness
from rockfrag.rocking.thresholds import find_thresholds
from rockfrag.system.blocks import Block, Stack

from ..oracle import cases as benchmark_cases
from .reference_bodies import T1, polyline, uniform

G = 9.81


def one_sine() -> tuple[Block, np.ndarray, float]:
    """Block of p = 2.14, α = .25 and a sine pulse of ωp = 5 p whose peak is αg."""
    p, alpha = 2.14, 0.25
    dt = 0.001
    period = 2 * math.pi / (5 * p)
    time = np.arange(math.ceil(period / dt)) * dt
    quiet = np.zeros(8000)
    pulse = alpha * G * np.sin(5 * p * time)
    return uniform(p, alpha), np.concatenate([pulse, quiet]), dt


def test_the_survival_window_of_a_sine_pulse_between_its_two_modes_of_overturning():
    """Overturning with one impact from 3.032, survival from 6.743, overturning above 7.493 αg."""
    block, pulse, dt = one_sine()
    found = find_thresholds(
        block, pulse, dt, 9.0, tolerance=1e-3, narrowest_resurrection=0.25, restitution=[0.9]
    )
    row = found.table.iloc[0]
    assert row.resurrections == 1
    assert row.first_overturning == pytest.approx(3.032, rel=2e-3)
    assert row.always_overturning == pytest.approx(7.493, rel=2e-3)
    assert row.first_overturning_pga_g == pytest.approx(3.032 * 0.25, rel=2e-3)
    window = found.resurrections.iloc[0]
    assert window.lower == pytest.approx(6.743, rel=2e-3)
    assert window.upper == pytest.approx(7.493, rel=2e-3)


def test_a_window_narrower_than_promised_can_be_missed_and_a_finer_grid_finds_it():
    block, pulse, dt = one_sine()
    settings = {"tolerance": 0.01, "restitution": [0.9]}
    coarse = find_thresholds(block, pulse, dt, 12.0, narrowest_resurrection=4.0, **settings)
    fine = find_thresholds(block, pulse, dt, 12.0, narrowest_resurrection=0.7, **settings)
    assert len(coarse.resurrections) == 0
    assert len(fine.resurrections) == 1


@pytest.fixture(scope="module")
def ensemble():
    return benchmark_cases.blocks(4, seed=2), [m[:2500] for m in benchmark_cases.motions(3, seed=2)]


def test_thresholds_are_those_of_a_fine_grid(ensemble):
    bodies, motions = ensemble
    spacing, tolerance = 0.02, 0.002
    width = spacing / 16  # the first power of two that makes it no wider than the tolerance
    found = find_thresholds(
        bodies, motions, 0.01, 1.2, tolerance=tolerance, narrowest_resurrection=spacing
    )
    fine = np.arange(1, 601) * tolerance
    fallen = overturns(bodies, motions, 0.01, fine).overturned
    checked = 0
    for row in found.table.itertuples():
        outcomes = fallen[row.body, row.motion]
        if math.isnan(row.first_overturning):
            assert not outcomes[fine >= 1.2 - 1e-9].any()
            continue
        on_grid = outcomes[9::10]
        assert on_grid.any()
        # the changes next to the first and last of those on the coarse grid
        first = 10 * (int(np.argmax(on_grid)) + 1) * tolerance
        assert first - spacing < row.first_overturning <= first + 1e-12
        for scale in (row.first_overturning, row.always_overturning):
            if not math.isnan(scale):
                pair = overturns(
                    bodies[row.body], motions[row.motion], 0.01, [scale - width, scale]
                )
                assert pair.overturned[0, 0].tolist() == [False, True]
                checked += 1
        always = on_grid[::-1].argmin() if not on_grid.all() else on_grid.size
        if always:
            last = 1.2 - spacing * always
            assert last < row.always_overturning <= last + spacing + 1e-12
        else:
            assert math.isnan(row.always_overturning)
    assert checked > 4


def test_both_ends_of_every_window_survive_and_it_overturns_just_outside(ensemble):
    bodies, motions = ensemble
    found = find_thresholds(
        bodies, motions, 0.01, 1.5, tolerance=0.004, narrowest_resurrection=0.01
    )
    assert len(found.resurrections) > 3
    width = 0.01 / 4
    for row in found.resurrections.itertuples():
        scales = [row.lower - width, row.lower, row.upper, row.upper + width]
        fallen = overturns(bodies[row.body], motions[row.motion], 0.01, scales).overturned[0, 0]
        assert not fallen[1:3].any()
        assert fallen[0]
        assert fallen[3] or row.upper == 1.5
    counts = found.resurrections.groupby(["body", "motion"]).size().sum()
    assert counts == found.table["resurrections"].sum()


def test_a_block_that_nothing_topples_has_no_threshold():
    block, motion = Block(10.0, 10.0, 1.0), benchmark_cases.motions(1, 3)[0]
    found = find_thresholds(block, motion, 0.01, 0.9, tolerance=0.1, narrowest_resurrection=0.3)
    assert found.table[["first_overturning", "always_overturning"]].isna().all(axis=None)
    assert found.resurrections.empty


def test_scattered_cases_have_the_outcomes_of_the_grid(ensemble):
    bodies, motions = ensemble
    scales = np.linspace(0.2, 1.0, 7)
    grid = overturns(bodies, motions, 0.01, scales).overturned
    rng = np.random.default_rng(1)
    i, j, k = (rng.integers(0, n, 50) for n in grid.shape)
    cases = prepared(bodies, motions, 0.01, scales)
    some = overturned_cases(cases, i, j, scales[k])
    np.testing.assert_array_equal(some, grid[i, j, k])


@pytest.mark.parametrize(("kind", "gate"), [("lone", 0.001), ("stack", 0.005)])
@pytest.mark.parametrize("count", [1000, pytest.param(10_000, marks=pytest.mark.slow, id="10000")])
def test_few_outcomes_change_when_the_step_is_halved(kind, gate, count):
    cases = benchmark_cases.cases(kind, count)
    fragile = find_step_size_sensitive(
        cases.bodies, cases.accelerations, cases.dt, cases.scales, sample=cases.count
    )
    assert fragile.sampled == cases.count
    # the gate is for 10⁴ cases; a thousand may by chance hold two more than their share
    assert fragile.changed < gate * fragile.sampled + (2 if count < 10_000 else 0)


def test_outcomes_taken_with_long_steps_are_fragile():
    """The count is not zero by construction: steps of p h up to 1 leave more outcomes open."""
    cases = benchmark_cases.cases("lone", 1000)
    rough = [motion[::10] for motion in cases.accelerations]
    fragile = find_step_size_sensitive(
        cases.bodies, rough, 0.1, cases.scales, sample=1000, step=3.0
    )
    assert fragile.fraction > 0.005
    assert fragile.cases.shape == (fragile.changed, 3)


def test_the_sample_follows_from_its_seed(ensemble):
    bodies, motions = ensemble
    item, again = (
        find_step_size_sensitive(
            bodies, motions, 0.2, [0.5, 1.0, 2.0], sample=20, seed=4, step=3.0, threads=threads
        )
        for threads in (1, 2)
    )
    assert item.sampled == 20
    np.testing.assert_array_equal(item.cases, again.cases)


STACK = Stack(Block(0.184, 0.208, 2.3), T1)
DT = 0.01
MOTION = polyline(0, 2000)


SCALES = np.linspace(1.5, 5.0, 250)


def test_what_is_sure_does_not_flip_and_what_is_not_does():
    """Predict, with one set of copies, the flips of another."""
    motions = [polyline(seed, 2000) for seed in range(4)]
    bodies = [T1, STACK]
    sure = outcome_robustness(bodies, motions, DT, SCALES, perturbation=0.01, copies=12, seed=1)
    other = outcome_robustness(bodies, motions, DT, SCALES, perturbation=0.01, copies=4, seed=2)
    flips = 1 - other
    assert (sure < 1).sum() > 20
    assert flips[sure == 1].mean() < 0.02 < 0.1 < flips[sure < 0.8].mean()


def test_a_smaller_perturbation_leaves_more_outcomes_as_they_are():
    fractions = [
        outcome_robustness(STACK, MOTION, DT, SCALES, perturbation=size, copies=6).mean()
        for size in (1e-9, 1e-5, 1e-2)
    ]
    assert fractions[0] >= fractions[1] >= fractions[2]
    assert fractions[2] < 1


def test_the_unstable_distance_does_not_tell_what_flips():
    found = overturns(STACK, MOTION, DT, SCALES)
    sure = outcome_robustness(STACK, MOTION, DT, SCALES, perturbation=0.01, copies=12)
    unsure = sure < 1
    assert unsure.sum() > 3
    # most outcomes that do flip have kept away from every unstable equilibrium
    assert np.median(found.unstable_distance[unsure]) > 1e-3
