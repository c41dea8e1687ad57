"""Names of comprehensions: what Python 3.12.1 and 3.13.0 read unset is written nowhere.

Since PEP 709 a list, set or dict comprehension runs in its function's frame. Where it binds a name that the
function has from an enclosing one, those versions take the comprehension's name for the enclosing one, and a
function or generator inside of this one finds it without a value.
"""

import symtable
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(
    sys.version_info >= (3, 12),
    reason="newer tables of symbols have comprehensions merged into their functions",
)

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("src", "thesis/src", "tests", "thesis/tests", "benchmarks", "maintenance")
COMPREHENSIONS = {"listcomp", "setcomp", "dictcomp"}


def rebound(source: str) -> list[str]:
    """Names that a comprehension binds and its function takes from an enclosing one: function and name."""
    return list(_rebound(symtable.symtable(source, "source", "exec")))


def _rebound(scope: symtable.SymbolTable) -> Iterator[str]:
    if isinstance(scope, symtable.Function) and scope.get_name() not in COMPREHENSIONS:
        taken = set(scope.get_frees())
        for bound in _bound_by_comprehensions(scope):
            if bound in taken:
                yield f"{scope.get_name()}, line {scope.get_lineno()}: {bound}"
    for child in scope.get_children():
        yield from _rebound(child)


def _bound_by_comprehensions(scope: symtable.SymbolTable) -> Iterator[str]:
    for child in scope.get_children():
        if isinstance(child, symtable.Function) and child.get_name() in COMPREHENSIONS:
            yield from child.get_locals()
            yield from _bound_by_comprehensions(child)


def test_no_comprehension_binds_a_name_that_its_function_has_from_an_enclosing_one():
    files = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.py")]
    assert len(files) > 300
    found = [
        f"{path.relative_to(ROOT)}: {where}"
        for path in sorted(files)
        for where in rebound(path.read_text(encoding="utf-8"))
    ]
    assert not found, "\n".join(found)


ENCLOSED = """
def outer():
    level = 1
    def inner(rows):
        {body}
    return inner
"""


@pytest.mark.parametrize(
    "body",
    [
        "return sum(level for _ in rows), [level for level, _ in rows]",
        "return (lambda: level)(), {level for level in rows}",
        "return (lambda: level)(), [{level: 1 for level in row} for row in rows]",
        "return (lambda: level)(), [row for level in rows for row in level]",
    ],
)
def test_such_a_name_is_seen(body: str):
    assert rebound(ENCLOSED.format(body=body)) == ["inner, line 4: level"]


@pytest.mark.parametrize(
    "body",
    [
        "return sum(level for _ in rows), [other for other, _ in rows]",
        "return [level for level in rows]",
        "return level, sum(level for level in rows)",
        "return [level * row for row in rows]",
    ],
)
def test_what_every_version_reads_alike_is_left_alone(body: str):
    assert rebound(ENCLOSED.format(body=body)) == []
