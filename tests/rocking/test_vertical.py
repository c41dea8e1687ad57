"""A ground that moves vertically too: gravity is g + a_v(t), in one history and in ensembles."""

from itertools import product

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.laws import law_names
from rockfrag.rocking import MeasuredRestitution

from ..oracle.rocking_integrator import simulate_reference
from ..oracle.standing import upper_on_contact

# random bodies may lose contact, and pure rocking is what these tests are about
pytestmark = pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")

DT = 0.01
TOWER = Block(0.124, 0.496, 2.79)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
CROOKED = Stack(
    Block(0.3, 0.3, 60.0, cg_offset=0.01, lean=0.004), Block(0.25, 0.9, 50.0, cg_offset=-0.01)
)


def shaking(rng, peak, samples=500):
    """Random motion of 5 s that ends in zero [m/s²]."""
    coarse = rng.normal(size=samples // 10 + 1)
    coarse[-1] = 0.0
    motion = np.interp(np.arange(samples) * 0.1, np.arange(coarse.size), coarse)
    motion[-1] = 0.0
    return peak * motion / np.abs(motion).max()


@pytest.mark.parametrize("body", [TOWER, STACK, CROOKED])
@pytest.mark.parametrize("upward", [2.5, -4.0])
@pytest.mark.parametrize("linear", [False, True])
def test_a_constant_vertical_acceleration_is_another_gravity(body, upward, linear):
    motion = shaking(np.random.default_rng(1), 4.5)
    with_it = simulate(body, motion, DT, vertical=np.full(motion.size, upward), linear=linear)
    other = simulate(body, motion, DT, g=9.81 + upward, linear=linear)
    n = min(len(with_it.time), len(other.time), motion.size)
    # each stays within the same steps, and rounds differently
    assert len(with_it.contact_events) > 2
    assert with_it.theta[:n] == pytest.approx(other.theta[:n], abs=1e-9)
    assert with_it.overturned == other.overturned


def cases(count):
    """Bodies, motions and vertical ones, every third strong enough to nearly take weight away."""
    rng = np.random.default_rng(3)
    for number in range(count):
        base, slenderness = rng.uniform(0.1, 0.5), rng.uniform(2, 6)
        off = float(0.02 * base * rng.normal())
        body = Block(base, base * slenderness, 1000 * base**2 * slenderness, cg_offset=off)
        below = base * rng.uniform(1, 1.6)
        if number % 2 == 0:
            body = Stack(Block(below, below * rng.uniform(0.5, 2), 1500 * below**2), body)
        motion = shaking(rng, 9.81 / slenderness * rng.uniform(1.1, 3))
        up = shaking(rng, 8.0 if number % 3 == 0 else 3.0)
        yield body, motion, up


def test_ensembles_and_histories_agree_under_vertical_motion():
    differ = 0
    for body, motion, up in cases(60):
        item = simulate(body, motion, DT, vertical=up)
        found = overturns(body, motion, DT, vertical=[up])
        if item.overturned != found.overturned.item():
            differ += 1
        elif not item.overturned and isinstance(body, Block):
            peak = np.abs(item.theta).max() / body.alpha
            assert found.peak_rotation.item() == pytest.approx(peak, rel=0.1, abs=1e-3)
        kinetic = max(1e-3, item.energy["kinetic"].max())
        assert np.abs(item.energy["residual"]).max() <= 1e-5 * kinetic
    assert differ <= 1


@pytest.mark.parametrize(
    ("seed", "law"),
    [
        *((seed, None) for seed in range(6)),
        *(
            pytest.param(seed, law, marks=pytest.mark.slow)
            for seed, law in product(range(6, 46), (None, *law_names()))
        ),
    ],
)
def test_histories_follow_the_plain_integrator_under_vertical_motion(seed, law):
    """Up to the sixth contact event, before a contact grazes."""
    body, motion, up = list(cases(seed + 1))[-1]
    rng = np.random.default_rng(seed)
    restitution = None
    if law is not None:
        blocks = (body,) if isinstance(body, Block) else (body.lower, upper_on_contact(body))
        values = [
            min(block.momentum_restitution(s) for s in (1, -1)) * rng.uniform(0.8, 1.04)
            for block in blocks
        ]
        if min(values) <= 0:
            values = [max(0.1, value) for value in values]
            law = "ratio" if law == "couple" else law
        restitution = MeasuredRestitution(values[0] if len(values) == 1 else tuple(values), law)
    fast = simulate(body, motion, DT, vertical=up, restitution=restitution)
    slow = simulate_reference(
        body, motion, DT, vertical=up, restitution=restitution, duration=motion.size * DT
    )
    contact_events = [e for e in slow.contact_events if e.kind != "overturning"]
    until = contact_events[6].time if len(contact_events) > 6 else np.inf
    for contact_event in contact_events:
        change = np.diff(contact_event.omega_before, prepend=0.0)
        if contact_event.kind != "opening" and np.abs(change[change != 0]).min(initial=1.0) < 1e-2:
            until = min(until, contact_event.time)
    n = min(len(fast.time), len(slow.time), int(np.searchsorted(fast.time, until)))
    upright = np.abs(slow.theta[:n]).max(axis=1) < 0.5
    if n < 4 and until < np.inf:
        pytest.skip(f"a contact grazes after {until:.3f} s, before there is anything to compare")
    assert n > 3
    assert fast.theta[:n][upright] == pytest.approx(slow.theta[:n][upright], abs=1e-6)
