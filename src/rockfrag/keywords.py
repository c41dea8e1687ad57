"""Keywords that a function does not have are answered with the ones it has."""

import difflib
import functools
import inspect
from collections.abc import Callable
from typing import Any, TypeVar, cast, get_args, get_type_hints

from rockfrag.errors import InputError

Called = TypeVar("Called", bound=Callable[..., Any])
Made = TypeVar("Made")


class UnknownKeyword(InputError, TypeError):
    """A keyword that the function does not have."""


def named_keywords(function: Called) -> Called:
    """Let a function answer a wrong keyword with the right one, or with all there are (a decorator)."""
    known = _names_of(function)
    names = frozenset(known)

    @functools.wraps(function)
    def checked(*arguments: Any, **keywords: Any) -> Any:
        for name in keywords:
            if name not in names:
                raise UnknownKeyword(
                    _answer(function.__qualname__.removesuffix(".__init__"), name, known)
                )
        return function(*arguments, **keywords)

    return cast(Called, checked)


def named_fields(of: type[Made]) -> type[Made]:
    """Let a class answer a wrong keyword likewise (a decorator)."""
    of.__init__ = named_keywords(of.__init__)  # type: ignore[method-assign]
    return of


def _names_of(function: Callable[..., Any]) -> tuple[str, ...]:
    """Names of the arguments of a function, those of a typed ``**`` among them."""
    names: list[str] = []
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD:
            names += get_args(get_type_hints(function)[name])[0].__annotations__
        elif name != "self":
            names.append(name)
    return tuple(names)


def _answer(function: str, name: str, known: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(name, known, n=1)
    meant = f"did you mean {near[0]}?" if near else f"it has {', '.join(known)}."
    return f"{function}: no argument is called {name}; {meant}"
