"""Behind one contract the first engine that supports a wish answers; at every door, or a sentence says why not.

What it answers are four tidy tables whose columns are declared once, and limit states that are read off them.
"""

import itertools
from types import SimpleNamespace

import numpy as np
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
from rockfrag.base.errors import InputError
from rockfrag.engines import contract
from rockfrag.engines.contract import Request
from rockfrag.outcomes.limit_states import limit_state, limit_state_named
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.options import system_of
from rockfrag.simulation.parquet import stream_histories, stream_overturns
from rockfrag.system import Bond, SlidingPendulum, Tie, Wall, hold

BLOCK = Block(0.3, 1.0, 50.0)
STACK = Stack(Block(0.5, 0.3, 50.0), BLOCK)


def motion(**components):
    return GroundMotion(
        **{name: Motion(values, 0.01) for name, values in components.items()}
    )


def rough(body, mu):
    return system_of(body, friction=mu)


def test_the_first_engine_that_supports_a_system_answers_and_is_named():
    found = overturns([BLOCK, rough(STACK, 0.1), STACK], 4.0 * np.ones(20), 0.01)
    names = ["lanes of lone blocks", "planar contact", "lanes of two blocks"]
    assert list(found.table()["engine"]) == names


def test_a_refusal_names_the_wishes_that_do_not_go_together():
    shaken, column = motion(x=np.ones(3), y=np.ones(3)), Column((BLOCK,) * 3).system()
    with pytest.raises(
        InputError, match="three and more bodies cannot be had together with a"
    ):
        contract.engine_for(column, shaken, Request())
    leaning = Block(0.3, 1.0, 50.0, lean=0.01, depth=0.3).system()
    with pytest.raises(
        InputError, match="an uneven base in space is beyond every engine"
    ):
        contract.engine_for(leaning, shaken, Request())
    with pytest.raises(InputError, match="is registered already; give it another name"):
        contract.register_engine(contract.engines()[0])
    with pytest.raises(
        InputError, match="engine 'unknown' is not known; choose one of lanes"
    ):
        contract.register_engine(SimpleNamespace(name="new"), before="unknown")


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
    "theta0": lambda body: (
        0.01 if body is UPPER else (0.0,) * (len(body.blocks) - 1) + (0.01,)
    ),
    "linear": lambda body: True,
    "forces": lambda body: True,
}
EACH_BODY = ("restitution", "theta0")
DOORS = {
    simulate: {},
    overturns: {"scales": [0.5, 1.0]},
    find_thresholds: {"highest": 1.0, "tolerance": 0.2, "narrowest_resurrection": 0.5},
    stream_overturns: {"scales": [0.5], "path": "file"},
    stream_histories: {"scales": [0.5], "path": "file"},
    outcome_robustness: {"scales": [0.5], "perturbation": 1e-6, "copies": 1},
    find_step_size_sensitive: {"scales": [0.5, 1.0], "sample": 2},
}
FORCES = (overturns, stream_overturns)  # doors that tell forces

CONFLICTS = ("cannot be had together with", "is beyond every engine")
CASES = [(), *((option,) for option in OPTIONS), *itertools.combinations(OPTIONS, 2)]


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize("kind", list(BODIES))
@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
def test_every_pair_of_options_works_or_is_refused_in_one_sentence(
    door, kind, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    body, worked = BODIES[kind], 0
    for names in CASES:
        options = {
            k: OPTIONS[k](body) for k in names if k != "forces" or door in FORCES
        }
        if door is not simulate:
            options |= {k: [options[k]] for k in EACH_BODY if k in options}
        try:
            answer = door(body, SHAKE, DT, **DOORS[door], **options)
        except InputError as error:
            said = str(error)
            assert any(words in said for words in CONFLICTS), (names, said)
            assert said.count(". ") == 0
        else:
            assert np.isfinite(getattr(answer, "theta", 0.0)).all()
            worked += 1
    assert worked >= 6


def test_what_a_spectrum_takes_works():
    for more in ({}, {"restitution": 0.8}, {"friction": 0.4, "vertical": UP}):
        found = rocking_spectrum(Motion(SHAKE, DT), [2.0], 0.25, **more)
        assert found.rotation.shape == (1, 1)


def test_a_history_of_what_slides_takes_the_steps_that_are_asked_for():
    wave = motion(x=4.0 * np.sin(0.1 * np.arange(150)))
    system = rough(BLOCK, 0.2)

    def slip(step):
        case = contract.Case(system, wave, 1.0, Request(history=True, step=step))
        return contract.engine_for(system, wave, case.request).history(case).slip

    assert 0 < np.abs(slip(0.01) - slip(0.1)).max() < 1e-6


@pytest.fixture
def shaken():
    made = empty_outcomes(
        [("block",), ("lower", "upper")], np.array([[1.0, 2.0]]), ("lanes",)
    )
    made.overturned[1, 0, 1] = True
    made.overturned_body[1, 0, 1] = 2
    made.peak_rotation[:] = [
        [[[0.0, np.nan], [0.5, np.nan]]],
        [[[0.0, 0.0], [0.2, np.inf]]],
    ]
    return made


def test_tables_are_tidy_and_what_no_engine_told_is_nan(shaken):
    cases, bodies, contacts = (
        shaken.table(which) for which in ("cases", "bodies", "contacts")
    )
    assert len(cases) == 4
    assert len(bodies) == len(contacts) == 2 * 1 + 2 * 2
    assert list(cases["scale"]) == [1.0, 2.0, 1.0, 2.0]
    assert list(bodies["body"]) == [1, 1, 1, 2, 1, 2]
    assert list(bodies["name"]) == [
        "block",
        "block",
        "lower",
        "upper",
        "lower",
        "upper",
    ]
    assert bodies["peak_rotation"].tolist() == [0.0, 0.5, 0.0, 0.0, 0.2, np.inf]
    assert set(cases["engine"]) == {"lanes"}
    assert "peak_slip_m" in contacts
    assert bodies["turn_rad"].isna().all()
    assert (bodies["fell_over"] == "").all()


def test_a_limit_state_is_declared_once_and_known_by_its_name():
    with pytest.raises(InputError, match="declared twice"):
        limit_state("slides", order=1, label="")(None)
    with pytest.raises(
        InputError, match="choose one of rocks, slides, leans, overturns"
    ):
        limit_state_named("leans_far")
    with pytest.raises(InputError, match="expected one word"):
        limit_state("leans far", order=1, label="")


def test_built_in_states(shaken):
    assert limit_state_named("rocks").reached(shaken).tolist() == [
        [[False, True]],
        [[False, True]],
    ]
    slides = limit_state_named("slides")
    assert slides.reached(shaken).sum() == 1, "what fell is displaced"
    shaken.peak_slip[0, 0, 0, 0] = 0.0004
    assert slides.reached(shaken).sum() == 1, (
        "a hair's breadth at an impact is not seen"
    )
    shaken.peak_slip[0, 0, 0, 0] = 0.002
    assert slides.reached(shaken).sum() == 2
    held, loose = BLOCK.system(), rough(BLOCK, 0.5)
    assert [slides.counted(item) for item in (held, loose)] == [False, True]
    assert limit_state_named("overturns").reached(shaken).sum() == 1


HOLDING = {
    "a wall": lambda system: hold(system, Wall(1.0)),
    "a tie": lambda system: hold(system, Tie((0, 0, 1), (1, 0, 1), 1e4)),
    "a bond": lambda system: hold(system, bonds=Bond(10.0, 10.0, 0.1)),
    "an isolator": lambda system: hold(system, support=SlidingPendulum(mass=5.0)),
}


@pytest.mark.parametrize("name", list(HOLDING))
def test_what_holds_a_body_is_computed_in_its_plane_or_refused_in_one_sentence(name):
    held = HOLDING[name](BLOCK.system())
    engine = contract.engine_for(held, motion(x=np.ones(3), z=np.ones(3)), Request())
    assert engine.name == "planar contact"
    said = f"cannot be had together with {name}|{name} cannot be had together with"
    for request in (Request(linear=True), Request(forces=True)):
        with pytest.raises(InputError, match=said):
            contract.engine_for(held, motion(x=np.ones(3)), request)


def test_what_leads_out_of_the_plane_is_refused_there():
    column = Column((BLOCK, BLOCK)).system()
    askew = Tie((0, 0, 1), (1, 0.5, 1), 1e4)
    with pytest.raises(InputError, match="a tie leads out of the plane of motion"):
        contract.engine_for(hold(column, askew), motion(x=np.ones(3)), Request())
