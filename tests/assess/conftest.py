"""Motions of assessments: made ones, which need no network, and the default set."""

from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import IntensityLevels, ObjectOutcomes
from rockfrag.assess.request import Request, make_request

from ..own_kinds import cabinet as cabinet


@pytest.fixture(scope="session")
def motions(made_motions) -> MotionSet:
    """Twenty-four made motions of six earthquakes, two components a record."""
    made = made_motions(24)
    return MotionSet(
        made, made, tuple((i, i + 1) for i in range(0, len(made), 2)), "made motions"
    )


@pytest.fixture(scope="session")
def few(motions) -> MotionSet:
    """Four records of two components."""
    ground, base = motions.ground[:8], motions.base[:8]
    return replace(motions, ground=ground, base=base, pairs=motions.pairs[:4])


def outcomes_of(fell, levels, earthquakes, *, all_rock=False) -> ObjectOutcomes:
    """Outcomes of motions at levels of PGA, a row a motion; what falls rocks, and the others if all do."""
    scales, allowed = (
        np.broadcast_to(levels, fell.shape),
        np.ones(fell.shape, dtype=bool),
    )
    rocked = allowed if all_rock else fell
    names = np.array(earthquakes, dtype=object)
    return ObjectOutcomes(
        IntensityLevels(PGA, levels, scales, allowed), fell, rocked, names
    )


def asked(**settings) -> Request:
    """A request of these keys of ``statue.yaml``."""
    return make_request(settings, "test")
