"""A few random calls of commands; ``python -m tests.fuzz --only commands --inputs 200`` makes many."""

import random

import pytest

from ..fuzz.commands import CALLS, commands


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("call", sorted({*CALLS}, key=lambda call: call.__name__))
def test_a_random_call_contradicts_nothing(call, seed, tmp_path):
    assert call(random.Random(seed), tmp_path) == []


@pytest.mark.slow
def test_two_hundred_random_calls_contradict_nothing(tmp_path):
    draw, rng = commands(tmp_path), random.Random(57)
    for _ in range(200):
        draw(rng)[1]()
