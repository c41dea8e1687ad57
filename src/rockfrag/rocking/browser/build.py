"""Make the WebAssembly module from the kernels: ``python -m rockfrag.rocking.browser.build``.

The kernel that ``simulate`` calls is compiled by numba to LLVM's language as always, and from there on for
WebAssembly instead of this processor.  The linker is that of the package ``ziglang`` (``pip install
'rockfrag[browser]'``), which nothing else needs.  The same versions make the same bytes on every machine.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np

from rockfrag.engines.kernels._numba import whole_ir
from rockfrag.engines.kernels.jit import KNOWN, TESTED_NUMBA
from rockfrag.engines.kernels.record import CONTACT_EVENT, SAMPLE
from rockfrag.engines.steps import FREE_TIME, STEP
from rockfrag.rocking.browser.entry import CALL, describe, integrate_call
from rockfrag.units import GRAVITY

MODULE = Path(__file__).with_name("integrate.wasm")

TRIPLE = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory,+sign-ext,+nontrapping-fptoint"
MEMORY_PAGES = 2
"""Pages of 64 KiB that the module starts with; the page asks for more as histories need them."""


def build() -> bytes:
    """Return the bytes of the module, with the layout of its records in a section of their own."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    call = np.zeros(1, CALL)[0]
    entries = {
        "describe": (describe, (call,)),
        "integrate": (
            integrate_call,
            (call, np.zeros(1), np.zeros(1), np.zeros(1, SAMPLE), np.zeros(1, CONTACT_EVENT)),
        ),
    }
    objects = [_object(name, *entry) for name, entry in entries.items()]
    return _with_section(_linked(objects, list(entries)), "layout", _layout())


def _object(name: str, function: Any, arguments: tuple[Any, ...]) -> bytes:
    """Compile a function and all that it needs; it gets this name, and all others none."""
    text, entry = whole_ir(function, tuple(map(numba.typeof, arguments)))
    text = text.replace(f"@{entry}", f"@{name}").replace(f'@"{entry}"', f"@{name}")
    text = re.sub(r"^target (triple|datalayout) = .*$", "", text, flags=re.MULTILINE)
    # a square root is an instruction, not a function of a library
    text = re.sub(r"^declare double @sqrt\(double\).*$", "", text, flags=re.MULTILINE)
    text = text.replace("@sqrt(", "@llvm.sqrt.f64(")
    # WebAssembly has no symbols that several objects may define
    text = text.replace("= common ", "= internal ")
    module = llvm.parse_assembly(text)
    machine = llvm.Target.from_triple(TRIPLE).create_target_machine(
        cpu="", features=FEATURES, opt=3, reloc="static", codemodel="default"
    )
    module.triple, module.data_layout = TRIPLE, str(machine.target_data)
    for item in [*module.functions, *module.global_variables]:
        if not item.is_declaration and item.name != name:
            item.linkage = "internal"
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization = options.slp_vectorization = False
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    made: bytes = machine.emit_object(module)
    return made


def _linked(objects: list[bytes], exports: list[str]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f"{i}.o") for i in range(len(objects))]
        for path, made in zip(paths, objects, strict=True):
            path.write_bytes(made)
        linked = Path(folder, "linked.wasm")
        command = [
            sys.executable, "-m", "ziglang", "wasm-ld", "--no-entry", "--strip-all", "--gc-sections",
            "--export=__heap_base", *[f"--export={name}" for name in exports], "-z", "stack-size=32768",
            f"--initial-memory={MEMORY_PAGES * 65536}", "-o", str(linked), *map(str, paths),
        ]  # fmt: skip
        subprocess.run(command, check=True, capture_output=True, text=True)
        return linked.read_bytes()


# --------------------------------------------------------------------------- the layout of records, and constants


def _layout() -> bytes:
    records = {"call": CALL, "sample": SAMPLE, "event": CONTACT_EVENT}
    layout: dict[str, Any] = {name: _described(dtype) for name, dtype in records.items()}
    layout["constants"] = {"gravity": GRAVITY, "step": STEP, "free_time": FREE_TIME}
    return json.dumps(layout, separators=(",", ":")).encode()


def _described(dtype: np.dtype[Any]) -> dict[str, Any]:
    """Size of a record and the place of each of its numbers: [offset, kind], or a record by itself."""
    fields: dict[str, Any] = {}
    for name in dtype.names or ():
        kind, offset = dtype.fields[name][:2]  # type: ignore[index]
        if kind.names is not None:
            fields[name] = {"at": offset, **_described(kind)}
        elif kind.subdtype is None:
            fields[name] = [offset, kind.kind + str(kind.itemsize)]
    return {"size": dtype.itemsize, "fields": fields}


def _with_section(module: bytes, name: str, content: bytes) -> bytes:
    """Append a custom section to a module."""
    label = name.encode()
    body = _length(len(label)) + label + content
    return module + b"\0" + _length(len(body)) + body


def _length(number: int) -> bytes:
    """Write a number as WebAssembly does, seven bits a byte."""
    digits = bytearray()
    while number > 127:
        digits.append(number & 127 | 128)
        number >>= 7
    digits.append(number)
    return bytes(digits)


if __name__ == "__main__":
    if not KNOWN:
        raise SystemExit(
            f"numba: the module is made with version {TESTED_NUMBA[0]}x; install that."
        )
    MODULE.write_bytes(build())
    print(f"{MODULE}: {MODULE.stat().st_size} bytes")
