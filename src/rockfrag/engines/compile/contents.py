"""What a function does, as text: the same in every process, another where anything it computes with is another.

In: a Python function or a kernel. Out: text that belongs into a digest. Machine code is kept by such digests
(``docs/kernels.md``, "How kernels are compiled"): whatever is compiled into it has to change them.
"""

from collections.abc import Iterable, Iterator
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

PLAIN = (bool, int, float, complex, str, bytes, type(None), np.generic)
"""Types whose ``repr`` says all of a value, and the same in every process."""


def contents_of(function: Any) -> str:
    """Return all that a function computes with: its code, and the values and functions that it names.

    Parameters
    ----------
    function : of Python, or compiled from one

    Returns
    -------
    Text, the same for two functions that compute the same from the same source, whatever the process.
    """
    return "\n".join(_function(function, set()))


def _function(function: Any, seen: set[int]) -> Iterator[str]:
    """Contents of a function that is not among those ``seen``, and of what it calls."""
    plain = getattr(function, "py_func", function)
    if not isinstance(plain, FunctionType):
        yield f"{type(function).__module__}.{getattr(function, '__qualname__', type(function).__qualname__)}"
        return
    if id(plain) in seen:
        yield plain.__qualname__
        return
    seen.add(id(plain))
    yield from _code(plain.__code__)
    yield from _value(plain.__defaults__, (), seen)
    for cell in plain.__closure__ or ():
        yield from _value(cell.cell_contents, (), seen)
    names = tuple(_names(plain.__code__))
    for name in dict.fromkeys(names):
        if name in plain.__globals__:
            yield name
            yield from _value(plain.__globals__[name], names, seen)


def _code(code: CodeType) -> Iterator[str]:
    """Instructions, names and constants of code, and of the functions written inside of it."""
    yield code.co_code.hex()
    yield " ".join((*code.co_names, *code.co_varnames, *code.co_freevars))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield from _value(constant, (), set())


def _names(code: CodeType) -> Iterator[str]:
    """Names that code looks up outside of itself."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _names(constant)


def _value(value: Any, names: Iterable[str], seen: set[int]) -> Iterator[str]:
    """Contents of a value; of a module those of its parts with such names."""
    if isinstance(value, PLAIN):
        yield repr(value)
    elif isinstance(value, (tuple, list)):
        yield f"{len(value)} values"
        for part in value:
            yield from _value(part, (), seen)
    elif isinstance(value, (set, frozenset)):
        # in an order that does not change from process to process
        yield from sorted("\n".join(_value(part, (), seen)) for part in value)
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    elif isinstance(value, ModuleType):
        yield value.__name__
        for name in dict.fromkeys(names):
            if name in vars(value) and not isinstance(vars(value)[name], ModuleType):
                yield name
                yield from _value(vars(value)[name], (), seen)
    else:
        yield from _function(value, seen)
