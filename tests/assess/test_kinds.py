"""A kind of standing is a class and its texts: nothing else knows it, from the settings to the page."""

import json

import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.findings import details_of, lines_of
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.page import page_of
from rockfrag.assess.standing import make_standing
from rockfrag.base.errors import InputError

from ..own_kinds import NEW, OnFeet, OnTwoFeet
from .conftest import asked
from .in_node import check_all, in_node, needs_node

SIZES = {"width": "30 cm", "height": "1 m"}


@pytest.mark.parametrize(
    ("settings", "kind"),
    [
        ({}, "Planar"),
        ({"depth": "40 cm"}, "Box"),
        ({"round": True}, "Round"),
        ({"round": True, "depth": "30 cm"}, "Round"),
    ],
)
def test_settings_are_of_the_first_kind_that_takes_them(settings, kind):
    made = asked(**SIZES, **settings).objects
    assert type(made).__name__ == kind
    # none has more than a handful of fields of its own
    own = set(vars(made)) - set(vars(asked(**SIZES).objects))
    assert len(own) <= 3


def test_a_kind_added_by_a_class_and_its_texts_runs_to_the_page(cabinet, motions):
    request = asked(name="cabinet", **SIZES, pga="0.3 g", return_period="475")
    assert isinstance(request.objects, OnFeet)
    assert make_standing({"width_m": 0.3, "height_m": 1.0}, None).block.width == 0.3
    found = assess_with(request, motions)
    # statics of its feet: b/h
    assert found.rocks_from == pytest.approx(0.24)
    ways = found.by_arrangement
    assert ways["without_feet"] < ways["on_the_floor"]
    said = " ".join([*lines_of(found), *details_of(found)])
    assert "It rocks on its feet." in said
    assert "it stands on its feet" in said or "more assumptions" in said
    page = page_of(found)
    # in a few words it stands in lists only
    for id in set(NEW) - {"assumed_on_feet", "on_two_feet", "on_feet_of_its_own"}:
        assert NEW[id].lower() in page.lower(), id


SHAKEN = {"measure": "PGA", "level": "0.3 g", "years": "475"}
ON_PEDESTAL = {"pedestal_width": "60 cm", "pedestal_height": "50 cm"}


@needs_node
@pytest.mark.usefixtures("cabinet")
def test_a_kind_by_declaration_has_the_answer_of_the_command_in_the_one_file_page(
    motions, tmp_path
):
    ground = motions.ground[:12]
    few = MotionSet(ground, ground, motions.pairs[:6], "made motions")
    form = SIZES | SHAKEN | ON_PEDESTAL | {"stands": "on_two_feet"}
    (said,) = in_node(tmp_path, few, [form])
    page = (tmp_path / "in.json").read_text(encoding="utf-8")
    fields = json.loads(page)["data"]["fields"]
    (field,) = [field for field in fields if field["name"] == "stands"]
    assert field["options"] == ["", "on_feet_of_its_own", "on_two_feet"]
    settings = SIZES | {"stands": "on_two_feet", "pga": "0.3 g", "return_period": "475"}
    settings["pedestal"] = {"width": "60 cm", "height": "50 cm"}
    found = check_all(few, settings, said)
    assert isinstance(found.request.objects, OnTwoFeet)
    assert found.by_arrangement["without_feet"] < found.main.value
    # statics of its feet, of the object alone: b/h
    assert found.rocks_from < 0.3


@needs_node
@pytest.mark.usefixtures("cabinet")
def test_a_kind_whose_code_a_page_has_not_is_refused_beside_its_field(
    motions, tmp_path
):
    rounded = {"stands": "on_two_feet", "round": True}
    own = {"stands": "on_feet_of_its_own"}
    forms = [SIZES | SHAKEN | each for each in (own, rounded)]
    assert in_node(tmp_path, motions, forms) == 2 * [
        {"refused": ["stands", "kind", True]}
    ]
    with pytest.raises(InputError, match="key round: it rocks in one plane"):
        asked(**SIZES, **rounded)


def test_a_word_that_no_kind_has_is_refused():
    with pytest.raises(InputError, match=r"key stands: .* found 'on one leg'"):
        asked(**SIZES, stands="on one leg")
