"""Symmetries, similarities and limits that hold for every body and every motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockfrag.engines.pure_rocking.kernels.chatter import HISTORY
from rockfrag.outcomes.response import Response
from rockfrag.simulation import overturns, simulate
from rockfrag.system import Block, Body, Stack

from ...simulation.reference_bodies import random_motion
from ..planar.cases import DT, random_block, random_stack

# random bodies may lose contact, and pure rocking is what these tests are about
pytestmark = [
    pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies"),
    # similarity wants bodies of any size and weight
    pytest.mark.filterwarnings("ignore::rockfrag.system.blocks.UnlikelyBlock"),
]

few = settings(max_examples=25, derandomize=True)
seeds = st.integers(0, 10**6)


def drawn(seed: int) -> tuple[Body, np.ndarray, np.random.Generator]:
    """Draw a body, a motion of 3 s, and what else is drawn from."""
    rng = np.random.default_rng(seed)
    body = random_block(rng) if rng.uniform() < 0.5 else random_stack(rng)
    return body, random_motion(rng), rng


def turned(body: Body, change) -> Body:
    """The body with each of its blocks, and its offset, changed."""
    if isinstance(body, Block):
        return change(body)
    offset = change(replace(body.lower, cg_offset=body.offset)).cg_offset
    return Stack(change(body.lower), change(body.upper), offset)


def until_fallen(response: Response) -> slice:
    """Samples before any block lies down."""
    down = np.flatnonzero(np.abs(response.theta).max(axis=1) > 1.0)
    return slice(0, int(down[0]) if down.size else len(response.time))


@few
@given(seeds)
def test_a_mirrored_motion_mirrors_the_response(seed):
    body, motion, _ = drawn(seed)
    behind = turned(body, lambda b: replace(b, cg_offset=-b.cg_offset, lean=-b.lean))
    first, other = simulate(body, motion, DT), simulate(behind, -motion, DT)
    assert first.overturned == other.overturned
    assert first.impacts == other.impacts
    assert first.theta == pytest.approx(-other.theta, abs=1e-12)
    assert (first.state == -other.state).all()
    assert first.normal_force == pytest.approx(other.normal_force, rel=1e-9, abs=1e-6)
    outcome, opposite = overturns(body, motion, DT), overturns(behind, -motion, DT)
    assert outcome.overturned_body == opposite.overturned_body
    assert outcome.peak_rotation == pytest.approx(opposite.peak_rotation, rel=1e-9)


@few
@given(seeds)
def test_similar_bodies_share_one_response_whatever_they_weigh(seed):
    # α, ωp/p and a/(αg) alike: θ(p t)/α alike
    body, motion, rng = drawn(seed)
    size, weight = rng.uniform(0.2, 20), rng.uniform(0.01, 100)

    def larger(block: Block) -> Block:
        lengths = {
            name: getattr(block, name) * size
            for name in ("width", "height", "cg_offset")
        }
        return replace(
            block, **lengths, mass=block.mass * weight, cg_height=block.h * size
        )

    first = simulate(body, motion, DT)
    other = simulate(turned(body, larger), motion, DT * math.sqrt(size))
    n = min(until_fallen(first).stop, until_fallen(other).stop)
    if isinstance(body, Block):
        assert first.overturned == other.overturned
        assert abs(until_fallen(first).stop - until_fallen(other).stop) <= 1
    else:
        # the threshold that closes chatter is a speed, which does not scale; before the first it matters not
        closed = first.contact_events.query("kind == 'chatter'")["time"]
        n = min(n, int(closed.iloc[0] / DT) if len(closed) else n)
    assert first.theta[:n] == pytest.approx(
        other.theta[:n], abs=1e-8 * min(b.alpha for b in body.blocks)
    )


@few
@given(seeds)
def test_on_a_pedestal_that_cannot_move_the_statue_rocks_alone(seed):
    rng = np.random.default_rng(seed)
    upper, motion = random_block(rng), random_motion(rng)
    stack = Stack(Block(1e3, 1.0, 1e12), upper)
    alone, carried = simulate(upper, motion, DT), simulate(stack, motion, DT)
    assert alone.overturned == carried.overturned
    n = min(until_fallen(alone).stop, until_fallen(carried).stop)
    assert np.abs(carried.theta[:, 0]).max() < 1e-9
    assert carried.theta[:n, 1] == pytest.approx(alone.theta[:n, 0], abs=1e-9)


@few
@given(seeds)
def test_energy_is_never_gained_at_impacts_and_the_energy_balance_closes(seed):
    body, motion, _ = drawn(seed)
    response = simulate(body, motion, DT)
    impacts = response.contact_events.query("kind != 'opening'")
    before, after = impacts["energy_before"], impacts["energy_after"]
    assert (after <= before * (1 + 1e-12) + 1e-300).all()
    energy = response.energy
    scale = energy["kinetic"].max() + energy["input"].abs().max()
    residual = energy["residual"].abs().max()
    # a contact that closes because it chatters gives up no more than this
    whole = body.rigidly_joined()
    closing = (
        0.5
        * max(whole.pivot_inertia(pivot) for pivot in (+1, -1))
        * HISTORY.closing_speed**2
    )
    assert residual <= 1e-6 * scale + closing, f"{residual} J of {scale} J"
    # positions agree with the contact states
    relative = np.diff(response.theta, axis=1, prepend=0.0)
    assert (relative * response.state >= -1e-9)[until_fallen(response)].all()
    assert (np.abs(relative[response.state == 0]) < 1e-9).all()


@few
@given(seeds, st.floats(0.01, 0.9), st.sampled_from((-1, 1)))
def test_free_rocking_ends_at_rest_or_on_the_side(seed, start, side):
    body, _, _ = drawn(seed)
    turn = side * start * body.blocks[-1].alpha
    response = simulate(
        body, np.zeros(2), DT, theta0=(*[0.0] * (len(body.blocks) - 1), turn)
    )
    assert response.overturned or response.rocking_mode[-1] == "rest"
    assert np.isfinite(response.theta).all()
