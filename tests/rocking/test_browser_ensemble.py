"""The module that counts outcomes in a page counts those of ``overturns``."""

import json
import shutil
import subprocess

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack, overturns
from rockfrag.rocking.browser import driver_text, module_bytes

from .test_browser import given, needs_node

RUN = """
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
    (tmp_path / "ensemble.wasm").write_bytes(module_bytes("ensemble"))
    shaking = {
        "counts": [motion.acceleration.size for motion in motions],
        "dts": [motion.dt for motion in motions],
    }
    (tmp_path / "cases.json").write_text(
        json.dumps({"bodies": told, **shaking, "scales": scales.ravel().tolist()})
    )
    (tmp_path / "motions").write_bytes(
        np.concatenate([motion.acceleration for motion in motions]).tobytes()
    )
    (tmp_path / "run.cjs").write_text(f"{driver_text('ensemble')}\n{RUN}")
    files = [
        tmp_path / name for name in ("run.cjs", "ensemble.wasm", "cases.json", "motions", "out")
    ]
    subprocess.run([shutil.which("node"), *files], check=True)
    said = np.fromfile(tmp_path / "out", np.uint8).astype(bool)
    overturned, rocked = np.moveaxis(said.reshape(len(bodies), 2, *scales.shape), 1, 0)
    np.testing.assert_array_equal(overturned, found.overturned)
    np.testing.assert_array_equal(rocked, (found.peak_rotation > 0).any(axis=-1))
    assert 0.1 < overturned.mean() < rocked.mean() < 0.95
