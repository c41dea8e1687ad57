"""A scan is answered in space on the polygon of the points that carry, beside the answer in one plane."""

import json
from dataclasses import replace

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.as_json import as_json
from rockfrag.assess.request import make_request
from rockfrag.assess.words import five_lines
from rockfrag.errors import InputError
from rockfrag.system import Block
from rockfrag.system.mesh import read_shape

from .conftest import fallen_in_space

MEASURED = {"contact_tolerance": "1 mm", "edge_retreat": "0 mm"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    trimesh = pytest.importorskip("trimesh")
    made = tmp_path_factory.mktemp("scans")
    trimesh.creation.box((0.35, 0.5, 1.2)).export(made / "box.stl")
    trimesh.creation.cylinder(0.2, 1.0, sections=180).export(made / "column.stl")
    return made


def asked(folder, name="box.stl", *, mesh=MEASURED, **settings):
    given = {"mesh": {"file": str(folder / name), **mesh}, "mass": "180 kg", "pga": "0.4 g"}
    return make_request(given | settings, "test")


def test_the_scan_of_a_box_is_answered_as_the_box_in_space(folder, few):
    found = assess_with(asked(folder, facing_deg=0), few)
    as_box = fallen_in_space(few, Block(0.35, 1.2, 180.0, depth=0.5), 0.4)
    assert 0 < found.fraction.value == as_box.mean() < 1
    assert json.loads(as_json(found))["in_space"] is True
    assert "which counts; in one plane" in " ".join(five_lines(found))


def test_how_it_faces_is_given_or_a_source(folder, few):
    anywhere = assess_with(asked(folder), few, brief=True)
    given = assess_with(asked(folder, facing_deg=30), few, brief=True)
    assert "facing" in anywhere.amplitudes[0.5].sources
    assert "facing" not in given.amplitudes[0.5].sources
    body = given.request.objects.scanned
    corners = np.array(body.base.vertices)
    # the mesh's x axis points 30° from the first component
    first = np.degrees(np.arctan2(*(corners[np.argmax(corners[:, 0])])[::-1]))
    assert first == pytest.approx(30 - np.degrees(np.arctan2(0.25, 0.175)), abs=1e-6)
    with pytest.raises(InputError, match="leave out one of them"):
        asked(folder, facing_deg=30, mesh={"direction_deg": 20})


def test_changes_of_the_object_change_it_in_space(folder):
    objects = asked(folder, facing_deg=0).objects
    as_it_is = objects.solid(objects.body).bodies[0]
    for change in objects.variants():
        if change.name == "width":
            lower, upper = (side.solid(side.body).bodies[0] for side in change.sides)
            assert lower.width < as_it_is.width < upper.width
    heavier = replace(objects.block, mass=360.0, inertia=objects.block.centroidal_inertia + 5.0)
    changed = objects.solid(heavier).bodies[0]
    assert changed.mass == pytest.approx(360.0)
    np.testing.assert_allclose(np.diag(changed.tensor - as_it_is.tensor), [5, 5, 0], atol=1e-9)


def test_a_fine_round_base_keeps_as_many_corners_as_count(folder):
    shape = read_shape(folder / "column.stl", mass=200.0)
    assert len(shape.contact_polygon(0.001)) > 100
    base = np.array(shape.body(0.0, 0.001).base.vertices)
    assert 12 <= len(base) <= 48
    assert np.hypot(*base.T) == pytest.approx(0.2, rel=1e-3)
