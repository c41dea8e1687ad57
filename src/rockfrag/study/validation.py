"""Checking a configuration against its JSON schema, with one sentence for the first thing wrong."""

import difflib
import json
import math
from collections.abc import Iterator, Mapping
from importlib.resources import files
from typing import Any

from jsonschema import Draft202012Validator, ValidationError

from rockfrag.errors import InputError


def read_schema(name: str) -> dict[str, Any]:
    """Read a schema that is part of this package, for example ``study.schema.json``."""
    text = files("rockfrag.study").joinpath(name).read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def check_schema(content: Mapping[str, Any], schema: Mapping[str, Any], where: str) -> None:
    """Check a configuration against a schema.

    Parameters
    ----------
    content
        The configuration as read.
    schema
        Its JSON schema; ``description`` of a key says what is expected, in words.
    where
        The file it came from, for the message.

    Raises
    ------
    InputError
        One sentence that names the file, the key, what was expected and what was found.
    """
    for key, value in _leaves(content):
        if isinstance(value, float) and not math.isfinite(value):
            sentence = f"key {key}: expected a finite number, found {value}."
            raise InputError(f"{where}: {_printable(sentence)}")
    found = sorted(Draft202012Validator(schema).iter_errors(content), key=_importance)
    if found:
        raise InputError(f"{where}: {_printable(_sentence(_deepest(found[0])))}")


def _printable(text: str) -> str:
    """Escape what would break the line, such as a key that holds a line feed."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def _leaves(value: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _leaves(inner, f"{key}.{name}" if key else str(name))
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _leaves(inner, f"{key}[{i}]")
    else:
        yield key, value


def _importance(error: ValidationError) -> tuple[int, list[str]]:
    # a misspelt key is also a missing one: name the misspelling, which is what the user typed
    rank = {"additionalProperties": 0, "required": 2}.get(str(error.validator), 1)
    return rank, [str(part) for part in error.absolute_path]


def _deepest(error: ValidationError) -> ValidationError:
    """Of the alternatives of a oneOf, take the errors of the one whose type was meant."""
    if error.validator not in ("oneOf", "anyOf") or not error.context:
        return error
    meant = [inner for inner in error.context if inner.validator not in ("type", "const", "enum")]
    return _deepest(meant[0]) if meant else error


def _key(error: ValidationError, last: str | None = None) -> str:
    key = ""
    for part in error.absolute_path:
        key += f"[{part}]" if isinstance(part, int) else f".{part}"
    if last is not None:
        key += f".{last}"
    return key.lstrip(".") or "(top level)"


def _expected(schema: Mapping[str, Any], fallback: str) -> str:
    return str(schema.get("description", fallback))


def _sentence(error: ValidationError) -> str:
    schema: Mapping[str, Any] = error.schema if isinstance(error.schema, Mapping) else {}
    instance: Any = error.instance
    if error.validator == "additionalProperties":
        known = sorted(schema.get("properties", {}))
        wrong = sorted(str(name) for name in instance if name not in known)[0]
        close = difflib.get_close_matches(wrong, known, n=1)
        hint = f"did you mean {close[0]}?" if close else f"expected one of {', '.join(known)}."
        return f"key {_key(error, wrong)} is not known; {hint}"
    if error.validator == "required":
        missing = next(name for name in schema["required"] if name not in instance)
        wanted = schema.get("properties", {}).get(missing, {})
        return f"key {_key(error, missing)} is missing; expected {_expected(wanted, 'a value')}."
    return (
        f"key {_key(error)}: expected {_expected(schema, error.message)}, "
        f"found {json.dumps(instance, ensure_ascii=False, default=str)}."
    )
