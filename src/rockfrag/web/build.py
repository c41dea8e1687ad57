"""Make the WebAssembly modules from the kernels: ``python -m rockfrag.web.build``.

Numba compiles what Python calls to LLVM's language, which is then compiled for WebAssembly.  The linker is that of
``ziglang`` (``pip install 'rockfrag[browser]'``); the same versions make the same bytes on every machine.
"""

import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np

from rockfrag.base.units import GRAVITY
from rockfrag.engines.compile._numba import whole_ir
from rockfrag.engines.compile.jit import KNOWN, TESTED_NUMBA
from rockfrag.engines.planar import integrate as planar
from rockfrag.engines.pure_rocking.kernels.equations import BODY
from rockfrag.engines.pure_rocking.kernels.lanes.block import PIVOT
from rockfrag.engines.pure_rocking.kernels.lanes.case import BLOCK, OUTCOME
from rockfrag.engines.pure_rocking.kernels.record import CONTACT_EVENT, SAMPLE
from rockfrag.engines.spatial import _ground as ground
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial._body import BOND, MOST_VERTICES
from rockfrag.engines.spatial.body import NEVER_SLIDES
from rockfrag.engines.spatial.engine import AFTER, CUT_OFF, TOLERANCE
from rockfrag.engines.steps import FREE_TIME, STACK_STEP, STEP
from rockfrag.web import ensemble_entry as ensemble
from rockfrag.web import plane_entry as plane
from rockfrag.web.entry import CALL, describe, integrate_call, jump_call
from rockfrag.web.space_entry import SPACE, describe_solid, integrate_solid

TRIPLE = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory,+sign-ext,+nontrapping-fptoint"
SPACE_INLINING, PLANE_INLINING = 10, 140
"""Size of what LLVM copies in a body in space, and in a plane: by itself modules are larger than they may be."""
MEMORY_PAGES = 2
"""Pages of 64 KiB that the module starts with; the page asks for more as histories need them."""


Entries = dict[str, tuple[Any, tuple[Any, ...]]]


def build_integrate() -> bytes:
    """Return the bytes of the module of one history."""
    call = np.zeros(1, CALL)[0]
    history = (
        call,
        np.zeros(1),
        np.zeros(1),
        np.zeros(1, SAMPLE),
        np.zeros(1, CONTACT_EVENT),
    )
    entries: Entries = {
        "describe": (describe, (call,)),
        "integrate": (integrate_call, history),
        "jump": (jump_call, (call,)),
    }
    constants = {"gravity": GRAVITY, "step": STEP, "free_time": FREE_TIME}
    return module_of(
        entries,
        {"call": CALL, "sample": SAMPLE, "event": CONTACT_EVENT},
        constants,
        fused=None,
    )


def build_ensemble(*, fused: bool) -> bytes:
    """Return the bytes of the module that counts outcomes, with fused multiply-adds or without."""
    call = np.zeros(1, ensemble.SHAKEN)[0]
    table, whole = np.zeros((1, 1)), np.zeros((1, 1), np.int64)
    motions = (
        table,
        whole,
        table,
        whole,
        np.zeros(1),
        table,
        whole,
        np.zeros(1, OUTCOME),
    )
    entries: Entries = {
        "describe": (ensemble.describe_shaken, (call,)),
        "multiplyAdd": (ensemble.multiply_add, (call,)),
        "countBlocks": (
            ensemble.count_blocks,
            (call, np.zeros((1, 1, 2), PIVOT), *motions),
        ),
        "countStacks": (ensemble.count_stacks, (call, table, *motions)),
    }
    constants = {
        "gravity": GRAVITY, "step": STEP, "stack_step": STACK_STEP, "free_time": FREE_TIME, "block": BLOCK,
    }  # fmt: skip
    records = {
        "call": ensemble.SHAKEN,
        "body": BODY,
        "pivot": PIVOT,
        "outcome": OUTCOME,
    }
    return module_of(entries, records, constants, fused=fused)


def build_space() -> bytes:
    """Return the bytes of the module of a body in space."""
    call, tables = (
        np.zeros(1, SPACE)[0],
        [np.zeros((1, n)) for n in (3, 4, outcome.COLUMNS)],
    )
    entries: Entries = {
        "describe": (describe_solid, (call,)),
        "integrate": (integrate_solid, (call, *tables)),
    }
    constants = {
        "gravity": GRAVITY, "tolerance": TOLERANCE, "cut": CUT_OFF, "after": AFTER, "rests": outcome.RESTS,
        "window": ground.WINDOW,
        "columns": outcome.COLUMNS, "outcome": outcome.OUTCOME, "most": MOST_VERTICES,
        "sticks": NEVER_SLIDES, "fell": outcome.FELL, "certain": outcome.CERTAIN_TIME,
        "azimuth": outcome.FALL_AZIMUTH, "peak": outcome.PEAK_RATIO, "tilt": outcome.PEAK_TILT,
        "leans": outcome.LEANS, "turned": outcome.TURN, "walk": outcome.WALK_X, "held": outcome.HELD, "bond": BOND,
    }  # fmt: skip
    return module_of(
        entries, {"call": SPACE}, constants, fused=None, inlining=SPACE_INLINING
    )


def build_plane() -> bytes:
    """Return the bytes of the module of bodies in a plane that something holds."""
    call = np.zeros(1, plane.HELD)[0]
    kept = np.zeros(1, planar.SAMPLE), np.zeros(1, planar.CONTACT_EVENT)
    shaken = (call, np.zeros(1), np.zeros(1), np.zeros((1, 1)), *kept)
    entries: Entries = {
        "describe": (plane.describe_held, (call,)),
        "shake": (plane.shake_held, shaken),
    }
    constants = {
        "gravity": GRAVITY, "fell": plane.FELL, "rocked": plane.ROCKED, "leans": plane.LEANS,
        "loose": plane.LOOSE, "force": plane.FORCE, "stroke": plane.STROKE,
    }  # fmt: skip
    records = {
        "call": plane.HELD,
        "sample": planar.SAMPLE,
        "event": planar.CONTACT_EVENT,
    }
    return module_of(entries, records, constants, fused=None, inlining=PLANE_INLINING)


_VECTORS = {None: "", False: ",+simd128", True: ",+simd128,+relaxed-simd"}
"""Features by whether multiply-adds are fused; None: there are none."""

MODULES: Mapping[str, Callable[[], bytes]] = {
    "integrate": build_integrate,
    "space": build_space,
    "plane": build_plane,
    "ensemble": partial(build_ensemble, fused=False),
    "ensemble-fused": partial(build_ensemble, fused=True),
}
"""How each module is made, by its name."""


def module_of(
    entries: Entries,
    records: Mapping[str, np.dtype[Any]],
    constants: Mapping[str, float],
    *,
    fused: bool | None,
    inlining: int | None = None,
) -> bytes:
    """Compile and link entries, with the layout of records in a section of their own.

    Parameters
    ----------
    entries : kernels by the names that the page calls, with arguments of the types for which they are compiled
    records : dtypes of records by name; ``call`` is what the page hands over
    constants : numbers that the page gets, by name
    fused : whether multiply-adds are fused; None where there are none
    inlining : size above which LLVM calls a function rather than copying it; None as it does by itself

    Returns
    -------
    The bytes of the module.
    """
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    objects = [
        _object(name, *entry, fused, inlining) for name, entry in entries.items()
    ]
    layout = {name: _described(dtype) for name, dtype in records.items()}
    stated = json.dumps(
        layout | {"constants": dict(constants)}, separators=(",", ":")
    ).encode()
    # a custom section, which has the number 0, its length, and the length of its name
    section = _length(len(b"layout")) + b"layout" + stated
    return _linked(objects, list(entries)) + b"\0" + _length(len(section)) + section


def _object(
    name: str,
    function: Any,
    arguments: tuple[Any, ...],
    fused: bool | None,
    inlining: int | None,
) -> bytes:
    """Compile a function and all that it needs; it gets this name, and all others none."""
    text, entry = whole_ir(function, tuple(map(numba.typeof, arguments)))
    text = text.replace(f"@{entry}", f"@{name}").replace(f'@"{entry}"', f"@{name}")
    text = re.sub(r"^target (triple|datalayout) = .*$", "", text, flags=re.MULTILINE)
    # a square root is an instruction, not a function of a library
    text = re.sub(r"^declare double @sqrt\(double\).*$", "", text, flags=re.MULTILINE)
    text = text.replace("@sqrt(", "@llvm.sqrt.f64(")
    # as what may be fused it is made vectors of; how it is fused is said below
    text = text.replace("@llvm.fma.f64", "@llvm.fmuladd.f64")
    text = _with_short_names(text)
    # WebAssembly has no symbols that several objects may define
    text = text.replace("= common ", "= internal ")
    module = llvm.parse_assembly(text)
    machine = llvm.Target.from_triple(TRIPLE).create_target_machine(
        cpu="",
        features=FEATURES + _VECTORS[fused],
        opt=3,
        reloc="static",
        codemodel="default",
    )
    module.triple, module.data_layout = TRIPLE, str(machine.target_data)
    for symbol in [*module.functions, *module.global_variables]:
        if not symbol.is_declaration and symbol.name != name:
            symbol.linkage = "internal"
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    if inlining is not None:
        options.inlining_threshold = inlining
    options.loop_vectorization = fused is not None
    options.slp_vectorization = fused is not None
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    if fused is not None:
        module = llvm.parse_assembly(_with_multiply_adds(str(module), fused))
        module.verify()
        builder = llvm.create_pass_builder(machine, options)
        builder.getModulePassManager().run(module, builder)
    made: bytes = machine.emit_object(module)
    return made


def _with_short_names(text: str) -> str:
    """Name functions by numbers: of names beyond 1024 letters, as those with records have, LLVM reads no more."""
    numbers: dict[str, int] = {}
    return re.sub(
        r'@(_ZN[\w.$]+|"_ZN[^"]+")',
        lambda found: f"@function{numbers.setdefault(found[0], len(numbers))}",
        text,
    )


def _with_multiply_adds(text: str, fused: bool) -> str:
    """Say how multiply-adds round once: by an instruction that may fuse, or by the parts of a product (Dekker).

    What the second leaves to chance is below 2**-50 an operation.
    """
    text = re.sub(r"^declare .*@llvm\.fmuladd\..*$", "", text, flags=re.MULTILINE)
    text = text.replace("@llvm.fmuladd.v2f64", "@fma2").replace(
        "@llvm.fmuladd.f64", "@fma1"
    )
    parts = ("fused" if fused else "by-parts"), "of-one"
    return text + "".join(
        _beside(f"multiply-add-{part}.ll").read_text() for part in parts
    )


def _beside(name: str) -> Path:
    return Path(__file__).with_name(name)


def _linked(objects: list[bytes], exports: list[str]) -> bytes:
    """Link objects to one module that exports some of their functions."""
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


def _described(dtype: np.dtype[Any]) -> dict[str, Any]:
    """Size of a record and the place of each of its numbers: [offset, kind], or a record by itself."""
    fields: dict[str, Any] = {}
    for name in dtype.names or ():
        kind, offset = dtype.fields[name][:2]  # type: ignore[index]
        if kind.names is not None:
            fields[name] = {"at": offset, **_described(kind)}
        elif kind.subdtype is None:
            fields[name] = [offset, kind.kind + str(kind.itemsize)]
        else:
            # of an array the place, which is all that is asked for
            fields[name] = [offset]
    return {"size": dtype.itemsize, "fields": fields}


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
    for name in sys.argv[1:]:
        path = _beside(f"{name}.wasm")
        path.write_bytes(MODULES[name]())
        print(f"{path}: {path.stat().st_size} bytes")
    # what one process has compiled before changes the bytes
    for name in MODULES if not sys.argv[1:] else ():
        subprocess.run([sys.executable, "-m", "rockfrag.web.build", name], check=True)
