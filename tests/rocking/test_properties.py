"""Symmetries, similarities and limits that hold for every body and every motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from rockfrag.engines.kernels.chatter import HISTORY
from rockfrag.engines.response import Response
from rockfrag.rocking import overturns, simulate
from rockfrag.system import Block, Body, Stack
from rockfrag.system.blocks import stacked

# random bodies may lose contact, and pure rocking is what these tests are about
pytestmark = [
    pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies"),
    # similarity wants bodies of any size and weight
    pytest.mark.filterwarnings("ignore::rockfrag.system.blocks.UnlikelyBlock"),
]

G = 9.81
DT = 0.01

few = settings(max_examples=25, derandomize=True, suppress_health_check=list(HealthCheck))


@st.composite
def motions(draw: st.DrawFn, peak_g: float = 0.8) -> np.ndarray:
    """Sum of three sines under an envelope [m/s²], 3 s long, that begins and ends with zero."""
    t = np.arange(300) * DT
    waves = np.zeros_like(t)
    for _ in range(3):
        frequency, phase = draw(st.floats(0.4, 5)), draw(st.floats(0, 6))
        waves += draw(st.floats(0.3, 1)) * np.sin(2 * np.pi * frequency * t + phase)
    shape = waves * np.sin(np.pi * np.arange(300) / 299) ** 0.5
    shape[[0, -1]] = 0.0
    top = float(np.abs(shape).max())
    assume(top > 0.05)
    return np.asarray(draw(st.floats(0.2, peak_g)) * G * shape / top)


@st.composite
def blocks(draw: st.DrawFn, crooked: bool = False) -> Block:
    """A block of H/B from 1.5 to 6, uniform or crooked."""
    width = draw(st.floats(0.1, 1.0))
    height = width * draw(st.floats(1.5, 6))
    if not crooked:
        return Block(width, height, width * height * 500)
    cg = height * draw(st.floats(0.3, 0.6)), width * draw(st.floats(-0.15, 0.15))
    return Block(width, height, width * height * 500, None, *cg, draw(st.floats(-0.01, 0.01)))


@st.composite
def stacks(draw: st.DrawFn, crooked: bool = False) -> Stack:
    """A statue on a pedestal that it leaves some room on."""
    upper = draw(blocks(crooked))
    width = upper.width * draw(st.floats(1.2, 2.5))
    height = width * draw(st.floats(0.3, 2))
    lower = Block(width, height, width * height * draw(st.floats(300, 2000)))
    offset = draw(st.floats(-0.05, 0.05)) * width if crooked else 0.0
    return Stack(lower, upper, offset)


def bodies(crooked: bool) -> st.SearchStrategy[Body]:
    return st.one_of(blocks(crooked), stacks(crooked))


def mirrored(body: Body) -> Body:
    """The body seen from behind."""
    if isinstance(body, Block):
        return replace(body, cg_offset=-body.cg_offset, lean=-body.lean)
    lower, upper = mirrored(body.lower), mirrored(body.upper)
    assert isinstance(lower, Block) and isinstance(upper, Block)
    return Stack(lower, upper, -body.offset)


def until_fallen(response: Response) -> slice:
    """Samples before any block lies down."""
    down = np.flatnonzero(np.abs(response.theta).max(axis=1) > 1.0)
    return slice(0, int(down[0]) if down.size else len(response.time))


@few
@given(body=bodies(crooked=True), motion=motions())
def test_a_mirrored_motion_mirrors_the_response(body: Body, motion: np.ndarray) -> None:
    first = simulate(body, motion, DT)
    other = simulate(mirrored(body), -motion, DT)
    assert first.overturned == other.overturned
    assert first.impacts == other.impacts
    assert first.theta == pytest.approx(-other.theta, abs=1e-12)
    assert (first.state == -other.state).all()
    assert first.normal_force == pytest.approx(other.normal_force, rel=1e-9, abs=1e-6)
    outcome, opposite = (
        overturns(*each, DT) for each in ((body, motion), (mirrored(body), -motion))
    )
    assert outcome.overturned_body == opposite.overturned_body
    assert outcome.peak_rotation == pytest.approx(opposite.peak_rotation, rel=1e-9)


@few
@given(
    body=bodies(crooked=False),
    motion=motions(),
    size=st.floats(0.2, 20),
    weight=st.floats(0.01, 100),
)
def test_similar_bodies_share_one_response_whatever_they_weigh(body, motion, size, weight):
    # α, ωp/p and a/(αg) alike: θ(p t)/α alike
    larger = [Block(b.width * size, b.height * size, b.mass * weight) for b in body.blocks]
    first = simulate(body, motion, DT)
    other = simulate(stacked(larger), motion, DT * math.sqrt(size))
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
@given(upper=blocks(), motion=motions())
def test_on_a_pedestal_that_cannot_move_the_statue_rocks_alone(upper, motion):
    stack = Stack(Block(1e3, 1.0, 1e12), upper)
    alone, carried = simulate(upper, motion, DT), simulate(stack, motion, DT)
    assert alone.overturned == carried.overturned
    n = min(until_fallen(alone).stop, until_fallen(carried).stop)
    assert np.abs(carried.theta[:, 0]).max() < 1e-9
    assert carried.theta[:n, 1] == pytest.approx(alone.theta[:n, 0], abs=1e-9)


@few
@given(motion=motions(), height=st.floats(1.0, 3.0), top=st.floats(0.05, 0.2))
def test_two_blocks_that_never_part_rock_as_one(motion, height, top):
    # a flat plate on a column has no cause to rock on its own
    stack = Stack(Block(0.5, height, 300.0), Block(0.5, top * 0.5, 30.0))
    together, item = simulate(stack, motion, DT), simulate(stack.rigidly_joined(), motion, DT)
    parted = np.flatnonzero(together.state[:, 1] != 0)
    n = min(until_fallen(together).stop, until_fallen(item).stop)
    n = min(n, int(parted[0]) if parted.size else n)
    assume(n > 20)
    assert together.theta[:n, 0] == pytest.approx(item.theta[:n, 0], abs=1e-9)
    assert together.theta[:n, 1] == pytest.approx(item.theta[:n, 0], abs=1e-9)
    assert set(together.rocking_mode[:n]) <= {"rest", "3a", "3b"}


@few
@given(body=bodies(crooked=True), motion=motions(), zeros=st.integers(1, 200))
def test_a_later_start_shifts_the_response_rigidly(body, motion, zeros):
    first = simulate(body, motion, DT)
    other = simulate(body, np.r_[np.zeros(zeros), motion], DT)
    n = len(first.time)
    assert not other.theta[:zeros].any()
    assert other.theta[zeros : zeros + n] == pytest.approx(first.theta, abs=1e-12)
    assert other.impacts == first.impacts and other.overturned == first.overturned


@few
@given(body=bodies(crooked=True), motion=motions())
def test_energy_is_never_gained_at_impacts_and_the_energy_balance_closes(body, motion):
    response = simulate(body, motion, DT)
    impacts = response.contact_events.query("kind != 'opening'")
    before, after = impacts["energy_before"], impacts["energy_after"]
    assert (after <= before * (1 + 1e-12) + 1e-300).all()
    energy = response.energy
    scale = energy["kinetic"].max() + energy["input"].abs().max()
    residual = energy["residual"].abs().max()
    # a contact that closes because it chatters gives up no more than this
    whole = body if isinstance(body, Block) else body.rigidly_joined()
    closing = 0.5 * max(whole.pivot_inertia(pivot) for pivot in (+1, -1)) * HISTORY.closing_speed**2
    assert residual <= 1e-6 * scale + closing, f"{residual} J of {scale} J"
    # positions agree with the contact states
    relative = np.diff(response.theta, axis=1, prepend=0.0)
    assert (relative * response.state >= -1e-9)[until_fallen(response)].all()
    assert (np.abs(relative[response.state == 0]) < 1e-9).all()


@few
@given(body=bodies(crooked=True), start=st.floats(-0.9, 0.9))
def test_free_rocking_ends_at_rest_or_on_the_side(body: Body, start: float) -> None:
    assume(abs(start) > 0.01)
    if isinstance(body, Block):
        theta0: float | tuple[float, float] = start * body.alpha
    else:
        theta0 = (0.0, start * body.upper.alpha)
    response = simulate(body, np.zeros(2), DT, theta0=theta0)
    assert response.overturned or response.rocking_mode[-1] == "rest"
    assert np.isfinite(response.theta).all()
