"""How kernels are compiled: once per machine, cached where the installation can be written."""

from collections.abc import Callable
from typing import Any

import numba


def kernel(function: Callable[..., Any]) -> Callable[..., Any]:
    """Compile ``function`` without the interpreter's lock and cache the machine code.

    Multiplications and additions may be contracted to one rounding; nothing else is reordered, so
    results do not depend on how cases are grouped or threaded.
    """
    options = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
    try:
        return numba.njit(cache=True, **options)(function)  # type: ignore[no-any-return]
    except RuntimeError:
        # numba finds no folder it may write its cache to: compile for this process alone
        return numba.njit(**options)(function)  # type: ignore[no-any-return]
