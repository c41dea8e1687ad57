"""The modules for pages are made from the kernels, and compute what Python does with them, to the last bit."""

import importlib.util
import json
import math
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rockfrag import Block, GroundMotion, Motion, Stack, overturns, simulate
from rockfrag.assess.core import holding as core
from rockfrag.assess.standing.changes import row_of
from rockfrag.assess.standing.holders import (
    Beside,
    Bracket,
    Casters,
    Cords,
    Pendulum,
    Putty,
    Springs,
)
from rockfrag.base.units import GRAVITY
from rockfrag.engines.planar.engine import described
from rockfrag.engines.pure_rocking.ensembles import body_record
from rockfrag.engines.spatial.body import kernel_body
from rockfrag.engines.spatial.engine import AFTER, run_case
from rockfrag.engines.steps import STEP, free_samples, step_count
from rockfrag.records.velocity_steps import bump_and_stop
from rockfrag.simulation.options import system_of
from rockfrag.system.body import Polygon, RigidBody
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.mounts import ROLLING
from rockfrag.system.system import System, turned_about_vertical
from rockfrag.web import driver_text, module_bytes

from ..engines.planar.cases import random_block, random_stack

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="Node is not installed")

HISTORY = [
    "theta1",
    "omega1",
    "theta2",
    "omega2",
    "c1",
    "c2",
    "alpha1",
    "alpha2",
    "work",
]


def in_node(
    folder: Path, module: str, cases: object, motion: np.ndarray, script: str = ""
) -> tuple:
    """Run cases in Node; what it says of each, and the numbers that it writes."""
    files = {
        name: folder / name
        for name in ("module.wasm", "cases.json", "motions", "found")
    }
    files["module.wasm"].write_bytes(module_bytes(module))
    files["cases.json"].write_text(json.dumps(cases))
    files["motions"].write_bytes(motion.tobytes())
    scripts = Path(__file__).parent / "node_scripts"
    texts = [
        (scripts / f"{name}.js").read_text() for name in ("shaking", script or module)
    ]
    (folder / "run.cjs").write_text("\n".join([driver_text(module), *texts]))
    done = subprocess.run(
        [NODE, folder / "run.cjs", *files.values()], capture_output=True, text=True
    )
    assert done.stderr == "" and done.returncode == 0
    return json.loads(done.stdout or "null"), files["found"].read_bytes()


def given(block: Block) -> dict[str, float | None]:
    return {
        "width": block.width, "height": block.height, "mass": block.mass, "inertia": block.inertia,
        "cgHeight": block.cg_height, "cgOffset": block.cg_offset, "lean": block.lean,
    }  # fmt: skip


def told(body: Block | Stack, **more):
    if isinstance(body, Block):
        return {"statue": given(body), **more}
    both = {"statue": given(body.upper), "pedestal": given(body.lower)}
    return {**both, "offset": body.offset, **more}


@pytest.mark.filterwarnings("ignore:.*left the ground")
@needs_node
def test_a_base_that_is_hit_and_stopped_does_in_the_page_what_it_does_in_simulate(
    tmp_path,
):
    block = Block(0.02, 0.09, 1.0, cg_offset=0.001)
    velocities = [0.1, 0.2, 0.36, 0.37, 0.45, 0.6]
    bumps = [{"velocity": each, "distance": 0.025} for each in velocities]
    cases = [{"statue": given(block), **bump} for bump in bumps]
    told, numbers = in_node(tmp_path, "integrate", cases, np.zeros(1), "bump")
    rotations, first = np.frombuffer(numbers), 0
    for case, bump in zip(told, bumps, strict=True):
        still = Motion(np.zeros(2), case["dt"])
        shaken = GroundMotion(still, steps=bump_and_stop(**bump))
        expected = simulate(block, shaken)
        assert bool(case["fallen"]) == expected.overturned
        # the package tells the state before each jump, and after it
        theta = expected.theta[1:, 0]
        theta = theta[np.append(True, np.diff(expected.time[1:]) > 1e-12)]
        shown = rotations[first : first + min(case["done"], theta.size)]
        assert shown == pytest.approx(theta[: shown.size], abs=1e-12)
        first += case["done"]
    assert {bool(case["fallen"]) for case in told} == {False, True}


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@needs_node
def test_fifty_random_histories_have_the_bits_of_simulate(tmp_path):
    rng = np.random.default_rng(11)
    motion = np.sin(np.arange(3000) * 0.06) * np.linspace(0.2, 1.0, 3000) * 5
    motion += rng.normal(0.0, 1.0, motion.size)
    cases, responses, records = [], [], []
    for number in range(50):
        lone = number % 5 < 2
        body = (
            random_block(rng, rng.uniform(0.1, 0.6), (2.5, 6))
            if lone
            else random_stack(rng)
        )
        if lone and number % 2:
            body = replace(body, inertia=1.1 * body.centroidal_inertia, lean=0.01)
        ratios = rng.uniform(0.5, 0.8, 2).tolist()
        restitution = (
            ratios[0]
            if lone
            else [ratios, [None, ratios[1]], [ratios[0], None]][number % 3]
        )
        restitution = restitution if rng.random() < 0.5 else None
        start, count = int(rng.integers(0, 2000)), int(rng.integers(200, 1000))
        # vertical motion is scaled by the page after it is divided by gravity, here before
        scale = 1.0 if rng.random() < 0.2 else float(rng.uniform(0.2, 1.5))
        linear = scale != 1.0 and bool(rng.random() < 0.3)
        dt = float(rng.choice([0.005, 0.01, 0.02]))
        lean = 0.3 * (body.alpha if lone else body.upper.alpha) * (rng.random() < 0.3)
        samples = scale * motion[start : start + count]
        vertical = 0.6 * motion[:count] if scale == 1.0 else None
        cases.append({
            "given": told(body, linear=linear, restitution=restitution), "start": start, "count": count,
            "scale": scale, "dt": dt, "initial": {"theta2": lean}, "lifted": vertical is not None,
        })  # fmt: skip
        more = {
            "linear": linear,
            "theta0": lean if lone else (0.0, lean),
            "restitution": restitution,
        }
        responses.append(simulate(body, samples, dt, vertical=vertical, **more))
        records.append(body_record(system_of(body, restitution=restitution), linear))
    said, written = in_node(tmp_path, "integrate", cases, motion)
    lengths = [
        [item["done"]] * len(HISTORY) + [3 * len(item["kinds"])] for item in said
    ]
    found = iter(np.split(np.frombuffer(written), np.cumsum(np.concatenate(lengths))))
    for case, item, response, record in zip(
        cases, said, responses, records, strict=True
    ):
        body, events = response.system, response.contact_events
        assert item["record"] == record.tobytes().hex()
        assert item["shaking"] == {
            "substeps": step_count(body, case["dt"], GRAVITY, STEP),
            "freeSamples": free_samples(body, case["dt"], GRAVITY),
        }
        assert item["done"] == len(response.time)
        history = dict(zip(HISTORY, (next(found) for _ in HISTORY), strict=True))
        blocks = ("1", "2")[-body.count :]
        for name, short in (
            ("theta", "theta"),
            ("omega", "omega"),
            ("alpha", "alpha"),
            ("state", "c"),
        ):
            columns = np.column_stack([history[short + block] for block in blocks])
            np.testing.assert_array_equal(columns, getattr(response, name))
        np.testing.assert_array_equal(history["work"], response.energy["input"])
        times, energies, speeds = next(found).reshape(3, -1)
        np.testing.assert_array_equal(times, events["time"])
        np.testing.assert_array_equal(energies, events["energy_after"])
        np.testing.assert_array_equal(
            speeds, [omega[-1] for omega in events["omega_before"]]
        )
        assert item["kinds"] == events["kind"].tolist()
        assert (item["fallen"] > 0) == response.overturned
        assert item["fallTime"] == response.overturning_time or not response.overturned
        assert (item["impacts"], item["grazings"]) == (
            response.impacts,
            response.grazings,
        )
        assert item["unstable_distance"] in (response.unstable_distance, None)
        assert item["alike"], "an outcome alone is that of the history"
    assert len(list(found)) == 1, "what is left is empty"
    assert sum(response.overturned for response in responses) > 5
    assert sum(len(response.contact_events) for response in responses) > 500


@needs_node
def test_bodies_that_cannot_stand_are_refused(tmp_path):
    statue, wide = Block(0.3, 1.2, 200.0), Block(0.6, 1.2, 200.0)
    base = Block(0.4, 0.2, 100.0)
    both = told(Stack(base, statue))
    bodies = {
        "cannot stand": {"statue": given(statue) | {"cgOffset": 0.2}},
        "does not lie on": both | {"offset": 0.4},
        "above the part": both | {"offset": 0.25},
        "once the pedestal's lean": both | {"pedestal": given(base) | {"lean": 0.3}},
        "touch the ground": {
            "statue": given(wide),
            "pedestal": given(Block(0.4, 0.05, 100.0)),
        },
        "gain energy": told(statue, restitution=1.2),
        "mass of 0": {"statue": given(statue) | {"mass": 0}},
        "width of null": {"statue": given(statue) | {"width": None}},
    }
    cases = [
        {"given": body, "start": 0, "count": 2, "dt": 0.01} for body in bodies.values()
    ]
    said, written = in_node(tmp_path, "integrate", cases, np.zeros(2))
    assert not written
    for words, item in zip(bodies, said, strict=True):
        assert words in item["error"]


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@needs_node
def test_outcomes_are_those_of_overturns(tmp_path, made_motions):
    """Blocks and stacks, measured or not, of all sampling densities."""
    rng = np.random.default_rng(3)
    motions = made_motions(6)
    bodies, restitutions = [], []
    for width in (0.02, 0.1, 0.3, 0.5):
        block = Block(width, width * rng.uniform(3, 5), 200.0, cg_offset=0.05 * width)
        bodies += [block, Stack(Block(1.3 * width, 2 * width, 300.0), block)]
        restitutions += [None, None] if width < 0.3 else [0.7, (0.7, 0.7)]
    scales = np.tile(np.geomspace(0.2, 6, 12), (len(motions), 1))
    found = overturns(bodies, list(motions), scales=scales, restitution=restitutions)
    asked = {
        "bodies": [
            told(body, measured=0.7 if ratio else None)
            for body, ratio in zip(bodies, restitutions, strict=True)
        ],
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
        "scales": scales.ravel().tolist(),
    }
    samples = np.concatenate([motion.acceleration for motion in motions])
    _, written = in_node(tmp_path, "ensemble", asked, samples)
    said = np.frombuffer(written, np.uint8).astype(bool)
    overturned, rocked = np.moveaxis(said.reshape(len(bodies), 2, *scales.shape), 1, 0)
    np.testing.assert_array_equal(overturned, found.overturned)
    np.testing.assert_array_equal(rocked, (found.peak_rotation > 0).any(axis=-1))
    assert 0.1 < overturned.mean() < rocked.mean() < 0.95


# --------------------------------------------------------------------------- what is held


SPRINGS = ("spring_stiffness", "spring_strength", "spring_yield")


def some_held(rng, kind: str):
    """A block or stack that something holds, as the engine and as a page have it."""
    width = rng.uniform(0.15, 0.5)
    size = (width, width * rng.uniform(2, 4), rng.uniform(40, 400))
    block = Block(*size, cg_offset=0.04 * width * rng.integers(0, 2))
    body = block
    if rng.random() < 0.4:
        lower = Block(width * rng.uniform(0.9, 1.6), rng.uniform(0.2, 0.9), 300.0)
        body = Stack(lower, block)
    ratio = 0.75 if rng.random() < 0.3 else None
    weight = block.mass * GRAVITY
    bears = float(weight * rng.choice([0.1, 0.3, 1.0, 1e6]))
    mass = body.system().mass
    bracket, cords, springs = np.zeros(4), np.zeros(4), np.zeros(3)
    core.tell_fastener(row_of(block), True, bracket)
    core.tell_fastener(row_of(block), False, cords)
    core.tell_springs(core.PLATE * mass + mass, springs)
    names = ("tie_height", "tie_reach", "tie_stiffness", "tie_damping")

    def ties(numbers, count):
        about = dict(zip(names, numbers.tolist(), strict=True))
        return about | {"ties": count, "is_bracket": 2 - count, "tie_strength": bears}

    stroke = float(rng.uniform(0.01, 0.3))
    holder, held = {
        "putty": (Putty(bears), {
            "bond_tension": bears, "bond_shear": bears, "bond_spread": core.pads_across(width),
        }),
        "bracket": (Bracket(bears), ties(bracket, 1)),
        "cord": (Cords(bears), ties(cords, 2)),
        "isolator": (Pendulum(stroke), {
            "plate": core.PLATE * mass, "dish_radius": core.RADIUS, "dish_friction": core.SLIDES_AT,
            "stroke": stroke,
        }),
        "springs": (Springs(stroke), {
            "plate": core.PLATE * mass, "dish_friction": 0.0, "stroke": stroke,
            **dict(zip(SPRINGS, springs.tolist(), strict=True)),
        }),
        "wall": (Beside(0.03), {"wall": 0.03}),
        "casters": (Casters(), {"friction": ROLLING.kinetic}),
    }[kind]  # fmt: skip
    ratios = ratio if body is block or ratio is None else (ratio, ratio)
    system = system_of(body.system(), restitution=ratios)
    return holder.on(system), told(body, measured=ratio, held=held)


@needs_node
@pytest.mark.parametrize("each", [1, pytest.param(12, marks=pytest.mark.slow)])
def test_what_is_held_in_a_plane_has_the_bits_of_overturns(
    tmp_path, made_motions, each
):
    rng, motions = np.random.default_rng(31), made_motions(3)
    kinds = ("putty", "bracket", "cord", "isolator", "springs", "wall", "casters")
    systems, given = zip(*(some_held(rng, kind) for kind in kinds * each), strict=True)
    scales = np.tile([0.6, 1.4, 3.0], (len(motions), 1))
    found = overturns(systems, list(motions), scales=scales)
    asked = {
        "bodies": given,
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
        "scales": scales.ravel().tolist(),
    }
    samples = np.concatenate([motion.acceleration for motion in motions])
    records, written = in_node(tmp_path, "plane", asked, samples)
    for record, system in zip(records, systems, strict=True):
        body, _ = described(system_of(system), GRAVITY)
        mine = np.frombuffer(bytes.fromhex(record), body.dtype)[0]
        for name in body.dtype.names:
            np.testing.assert_array_equal(mine[name], body[name], err_msg=name)
    numbers = np.frombuffer(written).reshape(len(systems), 5, *scales.shape)
    fell, rocked, loose, force, stroke = np.moveaxis(numbers, 1, 0)
    for i, system in enumerate(systems):
        # what only rolls is answered by pure rocking where it does not
        told = np.full(scales.shape, True) if system.holding else loose[i] > 0
        np.testing.assert_array_equal((fell[i] > 0)[told], found.overturned[i][told])
        turned = (found.peak_rotation[i] > 0).any(axis=-1)
        np.testing.assert_array_equal((rocked[i] > 0)[told], turned[told])
        if system.holding:
            for mine, his in ((force, found.largest_force), (stroke, found.stroke)):
                np.testing.assert_array_equal(
                    mine[i], np.nan_to_num(his[i]).max(axis=-1)
                )
    assert 0 < fell.mean() < 0.9 and force.max() > 0 and stroke.max() > 0


# --------------------------------------------------------------------------- bodies in space


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
    angles = np.sort(
        (np.arange(count) + rng.uniform(0, 0.6, count)) * 2 * math.pi / count
    )
    vertices = rng.uniform(0.2, 0.4) * np.column_stack([np.cos(angles), np.sin(angles)])
    tilt = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    tensor = 40 * tilt @ np.diag([1.0, 1.2, 0.9]) @ tilt.T
    tensor = (tensor + tensor.T) / 2
    centre = (0.02, -0.01, float(rng.uniform(0.4, 0.9)))
    base = Polygon(tuple(map(tuple, vertices.tolist())))
    told = {"mass": 300.0, "centre": centre, "tensor": tensor.tolist()}
    system = System((RigidBody(300.0, tensor, centre, base, 2.0),), (Contact(),))
    return system, told | {"vertices": vertices.tolist()}


@needs_node
@pytest.mark.parametrize("bodies", [9, pytest.param(60, marks=pytest.mark.slow)])
def test_random_bodies_in_space_have_the_bits_of_the_package(tmp_path, bodies):
    rng = np.random.default_rng(4)
    time = np.arange(900) * 0.01
    strong = np.exp(-(((time - 3) / 1.5) ** 2)) * np.array([[1.0], [1.0], [0.4]])
    motion = rng.normal(0, 3.0, (3, 900)) + 2.5 * np.sin(
        4 * time + np.array([[0.0], [1.0], [2.0]])
    )
    motion *= strong
    cases, systems = [], []
    for i in range(bodies):
        kind = ("block", "block", "solid")[i % 3]
        system, told = (
            some_polygon(rng) if kind == "solid" else some_block(rng, i % 3 == 1)
        )
        friction = 0.5 if rng.random() < 0.3 else None
        if friction is not None:
            system = System(
                system.bodies, (Contact(friction=Friction(friction, friction)),)
            )
        systems.append(system)
        cases.append({
            kind: told, "friction": friction, "components": int(rng.integers(1, 4)),
            "dt": float(rng.choice([0.005, 0.01])), "scale": float(rng.uniform(0.3, 2.0)),
        })  # fmt: skip
    said, written = in_node(tmp_path, "space", cases, motion)
    numbers = np.frombuffer(written)
    fell = 0
    for case, item, system in zip(cases, said, systems, strict=True):
        body = kernel_body(system)
        assert item["record"] == body.tobytes().hex()
        shaking = np.zeros((900, 3))
        shaking[:, : case["components"]] = motion[: case["components"]].T
        samples = 900 + math.ceil(AFTER / case["dt"]) + 2
        outcome, history = run_case(
            body, shaking, case["dt"], case["scale"], samples=samples
        )
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


@needs_node
def test_a_body_at_a_wall_or_on_wax_has_the_bits_of_the_package(tmp_path):
    """At a wall behind its narrower side, touching it or some way off, bonded, or both, whichever way it faces."""
    rng = np.random.default_rng(8)
    time = np.arange(700) * 0.01
    motion = np.exp(-(((time - 2) / 1.2) ** 2)) * (
        rng.normal(0, 2.0, (3, 700))
        + 3 * np.sin(5 * time + np.array([[0.0], [1], [2]]))
    )
    cases, systems, alone = [], [], []
    # gap of a wall [m], pull that wax holds over the weight, direction [degrees], and whether it is round
    given = [
        *[(gap, None, 0.0, False) for gap in (0.0, 0.02, 5.0)],
        *[
            (0.0, None, 33.0, False),
            (0.01, None, -71.0, False),
            (None, 0.3, 0.0, False),
        ],
        *[(None, 0.6, 25.0, False), (0.0, 0.4, 12.0, False), (None, 0.4, 0.0, True)],
    ]
    for gap, part, facing, is_round in given:
        width = float(rng.uniform(0.2, 0.4))
        block = {"width": width, "height": 3 * width, "mass": 900 * width * width}
        block |= {"cg_offset": 0.02 * width}
        block |= {"round": True} if is_round else {"depth": 1.3 * width}
        free = turned_about_vertical(Block(**block).system(), facing)
        held, bond = free, None
        if gap is not None:
            held = Beside(gap).on(held)
        if part is not None:
            pull = part * block["mass"] * GRAVITY
            held = Putty(pull).on(held)
            bond = {"tension": pull, "shear": pull, "padsAt": core.PADS_AT}
        systems.append(held)
        alone.append(free)
        told = {
            "cgOffset" if key == "cg_offset" else key: v for key, v in block.items()
        }
        cases.append({
            "block": told | {"turn": facing * (math.pi / 180)}, "wall": gap, "bond": bond, "friction": None,
            "components": 2, "dt": 0.01, "scale": 1.2,
        })  # fmt: skip
    said, written = in_node(tmp_path, "space", cases, motion)
    numbers, differ = np.frombuffer(written), []
    shaking = np.column_stack([motion[0], motion[1], np.zeros(700)])
    shaken = [GroundMotion(*(Motion(motion[k], 0.01) for k in (0, 1))).with_second()]
    for item, system, free, (_, part, *_) in zip(
        said, systems, alone, given, strict=True
    ):
        body = kernel_body(system)
        assert item["record"] == body.tobytes().hex()
        samples = 700 + math.ceil(AFTER / 0.01) + 2
        outcome, history = run_case(body, shaking, 0.01, 1.2, samples=samples)
        table, numbers = np.split(numbers, [history.size])
        np.testing.assert_array_equal(table.reshape(history.shape), history)
        _, numbers = np.split(numbers, [7])
        assert item["fell"] == outcome.overturned
        if part is not None:
            bears = overturns([system], shaken, scales=np.array([[1.2]])).largest_force
            mass = system.bodies[0].mass
            assert item["force"] * mass == bears[0, 0, 0, -1]
        other, _ = run_case(kernel_body(free), shaking, 0.01, 1.2, samples=samples)
        differ.append(outcome.peak_rotation != other.peak_rotation)
    assert 5 <= sum(differ) < len(given)


# --------------------------------------------------------------------------- the modules


@pytest.mark.parametrize(
    ("name", "largest"),
    [
        ("integrate", 60_000),
        ("space", 156_000),
        ("plane", 165_000),
        ("ensemble", 270_000),
        ("ensemble-fused", 132_000),
    ],
)
def test_a_module_is_small_and_needs_nothing(name, largest):
    module = module_bytes(name)
    assert len(module) <= largest
    # after a header of 8 bytes stand the types (1); what is imported (2) would come before functions (3)
    assert module[8] == 1
    size = module[9] if module[9] < 128 else module[9] % 128 + 128 * module[10]
    after = 10 + (module[9] >= 128) + size
    assert module[after] == 3


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None,
    reason="ziglang, the linker, is not installed",
)
@pytest.mark.parametrize(
    ("name", "seed"),
    [
        ("integrate", "1"),
        ("space", "2"),
        ("plane", "1"),
        ("ensemble", "2"),
        ("ensemble-fused", "1"),
    ],
)
def test_a_module_is_that_of_the_kernels(name, seed, tmp_path):
    again = f"from rockfrag.web.build import MODULES; made = MODULES[{name!r}]()"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; {again}; sys.stdout.buffer.write(made)"],
        env={**os.environ, "PYTHONHASHSEED": seed},
        check=True,
        capture_output=True,
    )
    assert done.stdout == module_bytes(name), (
        "make it anew: python -m rockfrag.web.build"
    )
