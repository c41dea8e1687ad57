"""Mark of tests that wait for the planar engine to hold bodies by walls, ties, bonds and isolators."""

import pytest

from rockfrag.engines.built_in import PLANAR
from rockfrag.engines.contract import Wish

NEEDS_PLANAR_HOLDING = pytest.mark.skipif(
    Wish.WALL not in PLANAR.meets,
    reason="the planar engine refuses what holds a body: not all of its closed forms hold yet",
)
