"""Reading a YAML file with errors that name the place.

Values are those of YAML 1.2: ``1e-3`` is a number, and ``no``, ``12:30`` and ``1976-05-06`` are texts.
"""

import os
import re
from typing import Any

import yaml

from rockfrag.base.errors import InputError
from rockfrag.base.text_files import read_text, unfit_character

# largest configuration; three thousand names of motions are a third of it
MOST_BYTES = 256 * 1024
MOST_VALUES, DEEPEST = 20_000, 20  # values, and mappings and lists within each other


class _StrictLoader(yaml.SafeLoader):
    """PyYAML's safe loader for plain data: keys are texts and given once, values those of YAML 1.2."""

    values, depth = 0, 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Compose a value, unless there are too many or too deep ones; an alias can stand for millions."""
        self.values += 1
        coming = self.peek_event()
        if self.values > MOST_VALUES or self.depth > DEEPEST:
            much = (
                "nested too deeply"
                if self.depth > DEEPEST
                else f"more than {MOST_VALUES}"
            )
            raise _wrong(coming, f"values are {much}; simplify it")
        if self.check_event(yaml.AliasEvent):
            raise _wrong(
                coming,
                f"the alias *{coming.anchor} is not understood; write its value out",
            )
        self.depth += 1
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


def _wrong(place: Any, problem: str) -> yaml.MarkedYAMLError:
    return yaml.MarkedYAMLError(problem=problem, problem_mark=place.start_mark)


def _mapping(loader: _StrictLoader, node: yaml.MappingNode) -> dict[str, Any]:
    """A mapping whose keys are words, each given once."""
    seen: set[str] = set()
    for key, _ in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise _wrong(key, "a key must be a word, not a list or a mapping")
        _text(loader, key)
        if key.value in seen:
            raise _wrong(key, f"key {key.value!r} is given twice")
        seen.add(key.value)
    # a floor may be called 1 or 3.5, and is called by that text
    return {
        key.value: loader.construct_object(value, deep=True)
        for key, value in node.value
    }


def _text(loader: _StrictLoader, node: yaml.ScalarNode) -> str:
    """A text without characters that no text shows."""
    # an escape such as "\x07" can write what the file itself must not hold
    if unfit := unfit_character(node.value):
        raise _wrong(
            node, f"holds the character {unfit!r}, which no text shows; remove it"
        )
    return str(node.value)


def _number(loader: _StrictLoader, node: yaml.ScalarNode) -> float:
    """A floating-point number of a file, also an infinite one or none."""
    return float(
        node.value.replace(".inf", "inf").replace(".nan", "nan").replace(".NaN", "nan")
    )


_TAG = "tag:yaml.org,2002:"
_StrictLoader.yaml_constructors = {
    f"{_TAG}map": _mapping,
    f"{_TAG}seq": yaml.SafeLoader.construct_yaml_seq,
    f"{_TAG}str": _text,
    f"{_TAG}int": lambda loader, node: int(node.value),
    f"{_TAG}float": _number,
    f"{_TAG}bool": yaml.SafeLoader.construct_yaml_bool,
    f"{_TAG}null": yaml.SafeLoader.construct_yaml_null,
    None: yaml.SafeLoader.construct_undefined,
}
_StrictLoader.yaml_implicit_resolvers = {}
_FLOAT = r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.inf|\.nan|\.NaN"
for _name, _pattern, _first in (
    ("null", r"~|null|Null|NULL|", ["~", "n", "N", ""]),
    ("bool", r"true|True|TRUE|false|False|FALSE", list("tTfF")),
    ("int", r"[-+]?[0-9]+", list("-+0123456789")),
    ("float", _FLOAT, list("-+.0123456789")),
):
    _StrictLoader.add_implicit_resolver(
        f"{_TAG}{_name}", re.compile(rf"(?:{_pattern})\Z"), _first
    )


def read_yaml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read a YAML file whose top level is a mapping.

    Parameters
    ----------
    path : of the file

    Returns
    -------
    The mapping: keys are texts, values numbers, texts, booleans, None, lists or such mappings.
    """
    text = read_text(path, MOST_BYTES)
    try:
        content = yaml.load(text, Loader=_StrictLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f", line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise InputError(
            f"{path}{where}: {error.problem or 'is not valid YAML'}."
        ) from error
    except RecursionError as error:
        raise InputError(f"{path}: brackets or lists are nested too deeply.") from error
    except (yaml.YAMLError, ValueError, TypeError, LookupError) as error:
        # a tag such as !!bool stands before what is none
        raise InputError(f"{path}: is not valid YAML ({error}).") from error
    if not isinstance(content, dict):
        raise InputError(
            f"{path}: expected a mapping of keys to values, as in config/config.yaml."
        )
    return content
