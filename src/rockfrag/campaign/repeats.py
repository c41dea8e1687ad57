"""Tests that repeat a setting: what no model that knows the setting alone can exceed."""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Bools = NDArray[np.bool_]

REPEATS = "majority of repeated tests (ceiling)"
"""Who gave these outcomes, in the tables."""


def majority_of_repeats(settings: NDArray[Any], measured: Bools) -> Bools | None:
    """Outcome that most tests at the same setting had, shape (tests,); None where no setting is repeated.

    A model whose answer follows from the setting alone gives one outcome for all repeats, so it is right in no
    more tests than the majority. Tests whose setting is not repeated count as right.
    """
    code = pd.factorize(settings)[0]
    tests = np.bincount(code)
    if tests.max() < 2:
        return None
    fell = np.bincount(code, measured)
    return np.asarray(2 * fell[code] >= tests[code])
