"""Ensembles: the same numbers however cases are grouped, and the same as one by one."""

from itertools import product

import numpy as np
import pytest

from rockfrag.outcomes.outcomes import Outcomes, columns
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.history import simulate
from rockfrag.system.blocks import Block, Stack

from ..oracle import cases as benchmark_cases

MOTIONS = [motion[:2500] for motion in benchmark_cases.motions(4, seed=11)]
SCALES = np.array(
    [[0.15, 0.4, 0.9], [0.2, 0.5, 1.0], [0.25, 0.6, 0.8], [0.0, 0.35, 0.7]]
)
LONE = benchmark_cases.blocks(5, seed=11)
STACKS = benchmark_cases.stacks(3, seed=11)
# a leaning block with its centre of gravity to one side has two different pivots
SKEW = Block(width=0.3, height=1.2, mass=100.0, cg_offset=0.02, lean=0.01)
# a slender pedestal falls with its squat statue
SLENDER = Stack(
    Block(width=0.3, height=1.5, mass=360.0), Block(width=0.25, height=0.4, mass=70.0)
)
BODIES = [SLENDER, LONE[0], STACKS[0], LONE[1], SKEW, STACKS[1], *LONE[2:], STACKS[2]]


def same(whole: Outcomes, index: object, other: Outcomes) -> None:
    """Every array of some cases agrees bit for bit."""
    for known in columns():
        values, others = getattr(whole, known.name)[index], getattr(other, known.name)
        if known.table != "cases":
            # without what systems of fewer bodies are filled up with
            most = min(values.shape[-1], others.shape[-1])
            values, others = values[..., :most], others[..., :most]
        np.testing.assert_array_equal(values, others, err_msg=known.name)


@pytest.fixture(scope="module")
def whole() -> Outcomes:
    found = overturns(BODIES, MOTIONS, benchmark_cases.DT, SCALES, threads=1)
    assert all((found.overturned_body == number).any() for number in (1, 2))
    assert 0.1 < found.overturned.mean() < 0.9
    assert (found.impacts > 20).any()
    return found


def test_neither_threads_nor_order_nor_company_change_a_bit(whole):
    same(whole, ..., overturns(BODIES, MOTIONS, benchmark_cases.DT, SCALES, threads=3))
    rng = np.random.default_rng(3)
    i, j, k = (rng.permutation(n) for n in whole.overturned.shape)
    bodies, motions = [BODIES[n] for n in i], [MOTIONS[n] for n in j]
    shuffled = overturns(
        bodies, motions, benchmark_cases.DT, SCALES[j][:, k], threads=1
    )
    same(whole, np.ix_(i, j, k), shuffled)
    for i, j, k in ((0, 1, 2), (1, 0, 1), (4, 2, 0), (9, 3, 2)):
        alone = overturns(
            BODIES[i], MOTIONS[j], benchmark_cases.DT, SCALES[j, k : k + 1]
        )
        same(whole, np.s_[i : i + 1, j : j + 1, k : k + 1], alone)
    # this one needs shorter steps
    small = Block(width=0.01, height=0.04, mass=0.01)
    more = overturns([small, *BODIES], MOTIONS, benchmark_cases.DT, SCALES, threads=1)
    same(more, np.s_[1:], whole)


def test_single_simulations_of_blocks_agree_in_outcomes_and_peaks(whole):
    """simulate() follows every impact with Taylor series of higher order."""
    checked = 0
    for at in np.ndindex(len(BODIES), 2, SCALES.shape[1]):
        body, motion, scale = BODIES[at[0]], MOTIONS[at[1]], SCALES[at[1:]]
        if isinstance(body, Stack) or whole.unstable_distance[at] < 1e-3:
            continue
        response = simulate(body, scale * motion, benchmark_cases.DT)
        assert response.overturned == whole.overturned[at]
        if response.overturned:
            continue
        top = response.theta[:, -1]
        peak = max(
            top.max() / body.critical_angle(1), -top.min() / body.critical_angle(-1)
        )
        # between samples a flight rises by at most (p dt)² α / 4 above them
        between = (body.frequency() * benchmark_cases.DT) ** 2 / 4 + 1e-6
        assert peak - 1e-6 <= whole.peak_rotation[(*at, 0)] <= peak + between
        assert whole.peak_velocity[(*at, 0)] >= np.abs(response.omega).max() - 1e-6
        checked += 1
    assert checked > 5


def test_single_simulations_of_stacks_agree_in_outcomes_and_peaks():
    """Over some seconds: an ensemble closes chatter to 1e-7 rad/s, and stacks are chaotic in the long run."""
    checked = 0
    for body, motion, scale in product(STACKS, MOTIONS, (0.25, 0.4, 0.6, 0.9)):
        start = int(np.argmax(np.abs(scale * motion) > 2.0))
        # with still ground at its end, as an ensemble stops when nothing can fall any more
        part = np.append(scale * motion[start : start + 400], np.zeros(500))
        response = simulate(body, part, benchmark_cases.DT)
        item = overturns(body, part, benchmark_cases.DT, [1.0])
        distance = item.unstable_distance.item()
        if distance < 0.02:
            continue
        assert response.overturned == item.overturned.item()
        if response.overturned or response.impacts == 0:
            continue
        # the ensemble looks at its speed before impacts, and at samples
        fastest = np.abs(response.omega[:, -1]).max()
        assert item.peak_velocity[0, 0, 0, -1] >= fastest - 1e-3
        assert distance == pytest.approx(response.unstable_distance, rel=0.01)
        checked += 1
    assert checked > 10


@pytest.mark.parametrize("linear", [False, True])
def test_cases_with_a_start_of_their_own_end_as_single_simulations_do(linear):
    bodies = [LONE[1], STACKS[0]]
    start = {
        "theta0": [0.3 * LONE[1].alpha, (0.0, 0.02)],
        "omega0": [None, (0.0, -0.1)],
    }
    dt, scales = benchmark_cases.DT, (0.2, 0.6)
    found = overturns(bodies, MOTIONS[:2], dt, scales, linear=linear, **start)
    for i, j, k in np.ndindex(found.overturned.shape):
        own = {name: values[i] for name, values in start.items()}
        response = simulate(bodies[i], scales[k] * MOTIONS[j], dt, linear=linear, **own)
        assert found.overturned[i, j, k] == response.overturned
        assert found.impacts[i, j, k] == response.impacts
        assert found.unstable_distance[i, j, k] == response.unstable_distance
    assert found.overturned.any() and not found.overturned.all()
