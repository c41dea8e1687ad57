"""Print how densely the code is written, beside packages that read well: to look at, not to be met.

    .venv/bin/python maintenance/reading.py

Size is nodes of the syntax tree, not lines: packing a line changes nothing. Of templates and scripts the words are
counted in their place.
"""

import ast
import re
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("src", "thesis/src")
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
ANCHORS = "pygmm 7.7, pooch 6.6, diffrax 6.3 nodes a line; 3 to 8 comprehensions, 2 to 4 conditional expressions"
"""The same numbers of packages that read well, counted in the same way."""

_WORD = re.compile(r"\w+|[^\w\s]")
_DECISION = re.compile(r"\{%-?\s*(?:el)?if\b|\{\{[^}]*\bif\b[^}]*\}\}")
_COMPARISON = re.compile(r"\{[%{][^%}]*(?:[<>]=?|[!=]=)[^%}]*[%}]\}")


def main() -> int:
    """Print a line a number; return 0."""
    code = [ast.parse(text) for text in _texts("*.py")]
    lines = sum(len(_lines_of_code(tree)) for tree in code)
    nodes = [node for tree in code for node in ast.walk(tree)]
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    described = [_has_sections(function) for function in functions]
    templates, scripts = "".join(_texts("*.j2")), "".join(_texts("*.js"))
    told = {
        "nodes of Python": len(nodes),
        "words of templates": len(_WORD.findall(templates)),
        "words of JavaScript": len(_WORD.findall(scripts)),
        "lines of code": lines,
        "nodes a line": round(len(nodes) / lines, 1),
        "comprehensions in 1000 lines": _in_thousand(nodes, COMPREHENSIONS, lines),
        "conditional expressions in 1000 lines": _in_thousand(nodes, ast.IfExp, lines),
        "functions": len(functions),
        "functions with sections": sum(described),
        "functions without a docstring": sum(
            ast.get_docstring(function) is None for function in functions
        ),
        "decisions in templates": len(_DECISION.findall(templates)),
        "comparisons in templates": len(_COMPARISON.findall(templates)),
    }
    for name, number in told.items():
        print(f"{name:40}{number:>10}")
    print(f"beside: {ANCHORS}")
    return 0


def _texts(pattern: str) -> list[str]:
    paths = (path for folder in FOLDERS for path in (ROOT / folder).rglob(pattern))
    return [path.read_text(encoding="utf-8") for path in sorted(paths)]


def _lines_of_code(tree: ast.AST) -> set[int]:
    """Lines on which something begins, docstrings left out."""
    words = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    return {
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, (ast.stmt, ast.expr)) and id(node) not in words
    }


def _has_sections(function: ast.FunctionDef) -> bool:
    said = ast.get_docstring(function) or ""
    return "Parameters\n---" in said or "Returns\n---" in said


def _in_thousand(
    nodes: Iterable[ast.AST], kind: type | tuple[type, ...], lines: int
) -> float:
    return round(1000 * sum(isinstance(node, kind) for node in nodes) / lines, 1)


if __name__ == "__main__":
    sys.exit(main())
