"""What is compiled and how often, with a numba that is not known too; machine code on disk may be damaged."""

import ast
import importlib.util
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numba
import numpy as np
import pytest
from numba import TypingError
from numba.core.types.functions import Dispatcher

from rockfrag.engines.compile import jit
from rockfrag.engines.compile.contents import contents_of
from rockfrag.engines.pure_rocking.kernels.lanes.block import integrate_blocks
from rockfrag.engines.pure_rocking.kernels.lanes.scheduler import integrate_stacks
from rockfrag.laws import laws
from rockfrag.simulation.ensemble import overturns
from rockfrag.stages import job
from rockfrag.system.blocks import Block, Stack

from ...conftest import printed_alone
from ...sources import nodes_of

BLOCK = Block(0.3, 1.2, 200.0)
STACK = Stack(Block(0.4, 0.3, 100.0), BLOCK)
LAWS = laws()
MOTION = 6.0 * np.sin(np.arange(300) * 0.06)


@pytest.mark.parametrize(
    ("body", "entry"), [(BLOCK, integrate_blocks), (STACK, integrate_stacks)]
)
def test_one_compilation_serves_every_ensemble(body, entry):
    for motions, scales in (
        (1, [1.0]),
        (2, np.ones((2, 3))),
        (1, np.linspace(0, 1, 5)),
    ):
        overturns([body] * motions, [MOTION] * motions, 0.01, scales)
    assert len(entry.signatures) == 1


KERNELS = Path(jit.__file__).parents[1] / "pure_rocking" / "kernels"


LAW = """
import math
import numba

RATIO = {ratio}
TABLE = ({entry}, 2.0)

@numba.njit
def part(moved):
    return {part} * moved

def made(closed):
    def rate(value, by_momentum, before, moved, share={default}):
        if moved in {{1.5, 2.5, {among}, "a", "b", "c"}}:
            return math.{function}(moved)
        return {written} * RATIO * TABLE[0] * closed * share * part(moved)
    return rate

rate = made({closed})
"""
FIRST = {
    "ratio": 0.9, "entry": 1.0, "part": 0.5, "default": 1.0, "among": 3.5, "function": "sin", "written": 0.9,
    "closed": 1.0,
}  # fmt: skip
CHANGED = {
    "ratio": 0.8, "entry": 1.5, "part": 0.6, "default": 2.0, "among": 4.5, "function": "cos", "written": 0.8,
    "closed": 2.0,
}  # fmt: skip


def law_of(values):
    """The function ``rate`` of a law whose source has these values."""
    names: dict = {}
    exec(LAW.format(**values), names)
    return names["rate"]


@pytest.mark.parametrize("name", FIRST)
def test_another_number_in_a_law_asks_for_other_machine_code(name, monkeypatch):
    """Code alone is the same whatever the numbers in it: constants are not part of instructions."""
    digests = []
    for values in (FIRST, FIRST, FIRST | {name: CHANGED[name]}):
        law = replace(LAWS[0], name="of this test", number=9, rate=law_of(values))
        monkeypatch.setattr(jit, "laws", lambda law=law: (law,))
        digests.append(jit._digest())
    assert digests[0] == digests[1] != digests[2]


def test_what_a_law_computes_with_is_the_same_in_every_process():
    program = f"{LAW.format(**FIRST)}\nfrom {contents_of.__module__} import contents_of"
    program += "\nprint(contents_of(rate))"
    first, second = (printed_alone("-c", program, PYTHONHASHSEED=k) for k in "12")
    assert first == second
    assert "0.9" in first


def test_no_kernel_has_more_than_eight_parameters():
    for path in KERNELS.rglob("*.py"):
        for node in nodes_of(path):
            if isinstance(node, ast.FunctionDef):
                count = len(
                    [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
                )
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
from rockfrag.engines.compile import jit
from rockfrag.engines.compile.contents import contents_of
assert not jit.KNOWN
found = overturns(Block(0.3, 1.2, 200.0), 6.0 * np.sin(np.arange(300) * 0.06), 0.01, [0.5, 1.0])
print(found.peak_velocity.ravel().tolist())
"""


@pytest.mark.slow
def test_an_unknown_numba_gives_the_same_bits(tmp_path):
    known = overturns(BLOCK, MOTION, 0.01, [0.5, 1.0]).peak_velocity.ravel().tolist()
    assert printed_alone("-c", UNKNOWN, NUMBA_CACHE_DIR=str(tmp_path)) == str(known)


def test_kernels_that_may_not_be_compiled_are_one_sentence(tmp_path):
    record = tmp_path / "record.txt"
    record.write_text("".join(f"{0.01 * i:.2f} {i % 7 / 10}\n" for i in range(100)))
    asked = ("simulate", str(record), "--unit", "g", "--body", "30cm", "90cm")
    done = subprocess.run(
        [sys.executable, "-m", "rockfrag.cli.main", *asked],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr.startswith("NUMBA_DISABLE_JIT is set")
    assert done.stderr.count("\n") == 1


# --------------------------------------------------------------------------- machine code on disk

PROGRAM = """
from rockfrag.runtime.machine_code import cached_njit

@cached_njit()
def thrice(x):
    return 3 * x
"""


def fresh(path: Path):
    spec = importlib.util.spec_from_file_location("of_this_test", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.thrice


@pytest.mark.parametrize(
    ("damaged", "left"), [("*.nbi", 20), ("*.nbc", 200), ("*.nb?", 0)]
)
def test_damaged_machine_code_is_made_anew(tmp_path, monkeypatch, damaged, left):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    assert fresh(path)(2) == 6
    files = [*(tmp_path / "cache").rglob(damaged)]
    assert files
    for file in files:
        file.write_bytes(file.read_bytes()[:left])
    assert fresh(path)(2) == 6
    again = fresh(path)
    assert again(2) == 6
    assert sum(again.stats.cache_hits.values()) == 1


def test_no_byte_of_machine_code_may_be_another(tmp_path, monkeypatch):
    """A byte that is not what was written would be a crash, or another number."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    rng = np.random.default_rng(2)
    for pattern in ("*.nbc", "*.nbi"):
        for _ in range(20):
            assert fresh(path)(2) == 6
            (file,) = (tmp_path / "cache").rglob(pattern)
            content = bytearray(file.read_bytes())
            content[rng.integers(len(content))] ^= 1 << rng.integers(8)
            file.write_bytes(content)
            assert fresh(path)(2) == 6
    damaged = fresh(path)
    assert damaged(2) == 6
    assert sum(damaged.stats.cache_hits.values()) == 1


@pytest.mark.parametrize("names", [["*.nbi"], ["*.nbc"], ["*.nbi", "*.nbc"]])
@pytest.mark.parametrize("replaced", [True, False])
def test_machine_code_of_another_user_that_may_not_be_read_is_as_if_it_were_not_there(
    tmp_path, monkeypatch, names, replaced
):
    """``replaced``: whether the folder lets this user put files in the place of others'."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    assert fresh(path)(2) == 6
    closed = {str(file) for name in names for file in (tmp_path / "cache").rglob(name)}
    replace, opened = os.replace, open

    # permissions do not bind everybody who runs the tests
    def refuse(file, mode="r", *given, **named):
        if str(file) in closed:
            raise PermissionError(13, "Permission denied", str(file))
        return opened(file, mode, *given, **named)

    def put(source, target):
        if str(target) in closed and not replaced:
            raise PermissionError(13, "Permission denied", str(target))
        closed.discard(str(target))
        replace(source, target)

    monkeypatch.setattr("builtins.open", refuse)
    monkeypatch.setattr("io.open", refuse)
    monkeypatch.setattr("os.replace", put)
    assert fresh(path)(2) == 6
    again = fresh(path)
    assert again(2) == 6
    assert sum(again.stats.cache_hits.values()) == replaced


ALONE = """
import sys
from rockfrag.runtime.machine_code import cached_njit

@cached_njit(_nrt=False)
def thrice(x):
    return 3 * x

print(thrice(2), "numba.np.arraymath" in sys.modules)
"""


def test_machine_code_is_read_without_what_compiling_needs(tmp_path):
    path = tmp_path / "alone.py"
    path.write_text(ALONE)
    for compiles in (True, False):
        said = printed_alone(str(path), NUMBA_CACHE_DIR=str(tmp_path / "cache"))
        assert said == f"6 {compiles}"


def test_without_a_folder_for_it_the_function_is_compiled_all_the_same(
    tmp_path, monkeypatch
):
    def nowhere(*given, **options):
        if options.pop("cache", False):
            raise RuntimeError("cannot cache function: no locator available")
        return numba.core.decorators.njit(*given, **options)

    monkeypatch.setattr("rockfrag.runtime.machine_code.numba.njit", nowhere)
    path = tmp_path / "of_this_test.py"
    path.write_text(PROGRAM)
    assert fresh(path)(2) == 6


def test_what_a_run_leaves_beside_the_source_does_not_change_its_digest(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(job, "PACKAGE", tmp_path)
    (tmp_path / "a.py").write_text("")
    before = job.package_digest.__wrapped__()
    (tmp_path / "__pycache__").mkdir()
    for name in ("a.cpython-311.pyc", "a.f-1.py311.nbi", "a.f-1.py311.1.nbc", "f.lock"):
        (tmp_path / "__pycache__" / name).write_text("x")
    assert job.package_digest.__wrapped__() == before
