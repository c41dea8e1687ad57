"""A base whose width and depth are given is answered in space, beside the answer in one plane."""

import json

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.as_json import as_json
from rockfrag.assess.objects import Objects
from rockfrag.assess.words import five_lines
from rockfrag.errors import InputError
from rockfrag.system import Block

from .conftest import asked, fallen_in_space

BOX = {"width": "35 cm", "depth": "50 cm", "height": "120 cm", "mass": "180 kg"}


@pytest.fixture(scope="module")
def found(few):
    return assess_with(asked(**BOX, pga="0.4 g"), few)


def test_the_fraction_is_that_of_both_components_at_once(found, few):
    fallen = fallen_in_space(few, Block(0.35, 1.2, 180.0, depth=0.5), 0.4)
    assert 0 < found.fraction.value == fallen.mean() < 1


def test_both_answers_stand_side_by_side_and_it_says_which_counts(found):
    answer = json.loads(as_json(found))
    assert answer["in_space"] is True
    assert 0 <= answer["in_one_plane"] <= 1
    assert "in space under both components of each record, which counts; in one plane" in " ".join(
        five_lines(found)
    )
    assert "space" not in found.main.sources


def test_without_a_depth_or_with_a_measured_restitution_it_is_planar(few):
    flat = {key: value for key, value in BOX.items() if key != "depth"}
    for settings in (flat, BOX | {"restitution": 0.8}):
        answer = assess_with(asked(**settings, pga="0.4 g"), few, brief=True)
        assert not answer.motions.both
        assert "space" in answer.main.sources


def solid_of(**settings) -> Objects:
    objects = asked(**settings).objects
    return objects.solid(objects.body)


def test_the_sides_may_be_given_either_way_round_and_the_object_may_face_anywhere():
    other = BOX | {"width": "50 cm", "depth": "35 cm"}
    first, second = (np.array(solid_of(**item).bodies[0].base.vertices) for item in (BOX, other))
    assert np.ptp(first, axis=0) == pytest.approx([0.35, 0.5])
    assert np.ptp(second, axis=0) == pytest.approx([0.5, 0.35])
    turned = solid_of(**BOX, facing_deg=90).bodies[0]
    assert np.ptp(np.array(turned.base.vertices), axis=0) == pytest.approx([0.5, 0.35])
    about = solid_of(**other).bodies[0].tensor
    np.testing.assert_allclose(turned.tensor, about, atol=1e-9)
    np.testing.assert_allclose(about, Block(0.5, 1.2, 180.0, depth=0.35).body.tensor, atol=1e-9)
    with pytest.raises(InputError, match="needs width and depth"):
        asked(width="35 cm", height="1.2 m", facing_deg=20)


def test_it_says_how_many_outcomes_next_to_nothing_turns_round(found):
    assert 0 <= found.flip_rate <= 0.5
    assert json.loads(as_json(found))["flip_rate"] == found.flip_rate


def test_corners_may_lie_elsewhere_by_a_stated_part_of_the_base(found, few):
    spread = assess_with(asked(**BOX, pga="0.4 g", base_spread=0.02), few)
    ideal, real = (item.outcomes.overturned for item in (found, spread))
    assert (ideal != real).any()
    assert abs(ideal.mean() - real.mean()) < 0.1
    with pytest.raises(InputError, match="base_spread"):
        asked(**BOX, base_spread=0.5)
