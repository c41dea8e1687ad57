"""Behind one contract the first engine that supports a wish answers; at every door, or a sentence says why not."""

import itertools
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from rockfrag import (
    Block,
    Column,
    MeasuredRestitution,
    Stack,
    find_step_size_sensitive,
    find_thresholds,
    outcome_robustness,
    overturns,
    rocking_spectrum,
    simulate,
)
from rockfrag.engines import contract
from rockfrag.engines.contract import Request, Wish
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.rocking.parquet import stream_histories, stream_overturns
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


DT = 0.01
TIME = np.arange(0.0, 1.5, DT)
SHAKE = 4.0 * np.sin(2 * np.pi * 1.5 * TIME)
UP = 0.3 * np.sin(2 * np.pi * 3 * TIME)
UPPER = Block(0.3, 1.2, 180.0)
BODIES = {
    "block": UPPER,
    "stack": Stack(Block(0.6, 0.4, 300.0), UPPER),
    "column": Column((Block(0.6, 0.4, 300.0), Block(0.45, 0.3, 120.0), UPPER)),
}
OPTIONS = {
    "restitution": lambda body: MeasuredRestitution(
        0.9 if body is UPPER else {"ground": None, "interface": 0.9}
    ),
    "friction": lambda body: 0.4,
    "vertical": lambda body: UP,
    "theta0": lambda body: 0.01 if body is UPPER else (0.0,) * (len(body.blocks) - 1) + (0.01,),
    "linear": lambda body: True,
    "forces": lambda body: True,
}
EACH_BODY = ("restitution", "theta0")


def stream(body, folder, **options):
    stream_overturns(body, SHAKE, DT, [0.5, 1.0], folder / "outcomes.parquet", **options)
    return pd.read_parquet(folder / "outcomes.parquet")["overturned"]


def histories(body, folder, **options):
    stream_histories(body, SHAKE, DT, [0.5], folder / "histories.parquet", **options)
    return pd.read_parquet(folder / "histories.parquet")["theta_rad"]


def thresholds(body, folder, **options):
    wanted = {"tolerance": 0.2, "narrowest_resurrection": 0.5}
    return find_thresholds(body, SHAKE, DT, 1.0, **wanted, **options).table[["body"]]


def robustness(body, folder, **options):
    return outcome_robustness(body, SHAKE, DT, [0.5], perturbation=1e-6, copies=1, **options)


DOORS = {
    "single": lambda body, _, **more: simulate(body, SHAKE, DT, **more).theta,
    "many": lambda body, _, **more: overturns(body, SHAKE, DT, [0.5, 1.0], **more).overturned,
    "thresholds": thresholds,
    "stream": stream,
    "histories": histories,
    "robustness": robustness,
    "step": lambda body, _, **more: (
        find_step_size_sensitive(body, SHAKE, DT, [0.5, 1.0], sample=2, **more).cases
    ),
}
FORCES = ("many", "stream")
"""Doors that tell forces."""

CONFLICTS = ("cannot be had together with", "is beyond every engine")
CASES = [(), *((option,) for option in OPTIONS), *itertools.combinations(OPTIONS, 2)]


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize("kind", list(BODIES))
@pytest.mark.parametrize("door", DOORS)
def test_every_pair_of_options_works_or_is_refused_in_one_sentence(door, kind, tmp_path):
    body, worked = BODIES[kind], 0
    for names in CASES:
        options = {k: OPTIONS[k](body) for k in names if k != "forces" or door in FORCES}
        if door != "single":
            options |= {k: [options[k]] for k in EACH_BODY if k in options}
        try:
            answer = np.asarray(DOORS[door](body, tmp_path, **options))
        except InputError as error:
            said = str(error)
            assert any(words in said for words in CONFLICTS), (names, said)
            assert said.count(". ") == 0
        else:
            assert np.isfinite(answer.astype(float)).all()
            worked += 1
    assert worked >= 6


def test_what_a_spectrum_takes_works():
    for names in ((), ("restitution",), ("friction",), ("vertical",), ("friction", "vertical")):
        options = {name: OPTIONS[name](UPPER) for name in names}
        if "restitution" in options:
            options["restitution"] = 0.8
        found = rocking_spectrum(Motion(SHAKE, DT), [2.0], 0.25, **options)
        assert found.rotation.shape == (1, 1)


def test_a_history_of_what_slides_takes_the_steps_that_are_asked_for():
    wave = motion(x=4.0 * np.sin(0.1 * np.arange(150)))
    system = BLOCK.system()
    system = replace(system, contacts=(Contact(friction=Friction(0.2, 0.2)),))

    def slip(step):
        case = contract.Case(system, wave, 1.0, Request(history=True, step=step))
        return contract.engine_for(system, wave, case.request).history(case).slip

    assert 0 < np.abs(slip(0.01) - slip(0.1)).max() < 1e-6
