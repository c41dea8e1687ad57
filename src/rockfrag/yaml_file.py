"""Reading a YAML file with errors that name the place."""

import os
from pathlib import Path
from typing import Any

import yaml

from rockfrag.errors import InputError


class _StrictLoader(yaml.SafeLoader):
    """PyYAML's safe loader for plain data: keys are texts and given once, dates stay texts."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Refuse aliases, which no configuration needs and which can stand for millions of values."""
        if self.check_event(yaml.AliasEvent):
            event = self.peek_event()
            raise yaml.MarkedYAMLError(
                problem=f"the alias *{event.anchor} is not understood; write its value out",
                problem_mark=event.start_mark,
            )
        return super().compose_node(parent, index)


def _mapping(loader: _StrictLoader, node: yaml.MappingNode) -> dict[str, Any]:
    seen: set[str] = set()
    for key, _ in node.value:
        if not isinstance(key, yaml.ScalarNode):
            raise yaml.MarkedYAMLError(
                problem="a key must be a word, not a list or a mapping", problem_mark=key.start_mark
            )
        if key.value in seen:
            raise yaml.MarkedYAMLError(
                problem=f"key {key.value!r} is given twice", problem_mark=key.start_mark
            )
        seen.add(key.value)
    # a floor may be called 1 or 3.5, and is called by that text
    return {key.value: loader.construct_object(value, deep=True) for key, value in node.value}


_StrictLoader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, _mapping)
_StrictLoader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if not tag.endswith(":timestamp")]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def read_yaml(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Read a YAML file whose top level is a mapping.

    Raises
    ------
    InputError
        If the file cannot be read, is not UTF-8 or not YAML, gives a key twice, or is no mapping.
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
        content = yaml.load(text, Loader=_StrictLoader)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path.") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text (byte {error.start}).") from error
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f", line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        raise InputError(f"{path}{where}: {error.problem or 'is not valid YAML'}.") from error
    except RecursionError as error:
        raise InputError(f"{path}: brackets or lists are nested too deeply.") from error
    except (yaml.YAMLError, ValueError, TypeError) as error:
        raise InputError(f"{path}: is not valid YAML ({error}).") from error
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected a mapping of keys to values, as in config/thesis.yaml.")
    return content
