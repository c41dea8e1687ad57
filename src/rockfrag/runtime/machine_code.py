"""Machine code that numba keeps between processes, and what becomes of it when its files are damaged."""

import hashlib
import pickle
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numba


def cached_njit(
    stamp: Callable[[], str] | None = None, **options: Any
) -> Callable[[Any], Any]:
    """Compile a function with options of ``numba.njit`` and keep its machine code where that can be written.

    ``stamp`` gives a digest of all sources that the machine code is made of; numba looks at the function's own
    file only, and would keep code with an old copy of another function. A file of machine code that is damaged or
    may not be read is made anew, as if it were not there; without a folder for it, or where it may not be written,
    the function is compiled for this process alone.

    Parameters
    ----------
    stamp : gives the digest of the sources, None where the function calls no other
    **options : of ``numba.njit``

    Returns
    -------
    A decorator that compiles a function.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        """Compile a function, with its machine code kept in a file where that is possible."""
        try:
            compiled: Any = numba.njit(cache=True, **options)(function)
        except RuntimeError:
            # numba finds no folder that it may write to
            return numba.njit(**options)(function)
        # numba does not document these: with a version that lacks them the cache is as it was, or is not used
        cache: Any = getattr(compiled, "_cache", None)
        file: Any = getattr(cache, "_cache_file", None)
        if stamp is not None:
            if not hasattr(file, "_source_stamp"):
                return numba.njit(**options)(function)
            file._source_stamp = (file._source_stamp, stamp())
        if all(hasattr(file, name) for name in _OF_A_FILE):
            _seal(file)
        if not options.get("_nrt", True) and hasattr(cache, "_load_overload"):
            cache.load_overload = _loading_alone(cache)
        return compiled

    return decorate


def is_kept(function: Any) -> bool:
    """Whether the machine code of a function is at hand, so that calling it compiles nothing.

    Parameters
    ----------
    function : as :func:`cached_njit` has made it

    Returns
    -------
    Whether it is, as far as numba says so.
    """
    if function.signatures:
        return True
    file: Any = getattr(getattr(function, "_cache", None), "_cache_file", None)
    try:
        return bool(file._load_index())
    except Exception:  # a folder that is not there, a damaged file, another numba
        return False


_OF_A_FILE = ("load", "save", "flush", "_dump", "_load_data", "_data_path")
"""What is asked of numba's file of machine code."""

_SEAL = hashlib.sha256().digest_size  # bytes of the digest at the end of a file


def _seal(file: Any) -> None:
    """Let a digest stand behind what numba writes of a function, and read nothing that it does not fit."""
    dump, load, save = file._dump, file.load, file.save

    def sealed(content: Any) -> bytes:
        written: bytes = dump(content)
        return written + hashlib.sha256(written).digest()

    def load_data(name: str) -> Any:
        """Machine code of a file whose seal is right."""
        found = Path(file._data_path(name)).read_bytes()
        content, seal = found[:-_SEAL], found[-_SEAL:]
        if hashlib.sha256(content).digest() != seal:
            raise ValueError(f"{name} is damaged")
        return pickle.loads(content)

    def load_whole(signature: Any) -> Any:
        """Machine code of a file, None where it is damaged."""
        try:
            return load(signature)
        except Exception:  # half a pickle raises nearly anything
            with suppress(OSError):
                file.flush()
            return None

    def save_if_allowed(signature: Any, content: Any) -> None:
        # a full disk, or an index of another user in a folder where it cannot be replaced
        with suppress(OSError):
            save(signature, content)

    file._dump, file._load_data = sealed, load_data
    file.load, file.save = load_whole, save_if_allowed


def _loading_alone(cache: Any) -> Callable[[Any, Any], Any]:
    """Read machine code that allocates nothing without what numba does first: it gets ready to compile."""

    def load(signature: Any, target: Any) -> Any:
        with cache._guard_against_spurious_io_errors():
            return cache._load_overload(signature, target)

    return load
