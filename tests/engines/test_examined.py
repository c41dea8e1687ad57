"""Cases of mechanics that once were answered wrongly, each as it was seen."""

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.simulation.ensemble import LightBodies

T = np.arange(0, 4, 0.01)
SHAKE = 4 * np.sin(2 * np.pi * 1.5 * T) * np.sin(np.pi * T / 4)
B = Block(0.2, 0.8, 50.0)
T6 = np.arange(0, 6, 0.01)
SLOW = 4 * np.sin(2 * np.pi * 0.7 * T6) * np.sin(np.pi * T6 / 6)
PAIR = Stack(Block(0.4, 0.3, 50.0), Block(0.15, 0.6, 20.0))
WIDER = Stack(Block(0.5, 0.3, 50.0), Block(0.15, 0.6, 20.0))


def test_a_fall_keeps_to_the_friction_that_was_given():
    r = simulate(B, SLOW, 0.01, friction=0.4)
    k = (r.time < r.overturning_time) & (r.normal_force[:, 0] > 0)
    assert (np.abs(r.friction_force[k, 0]) / r.normal_force[k, 0]).max() <= 0.4 * (
        1 + 1e-6
    )
    # the history and the outcome are of one response
    found = overturns(B, [SLOW], 0.01, friction=[0.4])
    assert found.overturned.item() == r.overturned
    assert found.peak_slip.item() == pytest.approx(np.abs(r.slip).max(), rel=0.05)


def ambiguous_stack():
    """A stack of which one impact has two outcomes that satisfy the laws."""
    rng = np.random.default_rng(606)
    first = None
    for i in range(24):
        b = rng.uniform(0.05, 0.4)
        h = b * rng.uniform(1.5, 8)
        if i % 2 == 0:
            size = (
                2 * b * rng.uniform(1.2, 3),
                rng.uniform(0.1, 1.0),
                rng.uniform(5, 200),
            )
            first = first or Stack(Block(*size), Block(2 * b, 2 * h, 1000 * b * h))
    t = np.arange(0, 6, 0.01)
    waves = zip(rng.uniform(0.3, 4, 3), rng.uniform(0, 6, 3), strict=True)
    a = (
        sum(np.sin(2 * np.pi * f * t + y) for f, y in waves)
        * np.sin(np.pi * t / 6) ** 2
    )
    return first, a * (9.81 / np.abs(a).max() * 0.9)


def test_histories_and_outcomes_choose_alike_where_two_outcomes_satisfy_the_laws():
    stack, a = ambiguous_stack()
    for friction in (2.0, 5.0, np.inf):
        item = simulate(stack, a, 0.01, friction=friction).overturned
        assert (
            item == overturns(stack, [a], 0.01, friction=[friction]).overturned.item()
        )
    # the choice is counted; with the usual friction of stone the laws leave one outcome alone
    rough = overturns([stack, stack], [a], 0.01, friction=[2.0, 0.6])
    assert rough.several_modes.ravel().tolist() == [14, 0]


def test_a_pair_of_friction_has_one_meaning():
    a = 5 * np.sin(2 * np.pi * 1.2 * T6) * np.sin(np.pi * T6 / 6)
    named = overturns(
        [PAIR, WIDER], a, 0.01, friction={"ground": 0.6, "interface": 0.2}
    )
    listed = overturns([PAIR, WIDER], a, 0.01, friction=[(0.6, 0.2), (0.6, 0.2)])
    assert (
        named.overturned.tolist()
        == listed.overturned.tolist()
        == [[[False]], [[False]]]
    )


def test_squat_bodies_that_lift_themselves_are_warned_of():
    t = np.arange(0, 3, 0.005)
    strong = 3 * 9.81 * np.sin(2 * np.pi * 2 * t)
    with pytest.warns(LightBodies, match="a squat body rocks so fast"):
        overturns(Block(0.49, 0.49, 280.0), strong, 0.005)


def test_the_instant_of_a_fall_has_one_meaning():
    certain = overturns(B, SLOW, 0.01)
    lying = overturns(B, SLOW, 0.01, forces=True)
    assert certain.overturned.item() and lying.overturned.item()
    # lanes stop when the fall is certain, and do not say when the body lies down
    assert np.isnan(certain.overturning_time.item())
    assert np.isnan(lying.certain_time.item())
    assert certain.certain_time.item() < lying.overturning_time.item()
    assert simulate(B, SLOW, 0.01).overturning_time == lying.overturning_time.item()


def near_jamming(seed):
    """A block that slides on a corner near the configuration in which the normal force has no bound."""
    rng = np.random.default_rng([901, seed])
    b = rng.uniform(0.05, 0.4)
    h = b * rng.uniform(1.5, 6)
    block = Block(
        2 * b, 2 * h, 1000 * b * h, cg_offset=float(rng.uniform(-0.3, 0.3) * b)
    )
    t = np.arange(0, 6, 0.01)

    def wave(peak):
        waves = [(rng.uniform(0.3, 4), rng.uniform(0, 6)) for _ in range(3)]
        made = (
            sum(np.sin(2 * np.pi * f * t + y) for f, y in waves)
            * np.sin(np.pi * t / 6) ** 2
        )
        return made * peak / abs(made).max()

    along = wave(9.81 * rng.uniform(0.5, 1.5))
    return block, along, wave(9.81 * rng.uniform(0.5, 1.2)), rng.uniform(0.8, 1.6)


@pytest.mark.parametrize("seed", [60, 1096, 1490, 1827, 3412])
def test_energy_is_kept_where_friction_nearly_jams_a_corner(seed):
    block, along, up, mu = near_jamming(seed)
    response = simulate(block, along, 0.01, friction=mu, vertical=up)
    energy = response.energy
    unit = max(block.mass * 9.81 * block.h, float(energy["input"].abs().max()))
    assert energy["residual"].abs().max() < 1e-7 * unit
    # the first of them was thrown to a rotation that is no number, and said to stand
    assert np.isfinite(response.theta).all() and response.overturned
    found = overturns(block, along, 0.01, friction=[mu], vertical=up)
    assert found.overturned.item()


def test_a_restitution_of_nothing_is_taken_as_it_is_said():
    """Any ratio that gains no energy can have been measured, so that none is doubted: 0 stops dead."""
    response = simulate(B, SHAKE, 0.01, restitution=0)
    impacts = response.contact_events[response.contact_events["kind"] == "impact"]
    assert len(impacts) and all(after == (0.0,) for after in impacts["omega_after"])


def test_an_interval_that_no_instrument_has_is_taken_where_nothing_is_sampled():
    # an ensemble of lone blocks keeps no samples, and nothing moves in 4e-7 s
    assert not overturns(B, SHAKE, 1e-9).overturned.any()
