"""While an answer is computed it says how far it is; before it, how long it takes where that is long."""

from dataclasses import replace
from unittest.mock import patch

import pytest

from rockfrag.assess import answer
from rockfrag.assess.answer import (
    COMPILING_S,
    assess_with,
    plan_for,
    seconds_of,
    seconds_of_holders,
    shake_all,
    waiting_for,
)
from rockfrag.assess.findings import lines_of
from rockfrag.assess.inventory import assess_each
from rockfrag.assess.outcomes import Shaking
from rockfrag.cli.main import main
from rockfrag.engines.compile import jit
from rockfrag.engines.planar.integrate import integrate_cases
from rockfrag.runtime.progress import in_words

from .conftest import asked

BLOCK = {"width": "30 cm", "height": "1 m", "pga": "0.3 g"}
COLUMN = BLOCK | {
    "pedestal": [
        {"width": "40 cm", "height": "40 cm"},
        {"width": "50 cm", "height": "40 cm"},
    ]
}


def simulated_tests(shaking: Shaking, every) -> int:
    return shaking.scales.size * len(every)


@pytest.mark.parametrize("settings", [BLOCK, BLOCK | {"depth": "25 cm"}])
def test_progress_rises_to_the_whole(settings, few):
    request = asked(**settings)
    said: list[float] = []
    plan = plan_for(request, few, brief=False, holds=False)
    shaken = shake_all([request], plan, said.append)
    assert said == sorted(said) and said[-1] == 1 and len(said) > 3
    assert 0 < said[0] < 0.9
    # whoever listens changes nothing
    alone = shake_all([request], plan)
    for some, other in zip(shaken, alone, strict=True):
        for name, outcomes in some.arrangements.items():
            both = outcomes.overturned, other.arrangements[name].overturned
            assert (both[0] == both[1]).all()


@pytest.mark.parametrize(
    ("settings", "brief"),
    [
        (BLOCK, False),
        (BLOCK, True),
        (COLUMN, False),
        # shaken under other periods and dampings of its building too
        (BLOCK | {"floor": "2/3"}, False),
    ],
)
def test_the_work_that_is_expected_is_the_work_that_is_done(settings, brief, few):
    """Otherwise the seconds left would run ahead, or stand still at the end."""
    request = asked(**settings)
    plan = plan_for(request, few, brief=brief, holds=False)
    counted: list[float] = []

    def count(shaking: Shaking, every) -> list:
        counted.extend(shaking.seconds_of(object_) for object_, _ in every)
        return shaken(shaking, every)

    shaken = Shaking._shaken
    with patch.object(Shaking, "_shaken", count):
        shake_all([request], plan)
    assert sum(counted) == pytest.approx(seconds_of([request], plan))


def test_what_holds_a_column_is_expected_to_take_longer_than_what_holds_a_block(few):
    """At 92 % it said "about 2 s left", and took four minutes to hold three bodies."""
    added = []
    for settings in (BLOCK, COLUMN):
        request = asked(**settings)
        plan = plan_for(request, few, brief=False, holds=True)
        assert seconds_of_holders(request, replace(plan, holds=False)) == 0
        added.append(seconds_of_holders(request, plan))
    assert added[1] > 20 * added[0] > 0


def test_lines_do_not_wait_for_what_may_hold_an_object(few):
    """It takes longer than all else, and no line says it."""
    tried = []
    with patch.object(answer, "try_holders", lambda *_: tried.append(1) or []):
        found = assess_with(asked(**BLOCK), few)
        assert lines_of(found) and not tried
        assert found.mitigations and tried
        assert set(found.mitigations) == set(found.changes)


def test_a_list_says_objects_also_where_they_are_shaken_at_once(few):
    requests = [replace(asked(**COLUMN), name=f"column {i}") for i in range(3)]
    said: list[tuple[float, float]] = []
    assess_each(requests, few, lambda done, total: said.append((done, total)))
    done = [count for count, _ in said]
    assert done == sorted(done) and said[-1] == (3, 3)
    assert any(0 < count < 3 for count in done)


def test_what_takes_long_is_said_beforehand_with_what_is_quicker(few):
    request = asked(**COLUMN)
    plan = plan_for(request, few, brief=False, holds=True)
    with patch.object(answer, "is_kept", lambda _: True):
        assert waiting_for(request, plan) == []
        with patch.object(answer, "seconds_of", lambda *_: 4000.0):
            (words,) = waiting_for(request, plan)
    assert words.startswith("this takes about ") and "fewer records" in words


def test_a_first_answer_says_how_long_its_kernels_compile(few):
    said = {}
    for name, settings in (("block", BLOCK), ("box", BLOCK | {"depth": "25 cm"})):
        request = asked(**settings)
        plan = plan_for(request, few, brief=False, holds=True)
        with patch.object(answer, "is_kept", lambda _: False):
            (said[name],) = waiting_for(request, plan)
        # what holds it is tried by kernels of contacts, which are compiled apart
        with patch.object(answer, "is_kept", lambda e: e is not integrate_cases):
            (words,) = waiting_for(request, plan)
        contacts = in_words(COMPILING_S["contacts"])
        assert words == f"compiling once on this machine, about {contacts}"
    assert said["block"].startswith("compiling once on this machine, about ")
    assert said["box"] != said["block"]


def test_a_numba_that_is_not_known_compiles_longer_which_is_said(few):
    request = asked(**BLOCK)
    plan = plan_for(request, few, brief=False, holds=False)
    with (
        patch.object(answer, "is_kept", lambda _: False),
        patch.object(jit, "KNOWN", False),
    ):
        (words,) = waiting_for(request, plan)
    about = in_words(COMPILING_S["core"] + COMPILING_S["blocks"])
    assert words.startswith(f"compiling once on this machine, about {about} with ")
    assert words.endswith("with this one many times as long")


def test_what_is_refused_waits_for_nothing(own_records, tmp_path, capsys):
    """A refusal came behind "compiling once on this machine"."""
    records = str(own_records / "catalogue.csv")
    words = ["assess", "--width", "30cm", "--height", "1m", "--pga", "0.3g"]
    with patch.object(answer, "is_kept", lambda _: False):
        status = main([*words, "--record", records, "--unit", "g"])
    assert status == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1 and "compiling" not in said
