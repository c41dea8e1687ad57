"""Friction without limit and no vertical motion: the nine-state model."""

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack, overturns, simulate
from rockfrag.rocking.contact.simulation import simulate_with_friction

from .cases import DT, random_block, random_motion, random_stack

SCALES = np.linspace(0.3, 1.5, 10)


def compare_verdicts(stacks: bool, bodies: int, seed: int) -> tuple[int, int, int, int]:
    """Verdicts that differ, those of them in which pure rocking lifts no block off, falls, and cases."""
    rng = np.random.default_rng(seed)
    drawn: list[Block | Stack] = [
        random_stack(rng) if stacks else random_block(rng) for _ in range(bodies)
    ]
    motions = [random_motion(rng) for _ in range(20)]
    pure = overturns(drawn, motions, DT, SCALES).overturned
    general = overturns(drawn, motions, DT, SCALES, friction=np.inf).overturned
    places = np.argwhere(pure != general)
    held = 0
    for i, j, k in places:
        response = simulate(drawn[i], SCALES[k] * motions[j], DT)
        held += bool(np.isnan(response.lost_contact))
    return len(places), held, int(pure.sum()), pure.size


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_verdicts_are_those_of_pure_rocking(stacks: bool) -> None:
    differing, _, fallen, cases = compare_verdicts(stacks, 2, seed=1)
    assert differing == 0
    assert 0.05 * cases < fallen < 0.95 * cases


@pytest.mark.slow
@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_ten_thousand_verdicts_are_those_of_pure_rocking_but_where_that_lifts_off(
    stacks: bool,
) -> None:
    """In pure rocking a pole may pull; bodies in contact lift off there, and go their own way."""
    differing, held, fallen, cases = compare_verdicts(stacks, 50, seed=2)
    assert cases == 10_000 and fallen > 900
    assert held == 0
    assert differing <= (10 if stacks else 0)


def test_where_nothing_slides_the_answer_is_that_of_pure_rocking_to_the_bit() -> None:
    rng = np.random.default_rng(6)
    same = 0
    for _ in range(8):
        body, motion = random_block(rng), random_motion(rng)
        pure, rough = simulate(body, motion, DT), simulate(body, motion, DT, friction=np.inf)
        np.testing.assert_array_equal(pure.theta, rough.theta)
        assert (rough.slip == 0).all()
        assert len(rough.events) == len(pure.events)
        same += len(pure.events) > 1
        smooth = simulate(body, motion, DT, friction=0.9 * float(pure.friction_demand.max()))
        assert (smooth.slides != 0).any()
    assert same > 3


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_histories_are_those_of_pure_rocking(stacks: bool) -> None:
    rng = np.random.default_rng(7)
    compared = 0
    for _ in range(12):
        body = random_stack(rng) if stacks else random_block(rng)
        motion = random_motion(rng)
        pure = simulate(body, motion, DT)
        general = simulate_with_friction(body, motion, DT, friction=np.inf)
        if len(pure.events) < 5:
            continue
        n = np.searchsorted(pure.time, pure.events["time"][4])
        np.testing.assert_allclose(general.theta[:n], pure.theta[:n], atol=1e-7)
        compared += 1
    assert compared > 5
