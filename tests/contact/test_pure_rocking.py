"""Friction without limit and no vertical motion: the nine-state model."""

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack, overturns, simulate
from rockfrag.rocking.contact.simulation import simulate_with_friction

from .cases import DT, random_block, random_motion, random_stack

SCALES = np.linspace(0.3, 1.5, 10)


def differing_verdicts(stacks: bool, bodies: int, seed: int) -> tuple[int, int, int]:
    """Verdicts that differ, falls, and cases, of random bodies × 20 motions × 10 scales."""
    rng = np.random.default_rng(seed)
    drawn: list[Block | Stack] = [
        random_stack(rng) if stacks else random_block(rng) for _ in range(bodies)
    ]
    motions = [random_motion(rng) for _ in range(20)]
    pure = overturns(drawn, motions, DT, SCALES).overturned
    general = overturns(drawn, motions, DT, SCALES, friction=[np.inf] * bodies).overturned
    return int((pure != general).sum()), int(pure.sum()), pure.size


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_verdicts_are_those_of_pure_rocking(stacks: bool) -> None:
    differing, fallen, cases = differing_verdicts(stacks, 2, seed=1)
    assert differing == 0
    assert 0.05 * cases < fallen < 0.95 * cases


@pytest.mark.slow
@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_ten_thousand_verdicts_are_those_of_pure_rocking(stacks: bool) -> None:
    differing, fallen, cases = differing_verdicts(stacks, 50, seed=2)
    assert cases == 10_000 and fallen > 1000
    assert differing == 0


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
