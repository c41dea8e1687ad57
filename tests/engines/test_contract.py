"""Engines stand behind one contract: the first that supports a wish answers, and refusals name the conflict."""

import numpy as np
import pytest

from rockfrag.engines import contract
from rockfrag.engines.contract import Request, Wish
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.rocking.ensemble import overturns
from rockfrag.system.blocks import Block, Column, Stack
from rockfrag.system.body import Interval, RigidBody
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.system import System

BLOCK = Block(0.3, 1.0, 50.0)
STACK = Stack(Block(0.5, 0.3, 50.0), BLOCK)


def motion(**components):
    each = {name: Motion(values, 0.01) for name, values in components.items()}
    return GroundMotion(**each)


class Stub:
    """Answers that everything stands."""

    def __init__(self, name, *meets):
        self.name, self.meets = name, frozenset(meets)

    def supports(self, system, motion, request):
        return contract.by_wishes(self, system, motion, request)

    def run(self, cases):
        return empty_outcomes(cases.names, cases.scales, (self.name,))

    def history(self, case):
        raise NotImplementedError


@pytest.fixture
def two(monkeypatch):
    contract.engines()
    monkeypatch.setattr(contract, "_ENGINES", [])
    contract.register_engine(Stub("fast", Wish.TWO_BODIES, Wish.RESTITUTION))
    contract.register_engine(Stub("slow", Wish.TWO_BODIES, Wish.FRICTION, Wish.VERTICAL))


def rough(system, mu):
    contacts = tuple(Contact(friction=Friction(mu, mu), tilt=c.tilt) for c in system.contacts)
    return System(system.bodies, contacts)


def shake(*systems, **components):
    shaken = motion(**(components or {"x": np.ones(5)}))
    return contract.run_cases(contract.Cases(systems, (shaken,), np.ones((1, 1)), Request()))


def test_the_first_engine_that_supports_a_system_answers_and_is_named(two):
    found = shake(BLOCK.system(), rough(STACK.system(), 0.4), STACK.system())
    assert list(found.table()["engine"]) == ["fast", "slow", "fast"]


def test_a_refusal_names_the_wishes_that_do_not_go_together(two):
    linear = Request(linear=True)
    assert contract.refusal(BLOCK.system(), motion(x=np.ones(3)), linear).startswith(
        "the linearised equations is beyond"
    )
    law = contract.wishes(BLOCK.system(), motion(x=np.ones(3)), Request())
    assert law == frozenset()
    with pytest.raises(InputError, match="three and more bodies is beyond every engine"):
        shake(Column((BLOCK,) * 3).system())


def test_wishes_are_read_off_system_motion_and_request():
    all_three = motion(x=np.ones(3), y=np.ones(3), z=np.ones(3))
    asked = Request(forces=True, history=True)
    assert contract.wishes(rough(STACK.system(), 0.1), all_three, asked) == {
        *(Wish.TWO_BODIES, Wish.SPACE, Wish.VERTICAL, Wish.FRICTION, Wish.FORCES, Wish.HISTORY)
    }


def test_a_plugin_may_go_before_the_others_and_say_why_it_does_not_answer():
    class Thin(Stub):
        def supports(self, system, motion, request):
            width = system.bodies[0].base.right - system.bodies[0].base.left
            return contract.Support(reason="it wants bodies without width" if width else "")

    needle = RigidBody(1.0, 0.1, (0.0, 0.0, 0.5), Interval(0.0, 0.0), 1.0, name="needle")
    contract.register_engine(Thin("thin"), before=contract.engines()[0].name)
    try:
        found = overturns([System((needle,), (Contact(),)), BLOCK], 4.0 * np.ones(20), 0.01)
    finally:
        contract.forget_engine("thin")
    assert list(found.table()["engine"]) == ["thin", "lanes of lone blocks"]


def test_components_of_a_ground_motion_share_their_time_base():
    with pytest.raises(InputError, match="component z has 4 samples"):
        motion(x=np.ones(3), z=np.ones(4))
    with pytest.raises(InputError, match="component y is sampled every"):
        GroundMotion(Motion(np.ones(3), 0.01), y=Motion(np.ones(3), 0.02))
    both = motion(x=np.ones(3), z=2 * np.ones(3))
    assert both.components == "xz"
    assert both.accelerations.tolist() == [[1.0, 0.0, 2.0]] * 3
