"""How kernels are compiled, and why so: ``docs/kernels.md``, "How kernels are compiled".

``kernel`` marks a function that other kernels call, ``entry_kernel`` one that Python calls: machine code is made
for these alone, once per machine, and cached.  Arithmetic is strictly IEEE; kernels may not allocate arrays.
"""

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numba
from numba import types
from numba.extending import intrinsic, register_jitable

from rockfrag.base import elementary
from rockfrag.base.errors import InputError
from rockfrag.engines.compile.contents import contents_of
from rockfrag.laws import couple, laws, position
from rockfrag.runtime.lock import locked
from rockfrag.runtime.machine_code import cached_njit
from rockfrag.system import geometry

TESTED_NUMBA = ("0.68.",)
"""Versions of numba whose private parts are known to be as this module takes them to be."""

# how long a process waits for another one that compiles the same [s]
PATIENCE_S = 300.0
KNOWN = numba.__version__.startswith(TESTED_NUMBA)

if KNOWN:
    from rockfrag.engines.compile._numba import PartCompiler, WholeCompiler


@cache
def _sources() -> bytes:
    """Sources of all kernels: those of engines, of laws, of the arithmetic and of bodies."""
    package = Path(__file__).parents[2]
    paths = [
        # of rooms of engines; what stands beside them is no kernel
        *sorted((package / "engines").glob("*/**/*.py")),
        *sorted((package / "laws").glob("*.py")),
        Path(elementary.__file__),
        Path(geometry.__file__),
    ]
    return b"".join(path.read_bytes() for path in paths)


def _digest() -> str:
    """Digest of all that is compiled into kernels, by which their machine code is kept.

    Laws may have been declared elsewhere, so that the sources do not hold them: theirs is all that they compute
    with, whenever they were declared.
    """
    digest = hashlib.sha256(_sources())
    for law in laws():
        rate = "" if law.rate is None else contents_of(law.rate)
        digest.update(f"{law.name} {law.number} {rate}\n".encode())
    return digest.hexdigest()


_EVERY: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
_WHOLE: dict[str, Any] = {}
_PART: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
if KNOWN:
    _WHOLE["pipeline_class"], _PART["pipeline_class"] = WholeCompiler, PartCompiler

if getattr(numba.config, "DISABLE_JIT", 0):
    raise InputError(
        "NUMBA_DISABLE_JIT is set, and kernels are what they are as machine code only; unset it."
    )

entry_kernel: Callable[..., Any] = cached_njit(_digest, **_EVERY, **_WHOLE)
"""Compile a function that Python calls, without the interpreter's lock, and cache the machine code."""

kernel: Callable[..., Any] = numba.njit(**_EVERY, **_PART)
"""Mark a function that only kernels call; it may be inlined or not."""

inlined_kernel: Callable[..., Any] = numba.njit(**_EVERY, **_PART, forceinline=True)
"""Mark a function that only kernels call as always inlined: what is called at every contact event."""


def compile_for_kernels(module: ModuleType) -> None:
    """Let kernels call the functions of a module, plain Python, as if they were some of them.

    Parameters
    ----------
    module : of plain functions of numbers and records
    """
    for function in list(vars(module).values()):
        if (
            isinstance(function, FunctionType)
            and function.__module__ == module.__name__
        ):
            register_jitable(**_EVERY, **_PART)(function)


for _module in (elementary, geometry, couple, position):
    compile_for_kernels(_module)


@contextmanager
def compiling_alone(entry: Any) -> Iterator[None]:
    """Let the first of several processes compile an entry kernel; the others wait, at most ``PATIENCE_S``."""
    folder: Any = getattr(getattr(entry, "_cache", None), "cache_path", None)
    alone = folder and not entry.overloads
    with (
        locked(Path(folder) / f"{entry.__name__}.lock", PATIENCE_S)
        if alone
        else nullcontext()
    ):
        yield


@intrinsic
def fma(typing_context, a, b, c):  # type: ignore[no-untyped-def]
    """Return a b + c, rounded once: everywhere the same, unlike multiply-adds that a compiler chooses.

    Parameters
    ----------
    typing_context : numba's
    a, b, c : numbers
    """

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), generate


@intrinsic
def take_next(typing_context, counter):  # type: ignore[no-untyped-def]
    """Return the first entry of an integer array and add 1 to it, in one step that no thread can interrupt."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        unit = context.get_constant(types.int64, 1)
        return builder.atomic_rmw("add", array.data, unit, "monotonic")

    return types.int64(counter), generate


@intrinsic
def lowest_bit(typing_context, bits):  # type: ignore[no-untyped-def]
    """Return the place of the lowest bit that is set in an integer that is not zero."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.cttz(arguments[0], context.get_constant(types.boolean, True))

    return types.int64(types.int64), generate
