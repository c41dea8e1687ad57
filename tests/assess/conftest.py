"""Motions of assessments: made ones, which need no network, and the default set."""

import numpy as np
import pytest

from rockfrag.assess.motions import MotionSet


@pytest.fixture(scope="session")
def motions(made_motions) -> MotionSet:
    """Twenty-four made motions of six earthquakes, two components a record."""
    made = made_motions(24)
    return MotionSet(made, made, tuple((i, i + 1) for i in range(0, len(made), 2)), "made motions")


@pytest.fixture
def random() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(7)
