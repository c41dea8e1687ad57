"""Every definition is reached from a command, a rule, a plugin or a public name.

What is read is text, not behaviour: a definition reaches what its source names, a method is reached if its class
is and its name is used as an attribute somewhere.
"""

import ast
import builtins
import re
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from ..sources import tree_of

ROOT = Path(__file__).resolve().parents[2]
SOURCES = (ROOT / "src", ROOT / "thesis" / "src")
REGISTERING = (
    "intensity_measure",
    "declare",
    "hypothesis",
    "order_hypothesis",
    "limit_state",
    "register",
    "register_model",
    "infer_getattr",
    "unbox",
    "lower_getattr_generic",
)
"""Decorators that put a function into a table, by which it is reached."""

DOOR = re.compile(r"rockfrag.*\.(register|forget)_\w+")
"""What code of one's own calls to add an engine, a law or a measure, and to take back what it added."""

ENTRY = re.compile(r"\brockfrag\w*(?:\.\w+)*(?:[:.]\w+)?")
FUNCTION, CLASS = (ast.FunctionDef, ast.AsyncFunctionDef), ast.ClassDef


@cache
def modules() -> dict[str, ast.Module]:
    """Every module of both distributions by its name."""
    found = {}
    for source in SOURCES:
        for path in sorted(source.rglob("*.py")):
            parts = path.relative_to(source).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name] = tree_of(path)
    return found


def imported(tree: ast.AST, package: str) -> dict[str, str]:
    """Full names of what a module imports, by the names that it gives them."""
    names = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            assert node.level < 2, (
                f"{package}: import from the package itself, or from the whole"
            )
            home = ".".join(filter(None, [package if node.level else "", node.module]))
            names |= {
                name.asname or name.name: f"{home}.{name.name}" for name in node.names
            }
        elif isinstance(node, ast.Import):
            names |= {name.asname: name.name for name in node.names if name.asname}
    return names


def defined(node: ast.stmt) -> list[str]:
    """Names that a statement of a module defines."""
    if isinstance(node, (*FUNCTION, CLASS)):
        return [node.name]
    if isinstance(node, ast.AnnAssign | ast.Assign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        return [
            n.id
            for target in targets
            for n in ast.walk(target)
            if isinstance(n, ast.Name)
        ]
    return []


def is_registered(node: ast.stmt) -> bool:
    """Whether a decorator, or what makes its value, enters the definition into a table."""
    made_by = [*getattr(node, "decorator_list", ()), getattr(node, "value", None)]
    functions = [one.func if isinstance(one, ast.Call) else one for one in made_by]
    return any(
        getattr(one, "attr", getattr(one, "id", "")) in REGISTERING for one in functions
    )


class Graph:
    """Definitions by their full names, and what each of them names."""

    def __init__(self) -> None:
        self.known: dict[str, ast.stmt] = {}
        self.names: dict[str, set[str]] = defaultdict(set)
        self.attributes: dict[str, set[str]] = defaultdict(set)
        self.handed_on: dict[str, set[str]] = defaultdict(set)
        for module, tree in modules().items():
            own = {name for node in tree.body for name in defined(node)}
            self.aliases = imported(tree, module.rpartition(".")[0])
            self.aliases |= {name: f"{module}.{name}" for name in own}
            for node in tree.body:
                self._enter(module, node)

    def _enter(self, module: str, node: ast.stmt) -> None:
        if not defined(node) or is_registered(node):
            # what runs when the module is imported
            self._read(module, node)
            self.names[module] |= {f"{module}.{name}" for name in defined(node)}
        for name in defined(node):
            full = f"{module}.{name}"
            if name.startswith("__"):
                self.names[module].add(full)
            self.known[full] = node
            self.names[full].add(module)
            self._read(full, node)
            if isinstance(node, CLASS):
                external = any(
                    not self._full(base).startswith("rockfrag") for base in node.bases
                )
                for method in node.body:
                    if not isinstance(method, FUNCTION):
                        continue
                    self.known[f"{full}.{method.name}"] = method
                    self._read(f"{full}.{method.name}", method)
                    if (
                        external
                        or method.name.startswith("__")
                        or is_registered(method)
                    ):
                        self.names[full].add(f"{full}.{method.name}")

    def _full(self, node: ast.expr) -> str:
        if isinstance(node, ast.Subscript):
            return self._full(node.value)
        if isinstance(node, ast.Attribute):
            return f"{self._full(node.value)}.{node.attr}"
        name = getattr(node, "id", "")
        return (
            "rockfrag"
            if name in ("Protocol", "Generic", "NamedTuple")
            else self.aliases.get(name, name)
        )

    def _read(self, reader: str, node: ast.AST) -> None:
        """Note what a piece of source names; methods of a class are read by themselves."""
        inner = list(ast.iter_child_nodes(node))
        if isinstance(node, CLASS):
            inner = [item for item in inner if not isinstance(item, FUNCTION)]
        if isinstance(node, ast.Name):
            full = self.aliases.get(node.id, node.id)
            self.names[reader].add(full)
            if full in modules():
                self.handed_on[reader].add(full)
        elif isinstance(node, ast.Attribute):
            full = self._full(node)
            self.names[reader].add(full)
            if full.rpartition(".")[0] in modules():
                inner = []
            else:
                self.attributes[reader].add(node.attr)
        elif isinstance(node, ast.ImportFrom):
            self.names[reader] |= {
                self.aliases.get(name.asname or name.name, "") for name in node.names
            }
        elif isinstance(node, ast.Import):
            self.names[reader] |= {name.name for name in node.names}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            self._read_text(reader, node.value)
        for item in inner:
            self._read(reader, item)

    def _read_text(self, reader: str, text: str) -> None:
        """A name in quotes: an annotation that is not evaluated, or a function that is named by its module."""
        if text in modules():
            self.names[reader].add(text)
            self.handed_on[reader].add(text)
        elif re.fullmatch(r"rockfrag[\w.]*:\w+", text):
            self.names[reader].add(text.replace(":", "."))
        elif re.fullmatch(r"[\w.\[\], |]{1,200}", text):
            self.names[reader] |= {
                self.aliases[word]
                for word in re.findall(r"\w+", text)
                if word in self.aliases
            }
            self.attributes[reader] |= {text} if text.isidentifier() else set()

    def reached(self, roots: set[str]) -> set[str]:
        """Everything that roots reach."""
        seen: set[str] = set()
        used: set[str] = set()
        objects: set[str] = set(self.known) - set(modules())
        methods = defaultdict(set)
        for full in self.known:
            home, _, name = full.rpartition(".")
            methods[name].add((home, full))
        left = set(roots)
        while left:
            name = left.pop()
            if name in seen:
                continue
            seen.add(name)
            left |= self.names[name] - seen
            used |= (
                {name.removeprefix("attribute.")}
                if name.startswith("attribute.")
                else set()
            )
            used |= self.attributes[name]
            objects |= self.handed_on[name]
            # the module or the class of a name that is reached by a longer one
            left |= {name.rpartition(".")[0]} - seen - {""}
            if not left:
                made = seen & objects
                left |= {
                    full
                    for item in used
                    for home, full in methods[item]
                    if home in made
                } - seen
        return seen


def exported(known: Iterable[str]) -> Iterator[str]:
    """Public names: what the stubs of the subpackages export, with the public names in each of them."""
    inside = defaultdict(list)
    for one in known:
        home, _, name = one.rpartition(".")
        inside[home] += [one] if name[0] != "_" else []
    for source in SOURCES:
        for path in source.rglob("__init__.pyi"):
            package = ".".join(path.parent.relative_to(source).parts)
            tree = tree_of(path)
            names = imported(tree, package)
            for node in tree.body:
                if isinstance(node, ast.Assign) and isinstance(
                    node.value, ast.Attribute
                ):
                    home = names[ast.unparse(node.value.value)]
                    names[node.value.attr] = f"{home}.{node.value.attr}"
            for full in names.values():
                yield full
                yield from inside[full]


def started() -> Iterator[str]:
    """What commands, rules, entry points, the Makefile and the documented scripts start."""
    for file in ("pyproject.toml", "thesis/pyproject.toml"):
        project = tomllib.loads((ROOT / file).read_text(encoding="utf-8"))["project"]
        groups = [project.get("scripts", {}), *project.get("entry-points", {}).values()]
        yield from (
            item.replace(":", ".") for group in groups for item in group.values()
        )
    rules = [
        path
        for folder in (ROOT / "workflow", *SOURCES)
        for path in folder.rglob("*.smk")
    ]
    for path in (
        *rules,
        ROOT / "workflow" / "Snakefile",
        *(ROOT / "workflow").rglob("*.py"),
        ROOT / "Makefile",
    ):
        text = path.read_text(encoding="utf-8")
        yield from (item.replace(":", ".") for item in ENTRY.findall(text))
        for home, names in re.findall(
            r"^ *from (rockfrag[\w.]*) import (.*)$", text, re.MULTILINE
        ):
            yield from (f"{home}.{name.strip()}" for name in names.split(","))
        # what the rules ask of the study
        yield from (f"attribute.{name}" for name in re.findall(r"\bSTUDY\.(\w+)", text))
    for name, tree in modules().items():
        asked = [node.test for node in tree.body if isinstance(node, ast.If)]
        yield from (name for test in asked if "__name__" in ast.unparse(test))
    for path in (ROOT / "src").rglob("*.j2"):
        yield from (
            f"attribute.{name}"
            for name in re.findall(r"\.(\w+)", path.read_text(encoding="utf-8"))
        )
    # found by their names by Snakemake
    yield "snakemake_logger_plugin_rockfrag.LogHandler"
    yield "snakemake_logger_plugin_rockfrag"


def test_every_definition_is_reached():
    graph = Graph()
    doors = filter(DOOR.fullmatch, graph.known)
    seen = graph.reached({*exported(graph.known), *started(), *doors})
    left = [
        full for full in graph.known if full not in seen and not hasattr(builtins, full)
    ]
    assert not left, "\n".join(sorted(left))
