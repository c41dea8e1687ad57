"""The module for pages is made from the kernels, and computes what ``simulate`` does, to the last bit."""

import importlib.util
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.engines.lanes import body_record
from rockfrag.engines.steps import STEP, free_samples, step_count
from rockfrag.rocking.browser import module_bytes
from rockfrag.rocking.options import system_of
from rockfrag.system.blocks import Body
from rockfrag.units import GRAVITY

from ..oracle.standing import upper_on_contact
from .node import in_node, needs_node

HISTORY = ["theta1", "omega1", "theta2", "omega2", "c1", "c2", "alpha1", "alpha2", "work"]

RUN = (
    f"const HISTORY = {HISTORY};"
    + """
const fs = require("fs");
const [wasm, cases, motions, out] = process.argv.slice(2);
const bytes = new Float64Array(new Uint8Array(fs.readFileSync(motions)).buffer);
rockfragKernel(new Uint8Array(fs.readFileSync(wasm))).then((kernel) => {
  const found = [];
  const told = JSON.parse(fs.readFileSync(cases)).map(({ given, start, count, lifted, ...rest }) => {
    let body;
    try {
      body = kernel.bodyOf(given);
    } catch (error) {
      return { error: error.message };
    }
    const samples = bytes.subarray(start, start + count);
    const more = lifted ? { vertical: bytes.subarray(0, count).map((a) => 0.6 * a) } : {};
    const r = kernel.integrate({ body, samples, ...rest, ...more });
    const outcome = kernel.integrate({ body, samples, ...rest, ...more, history: false });
    for (const name of HISTORY) found.push(Float64Array.from(r[name]));
    for (const number of [(e) => e.time, (e) => e.energy_after, (e) => e.before.omega2]) {
      found.push(Float64Array.from(r.contact_events, number));
    }
    const numbers = ["done", "fallen", "fallTime", "impacts", "grazings", "unstable_distance", "peak1", "peak2"];
    return {
      ...Object.fromEntries(numbers.map((name) => [name, r[name]])),
      record: Buffer.from(body.record).toString("hex"),
      shaking: kernel.shakingOf(body, rest.dt),
      kinds: r.contact_events.map((e) => e.kind),
      alike: numbers.every((name) => Object.is(r[name], outcome[name])),
    };
  });
  fs.writeFileSync(out, Buffer.concat(found.map((values) => Buffer.from(values.buffer))));
  console.log(JSON.stringify(told));
});
"""
)


def given(block: Block) -> dict[str, float | None]:
    return {
        "width": block.width, "height": block.height, "mass": block.mass, "inertia": block.inertia,
        "cgHeight": block.cg_height, "cgOffset": block.cg_offset, "lean": block.lean,
    }  # fmt: skip


def told(body: Body, **more):
    if isinstance(body, Block):
        return {"statue": given(body), **more}
    both = {"statue": given(body.upper), "pedestal": given(body.lower)}
    return {**both, "offset": body.offset, **more}


def some_body(rng) -> Body:
    """A block or a stack, some of them leaning, off their middle, or wider than their pedestal."""

    def block(width, slenderness):
        height = width * slenderness
        odd = rng.random() < 0.5
        return Block(
            width, height, 2000 * width * height,
            inertia=150 * width * height**3 if rng.random() < 0.3 else None,
            cg_height=0.45 * height if rng.random() < 0.3 else None,
            cg_offset=0.05 * width * rng.uniform(-1, 1) if odd else 0.0,
            lean=0.02 * rng.uniform(-1, 1) if odd else 0.0,
        )  # fmt: skip

    statue = block(rng.uniform(0.1, 0.6), rng.uniform(2.5, 6.0))
    if rng.random() < 0.4:
        return statue
    pedestal = block(statue.width * rng.uniform(0.9, 1.5), rng.uniform(0.5, 2.0))
    return Stack(pedestal, statue, offset=0.03 * statue.width * rng.uniform(-1, 1))


def some_restitution(rng, body: Body):
    """A measured restitution, of both contacts or of one, or none."""
    if rng.random() < 0.5:
        return None

    def of(block):
        least, most = sorted(block.pivot_inertia(pivot) for pivot in (1, -1))
        return float(rng.uniform(0.5, 0.99) * math.sqrt(least / most))

    if isinstance(body, Block):
        return of(body)
    ground, interface = of(body.lower), of(upper_on_contact(body))
    return [(ground, interface), (None, interface), (ground, None)][rng.integers(0, 3)]


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@needs_node
def test_fifty_random_histories_have_the_bits_of_simulate(tmp_path):
    rng = np.random.default_rng(11)
    motion = np.sin(np.arange(3000) * 0.06) * np.linspace(0.2, 1.0, 3000) * 5
    motion += rng.normal(0.0, 1.0, motion.size)
    cases, responses, records = [], [], []
    while len(cases) < 50:
        body, start = some_body(rng), int(rng.integers(0, 2000))
        restitution = some_restitution(rng, body)
        count, scale = int(rng.integers(200, 1000)), float(rng.uniform(0.2, 1.5))
        # vertical motion is scaled by the page after it is divided by gravity, here before
        scale = 1.0 if rng.random() < 0.2 else scale
        linear = scale != 1.0 and bool(rng.random() < 0.3)
        dt = float(rng.choice([0.005, 0.01, 0.02]))
        released = bool(rng.random() < 0.3)
        lean = 0.3 * (body.alpha if isinstance(body, Block) else body.upper.alpha)
        angles = {"theta2": lean} if released else {}
        theta0 = None if not released else lean if isinstance(body, Block) else (0.0, lean)
        samples = scale * motion[start : start + count]
        vertical = 0.6 * motion[:count] if scale == 1.0 else None
        described = told(body, linear=linear, restitution=restitution)
        cases.append({
            "given": described, "start": start, "count": count, "scale": scale, "dt": dt,
            "initial": angles, "lifted": vertical is not None,
        })  # fmt: skip
        more = {"linear": linear, "theta0": theta0, "restitution": restitution}
        responses.append(simulate(body, samples, dt, vertical=vertical, **more))
        records.append(body_record(system_of(body, restitution=restitution), linear))
        assert math.isfinite(responses[-1].theta[-1, -1])
    said, written = in_node(tmp_path, "integrate", RUN, cases, motion)
    numbers = np.frombuffer(written)
    found = iter(np.split(numbers, np.cumsum([n for item in said for n in lengths(item)])))
    for case, item, response, record in zip(cases, said, responses, records, strict=True):
        body, events = response.system, response.contact_events
        assert item["record"] == record.tobytes().hex()
        assert item["shaking"] == {
            "substeps": step_count(body, case["dt"], GRAVITY, STEP),
            "freeSamples": free_samples(body, case["dt"], GRAVITY),
        }
        assert item["done"] == len(response.time)
        history = dict(zip(HISTORY, (next(found) for _ in HISTORY), strict=True))
        blocks = ("1", "2")[-body.count :]
        for name in ("theta", "omega", "alpha", "state"):
            short = "c" if name == "state" else name
            columns = np.column_stack([history[short + block] for block in blocks])
            np.testing.assert_array_equal(columns, getattr(response, name))
        np.testing.assert_array_equal(history["work"], response.energy["input"])
        times, energies, speeds = next(found).reshape(3, -1)
        np.testing.assert_array_equal(times, events["time"])
        np.testing.assert_array_equal(energies, events["energy_after"])
        np.testing.assert_array_equal(speeds, [omega[-1] for omega in events["omega_before"]])
        assert item["kinds"] == events["kind"].tolist()
        assert (item["fallen"] > 0) == response.overturned
        assert item["fallTime"] == response.overturning_time or not response.overturned
        assert (item["impacts"], item["grazings"]) == (response.impacts, response.grazings)
        assert item["unstable_distance"] in (response.unstable_distance, None)
        assert item["alike"], "an outcome alone is that of the history"
    assert len(list(found)) == 1, "what is left is empty"
    assert sum(response.overturned for response in responses) > 5
    assert sum(len(response.contact_events) for response in responses) > 500


def lengths(item):
    """How many numbers each array of a case has."""
    return [item["done"]] * len(HISTORY) + [3 * len(item["kinds"])]


@needs_node
def test_bodies_that_cannot_stand_are_refused(tmp_path):
    statue, wide = Block(0.3, 1.2, 200.0), Block(0.6, 1.2, 200.0)
    base = Block(0.4, 0.2, 100.0)
    bodies = {
        "cannot stand": told(statue) | {"statue": given(statue) | {"cgOffset": 0.2}},
        "does not lie on": told(Stack(base, statue)) | {"offset": 0.4},
        "above the part": told(Stack(base, statue)) | {"offset": 0.25},
        "once the pedestal's lean": told(Stack(base, statue))
        | {"pedestal": given(base) | {"lean": 0.3}},
        "touch the ground": {"statue": given(wide), "pedestal": given(Block(0.4, 0.05, 100.0))},
        "gain energy": told(statue, restitution=1.2),
        "mass of 0": {"statue": given(statue) | {"mass": 0}},
        "width of null": {"statue": given(statue) | {"width": None}},
    }
    cases = [{"given": body, "start": 0, "count": 2, "dt": 0.01} for body in bodies.values()]
    said, written = in_node(tmp_path, "integrate", RUN, cases, np.zeros(2))
    numbers = np.frombuffer(written)
    assert numbers.size == 0
    for words, item in zip(bodies, said, strict=True):
        assert words in item["error"]


COUNT = """
const fs = require("fs");
const [wasm, cases, motions, out] = process.argv.slice(2);
const numbers = new Float64Array(new Uint8Array(fs.readFileSync(motions)).buffer);
rockfragEnsemble(new Uint8Array(fs.readFileSync(wasm))).then((ensemble) => {
  const { bodies, counts, dts, scales } = JSON.parse(fs.readFileSync(cases));
  let at = 0;
  const shaking = counts.map((n, i) => ({ samples: numbers.subarray(at, (at += n)), dt: dts[i] }));
  const found = bodies.flatMap((given) => {
    const body = ensemble.bodyOf(given);
    // in two parts, as a page does
    const ends = [[0, 1], [1, counts.length]];
    const parts = ends.map(([first, last]) => ensemble.count(body, shaking, scales, first, last));
    return ["overturned", "rocked"].flatMap((name) => parts.map((part) => part[name]));
  });
  fs.writeFileSync(out, Buffer.concat(found));
});
"""


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
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
    told = [
        {
            "statue": given(body.blocks[-1]),
            "pedestal": None if len(body.blocks) == 1 else given(body.blocks[0]),
            "measured": 0.7 if ratio else None,
        }
        for body, ratio in zip(bodies, restitutions, strict=True)
    ]
    asked = {
        "bodies": told,
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
        "scales": scales.ravel().tolist(),
    }
    samples = np.concatenate([motion.acceleration for motion in motions])
    _, written = in_node(tmp_path, "ensemble", COUNT, asked, samples)
    said = np.frombuffer(written, np.uint8).astype(bool)
    overturned, rocked = np.moveaxis(said.reshape(len(bodies), 2, *scales.shape), 1, 0)
    np.testing.assert_array_equal(overturned, found.overturned)
    np.testing.assert_array_equal(rocked, (found.peak_rotation > 0).any(axis=-1))
    assert 0.1 < overturned.mean() < rocked.mean() < 0.95


@pytest.mark.parametrize(
    ("name", "largest"),
    [("integrate", 60_000), ("space", 100_000), ("ensemble", 270_000), ("ensemble-fused", 132_000)],
)
def test_a_module_is_small_and_needs_nothing(name, largest):
    module = module_bytes(name)
    assert len(module) <= largest
    # section 2 of a module would list what it imports
    at, kinds = 8, []
    while at < len(module):
        kind, size, shift, at = module[at], 0, 0, at + 1
        while True:
            size |= (module[at] & 127) << shift
            at, shift, more = at + 1, shift + 7, module[at] & 128
            if not more:
                break
        kinds.append(kind)
        at += size
    assert kinds[:2] == [1, 3]
    assert kinds[-1] == 0


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("ziglang") is None, reason="ziglang, the linker, is not installed"
)
@pytest.mark.parametrize(
    ("name", "seed"),
    [("integrate", "1"), ("space", "2"), ("ensemble", "2"), ("ensemble-fused", "1")],
)
def test_a_module_is_that_of_the_kernels(name, seed, tmp_path):
    again = (
        "import sys; from rockfrag.rocking.browser.build import MODULES; sys.stdout.buffer.write("
    )
    done = subprocess.run(
        [sys.executable, "-c", f"{again}MODULES[{name!r}]())"],
        env={**os.environ, "PYTHONHASHSEED": seed},
        check=True,
        capture_output=True,
    )
    assert done.stdout == module_bytes(name), (
        "make it anew: python -m rockfrag.rocking.browser.build"
    )
