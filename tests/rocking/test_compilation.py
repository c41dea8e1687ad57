"""What is compiled ahead, in two processes, is what an ensemble of stacks then uses."""

import inspect

import numpy as np
import pytest

from rockfrag.rocking import _stack_cases as cases
from rockfrag.rocking import _stack_lanes as lanes
from rockfrag.rocking.bodies import Block, Stack
from rockfrag.rocking.ensemble import overturns


@pytest.mark.parametrize("motions", [1, 2])
def test_kernels_are_compiled_for_the_types_that_ensembles_give_them(motions):
    stack = Stack(Block(0.4, 0.3, 100.0), Block(0.3, 1.2, 200.0))
    motion = 6.0 * np.sin(np.arange(300) * 0.06)
    overturns(stack, [motion] * motions, 0.01, [1.0])
    lanes.compile_events()
    lanes.compile_others()
    assert len(lanes.stack_cases.signatures) == 1
    names = inspect.signature(lanes.stack_cases.py_func).parameters
    given = dict(zip(names, lanes.stack_cases.signatures[0], strict=True))
    for kernel in (cases.carry_on, cases.event_of_one, cases.event_of_two, cases.place_one):
        (types,) = kernel.signatures
        for name, kind in zip(inspect.signature(kernel.py_func).parameters, types, strict=True):
            if name in given:
                assert kind == given[name], (kernel.__name__, name)
