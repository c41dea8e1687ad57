"""How kernels are compiled: once per machine, cached where the installation can be written."""

import fcntl
import gc
import hashlib
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numba


@cache
def _digest() -> str:
    """Digest of all kernels' sources.

    Numba looks at a function's own file only, and would keep using machine code that holds an old copy of
    a kernel from another file.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.rglob("_*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def entry_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``function``, which Python calls, without the interpreter's lock and cache the machine code.

    It may not allocate arrays: what it is given is borrowed from its caller, and nothing counts references
    (atomic operations that took a twentieth of the time of an ensemble).

    Arithmetic is strictly IEEE: nothing is contracted or reordered, because the compiler would do so
    differently in each place that a kernel is inlined in, and a process that has just compiled would
    then differ in the last digit from one that reads the cache.
    """
    return _compiled(function)


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``function``, which only other kernels call, as :func:`entry_kernel` does.

    What a call from Python would need is left out: it took an eighth of the time to compile.
    """
    return _compiled(function, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def inlined_kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``function`` as :func:`kernel` does, into every kernel that calls it.

    Arrays are handed on entry by entry (seven numbers each), which for functions called at every event costs
    more than they do.
    """
    return _compiled(function, no_cpython_wrapper=True, no_cfunc_wrapper=True, forceinline=True)


def _compiled(function: Callable[..., Any], **more: bool) -> Callable[..., Any]:
    options: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False, **more}
    try:
        compiled: Any = numba.njit(cache=True, **options)(function)
    except RuntimeError:
        # numba finds no folder it may write its cache to: compile for this process alone
        compiled = numba.njit(**options)(function)
    index = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
    if index is not None:
        index._source_stamp = (index._source_stamp, _digest())
    return compiled  # type: ignore[no-any-return]


@contextmanager
def compiling_alone(
    compiled: Any, halves: tuple[Callable[[], None], Callable[[], None]] | None = None
) -> Iterator[None]:
    """Hold other processes off while this one calls a kernel for the first time.

    The first of several processes that start together compiles; the others wait and read its cache.
    ``halves`` compile what the kernel calls: the first here, the second in another process meanwhile.
    """
    cached: Any = getattr(compiled, "_cache", None)
    folder = getattr(cached, "cache_path", None)
    if folder is None or compiled.signatures:
        yield
        return
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        lock = open(Path(folder) / f"{compiled.__name__}.lock", "a")  # noqa: SIM115 (closed below)
    except OSError:
        # a cache that can be read but not written needs no lock
        yield
        return
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if cached._cache_file._load_index():
            yield
            return
        # the collector finds nothing in what a compiler builds, and takes a tenth of its time
        collects = gc.isenabled()
        gc.disable()
        try:
            if halves is not None and (os.cpu_count() or 1) > 1:
                here, elsewhere = halves
                with _in_another_process(elsewhere):
                    here()
            yield
        finally:
            if collects:
                gc.enable()


@contextmanager
def _in_another_process(function: Callable[[], None]) -> Iterator[None]:
    """Call a function of a module in a process of its own meanwhile; whether it succeeds does not matter."""
    call = (
        f"import gc; gc.disable(); from {function.__module__} import {function.__name__} as f; f()"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    quiet = subprocess.DEVNULL
    try:
        other = subprocess.Popen(
            [sys.executable, "-c", call], env=environment, stdin=quiet, stdout=quiet, stderr=quiet
        )
    except OSError:
        yield
        return
    try:
        yield
        other.wait()
    finally:
        other.kill()
        other.wait()
