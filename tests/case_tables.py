"""Tables of cases that are text or numbers alone stand in YAML beside the tests that run them.

A text of a table knows its line, which the report of a failing case names (``conftest.py``).
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml


class Words(str):
    """A text of a table, with the number of its line."""

    line: int


class _Loader(yaml.SafeLoader):
    """YAML whose texts know their lines."""


def _words(loader: _Loader, node: yaml.ScalarNode) -> Words:
    found = Words(loader.construct_scalar(node))
    found.line = node.start_mark.line + 1
    return found


_Loader.add_constructor("tag:yaml.org,2002:str", _words)
for dumper in (yaml.SafeDumper, yaml.Dumper):
    # written again it is a plain text
    dumper.add_representer(Words, lambda own, words: own.represent_str(str(words)))


def case_tables(test_file: str) -> dict[str, Any]:
    """Tables by name of ``test_NAME.yaml`` beside ``test_NAME.py``; a row lists what a test is given."""
    path = Path(test_file).with_suffix(".yaml")
    return yaml.load(path.read_text(encoding="utf-8"), _Loader)


def lines_of(value: Any) -> Iterator[int]:
    """Numbers of the lines of all texts in what a test is given."""
    if isinstance(value, Words):
        yield value.line
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from lines_of(key)
            yield from lines_of(inner)
    elif isinstance(value, (list, tuple)):
        for inner in value:
            yield from lines_of(inner)
