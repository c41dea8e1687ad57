"""How functions of the core are compiled: as kernels of engines are, for Python and for the page alike.

Their arithmetic is plain (:mod:`rockfrag.base.exponentials`), so that command and page have the same bits. They
allocate nothing: what they leave stands in arrays that are handed to them. Machine code is kept until one of
their sources changes.

In: a Python function on numbers and arrays. Out: the same, compiled. Docs: ``docs/kernels.md``.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from rockfrag.assess.core import bodies, choices, holding
from rockfrag.base import directions, exponentials
from rockfrag.engines.compile.jit import KNOWN, compile_for_kernels, kernel
from rockfrag.runtime.machine_code import cached_njit

__all__ = ["entry_kernel", "kernel"]

for _module in (exponentials, directions, choices, bodies, holding):
    compile_for_kernels(_module)


@cache
def _digest() -> str:
    """Digest of all sources of the core."""
    digest = hashlib.sha256()
    own = sorted(Path(__file__).parent.glob("*.py"))
    for path in [*own, Path(exponentials.__file__), Path(directions.__file__)]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "_nrt": False}
if KNOWN:
    from rockfrag.engines.compile._numba import WholeCompiler

    _OPTIONS["pipeline_class"] = WholeCompiler

entry_kernel: Callable[..., Any] = cached_njit(_digest, **_OPTIONS)
"""Compile a function of the core that Python and the page call."""
