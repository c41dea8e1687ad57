"""How sure an outcome is, by simulation of its neighbours."""

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns
from rockfrag.errors import InputError
from rockfrag.rocking.robustness import outcome_robustness

T1 = Block(0.124, 0.372, 2.172)
STACK = Stack(Block(0.184, 0.208, 2.3), T1)
DT = 0.01


def motion(seed, samples=2000):
    coarse = np.random.default_rng(seed).normal(size=samples // 8 + 1)
    return np.interp(np.arange(samples) / 8, np.arange(coarse.size), coarse)


SCALES = np.linspace(1.5, 5.0, 250)


def test_what_is_sure_does_not_flip_and_what_is_not_does():
    """Predict, with one set of copies, the flips of another."""
    motions = [motion(seed) for seed in range(4)]
    bodies = [T1, STACK]
    sure = outcome_robustness(bodies, motions, DT, SCALES, perturbation=0.01, copies=12, seed=1)
    other = outcome_robustness(bodies, motions, DT, SCALES, perturbation=0.01, copies=4, seed=2)
    flips = 1 - other
    assert (sure < 1).sum() > 20
    assert flips[sure == 1].mean() < 0.02 < 0.1 < flips[sure < 0.8].mean()


def test_a_smaller_perturbation_leaves_more_outcomes_as_they_are():
    fractions = [
        outcome_robustness(STACK, motion(0), DT, SCALES, perturbation=size, copies=6).mean()
        for size in (1e-9, 1e-5, 1e-2)
    ]
    assert fractions[0] >= fractions[1] >= fractions[2]
    assert fractions[2] < 1


def test_the_unstable_distance_does_not_tell_what_flips():
    found = overturns(STACK, motion(0), DT, SCALES)
    sure = outcome_robustness(STACK, motion(0), DT, SCALES, perturbation=0.01, copies=12)
    unsure = sure < 1
    assert unsure.sum() > 3
    # most outcomes that do flip have kept away from every unstable equilibrium
    assert np.median(found.unstable_distance[unsure]) > 1e-3


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"perturbation": 0.0}, "perturbation: expected a relative change above 0"),
        ({"perturbation": "a"}, "perturbation: expected a finite number"),
        ({"perturbation": 0.01, "copies": 0}, "copies: expected at least one"),
    ],
)
def test_unusable_perturbations_are_refused(changed, message):
    with pytest.raises(InputError, match=message):
        outcome_robustness(T1, motion(0), DT, [1.0], **changed)
