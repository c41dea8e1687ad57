"""What is compiled, how often, and what happens where numba's private parts are not known."""

import ast
from pathlib import Path

import numpy as np
import pytest
from numba import TypingError
from numba.core.types.functions import Dispatcher

from rockfrag.engines.kernels import jit
from rockfrag.engines.kernels.lanes.block import integrate_blocks
from rockfrag.engines.kernels.lanes.scheduler import integrate_stacks
from rockfrag.rocking.ensemble import overturns
from rockfrag.system.blocks import Block, Stack

from ..conftest import printed_alone

BLOCK = Block(0.3, 1.2, 200.0)
STACK = Stack(Block(0.4, 0.3, 100.0), BLOCK)
MOTION = 6.0 * np.sin(np.arange(300) * 0.06)


@pytest.mark.parametrize(("body", "entry"), [(BLOCK, integrate_blocks), (STACK, integrate_stacks)])
def test_one_compilation_serves_every_ensemble(body, entry):
    for motions, scales in ((1, [1.0]), (2, np.ones((2, 3))), (1, np.linspace(0, 1, 5))):
        overturns([body] * motions, [MOTION] * motions, 0.01, scales)
    assert len(entry.signatures) == 1


KERNELS = Path(jit.__file__).parent


def test_no_kernel_has_more_than_eight_parameters():
    for path in KERNELS.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                count = len([*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs])
                assert count <= 8, f"{path.name}: {node.name} has {count} parameters"


def test_compiling_leaves_numba_as_it_was_even_if_it_fails():
    @jit.entry_kernel
    def adds(a, b):
        return max(a, b) + a

    before = Dispatcher.get_call_type
    assert adds(1.0, 2.0) == 3.0
    with pytest.raises(TypingError, match=r"typing of call at .*test_compilation\.py"):
        adds(1.0, "two")
    assert Dispatcher.get_call_type is before


@pytest.mark.skipif(not jit.KNOWN, reason="an unknown numba compiles the ordinary way")
def test_a_kernel_is_compiled_once_whatever_number_is_written_out():
    @jit.kernel
    def twice(number, pair):
        return 2 * number + pair[0]

    @jit.entry_kernel
    def calls(n):
        return twice(n, (1, n)) + twice(1, (n, 2)) + twice(2, (2, 1))

    calls._cache.disable()
    assert calls(10) == 21 + 12 + 6
    assert len(twice.signatures) == 1


UNKNOWN = """
import numba, numpy as np
numba.__version__ = "9.9.9"
from rockfrag import Block, overturns
from rockfrag.engines.kernels import jit
assert not jit.KNOWN
found = overturns(Block(0.3, 1.2, 200.0), 6.0 * np.sin(np.arange(300) * 0.06), 0.01, [0.5, 1.0])
print(found.peak_velocity.ravel().tolist())
"""


@pytest.mark.slow
def test_an_unknown_numba_gives_the_same_bits(tmp_path):
    known = overturns(BLOCK, MOTION, 0.01, [0.5, 1.0]).peak_velocity.ravel().tolist()
    assert printed_alone("-c", UNKNOWN, NUMBA_CACHE_DIR=str(tmp_path)) == str(known)
