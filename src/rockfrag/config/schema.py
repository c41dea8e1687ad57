"""Checking what a file holds against its schema, with one sentence for the first thing wrong.

The schemas of all files, of a study, a table of measured tests, a building and a shaker, are the
``$defs`` of ``schema.json``.
"""

import difflib
import json
import math
import re
import reprlib
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.text_files import unfit_character
from rockfrag.base.units import other_names, quantity, split_name

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator, ValidationError

# up to here each whole number is exact as a float, and fits into every file
LARGEST_WHOLE = 2**53
_Schema = Mapping[str, Any]


@cache
def read_schema(name: str) -> dict[str, Any]:
    """Read the schema of one kind of file, such as ``building``; of a ``study`` with the keys of plugins.

    Parameters
    ----------
    name : of the kind of file

    Returns
    -------
    The JSON schema, a new copy for each name once.
    """
    text = files("rockfrag.config").joinpath("schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)["$defs"][name]
    if name == "study":
        from rockfrag.config.plugins import plugins

        for plugin in plugins().values():
            schema["properties"] |= plugin.schema
    return schema


def checked(content: object, name: str, where: str) -> dict[str, Any]:
    """Check the content of a YAML file against a schema, and return it with quantities in usual units.

    In the schema the ``description`` of a key says in words what is expected, a key with ``quantity`` may be
    given in any unit of its dimension, and a rule between keys ``says`` what is wrong where it is broken.

    Parameters
    ----------
    content : what the file holds, as YAML reads it
    name, where : kind of file, and what messages call the file

    Returns
    -------
    The content with quantities under their usual keys (``width_m``), in their units.
    """
    schema = read_schema(name)
    with errors_of(where):
        for key, value in _places(content):
            for word in value if isinstance(value, Mapping) else ():
                if not isinstance(word, str):
                    raise InputError(
                        f"key {_joined(key, str(word))}: expected a word in quotes."
                    )
        plain = _in_usual_units(content, schema, "")
        for key, value in _places(plain):
            if isinstance(value, str) and (unfit := unfit_character(value)):
                raise InputError(
                    f"key {key}: holds the character {unfit!r}, which no text shows; remove it."
                )
            if isinstance(value, float) and not math.isfinite(value):
                raise InputError(f"key {key}: expected a finite number, found {value}.")
            if isinstance(value, int) and abs(value) > LARGEST_WHOLE:
                raise InputError(
                    f"key {key}: expected a number of at most {LARGEST_WHOLE}, found a larger one."
                )
    found = sorted(_validator(name).iter_errors(plain), key=_importance)
    if found:
        raise InputError(f"{where}: {_sentence(_deepest(found[0]))}")
    result: dict[str, Any] = plain
    return result


@cache
def _validator(name: str) -> "Draft202012Validator":
    """Validator of a schema, to which 1.0 is no whole number."""
    # loaded where a file is checked: the command line only reads its options from a schema
    from jsonschema import Draft202012Validator
    from jsonschema.validators import extend

    # JSON knows no difference between 1 and 1.0; a seed or a count is a whole number
    types = Draft202012Validator.TYPE_CHECKER.redefine(
        "integer",
        lambda checker, value: isinstance(value, int) and not isinstance(value, bool),
    )
    keywords = {"registered": _registered}
    validator: Draft202012Validator = extend(
        Draft202012Validator, keywords, type_checker=types
    )(read_schema(name))
    return validator


def registered(kind: str) -> tuple[str, ...]:
    """Return the names that a registry has: what a file may name grows with what is declared."""
    from rockfrag.laws import law_names
    from rockfrag.motions.intensity import measure_columns

    names: dict[str, Callable[[], tuple[str, ...]]] = {
        "law of impacts": law_names,
        "intensity measure": measure_columns,
        "growing intensity measure": lambda: measure_columns(growing=True),
    }
    return names[kind]()


def _registered(
    validator: Any, kind: str, value: Any, schema: _Schema
) -> "Iterator[ValidationError]":
    """Keyword ``registered``: the name of something that is declared."""
    from jsonschema import ValidationError

    if value not in registered(kind):
        yield ValidationError(f"one of {', '.join(registered(kind))}")


def _described(schema: _Schema, otherwise: str) -> str:
    """What is expected, in words; ``{registry}`` of two words or more is its names."""
    words = str(schema.get("description", otherwise))
    return re.sub(
        r"\{(\w+ [\w ]+)\}", lambda found: ", ".join(registered(found[1])), words
    )


def _in_usual_units(value: Any, schema: _Schema, key: str) -> Any:
    """Express every quantity in the unit of its usual key, whatever key it was given under."""
    if isinstance(value, list | tuple):
        items = schema.get("items", {})
        return [
            _in_usual_units(entry, items, f"{key}[{i}]")
            for i, entry in enumerate(value)
        ]
    if not isinstance(value, Mapping):
        return value
    properties = schema.get("properties", {})
    usual = {
        other: (name, unit)
        for name, inner in properties.items()
        if inner.get("quantity")
        for other, unit in other_names(name).items()
    }
    plain: dict[str, Any] = {}
    for name, inner in value.items():
        own, unit = usual.get(name, (name, None))
        if own in plain:
            raise InputError(
                f"key {_joined(key, name)}: {own} is given in another unit already."
            )
        where = _joined(key, name)
        if name in usual:
            plain[own] = _converted(inner, own, unit, where)
        else:
            plain[own] = _in_usual_units(inner, properties.get(name, {}), where)
    return plain


def _converted(value: Any, name: str, unit: str | None, key: str) -> Any:
    """A quantity with its unit as a number in the unit of its key."""
    if isinstance(value, list | tuple):
        return [
            _converted(number, name, unit, f"{key}[{i}]")
            for i, number in enumerate(value)
        ]
    usual = split_name(name)[1]
    if not isinstance(value, str) and unit == usual:
        return value  # the schema says what is wrong with it, if anything
    with errors_of(f"key {key}"):
        return quantity(value, usual, unit)


def _joined(key: str, name: str) -> str:
    return f"{key}.{name}" if key else name


def _places(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """Yield a value and all that it holds, each with its key, from the outside to the inside."""
    yield key, value
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _places(inner, _joined(key, str(name)))
    elif isinstance(value, list | tuple):
        for i, inner in enumerate(value):
            yield from _places(inner, f"{key}[{i}]")


def _importance(error: "ValidationError") -> tuple[int, list[str]]:
    """Order of an error, the lowest named first: what a user typed goes before what follows from it."""
    if _broken_rule(error):
        # keys that are right by themselves: last, and by no path, so in the order of the schema
        return 3, []
    # a misspelt key is also a missing one: name the misspelling, which is what the user typed
    rank = {"additionalProperties": 0, "required": 2}.get(str(error.validator), 1)
    return rank, [str(part) for part in error.absolute_path]


def _broken_rule(error: "ValidationError") -> str:
    """Sentence on a rule between keys that is broken; empty where one value is wrong."""
    schema: _Schema = error.schema if isinstance(error.schema, Mapping) else {}
    if "says" not in schema:
        return ""
    instance: Any = error.instance
    missing = [name for name in schema.get("required", ()) if name not in instance]
    named = {
        "key": _key(error),
        "name": _key(error).rpartition(".")[2],
        "found": instance,
    }
    return str(schema["says"]).format(missing=next(iter(missing), ""), **named)


_WHOLES = ("type", "const", "enum", "registered")  # keywords on a value as a whole


def _deepest(error: "ValidationError") -> "ValidationError":
    """Of the alternatives of a oneOf, take the errors of the one whose type was meant."""
    if (
        error.validator not in ("oneOf", "anyOf")
        or not error.context
        or _broken_rule(error)
    ):
        return error
    meant = [inner for inner in error.context if inner.validator not in _WHOLES]
    return _deepest(meant[0]) if meant else error


def _key(error: "ValidationError", last: str | None = None) -> str:
    """The key of an error as a user writes it, such as ``floors[2].name``."""
    key = ""
    for part in error.absolute_path:
        key = f"{key}[{part}]" if isinstance(part, int) else _joined(key, str(part))
    if last is not None:
        key = _joined(key, last)
    return key or "(top level)"


def _sentence(error: "ValidationError") -> str:
    """An error in one sentence: what was expected and what was found."""
    if broken := _broken_rule(error):
        return broken
    schema: _Schema = error.schema if isinstance(error.schema, Mapping) else {}
    instance: Any = error.instance
    if error.validator == "additionalProperties" and "properties" in schema:
        known = sorted(schema["properties"])
        wrong = sorted(name for name in instance if name not in known)[0]
        close = difflib.get_close_matches(wrong, known, n=1)
        hint = (
            f"did you mean {close[0]}?"
            if close
            else f"expected one of {', '.join(known)}."
        )
        return f"key {_key(error, _short(wrong))} is not known; {hint}"
    if error.validator == "required":
        missing = next(name for name in schema["required"] if name not in instance)
        wanted = schema.get("properties", {}).get(missing, {})
        expected = _described(wanted, "a value")
        return f"key {_key(error, missing)} is missing; expected {expected}."
    expected = _described(schema, error.message)
    return f"key {_key(error)}: expected {expected}, found {_short(instance)}."


def _short(value: Any) -> str:
    """A value in few characters."""
    return (
        value[:60]
        if isinstance(value, str) and value.isidentifier()
        else _REPR.repr(value)
    )


_REPR = reprlib.Repr()
_REPR.maxstring = _REPR.maxother = 80
