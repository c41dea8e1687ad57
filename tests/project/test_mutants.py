"""The command that changes one line of what computes: its changes are programs, its plain kernels the kernels."""

import ast
import os
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rockfrag import Block, overturns

from ..mutants.__main__ import GROUPS, mutants_of
from ..mutants.changes import changes_of

ROOT = Path(__file__).resolve().parents[2]

SOURCE = '''
def f(x: int = 0) -> bool:
    """Words of 1 < 2 are left alone."""
    if not x < 3.0 and x != -y:
        raise ValueError("more than 5")
    return min(x, 2) ** 2 >= total
'''


def test_each_operator_number_and_counterpart_of_a_line_is_changed():
    found = {(change.line, change.old, change.new) for change in changes_of(SOURCE)}
    assert found == {
        (2, "0", "1"),
        (4, "not ", ""),
        (4, "<", "<="),
        (4, "<", ">"),
        (4, "3.0", "3.75"),
        (4, "and", "or"),
        (4, "!=", "=="),
        (4, "-", "+"),
        (6, "min", "max"),
        (6, "2", "3"),
        (6, "**", "*"),
        (6, ">=", ">"),
        (6, ">=", "<="),
    }


GUARDS = """
MOST_STEPS = 100
FEWEST = 5
small = 1e-9 if far < 1e300 else 1e-3
pairs = zip(a, b, strict=True)
"""


def test_what_guards_alone_is_left_and_what_counts_is_changed():
    found = {(change.line, change.old, change.new) for change in changes_of(GUARDS)}
    assert found == {
        (3, "5", "6"),
        (4, "<", "<="),
        (4, "<", ">"),
        (4, "1e-3", "0.00125"),
    }


def test_a_change_is_one_of_one_line_and_leaves_a_program():
    lines = [line for group in GROUPS for line in mutants_of(group, "")]
    assert len(lines) > 3000
    for line in random.Random(1).sample(lines, 25):
        for mutant in line:
            source = mutant.path.read_text(encoding="utf-8")
            changed = mutant.change.applied(source)
            ast.parse(changed)
            assert changed != source
            pairs = zip(source.splitlines(), changed.splitlines(), strict=True)
            assert sum(before != after for before, after in pairs) == 1


PLAIN = """
import sys
from tests.mutants.plain import without_compiling
without_compiling()
import numpy as np
from rockfrag import Block, overturns
motion = 3.5 * np.sin(np.arange(60) * 0.13)
found = overturns([Block(0.3, 1.2, 200.0)], motion, 0.02, [1.0], friction=0.6)
print(repr(float(found.peak_velocity[0, 0, 0].max())), "llvmlite.binding" in sys.modules)
"""


def test_kernels_that_are_not_compiled_give_the_same_response():
    done = subprocess.run(
        [sys.executable, "-c", PLAIN],
        cwd=ROOT,
        env={**os.environ, "NUMBA_CACHE_DIR": "/nowhere"},
        capture_output=True,
        text=True,
        check=True,
    )
    motion = 3.5 * np.sin(np.arange(60) * 0.13)
    found = overturns([Block(0.3, 1.2, 200.0)], motion, 0.02, [1.0], friction=0.6)
    expected = float(found.peak_velocity[0, 0, 0].max())
    assert expected > 0.1
    assert float(done.stdout.split()[0]) == pytest.approx(expected, rel=1e-9)


@pytest.mark.slow
def test_mutants_are_noticed():
    command = (sys.executable, "-m", "tests.mutants", "--number", "8", "--seed", "1")
    done = subprocess.run(
        [*command, "--only", "fragility/intervals", "--least", "60"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "8 mutants" in done.stdout
