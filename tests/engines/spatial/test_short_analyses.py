"""Short analyses of bodies in space of no symmetry, whole: what must be the same, and the balance of energy.

Kernels run as plain Python.
"""

import math

import numpy as np
import pytest

from .plain_space import (
    OUTLINE,
    Circle,
    Contact,
    G,
    Polygon,
    RigidBody,
    System,
    attitude,
    case,
    ground,
    kernel_body,
    limits,
    outcome,
    plain,
    solid,
    whole,
)

DT = 0.02
KINDS = {"free": 22, "bonded": 22, "round": 22}
"""What holds a body, or what it is, and how many samples tell."""


def made(kind, mirrored):
    """A body, or its mirror image in the plane x = 0."""
    flip = -1.0 if mirrored else 1.0
    centre = np.array([0.03 * flip, -0.02, 0.6])
    tensor = np.diag([0.27, 0.23, 0.25])
    tensor[0, 1] = tensor[1, 0] = 0.02 * flip
    tensor[0, 2] = tensor[2, 0] = 0.015 * flip
    tensor[1, 2] = tensor[2, 1] = 0.01
    outline = [(flip * x, y) for x, y in OUTLINE][:: -1 if mirrored else 1]
    base: Circle | Polygon = Polygon(tuple(outline))
    face = base
    if kind == "round":
        base = face = Circle(0.25, (0.02 * flip, 0.01))

    body = RigidBody(1.0, tensor, tuple(centre), base, 1.3, face)
    record = kernel_body(System((body,), (Contact(),)))
    record["static"], record["kinetic"] = 0.9, 0.8
    if kind == "bonded":
        record["bonded"], record["tension"], record["shear"] = 1, 6.0, 2.0
        record["pads"], record["aside"] = (0.2, 0.15), (0.01 * flip, -0.01)
    return plain(record)


def shaken(kind, mirrored=False, turned=0.0):
    """History and outcome of a body, all turned about the vertical or seen in a mirror."""
    body = made(kind, mirrored)
    count = KINDS[kind]
    time = np.arange(count) * DT
    motion = np.stack(
        [
            9.0 * np.sin(14 * time),
            6.0 * np.sin(9 * time + 0.4) * np.exp(-2 * time),
            2.0 * np.sin(23 * time),
        ],
        axis=1,
    )
    motion[0] = motion[-1] = 0.0
    motion[:, 0] *= -1.0 if mirrored else 1.0
    c, s = math.cos(turned), math.sin(turned)
    motion[:, :2] = motion[:, :2] @ np.array([[c, s], [-s, c]])
    y, memory, out = np.zeros(solid.SIZE), case(), np.zeros(outcome.OUTCOME)
    y[2], y[3], y[6] = body.height, math.cos(turned / 2), math.sin(turned / 2)
    peaks, history = np.zeros((count, 4)), np.full((count, 17), np.nan)
    ground.fill_peaks(motion, peaks)
    whole.integrate(
        body, motion, peaks, 1.0, DT, G, 0, 1e-9, 1e-6, y, history, out, memory
    )
    return history, out, memory, body


@pytest.mark.parametrize("kind", KINDS)
def test_turned_or_seen_in_a_mirror_a_case_is_the_same_and_its_energy_balances(kind):
    history, out, memory, body = shaken(kind)
    known = np.isfinite(history[:, 0])
    assert known.sum() == KINDS[kind]
    axes = np.array([attitude(row)[:, 2] for row in history[known]])
    assert np.hypot(*axes[:, :2].T).max() > 1e-2
    assert out[outcome.ENERGY_BALANCE] == pytest.approx(0, abs=1e-7)
    assert out[outcome.GAINED] < 1e-7
    assert out[outcome.LOST] > 0
    place, spin = history[known, :3], history[known, 10:13]
    turned, then, _, _ = shaken(kind, turned=0.7)
    c, s = math.cos(0.7), math.sin(0.7)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    # rounding grows with each impact
    near = {"abs": 1e-5}
    assert turned[known, :3] == pytest.approx(place @ turn.T, **near)
    assert turned[known, 10:13] == pytest.approx(spin, abs=1e-4)
    assert turned[known, 13:15] == pytest.approx(history[known, 13:15], **near)
    of_axes = np.array([attitude(row)[:, 2] for row in turned[known]])
    assert of_axes == pytest.approx(axes @ turn.T, **near)
    seen, there, _, _ = shaken(kind, mirrored=True)
    flip = np.array([-1.0, 1.0, 1.0])
    assert seen[known, :3] == pytest.approx(place * flip, **near)
    assert seen[known, 10:13] == pytest.approx(spin * (1.0, -1.0, -1.0), abs=1e-4)
    assert seen[known, 13] == pytest.approx(-history[known, 13], **near)
    for other in (then, there):
        alike = [
            outcome.PEAK_RATIO,
            outcome.PEAK_TILT,
            outcome.LOST,
            *range(outcome.HELD, outcome.OUTCOME),
        ]
        assert other[alike] == pytest.approx(
            out[alike], rel=1e-3, abs=1e-5, nan_ok=True
        )
    if kind == "bonded":
        tension, breaks = out[outcome.HELD + 4 * solid.BOND + 2 :][:2]
        assert tension == pytest.approx(0.5 * body.tension)
        assert 0 < breaks < 0.1
    assert memory.counters[limits.UNSOLVED] == 0
