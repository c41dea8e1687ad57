"""Friction without limit and no vertical motion: the nine-state model."""

import numpy as np
import pytest

from rockfrag.simulation import overturns, simulate
from rockfrag.simulation.ensemble import LIGHT, LightBodies

from ...simulation.reference_bodies import random_motion
from .cases import DT, random_block, random_stack

SCALES = np.linspace(0.3, 1.5, 10)

# where pure rocking loses contact is what these tests ask themselves
pytestmark = pytest.mark.filterwarnings(
    "ignore::rockfrag.simulation.ensemble.LightBodies"
)


@pytest.mark.parametrize("stacks", [False, True], ids=["blocks", "stacks"])
@pytest.mark.parametrize(
    ("bodies", "seed", "most"),
    [(2, 1, 0), pytest.param(50, 2, 10, marks=pytest.mark.slow)],
)
def test_outcomes_are_those_of_pure_rocking_but_where_that_lifts_off(
    bodies, seed, most, stacks
):
    """Random bodies under twenty random motions at ten scales.

    In pure rocking a pivot may pull; bodies in contact lift off there, and go their own way.
    """
    rng = np.random.default_rng(seed)
    drawn = [random_stack(rng) if stacks else random_block(rng) for _ in range(bodies)]
    motions = [random_motion(rng) for _ in range(20)]
    fell = overturns(drawn, motions, DT, SCALES).overturned
    rough = overturns(drawn, motions, DT, SCALES, friction=np.inf).overturned
    flagged = np.isfinite(
        overturns(drawn, motions, DT, SCALES, forces=True).lost_contact
    )
    differ = fell != rough
    assert 0.09 < fell.mean() < 0.95
    assert not (differ & ~flagged).any()
    assert differ.sum() <= (most if stacks else 0)
    assert bodies < 50 or differ.sum() <= flagged.sum() < 0.15 * differ.size


def test_where_the_ground_takes_weight_away_pure_rocking_says_that_it_may_be_wrong() -> (
    None
):
    """Outcomes that flight changes are among the cases that are marked; where little weight goes, none changes."""
    rng = np.random.default_rng(5)
    drawn = [draw(rng) for draw in (random_block, random_stack) for _ in range(10)]
    motions, ups = ([random_motion(rng) for _ in range(6)] for _ in range(2))
    scales = [0.4, 0.7, 1.0, 1.4, 2.0]
    words = "keeps less than half of its weight, in .* none at all"
    with pytest.warns(LightBodies, match=words) as told:
        pure = overturns(drawn, motions, DT, scales, vertical=ups)
    assert {each.filename for each in told} == {__file__}
    free = overturns(drawn, motions, DT, scales, vertical=ups, friction=np.inf)
    light = pure.minimum_gravity_ratio < LIGHT
    other = pure.overturned != free.overturned
    assert other.any() and light[other].all()
    assert 0.2 < light.mean() < 0.8
    # a ground that takes all weight away is left, but by what its own rocking presses on just then
    assert (free.flights[pure.minimum_gravity_ratio <= 0] > 0).mean() > 0.8
    assert (free.minimum_gravity_ratio == pure.minimum_gravity_ratio).all()


def test_where_nothing_slides_the_answer_is_that_of_pure_rocking_to_the_bit() -> None:
    rng = np.random.default_rng(6)
    same = 0
    for _ in range(8):
        body, motion = random_block(rng), random_motion(rng)
        pure, rough = (
            simulate(body, motion, DT),
            simulate(body, motion, DT, friction=np.inf),
        )
        assert rough.overturned == pure.overturned
        if pure.overturned:
            # past its balance pure rocking knows no friction, so falls are integrated with contact
            rocks = pure.time < pure.overturning_time
            n = int(rocks.sum())
            assert rough.theta[:n] == pytest.approx(pure.theta[:n], abs=1e-4)
            continue
        np.testing.assert_array_equal(pure.theta, rough.theta)
        assert (rough.slip == 0).all()
        assert len(rough.contact_events) == len(pure.contact_events)
        same += len(pure.contact_events) > 1
        smooth = simulate(
            body, motion, DT, friction=0.9 * float(pure.friction_demand.max())
        )
        assert (smooth.slides != 0).any()
    assert same > 3
