"""Keywords that are not there are answered with those that are, and messages speak of what the user has."""

import difflib
import functools
import inspect
import re
from collections.abc import Callable
from typing import Any, TypeVar, cast, get_args, get_type_hints

from rockfrag.base.errors import InputError

Called = TypeVar("Called", bound=Callable[..., Any])
Made = TypeVar("Made")


class UnknownKeyword(InputError, TypeError):
    """A keyword that the function does not have."""


def named_keywords(function: Called) -> Called:
    """Let a function answer a wrong keyword with the right one, or with all there are (a decorator).

    Parameters
    ----------
    function : that is public

    Returns
    -------
    The function, which raises :class:`UnknownKeyword` for a keyword that it lacks.
    """
    known = _names_of(function)
    names = frozenset(known)

    @functools.wraps(function)
    def checked(*arguments: Any, **keywords: Any) -> Any:
        """Call the function; a keyword that it has not is refused, with the nearest one that it has."""
        for name in keywords:
            if name not in names:
                near = difflib.get_close_matches(name, known, n=1)
                meant = (
                    f"did you mean {near[0]}?"
                    if near
                    else f"it has {', '.join(known)}."
                )
                called = function.__qualname__.removesuffix(".__init__")
                raise UnknownKeyword(f"{called}: no argument is called {name}; {meant}")
        return function(*arguments, **keywords)

    return cast(Called, checked)


def named_fields(of: type[Made]) -> type[Made]:
    """Let a class answer a wrong keyword likewise (a decorator).

    Parameters
    ----------
    of : a class with an ``__init__``, such as a dataclass

    Returns
    -------
    The class itself.
    """
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


_OPTION = re.compile(r"\b(unit|dt|channel|force|cut_short)=(?:True\b)?")
_FORCED = " with force=True or in the file"


def for_command_line(message: object, force: bool = True) -> str:
    """Return a message that names arguments of functions with the options of ``rockfrag`` instead.

    Parameters
    ----------
    message : of an :class:`InputError`
    force : whether the command has an option ``--force``

    Returns
    -------
    The message with ``--cut-short`` in the place of ``cut_short=``.
    """
    words = str(message) if force else str(message).replace(_FORCED, " in the file")
    return _OPTION.sub(lambda found: f"--{found[1].replace('_', '-')}", words)


def for_catalogue(message: object) -> str:
    """Return a message that names arguments of functions with the columns of a catalogue instead.

    Parameters
    ----------
    message : of an :class:`InputError`

    Returns
    -------
    The message with ``the column unit`` in the place of ``unit=``.
    """
    words = str(message).replace(_FORCED, " in the file")
    return _OPTION.sub(lambda found: f"the column {found[1]}", words)
