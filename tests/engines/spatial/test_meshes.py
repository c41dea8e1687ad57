"""A mesh in space: its contact polygon and its full tensor of inertia."""

import numpy as np
import pytest
import trimesh

from rockfrag import overturns
from rockfrag.base.errors import InputError
from rockfrag.campaign.standing import sample_trials, simulate_tests
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system import Block, Contact, System
from rockfrag.system.mesh import read_shape

from .samples import DT, synthetic_motion


@pytest.fixture(scope="module")
def shape(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "box.obj"
    mesh = trimesh.creation.box((0.35, 0.5, 1.2))
    mesh.export(path)
    return read_shape(path, mass=300.0)


def test_the_mesh_of_a_box_is_the_box(shape):
    body, block = shape.body(0.0, 1e-3), Block(0.35, 1.2, 300.0, depth=0.5).body
    np.testing.assert_allclose(body.tensor, block.tensor, atol=1e-9)
    corners = [np.array(sorted(item.base.vertices)) for item in (body, block)]
    np.testing.assert_allclose(*corners, atol=1e-12)
    x, y, _ = (synthetic_motion(np.random.default_rng(4), 2) * 0.5).T
    motion = GroundMotion(Motion(x, DT), Motion(y, DT))
    found = overturns([System((body,), (Contact(),))], [motion], scales=[0.6, 0.8, 1.0])
    expected = overturns(
        [Block(0.35, 1.2, 300.0, depth=0.5)], [motion], scales=[0.6, 0.8, 1.0]
    )
    np.testing.assert_array_equal(found.overturned, expected.overturned)


def test_edges_retreat_and_the_body_turns_to_the_direction_of_shaking(shape):
    body = shape.body(90.0, 1e-3, retreat=0.01)
    sides = np.ptp(np.array(body.base.vertices), axis=0)
    assert sides == pytest.approx([0.48, 0.33])
    xx, yy = shape.inertia[0, 0], shape.inertia[1, 1]
    assert np.diag(body.tensor)[:2] == pytest.approx([yy, xx])
    with pytest.raises(InputError, match="cannot stand"):
        shape.body(0.0, 1e-3, retreat=0.2)


def test_trials_with_friction_are_bodies_in_space(shape):
    ranges = {
        "direction_deg": (0.0, 360.0),
        "contact_tolerance_mm": (0.5, 2.0),
        "edge_retreat_mm": (0.0, 10.0),
        "friction": (0.4, 1.2),
    }
    trials = sample_trials(shape, ranges, 16, 1)
    assert not any(system.planar for system in trials.systems)
    rng = np.random.default_rng(2)
    motions = [
        Motion(synthetic_motion(rng, 1)[:, 0] * peak, DT) for peak in (0.1, 0.5, 1.5)
    ]
    overturned, rocked = simulate_tests(trials.systems, motions, 1)
    assert not overturned[:, 0].any() and overturned[:, 2].any()
    assert (overturned <= rocked).all()
