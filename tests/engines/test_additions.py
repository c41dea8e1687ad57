"""A limit state and an engine are one declaration each, and answer at the doors like those that are built in."""

import numpy as np

from rockfrag import Block, overturns
from rockfrag.engines.contract import Support, Wish, engines, forget_engine, register_engine
from rockfrag.outcomes.limit_states import forget_limit_state, limit_state, limit_states
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.system.body import Interval, RigidBody
from rockfrag.system.contact import Contact
from rockfrag.system.system import System

SHAKE = 4.0 * np.sin(2 * np.pi * np.arange(0, 1, 0.01))


class Balanced:
    """Answers that bodies of no width stand, for want of anything better."""

    name = "balanced"
    meets = frozenset({Wish.TWO_BODIES})

    def supports(self, system, motion, request):
        base = system.bodies[0].base
        return Support(reason="" if base.right == base.left else "it is for bodies of no width")

    def run(self, cases):
        return empty_outcomes(cases.names, cases.scales, (self.name,))

    def history(self, case):
        raise NotImplementedError


def test_an_engine_is_one_package_and_answers_first_where_it_is_put():
    needle = RigidBody(1.0, 0.1, (0.0, 0.0, 0.5), Interval(0.0, 0.0), 1.0, name="needle")
    register_engine(Balanced(), before=engines()[0].name)
    try:
        found = overturns([System((needle,), (Contact(),)), Block(0.3, 1.2, 180.0)], SHAKE, 0.01)
    finally:
        forget_engine("balanced")
    assert list(found.table()["engine"]) == ["balanced", "lanes of lone blocks"]
    assert not found.overturned[0].any()


def test_a_limit_state_is_one_declaration_and_is_read_off_any_outcome():
    @limit_state("turns_far", order=50, label="turning far")
    def _(outcomes):
        return (np.nan_to_num(outcomes.peak_rotation) > 0.5).any(axis=-1)

    try:
        found = overturns(Block(0.3, 1.2, 180.0), SHAKE, 0.01, [0.1, 0.8, 3.0])
        reached = {state.name: state.reached(found).ravel().tolist() for state in limit_states()}
    finally:
        forget_limit_state("turns_far")
    assert list(reached) == ["rocks", "slides", "turns_far", "overturns"]
    assert not reached["rocks"][0] and reached["overturns"][2] and reached["turns_far"][2]
    assert reached["slides"] == reached["overturns"], "only what fell was displaced"
