"""Machine code that numba keeps between processes, and what becomes of it when its files are damaged."""

from collections.abc import Callable
from typing import Any

import numba


def cached_njit(
    stamp: Callable[[], str] | None = None, **options: Any
) -> Callable[[Any], Any]:
    """Compile a function with options of ``numba.njit`` and keep its machine code where that can be written.

    ``stamp`` gives a digest of all sources that the machine code is made of; numba looks at the function's own
    file only, and would keep code with an old copy of another function. A file of machine code that cannot be
    read is made anew, as if it were not there; without a folder for it the function is compiled for this process
    alone.
    """

    def decorate(function: Callable[..., Any]) -> Any:
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
        if hasattr(file, "load") and hasattr(file, "flush"):
            file.load = _whole_or_nothing(file.load, file.flush)
        if not options.get("_nrt", True) and hasattr(cache, "_load_overload"):
            cache.load_overload = _loading_alone(cache)
        return compiled

    return decorate


def _whole_or_nothing(
    load: Callable[[Any], Any], forget: Callable[[], None]
) -> Callable[[Any], Any]:
    def load_whole(signature: Any) -> Any:
        try:
            return load(signature)
        except OSError:
            raise
        except Exception:  # half a pickle raises nearly anything
            forget()
            return None

    return load_whole


def _loading_alone(cache: Any) -> Callable[[Any, Any], Any]:
    """Read machine code that allocates nothing without what numba does first: it gets ready to compile."""

    def load(signature: Any, target: Any) -> Any:
        with cache._guard_against_spurious_io_errors():
            return cache._load_overload(signature, target)

    return load
