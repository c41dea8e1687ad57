"""Three tidy tables whose columns are declared once, and limit states that are read off them."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.outcomes.limit_states import (
    forget_limit_state,
    limit_state,
    limit_state_named,
    limit_states,
)
from rockfrag.outcomes.outcomes import columns, empty_outcomes, merge_outcomes
from rockfrag.rocking.options import system_of
from rockfrag.system.blocks import Block

ROLES = ("pedestal", "statue", "ground", "interface")


def shaken():
    made = empty_outcomes([("block",), ("lower", "upper")], np.array([[1.0, 2.0]]), ("lanes",))
    made.overturned[1, 0, 1] = True
    made.overturned_body[1, 0, 1] = 2
    made.peak_rotation[:] = [[[[0.0, np.nan], [0.5, np.nan]]], [[[0.0, 0.0], [0.2, np.inf]]]]
    return made


def test_every_column_has_a_unit_and_a_meaning_and_no_role_in_its_name():
    for column in columns():
        assert column.meaning.endswith(".")
        assert not any(column.title.endswith("_" + role) for role in ROLES)
    assert len({column.title for column in columns()}) == len(columns())


def test_tables_are_tidy_and_what_no_engine_told_is_nan():
    made = shaken()
    cases, bodies, contacts = (made.table(which) for which in ("cases", "bodies", "contacts"))
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


def test_answers_of_several_engines_are_put_together():
    made = empty_outcomes([("a",), ("b", "c"), ("d",)], np.ones((1, 1)), ("one", "two"))
    part = empty_outcomes([("a",), ("d",)], np.ones((1, 1)), ("two",))
    part.peak_rotation[:, 0, 0, 0] = 0.1, 0.2
    merge_outcomes(made, [0, 2], part)
    assert made.peak_rotation[[0, 2], 0, 0, 0].tolist() == [0.1, 0.2]
    assert list(made.table()["engine"]) == ["two", "one", "two"]
    assert made.of_top("peak_rotation")[2, 0, 0] == 0.2


def test_a_limit_state_is_one_declaration():
    @limit_state("leans_far", order=50, label="leaning far")
    def _(outcomes):
        with np.errstate(invalid="ignore"):
            return (outcomes.peak_rotation > 0.3).any(axis=-1)

    try:
        assert [state.name for state in limit_states()] == [
            "rocks",
            "slides",
            "leans_far",
            "overturns",
        ]
        reached = limit_state_named("leans_far").reached(shaken())
        assert reached.tolist() == [[[False, True]], [[False, True]]]
        with pytest.raises(InputError, match="declared twice"):
            limit_state("leans_far", order=1, label="")(_)
    finally:
        forget_limit_state("leans_far")
    with pytest.raises(InputError, match="choose one of rocks"):
        limit_state_named("leans_far")


def test_built_in_states():
    made = shaken()
    assert limit_state_named("rocks").reached(made).tolist() == [[[False, True]], [[False, True]]]
    slides = limit_state_named("slides")
    assert slides.reached(made).sum() == 1, "what fell is displaced"
    made.peak_slip[0, 0, 0, 0] = 0.0004
    assert slides.reached(made).sum() == 1, "a hair's breadth at an impact is not seen"
    made.peak_slip[0, 0, 0, 0] = 0.002
    assert slides.reached(made).sum() == 2
    held, loose = Block(0.3, 1.2, 100.0).system(), system_of(Block(0.3, 1.2, 100.0), 0.5)
    assert [slides.counted(item) for item in (held, loose)] == [False, True]
    assert limit_state_named("overturns").reached(made).sum() == 1
