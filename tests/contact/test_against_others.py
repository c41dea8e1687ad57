"""The fast kernel beside a plain event-driven integrator and beside time stepping with complementarity."""

import math

import numpy as np
import pytest

from rockfrag.rocking.contact.reference import simulate_reference
from rockfrag.rocking.contact.simulation import simulate_with_friction

from .cases import DT, as_friction, random_block, random_frictions, random_motion, random_stack
from .time_stepping import time_stepping


def case(rng: np.random.Generator, stacks: bool) -> tuple:
    """Draw a body, its frictions, and a motion with a vertical part."""
    body = random_stack(rng) if stacks else random_block(rng)
    return body, random_frictions(rng, body), random_motion(rng), 0.5 * random_motion(rng)


def compare_with_reference(cases: int, stacks: bool, seed: int) -> tuple[int, int]:
    """Check histories up to the eighth event; number of verdicts that differ, and of eventful cases."""
    rng = np.random.default_rng(seed)
    differing = eventful = 0
    for _ in range(cases):
        body, mus, motion, up = case(rng, stacks)
        kwargs = {"friction": as_friction(mus), "vertical": up}
        fast = simulate_with_friction(body, motion, DT, **kwargs)
        plain = simulate_reference(body, motion, DT, duration=3.2, **kwargs)
        times = [event.time for event in plain.events]
        until = times[8] if len(times) > 8 else math.inf
        n = min(np.searchsorted(plain.time, until), len(plain.time) - 1, len(fast.time) - 1)
        np.testing.assert_allclose(fast.theta[:n], plain.theta[:n], atol=2e-6)
        np.testing.assert_allclose(fast.slip[:n], plain.slip[:n], atol=2e-6)
        eventful += len(times) > 4
        fell = fast.overturned and fast.overturning_time < 3.2
        differing += plain.overturned != fell
    return differing, eventful


def compare_with_stepping(
    cases: int, stacks: bool, seed: int, step: float
) -> tuple[int, int, list[float]]:
    """Verdicts that differ, falls, and errors of the residual slip of those that stand [m]."""
    rng = np.random.default_rng(seed)
    differing = fallen = 0
    slips = []
    for _ in range(cases):
        body, mus, motion, up = case(rng, stacks)
        fast = simulate_with_friction(body, motion, DT, friction=as_friction(mus), vertical=up)
        fell, _, _, rows = time_stepping(body, motion, DT, mus, step=step, vertical=up)
        fallen += fast.overturned
        if fell != fast.overturned:
            differing += 1
        elif not fell:
            start = 3 * (len(mus) - 1)
            moved = rows[-1, start] - rows[0, start]
            slips.append(float(moved - fast.slip[-1].sum()))
    return differing, fallen, slips


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_histories_are_those_of_the_reference(stacks: bool) -> None:
    differing, eventful = compare_with_reference(3 if stacks else 5, stacks, seed=20)
    assert differing == 0 and eventful >= 2


@pytest.mark.slow
@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_many_histories_are_those_of_the_reference(stacks: bool) -> None:
    differing, eventful = compare_with_reference(60, stacks, seed=21)
    assert differing <= 1 and eventful >= 30


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
def test_verdicts_are_those_of_time_stepping(stacks: bool) -> None:
    differing, fallen, slips = compare_with_stepping(8, stacks, seed=25, step=1e-4)
    assert differing <= 1
    assert fallen >= 1
    assert np.median(np.abs(slips)) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("stacks", "allowed"), [(False, 6), (True, 10)], ids=["blocks", "stacks"])
def test_two_hundred_verdicts_are_those_of_time_stepping(stacks: bool, allowed: int) -> None:
    differing, fallen, slips = compare_with_stepping(200, stacks, seed=23, step=2e-5)
    assert differing <= allowed
    assert 20 <= fallen <= 180
    assert np.median(np.abs(slips)) < 1e-4
