"""Three tidy tables whose columns are declared once, and limit states that are read off them."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.outcomes.limit_states import limit_state, limit_state_named
from rockfrag.outcomes.outcomes import empty_outcomes
from rockfrag.rocking.options import system_of
from rockfrag.system.blocks import Block


@pytest.fixture
def shaken():
    made = empty_outcomes([("block",), ("lower", "upper")], np.array([[1.0, 2.0]]), ("lanes",))
    made.overturned[1, 0, 1] = True
    made.overturned_body[1, 0, 1] = 2
    made.peak_rotation[:] = [[[[0.0, np.nan], [0.5, np.nan]]], [[[0.0, 0.0], [0.2, np.inf]]]]
    return made


def test_tables_are_tidy_and_what_no_engine_told_is_nan(shaken):
    cases, bodies, contacts = (shaken.table(which) for which in ("cases", "bodies", "contacts"))
    assert len(cases) == 4
    assert len(bodies) == len(contacts) == 2 * 1 + 2 * 2
    assert list(cases["scale"]) == [1.0, 2.0, 1.0, 2.0]
    assert list(bodies["body"]) == [1, 1, 1, 2, 1, 2]
    assert list(bodies["name"]) == ["block", "block", "lower", "upper", "lower", "upper"]
    assert bodies["peak_rotation"].tolist() == [0.0, 0.5, 0.0, 0.0, 0.2, np.inf]
    assert set(cases["engine"]) == {"lanes"}
    assert "peak_slip_m" in contacts
    assert bodies["turn_rad"].isna().all()
    assert (bodies["fell_over"] == "").all()


def test_a_limit_state_is_declared_once_and_known_by_its_name():
    with pytest.raises(InputError, match="declared twice"):
        limit_state("slides", order=1, label="")(None)
    with pytest.raises(InputError, match="choose one of rocks, slides, overturns"):
        limit_state_named("leans_far")
    with pytest.raises(InputError, match="expected one word"):
        limit_state("leans far", order=1, label="")


def test_built_in_states(shaken):
    assert limit_state_named("rocks").reached(shaken).tolist() == [[[False, True]], [[False, True]]]
    slides = limit_state_named("slides")
    assert slides.reached(shaken).sum() == 1, "what fell is displaced"
    shaken.peak_slip[0, 0, 0, 0] = 0.0004
    assert slides.reached(shaken).sum() == 1, "a hair's breadth at an impact is not seen"
    shaken.peak_slip[0, 0, 0, 0] = 0.002
    assert slides.reached(shaken).sum() == 2
    held, loose = Block(0.3, 1.2, 100.0).system(), system_of(Block(0.3, 1.2, 100.0), 0.5)
    assert [slides.counted(item) for item in (held, loose)] == [False, True]
    assert limit_state_named("overturns").reached(shaken).sum() == 1
