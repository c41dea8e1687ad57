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
    Tie,
    Wall,
    attitude,
    case,
    forces,
    kernel_body,
    modes,
    plain,
    solid,
    whole,
)

DT, COUNT = 0.02, 22
KINDS = ("box", "bonded", "cord", "bracket", "one wall", "two walls", "round", "slips")


def made(kind, mirrored, turned):
    """A body that something holds, its mirror image in the plane x = 0, or the surroundings turned about it."""
    flip = -1.0 if mirrored else 1.0
    c, s = math.cos(turned), math.sin(turned)
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

    def placed(x, y, z):
        """A place of the surroundings, which turn about the foot of the centre of mass."""
        x, y = flip * x - centre[0], y - centre[1]
        return c * x - s * y + centre[0], s * x + c * y + centre[1], z

    def directed(angle):
        return (math.pi - angle if mirrored else angle) + turned

    def distance(at, angle):
        """Of a wall from the origin of the base, which stays when all turns about the centre."""
        before = at - flip * 0.0
        foot = centre[0] * math.cos(directed(angle)) + centre[1] * math.sin(
            directed(angle)
        )
        own = directed(angle) - turned
        return before - centre[0] * math.cos(own) - centre[1] * math.sin(own) + foot

    walls = {
        "one wall": [(0.42, 0.4, 0.3)],
        "two walls": [(0.39, 0.4, 0.0), (0.45, 0.4 + math.pi, 0.2)],
    }.get(kind, [])
    holders: list[Tie | Wall] = [
        Wall(distance(at, angle), directed(angle), friction=grip or None, restitution=0.3)
        for at, angle, grip in walls
    ]
    if kind in ("cord", "bracket"):
        point = (0.1 * flip, 0.05, 1.0)
        holders.append(
            Tie(point, placed(0.9, 0.3, 1.2), 300.0, damping=5.0, bracket=kind == "bracket")
        )
    body = RigidBody(1.0, tensor, tuple(centre), base, 1.3, face)
    friction = (0.3, 0.2) if kind in ("slips", "two walls") else (0.9, 0.8)
    record = kernel_body(System((body,), (Contact(),), constraints=tuple(holders)))
    record["static"], record["kinetic"] = friction
    if kind == "bonded":
        record["bonded"], record["tension"], record["shear"] = 1, 6.0, 2.0
        record["pads"], record["aside"] = (0.2, 0.15), (0.01 * flip, -0.01)
    return plain(record)


def shaken(kind, mirrored=False, turned=0.0):
    """History and outcome of a body, all turned about the vertical or seen in a mirror."""
    body = made(kind, mirrored, turned)
    time = np.arange(COUNT) * DT
    motion = np.stack(
        [
            6.5 * np.sin(14 * time),
            5.0 * np.sin(11 * time + 0.4) * np.exp(-2 * time),
            2.0 * np.sin(23 * time),
        ],
        axis=1,
    )
    motion[0] = motion[-1] = 0.0
    motion[:, 0] *= -1.0 if mirrored else 1.0
    c, s = math.cos(turned), math.sin(turned)
    motion[:, :2] = motion[:, :2] @ np.array([[c, s], [-s, c]])
    y, memory, out = np.zeros(solid.SIZE), case(), np.zeros(whole.OUTCOME)
    y[2], y[3], y[6] = body.height, math.cos(turned / 2), math.sin(turned / 2)
    peaks, history = np.zeros((COUNT, 4)), np.full((COUNT, 17), np.nan)
    whole.fill_peaks(motion, peaks)
    whole.integrate(
        body, motion, peaks, 1.0, DT, G, 0, 1e-9, 1e-6, y, history, out, memory
    )
    return history, out, memory, body


@pytest.mark.parametrize("kind", KINDS)
def test_turned_or_seen_in_a_mirror_a_case_is_the_same_and_its_energy_balances(kind):
    history, out, memory, body = shaken(kind)
    known = np.isfinite(history[:, 0])
    assert known.sum() > 12
    axes = np.array([attitude(row)[:, 2] for row in history[known]])
    assert np.hypot(*axes[:, :2].T).max() > (1e-3 if kind != "slips" else -1)
    assert out[whole.ENERGY_BALANCE] == pytest.approx(0, abs=1e-7)
    assert out[whole.GAINED] < 1e-7
    assert out[whole.LOST] > (0 if kind in ("cord", "slips") else 1e-6) - 1e-9
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
        alike = [whole.PEAK_RATIO, whole.PEAK_TILT, whole.LOST, *range(whole.HELD, whole.OUTCOME)]
        assert other[alike] == pytest.approx(out[alike], rel=1e-3, abs=1e-5, nan_ok=True)
    if kind in ("cord", "bracket", "bonded"):
        assert out[whole.HELD + 2 + 4 * (solid.BOND if kind == "bonded" else 0)] > 0.5
    if kind in ("one wall", "two walls"):
        assert out[whole.HELD] > 0
    assert memory.counters[modes.UNSOLVED] == 0
    assert forces.GRAVITY == 6
    assert body.height == 0.6
