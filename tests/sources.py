"""Trees of the project's modules, parsed once for all tests of form."""

import ast
from functools import cache
from pathlib import Path


@cache
def tree_of(path: Path) -> ast.Module:
    """The tree of a module."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes_of(path: Path) -> list[ast.AST]:
    """Everything that stands in a module."""
    return list(ast.walk(tree_of(path)))
