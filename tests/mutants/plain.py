"""Kernels as plain Python: nothing is compiled, so that a changed one runs at once, some hundred times slower.

Records have their fields as attributes then, arrays divide by zero as IEEE 754 says, a multiply-add rounds twice.
"""

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numba
import numba.extending
import numpy as np

# what is slow to load, so that each mutant need not; nothing of the library, which is what is changed
LIBRARIES = (
    *(
        "numba",
        "pandas",
        "scipy.optimize",
        "scipy.signal",
        "scipy.stats",
        "scipy.spatial",
    ),
    *(
        "statsmodels.api",
        "matplotlib.figure",
        "obspy",
        "jinja2",
        "jsonschema",
    ),
    *("trimesh", "pyarrow.parquet", "mpmath", "h5py"),
)


def load_libraries() -> None:
    """Load what mutants need and do not change."""
    for name in LIBRARIES:
        importlib.import_module(name)


_DTYPE = np.dtype


class _OfRecords(type):
    def __instancecheck__(cls, thing: object) -> bool:
        return isinstance(thing, _DTYPE)


class _Dtype(metaclass=_OfRecords):
    """In the place of ``numpy.dtype``: a type with fields is one of records."""

    def __new__(cls, *given: Any, **named: Any) -> Any:
        made = _DTYPE(*given, **named)
        return _DTYPE((np.record, made)) if made.names else made

    def __class_getitem__(cls, _: object) -> type:
        return _DTYPE


def _as_it_is(*given: Any, **_: Any) -> Any:
    """In the place of a decorator of numba."""
    if given and callable(given[0]):
        return given[0]
    return lambda function: function


def _take_next(counter: Any) -> int:
    number = int(counter[0])
    counter[0] += 1
    return number


def _lowest_bit(bits: int) -> int:
    return (int(bits) & -int(bits)).bit_length() - 1


_INTRINSICS: dict[str, Callable[..., Any]] = {
    "fma": lambda a, b, c: a * b + c,
    "take_next": _take_next,
    "referred": lambda values: values,
    "lowest_bit": _lowest_bit,
}


def without_compiling() -> None:
    """Let what is imported from now on in this process be plain Python."""
    # compiled ones want numpy's own types
    load_libraries()
    numba.njit = _as_it_is
    numba.extending.register_jitable = _as_it_is
    numba.extending.intrinsic = lambda made: _INTRINSICS[made.__name__]
    np.dtype = _Dtype  # type: ignore[misc]
    np.seterr(all="ignore")


@contextmanager
def plain_library() -> Iterator[None]:
    """Let what is imported inside be plain Python, and the library outside be the compiled one again.

    Of a process in which nothing is compiled all stays as it is.
    """
    if numba.njit is _as_it_is:
        yield
        return
    kept = {name: sys.modules.pop(name) for name in _ours()}
    compiled = numba.njit, numba.extending.register_jitable, numba.extending.intrinsic
    numba.njit = _as_it_is
    numba.extending.register_jitable = _as_it_is
    numba.extending.intrinsic = lambda made: _INTRINSICS[made.__name__]
    try:
        yield
    finally:
        numba.njit, numba.extending.register_jitable, numba.extending.intrinsic = (
            compiled
        )
        for name in _ours():
            del sys.modules[name]
        sys.modules.update(kept)


def _ours() -> list[str]:
    """Modules of the library that are loaded."""
    return [name for name in sys.modules if name.split(".")[0] == "rockfrag"]
