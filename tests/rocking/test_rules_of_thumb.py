"""Rules of engineers give what their sources give, and three models are the least of three."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack
from rockfrag.motions import half_sine, scale_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking.rules_of_thumb import RULES, asce_43, bias, predicted, static, three_models

COLUMN = Block(0.6, 3.0, 2700.0)


def test_static_rule_is_b_over_h(noise):
    motion = scale_to_pga(noise(1, 800), 0.1)
    assert static(COLUMN, motion) == pytest.approx(2.0)


@pytest.mark.parametrize("name", RULES)
def test_every_rule_scales_inversely_with_the_motion(noise, name):
    motion = noise(2, 800, tapered=True)
    twice = Motion(2 * motion.acceleration, motion.dt)
    assert RULES[name](COLUMN, twice) == pytest.approx(RULES[name](COLUMN, motion) / 2, rel=1e-6)


def test_for_a_slow_push_asce_43_bears_twice_b_over_h():
    # its capacity 2 g (f - 1) / θ falls from 2 g b/h with the rotation, and a slow push has no spectrum
    slow = half_sine(1.0, 100.0, 0.05)
    found = asce_43(COLUMN, slow) * slow.pga / 9.81
    assert found == pytest.approx(2 * math.tan(COLUMN.alpha), rel=0.03)


def test_larger_blocks_of_one_shape_bear_more_in_all_rules_but_the_static_one(noise):
    motion = noise(3, 2000, tapered=True)
    large = Block(1.8, 9.0, 72900.0)
    for name, rule in RULES.items():
        if name == "static b/h":
            assert rule(large, motion) == pytest.approx(rule(COLUMN, motion))
        else:
            assert rule(large, motion) > rule(COLUMN, motion)


def test_an_object_on_a_pedestal_is_checked_alone_and_as_one_body(noise):
    stack = Stack(Block(0.5, 0.9, 400.0), Block(0.35, 1.2, 180.0))
    motion = noise(4, 800, tapered=True)
    alone, joined = three_models(stack)
    for rule in RULES.values():
        assert predicted(stack, motion, rule) == min(rule(alone, motion), rule(joined, motion))


def test_bias_is_the_median_ratio_of_what_topples():
    predictions = np.array([1.0, 2.0, 4.0, 3.0])
    middle, scatter = bias(predictions, np.array([2.0, 4.0, 8.0, np.nan]))
    assert middle == pytest.approx(0.5)
    assert scatter == pytest.approx(0)
