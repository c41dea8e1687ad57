"""Functions that another room imports say what goes in and out: Parameters and Returns, with shapes and units."""

import ast
from collections import defaultdict
from functools import cache
from pathlib import Path

from ..sources import tree_of

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "rockfrag"
THESIS = ROOT / "thesis" / "src" / "rockfrag_thesis"


def room_of(module: str) -> str:
    """First part of a module's name behind the package."""
    parts = module.split(".")
    if parts[0] == "rockfrag_thesis":
        return "thesis"
    return parts[1] if len(parts) > 1 else ""


@cache
def trees() -> dict[str, ast.Module]:
    found = {}
    for package, folder in (("rockfrag", SOURCE), ("rockfrag_thesis", THESIS)):
        for path in sorted(folder.rglob("*.py")):
            name = ".".join((package, *path.relative_to(folder).with_suffix("").parts))
            found[name] = tree_of(path)
    return found


@cache
def functions() -> dict[str, ast.FunctionDef]:
    """Public functions of all modules by their full names."""
    return {
        f"{name}.{node.name}": node
        for name, tree in trees().items()
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    }


@cache
def imported_elsewhere() -> set[str]:
    """Functions that a module of another room imports or calls by its module's name."""
    known, used = functions(), set()
    for name, tree in trees().items():
        modules: dict[str, str] = {}
        for node in ast.walk(tree):
            if not isinstance(node, ast.ImportFrom) or not node.module:
                continue
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                if full in known and room_of(full) != room_of(name):
                    used.add(full)
                elif full in trees():
                    modules[alias.asname or alias.name] = full
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                home = modules.get(node.value.id)
                full = f"{home}.{node.attr}"
                if full in known and room_of(full) != room_of(name):
                    used.add(full)
    return used


def missing(function: ast.FunctionDef) -> str:
    """Sections that a function's docstring lacks, empty if none."""
    words = ast.get_docstring(function) or ""
    lacks = []
    arguments = [*function.args.args, *function.args.kwonlyargs]
    if arguments and "Parameters\n---" not in words:
        lacks.append("Parameters")
    returns = function.returns
    is_none = isinstance(returns, ast.Constant) and returns.value is None
    if returns is not None and not is_none and "Returns\n---" not in words:
        lacks.append("Returns")
    return " and ".join(lacks)


def test_functions_that_other_rooms_import_have_parameters_and_returns():
    known = functions()
    assert len(imported_elsewhere()) > 200
    left = defaultdict(list)
    for name in sorted(imported_elsewhere()):
        if lacks := missing(known[name]):
            left[room_of(name)].append(f"{name}: {lacks}")
    assert not left, "\n".join(line for lines in left.values() for line in lines)


def test_a_function_without_sections_is_seen():
    plain = ast.parse('def f(a: int) -> int:\n    """Do."""').body[0]
    assert missing(plain) == "Parameters and Returns"  # type: ignore[arg-type]
