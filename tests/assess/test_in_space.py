"""A base with width and depth, or a scan, is answered in space, beside the answer in one plane."""

import json
import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from rockfrag import overturns
from rockfrag.assess.answer import assess_with
from rockfrag.assess.export import as_json
from rockfrag.assess.findings import details_of, first_screen, quality_flags
from rockfrag.assess.request import make_request
from rockfrag.assess.scan import _least_angle_deg
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError
from rockfrag.records.motion import GroundMotion
from rockfrag.system import Block, Stack
from rockfrag.system.mesh import Shape, read_shape

from .conftest import asked

BOX = {"width": "35 cm", "depth": "50 cm", "height": "120 cm", "mass": "180 kg"}


@pytest.fixture(scope="module")
def found(few):
    return assess_with(asked(**BOX, pga="0.4 g"), few)


def test_the_fraction_is_that_of_both_components_which_counts_beside_that_in_one_plane(
    found, few
):
    shaking = [GroundMotion(few.base[i], few.base[j]) for i, j in few.pairs]
    scales = [[0.4 / np.sqrt(pair.x.pga * pair.y.pga) * 9.80665] for pair in shaking]
    body = Block(0.35, 1.2, 180.0, depth=0.5)
    fallen = overturns([body], shaking, scales=np.array(scales)).overturned
    total, _, fell = found.counts
    assert 0 < fell / total == fallen.mean() < 1
    answer = json.loads(as_json(found))
    assert answer["in_space"] is True
    assert 0 <= answer["in_one_plane"] <= 1
    said = "in space under both components of each record. In one plane, along one"
    assert said in " ".join(details_of(found))
    assert "space" not in found.main.sources
    # how many outcomes next to nothing turns round
    assert 0 <= answer["flip_rate"] == found.flip_rate <= 0.5


def test_without_a_depth_or_with_a_measured_restitution_it_is_planar(few):
    flat = asked(**{key: BOX[key] for key in ("width", "height", "mass")}, pga="0.4 g")
    for request in (flat, asked(**BOX, restitution=0.8, pga="0.4 g")):
        answer = assess_with(request, few, brief=True)
        assert not answer.motions.both
        assert "space" in answer.main.sources


@pytest.mark.parametrize(
    "settings",
    [
        {**BOX, "pga": "0.02 g"},
        {"width": "35 cm", "height": "120 cm", "floor": "2/3", "pga": "0.01 g"},
    ],
)
def test_far_below_uplift_it_is_said_not_to_move_in_space_and_on_floors(few, settings):
    """Statics of each record's own components say it, whatever the number of earthquakes."""
    request = asked(**settings)
    answer = assess_with(request, few.at(request.place), brief=True)
    assert answer.does_not_move
    assert answer.fraction.upper <= answer.rocking.upper < 0.01
    likely, *others = first_screen(answer)
    assert likely.id in (Text.HOW_LIKELY_AT_REST, Text.HOW_LIKELY_FEW_EARTHQUAKES)
    assert not any(each.id.startswith("how_far") for each in others)


def test_no_restitution_is_a_source_where_none_enters(found):
    assert "restitution" not in found.evidence.shifts
    assert "restitution" not in found.main.sources


@pytest.mark.parametrize("key", ["facing_deg", "base_spread"])
def test_what_acts_in_space_alone_is_refused_with_records_of_one_component(few, key):
    lone = replace(few, pairs=())
    with pytest.raises(InputError, match=f"key {key}: no record has two components"):
        assess_with(asked(**BOX, pga="0.4 g", **{key: 0.05}), lone, brief=True)


def test_the_sides_may_be_given_either_way_round_and_the_object_may_face_anywhere():
    def solid_of(**settings):
        objects = asked(**settings).objects
        return objects.solid(objects.body).bodies[0]

    other = BOX | {"width": "50 cm", "depth": "35 cm"}
    planar = asked(**other).objects
    assert (
        planar.block == Block(0.35, 1.2, 180.0)
        and planar.plane.id == Text.ROCKS_ACROSS_NARROWER
    )
    plain, across, turned = (
        solid_of(**BOX),
        solid_of(**other),
        solid_of(**BOX, facing_deg=90),
    )
    for solid, sides in (
        (plain, [0.35, 0.5]),
        (across, [0.5, 0.35]),
        (turned, [0.5, 0.35]),
    ):
        assert np.ptp(np.array(solid.base.vertices), axis=0) == pytest.approx(sides)
    block = Block(0.5, 1.2, 180.0, depth=0.35).body
    np.testing.assert_allclose(turned.tensor, across.tensor, atol=1e-9)
    np.testing.assert_allclose(across.tensor, block.tensor, atol=1e-9)


def test_corners_may_lie_elsewhere_by_a_stated_part_of_the_base(found, few):
    spread = assess_with(asked(**BOX, pga="0.4 g", base_spread=0.02), few)
    ideal, real = (item.outcomes.overturned for item in (found, spread))
    assert (ideal != real).any()
    assert abs(ideal.mean() - real.mean()) < 0.1


MEASURED = {"contact_tolerance": "1 mm", "edge_retreat": "0 mm"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    trimesh = pytest.importorskip("trimesh")
    made = tmp_path_factory.mktemp("scans")
    trimesh.creation.box((0.35, 0.5, 1.2)).export(made / "box.stl")
    trimesh.creation.cylinder(0.2, 1.0, sections=180).export(made / "column.stl")
    return made


def scanned(folder, name="box.stl", *, mesh=MEASURED, **settings):
    given = {
        "mesh": {"file": str(folder / name), **mesh},
        "mass": "180 kg",
        "pga": "0.4 g",
    }
    return make_request(given | settings, "test")


def test_the_scan_of_a_box_is_answered_as_the_box_in_space(folder, found, few):
    of_scan = assess_with(scanned(folder, facing_deg=0), few)
    np.testing.assert_array_equal(of_scan.counted.overturned, found.counted.overturned)
    assert "In one plane, along one component" in " ".join(details_of(of_scan))


def test_how_it_faces_is_given_or_a_source(folder, few):
    anywhere = assess_with(scanned(folder), few, brief=True)
    given = assess_with(scanned(folder, facing_deg=30), few, brief=True)
    assert "facing" in anywhere.amplitudes[0.5].sources
    assert "facing" not in given.amplitudes[0.5].sources
    corners = np.array(given.request.objects.scanned.base.vertices)
    # the mesh's x axis points 30° from the first component
    x, y = corners[np.argmax(corners[:, 0])]
    assert np.arctan2(y, x) == pytest.approx(
        np.radians(30) - np.arctan2(0.25, 0.175), abs=1e-8
    )
    with pytest.raises(InputError, match="leave out one of them"):
        scanned(folder, facing_deg=30, mesh={"direction_deg": 20})


def test_changes_of_the_object_change_it_in_space(folder):
    objects = scanned(folder, facing_deg=0).objects
    as_it_is = objects.solid(objects.body).bodies[0]
    for change in objects.variants():
        if change.name == "width":
            lower, upper = (side.solid(side.body).bodies[0] for side in change.sides)
            assert lower.width < as_it_is.width < upper.width
    heavier = replace(
        objects.block, mass=360.0, inertia=objects.block.centroidal_inertia + 5.0
    )
    changed = objects.solid(heavier).bodies[0]
    assert changed.mass == pytest.approx(360.0)
    np.testing.assert_allclose(
        np.diag(changed.tensor - as_it_is.tensor), [5, 5, 0], atol=1e-9
    )
    # fixed to what it stands on it is another body, which is no scan
    stack = Stack(Block(0.6, 0.4, 300.0), objects.block)
    assert objects.solid(stack) is not None
    assert objects.solid(stack.rigidly_joined()) is None


def test_a_fine_round_base_keeps_as_many_corners_as_count(folder):
    shape = read_shape(folder / "column.stl", mass=200.0)
    assert len(shape.contact_polygon(0.001)) > 100
    base = np.array(shape.body(0.0, 0.001).base.vertices)
    assert 12 <= len(base) <= 48
    assert np.hypot(*base.T) == pytest.approx(0.2, rel=1e-3)


@pytest.mark.parametrize("retreat_mm", [0.0, 30.0, 250.0])
def test_a_scanned_box_balances_at_the_least_angle_over_its_narrow_side(retreat_mm):
    """Half as wide as 0.2 m, which carries less far out, or not at all, where its edges are worn."""
    corners = np.array(list(product((-0.2, 0.2), (-0.5, 0.5), (-0.6, 0.6))))
    shape = Shape(corners, 100.0, np.eye(3), 0.48)
    way = {"contact_tolerance_mm": 1.0, "edge_retreat_mm": retreat_mm}
    angle = math.degrees(math.atan2(0.2 - retreat_mm / 1000, 0.6))
    assert _least_angle_deg(shape, way) == pytest.approx(angle)


def test_of_records_of_one_component_it_is_said_that_they_are_no_motion_in_space(
    found, few
):
    def said(answer):
        flags = [getattr(flag, "id", "") for flag in quality_flags(answer)]
        return Text.FLAG_ONE_COMPONENT in flags

    planar = {key: BOX[key] for key in BOX if key != "depth"}
    lone = replace(few, pairs=())
    alone, in_plane, both = (
        assess_with(asked(**sizes, pga="0.4 g"), shaken, brief=True)
        for sizes, shaken in ((BOX, lone), (planar, lone), (planar, few))
    )
    assert said(alone)
    assert not any(map(said, (found, in_plane, both)))
