"""Whatever cannot be used is refused with one sentence, never trimmed, never a traceback of another kind."""

from dataclasses import replace

import numpy as np
import pytest

from rockfrag import simulation as rocking
from rockfrag import system
from rockfrag.base.errors import InputError
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation import MeasuredRestitution, overturns, simulate
from rockfrag.simulation.inputs import UnitWarning
from rockfrag.system import Block, Circle, Contact, Stack, Start

from ..case_tables import case_tables
from .reference_bodies import T2, P

STACK = Stack(P, T2)
SHAKE = 4.0 * np.sin(np.arange(100) * 0.2)
MOTION = Motion(SHAKE, 0.01)
TABLES = case_tables(__file__)
VALUES = {
    "two numbers": np.array([0.1, 0.2]),
    "complex number": 0.1 + 0.1j,
    "too large": 10**400,
    "too many": np.broadcast_to(1.0, 10**9),
    "pair": (0.6, 0.2),
    "P": P,
    "T2": T2,
    "base": T2.body.base,
    "contact": Contact(),
    "stack": STACK,
    "wide": Block(0.7, 0.4, 5.0),
    "low": Block(0.4, 0.3, 50.0),
    "high": Block(0.2, 0.3, 10.0),
    "flat": Stack(Block(1.0, 0.2, 100.0), Block(0.5, 0.2, 10.0)),
    "circle": Circle(1.0),
    "body": T2.body,
    "faceless": replace(T2.body, face=None),
    "body in space": Block(0.3, 1.0, 50.0, depth=0.3).body,
    "start of one": Start((0.1,), (0.0,)),
    "by couple": MeasuredRestitution((0.3, None), "couple"),
    "shake": SHAKE,
    "fifty": SHAKE[:50],
    "half": Motion(SHAKE[:50], 0.01),
    "complex": SHAKE + 0j,
    "masked": np.ma.masked_array(SHAKE, mask=np.abs(SHAKE) > 3),
    "motion": MOTION,
    "slower": Motion(SHAKE, 0.02),
    "two components": np.zeros((400, 2)),
}


def meant(given):
    """What a value of the table is: a name with a dollar stands for what YAML cannot write."""
    if isinstance(given, str) and given.startswith("$"):
        return VALUES[given[1:]]
    return [meant(each) for each in given] if isinstance(given, list) else given


@pytest.mark.parametrize(("name", "changed", "words"), TABLES["refused"])
def test_what_cannot_be_used_is_refused_in_one_sentence(name, changed, words):
    call = GroundMotion if name == "GroundMotion" else getattr(rocking, name, None)
    call = call or getattr(system, name)
    given = TABLES["usable"][name] | changed
    with pytest.raises(InputError) as caught:
        call(**{key: meant(value) for key, value in given.items()})
    message = str(caught.value)
    assert words in message
    assert message.count(". ") == 0
    assert len(message) < 300


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_a_number_that_looks_like_another_unit_is_warned_about(body):
    for motion, scales, words in (
        (SHAKE, [1.0, 100.0], "divide it by 100"),
        (SHAKE, [1e-4, 1e-3], r"multiply it by 9\.81"),
    ):
        with pytest.warns(UnitWarning, match=words):
            overturns(body, motion, 0.01, scales)
    for changed, words in (
        ({"motion": 100 * SHAKE}, "divide it by 100"),
        ({"g": 981.0}, "of no planet"),
        ({"motion": SHAKE[:20], "dt": 5.0}, "too long for strong motion"),
    ):
        with pytest.warns(UnitWarning, match=words):
            simulate(**{"body": body, "motion": SHAKE, "dt": 0.01} | changed)


@pytest.mark.filterwarnings("ignore:the peak acceleration")
@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize("body", [T2, STACK], ids=["block", "stack"])
def test_hostile_motions_end(body):
    rng = np.random.default_rng(0)
    for values in (
        rng.normal(0, 1000, 200),
        np.tile([50.0, -50.0], 100),
        np.full(200, T2.b / T2.h * 9.81),
        np.r_[np.zeros(199), 1e4],
    ):
        response = simulate(body, values, 0.01)
        assert np.isfinite(response.theta).all()


def test_a_motion_may_be_given_in_every_usual_form():
    first = simulate(T2, MOTION)
    for other in (
        simulate(T2, SHAKE, 0.01),
        simulate(T2, SHAKE.tolist(), np.float64(0.01)),
    ):
        np.testing.assert_array_equal(first.theta, other.theta)
    outcomes = overturns(T2, MOTION, scales=[0.5, 2.0])
    for motions, dt in (([MOTION], None), (SHAKE, 0.01), (SHAKE.tolist(), 0.01)):
        found = overturns([T2], motions, dt, [0.5, 2.0])
        np.testing.assert_array_equal(found.peak_velocity, outcomes.peak_velocity)
