"""The kernels of pages in Node."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from rockfrag.rocking.browser import driver_text, module_bytes

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="Node is not installed")


def in_node(folder: Path, module: str, script: str, cases: object, motion: np.ndarray) -> tuple:
    """Run cases in Node; what it says of each, and all the bytes that it writes."""
    files = {name: folder / name for name in ("module.wasm", "cases.json", "motions", "found")}
    files["module.wasm"].write_bytes(module_bytes(module))
    files["cases.json"].write_text(json.dumps(cases))
    files["motions"].write_bytes(motion.tobytes())
    (folder / "run.cjs").write_text(f"{driver_text(module)}\n{script}")
    done = subprocess.run(
        [NODE, folder / "run.cjs", *files.values()], capture_output=True, text=True
    )
    assert done.stderr == "" and done.returncode == 0
    return json.loads(done.stdout or "null"), files["found"].read_bytes()
