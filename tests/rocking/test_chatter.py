"""A contact that is closed at once keeps the momentum that its hops would have kept."""

import math

import numpy as np
import pytest

from rockfrag.engines.kernels.chatter import Hop, closed
from rockfrag.engines.kernels.equations import STATE
from rockfrag.engines.kernels.impact import stuck
from rockfrag.engines.kernels.jit import entry_kernel
from rockfrag.engines.kernels.lanes.stack_constants import (
    IMPACT,
    ONE,
    TWO,
    fill_constants,
    number_of,
)
from rockfrag.engines.records import body_record
from rockfrag.rocking import Block, Stack

BODY = body_record(Stack(Block(0.4, 0.3, 100.0), Block(0.3, 1.2, 200.0, cg_offset=0.01)).system())


@entry_kernel
def closed_both_ways(body, hop, state, constants, scratch):
    """Velocities of a contact that stays closed, as it is closed at once and as an impact would close it."""
    ones, twos, impacts = constants
    fill_constants(body, 1.0, ones, twos, impacts, scratch)
    at_once = closed(hop, twos[number_of(state.c1, state.c2)])
    c1, c2 = (0, state.c2) if hop.ground else (state.c1, 0)
    return at_once, stuck(body, state, c1, c2)


@pytest.mark.parametrize(("ground", "theta"), [(True, (0.0, 0.2)), (False, (0.2, 0.2))])
@pytest.mark.parametrize("side", [1, -1])
def test_closing_at_once_is_an_impact_that_sticks(ground, theta, side):
    state, scratch = np.zeros(2, STATE)
    state["theta1"], state["theta2"] = theta
    state["c1"], state["c2"] = (side, 1) if ground else (1, side)
    state["omega1"], state["omega2"] = (side * 0.03, 0.4) if ground else (0.4, 0.4 + side * 0.03)
    w1, w2 = float(state["omega1"]), float(state["omega2"])
    old = -0.1 * side
    hop = Hop(ground, side, old, math.cos(theta[1]), math.sin(theta[1]), w1, w2)
    constants = np.zeros(9, ONE), np.zeros(9, TWO), np.zeros(9, IMPACT)
    at_once, by_impact = closed_both_ways(BODY, hop, state, constants, scratch)
    np.testing.assert_allclose(at_once, by_impact, rtol=1e-12)
