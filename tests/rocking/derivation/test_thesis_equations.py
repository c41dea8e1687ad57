"""Every equation of the thesis's chapter 2, 2.1 to 2.86, against what follows from the positions."""

import numpy as np
import pytest

from . import impacts, motion, single_block, transitions
from .systems import Equation, error

EQUATIONS = [*single_block.EQUATIONS, *motion.EQUATIONS, *transitions.EQUATIONS, *impacts.EQUATIONS]

# the misprints that docs/derivation.md lists
WRONG = [
    f"2.{i}" for i in (15, 16, 33, 39, 46, 47, 51, 60, 62, 64, 66, *range(69, 77), *range(78, 86))
]


@pytest.mark.parametrize("equation", EQUATIONS, ids=lambda e: e.number)
def test_the_equation_holds_or_its_mended_form_does(equation: Equation) -> None:
    systems = equation.systems()
    true = equation.true(systems)
    printed = error(equation.printed(systems), true)
    if equation.mended is None:
        assert printed.max() < equation.tolerance
        return
    # a wrong print is wrong for every system in at least one of its components or states
    assert printed.max() > 1e-3
    worst = printed.reshape(-1, printed.shape[-1]).max(axis=0)
    assert np.mean(worst > 1e-6) > 0.3
    assert error(equation.mended(systems), true).max() < equation.tolerance


def test_every_equation_is_judged_once() -> None:
    assert [e.number for e in EQUATIONS] == [f"2.{i}" for i in range(1, 87)]


def test_the_misprints_are_those_of_the_table() -> None:
    assert [e.number for e in EQUATIONS if e.mended is not None] == WRONG
