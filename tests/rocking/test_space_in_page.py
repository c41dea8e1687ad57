"""The module for pages shakes bodies in space as ``run_in_space`` does, to the last bit."""

import math

import numpy as np
import pytest

from rockfrag import Block
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.engines.spatial.engine import AFTER, run_case
from rockfrag.system.body import Polygon, RigidBody
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.system import System, turned_about_vertical

from .node import in_node, needs_node

RUN = """
const fs = require("fs");
const [wasm, cases, motion, out] = process.argv.slice(2);
const samples = new Float64Array(new Uint8Array(fs.readFileSync(motion)).buffer);
const part = (k) => samples.subarray((k * samples.length) / 3, ((k + 1) * samples.length) / 3);
const all = [part(0), part(1), part(2)];
rockfragSpace(new Uint8Array(fs.readFileSync(wasm))).then((space) => {
  const tables = [];
  const told = JSON.parse(fs.readFileSync(cases)).map(({ block, solid, friction, components, dt, scale }) => {
    const body = space.bodyOf({ ...(block ? rockfragSolid(block) : solid), friction });
    const [x, y, z] = all.map((own, k) => (k < components ? own : null));
    const found = space.integrate({ body, x, y, z, dt, scale, history: true });
    const again = space.integrate({ body, x, y, z, dt, scale });
    tables.push(found.history);
    const { history, done, ...rest } = found;
    const alike = Object.keys(rest).every((key) => String(rest[key]) === String(again[key]));
    const numbers = ["certainTime", "fallDirection", "peak", "peakTilt", "turn"].map((name) => rest[name]);
    tables.push(Float64Array.from([...numbers, ...rest.walk]));
    return { fell: rest.overturned, done, record: Buffer.from(body.record).toString("hex"), alike };
  });
  fs.writeFileSync(out, Buffer.concat(tables.map((table) => Buffer.from(table.buffer))));
  console.log(JSON.stringify(told));
});
"""


def some_block(rng, is_round: bool) -> tuple[System, dict]:
    """A box or a cylinder, some turned or with the centre of gravity aside, and how a page is told of it."""
    width = rng.uniform(0.15, 0.6)
    height = width * rng.uniform(2, 5)
    given = {
        "width": width, "height": height, "mass": 900 * width * height,
        "depth": None if is_round else width * rng.uniform(0.6, 1.6), "round": is_round,
    }  # fmt: skip
    odd = rng.random() < 0.5
    if odd:
        given |= {"cg_height": 0.45 * height, "cg_offset": 0.04 * width}
    angle = 0.0 if is_round or rng.random() < 0.5 else float(rng.uniform(-90, 90))
    names = {"cg_height": "cgHeight", "cg_offset": "cgOffset"}
    told = {names.get(key, key): value for key, value in given.items()}
    system = turned_about_vertical(Block(**given).system(), angle)
    return system, told | {"turn": angle * (math.pi / 180)}


def some_polygon(rng) -> tuple[System, dict]:
    """A body on a convex polygon with a full tensor, likewise."""
    count = int(rng.integers(3, 9))
    angles = np.sort((np.arange(count) + rng.uniform(0, 0.6, count)) * 2 * math.pi / count)
    vertices = rng.uniform(0.2, 0.4) * np.column_stack([np.cos(angles), np.sin(angles)])
    tilt = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    tensor = 40 * tilt @ np.diag([1.0, 1.2, 0.9]) @ tilt.T
    tensor = (tensor + tensor.T) / 2
    centre = (0.02, -0.01, float(rng.uniform(0.4, 0.9)))
    base = Polygon(tuple(map(tuple, vertices.tolist())))
    body = RigidBody(300.0, tensor, centre, base, 2.0)
    told = {"mass": 300.0, "centre": centre, "tensor": tensor.tolist()}
    return System((body,), (Contact(),)), told | {"vertices": vertices.tolist()}


@needs_node
@pytest.mark.parametrize("bodies", [9, pytest.param(60, marks=pytest.mark.slow)])
def test_random_bodies_in_space_have_the_bits_of_the_package(tmp_path, bodies):
    rng = np.random.default_rng(4)
    time = np.arange(900) * 0.01
    strong = np.exp(-(((time - 3) / 1.5) ** 2))
    motion = rng.normal(0, 3.0, (3, 900)) + 2.5 * np.sin(4 * time + np.array([[0.0], [1.0], [2.0]]))
    motion *= strong
    motion[2] *= 0.4
    cases, systems = [], []
    for i in range(bodies):
        kind = ("block", "block", "solid")[i % 3]
        system, told = some_polygon(rng) if kind == "solid" else some_block(rng, i % 3 == 1)
        friction = 0.5 if rng.random() < 0.3 else None
        if friction is not None:
            system = System(system.bodies, (Contact(friction=Friction(friction, friction)),))
        systems.append(system)
        cases.append({
            kind: told, "friction": friction, "components": int(rng.integers(1, 4)),
            "dt": float(rng.choice([0.005, 0.01])), "scale": float(rng.uniform(0.3, 2.0)),
        })  # fmt: skip
    said, written = in_node(tmp_path, "space", RUN, cases, motion)
    numbers = np.frombuffer(written)
    fell = 0
    for case, item, system in zip(cases, said, systems, strict=True):
        body = kernel_body(system)
        assert item["record"] == body.tobytes().hex()
        shaking = np.zeros((900, 3))
        shaking[:, : case["components"]] = motion[: case["components"]].T
        samples = 900 + math.ceil(AFTER / case["dt"]) + 2
        outcome, history = run_case(body, shaking, case["dt"], case["scale"], samples=samples)
        assert item["done"] == len(history)
        table, numbers = np.split(numbers, [history.size])
        np.testing.assert_array_equal(table.reshape(history.shape), history)
        told, numbers = np.split(numbers, [7])
        expected = [
            outcome.certain_time, outcome.fall_direction, outcome.peak_rotation, outcome.peak_tilt, outcome.turn,
            *outcome.walk,
        ]  # fmt: skip
        np.testing.assert_array_equal(told, expected)
        assert item["fell"] == outcome.overturned
        assert item["alike"], "an outcome alone is that of the history"
        fell += outcome.overturned
    assert 0.15 * bodies < fell < 0.85 * bodies
