"""A ground that moves vertically too: gravity is g + a_v(t), in one history and in ensembles."""

from itertools import product

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.laws import law_names
from rockfrag.system import geometry

from ...oracle.rocking_integrator import simulate_reference
from ...simulation.reference_bodies import T2, P, measured, random_motion
from ..planar.cases import DT, random_block, random_stack

# random bodies may lose contact, and pure rocking is what these tests are about
pytestmark = pytest.mark.filterwarnings(
    "ignore::rockfrag.simulation.ensemble.LightBodies"
)


@pytest.mark.parametrize(
    "body", [T2, Stack(P, T2), random_stack(np.random.default_rng(4))]
)
@pytest.mark.parametrize("upward", [2.5, -4.0])
@pytest.mark.parametrize("linear", [False, True])
def test_a_constant_vertical_acceleration_is_another_gravity(body, upward, linear):
    motion = 0.8 * random_motion(np.random.default_rng(2), 500)
    with_it = simulate(
        body, motion, DT, vertical=np.full(motion.size, upward), linear=linear
    )
    other = simulate(body, motion, DT, g=9.81 + upward, linear=linear)
    n = min(len(with_it.time), len(other.time), motion.size)
    # each stays within the same steps, and rounds differently
    assert len(with_it.contact_events) > 2
    assert with_it.theta[:n] == pytest.approx(other.theta[:n], abs=1e-9)
    assert with_it.overturned == other.overturned


def drawn(seed):
    """Draw a body, a motion and a vertical one, every third strong enough to nearly take weight away."""
    rng = np.random.default_rng(seed)
    body = random_block(rng, slenderness=(2, 6)) if seed % 2 else random_stack(rng)
    return (
        body,
        random_motion(rng),
        (0.9 if seed % 3 == 0 else 0.3) * random_motion(rng),
    )


def test_ensembles_and_histories_agree_under_vertical_motion():
    differ = 0
    for body, motion, up in map(drawn, range(60)):
        item = simulate(body, motion, DT, vertical=up)
        found = overturns(body, motion, DT, vertical=[up])
        if item.overturned != found.overturned.item():
            differ += 1
        elif not item.overturned and isinstance(body, Block):
            critical = np.where(
                item.theta > 0, body.critical_angle(1), body.critical_angle(-1)
            )
            peak = np.abs(item.theta / critical).max()
            assert found.peak_rotation.item() == pytest.approx(peak, rel=0.1, abs=1e-3)
        kinetic = max(1e-3, item.energy["kinetic"].max())
        assert np.abs(item.energy["residual"]).max() <= 1e-5 * kinetic
    assert differ <= 1


SLOW = product(range(6, 46), (None, *law_names()))


@pytest.mark.parametrize(
    ("seed", "law"),
    [
        *((seed, None) for seed in range(6)),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in SLOW),
    ],
)
def test_histories_follow_the_plain_integrator_under_vertical_motion(seed, law):
    """Up to the sixth contact event, before a contact grazes."""
    body, motion, up = drawn(seed)
    shapes = body.system().carried
    if (
        law == "couple"
        and min(geometry.momentum_restitution(s, 1) for s in shapes) < 0.05
    ):
        law = "ratio"  # momentum leaves it nothing to multiply
    restitution = law and measured(body, 0.8 + 0.005 * seed, law)
    fast = simulate(body, motion, DT, vertical=up, restitution=restitution)
    slow = simulate_reference(
        body,
        motion,
        DT,
        vertical=up,
        restitution=restitution,
        duration=motion.size * DT,
    )
    contact_events = [e for e in slow.contact_events if e.kind != "overturning"]
    until = contact_events[6].time if len(contact_events) > 6 else np.inf
    for contact_event in contact_events:
        change = np.diff(contact_event.omega_before, prepend=0.0)
        if (
            contact_event.kind != "opening"
            and np.abs(change[change != 0]).min(initial=1.0) < 1e-2
        ):
            until = min(until, contact_event.time)
    n = min(len(fast.time), len(slow.time), int(np.searchsorted(fast.time, until)))
    upright = np.abs(slow.theta[:n]).max(axis=1) < 0.5
    if n < 4 and until < np.inf:
        pytest.skip(
            f"a contact grazes after {until:.3f} s, before there is anything to compare"
        )
    assert n > 3
    assert fast.theta[:n][upright] == pytest.approx(slow.theta[:n][upright], abs=1e-6)
