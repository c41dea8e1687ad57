"""Code opens what it packs: few positional arguments, one thing a line, templates that only lay out."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from ..sources import tree_of

ROOT = Path(__file__).resolve().parents[2]
SOURCES = (ROOT / "src", ROOT / "thesis" / "src")
MOST_POSITIONAL = 5

COMPILED = {"rockfrag/system/geometry.py", "rockfrag/base/elementary.py"}
"""Modules that kernels compile, which take no names."""


@cache
def modules() -> dict[str, ast.Module]:
    """Trees of all modules, by their paths."""
    found = {}
    for folder in SOURCES:
        for path in sorted(folder.rglob("*.py")):
            name = path.relative_to(folder).as_posix()
            found[name] = tree_of(path)
    assert len(found) > 200
    return found


def positional(function: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> int:
    """Count the arguments that may be given without a name."""
    arguments = [*function.args.posonlyargs, *function.args.args]
    return sum(argument.arg not in ("self", "cls") for argument in arguments)


def is_kernel(function: ast.AST) -> bool:
    """Whether a decorator names a kernel, or numba's compiler, whose functions take no names."""
    decorators = getattr(function, "decorator_list", ())
    return any(
        "kernel" in ast.unparse(each) or "njit" in ast.unparse(each)
        for each in decorators
    )


def wide(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            continue
        if positional(node) > MOST_POSITIONAL and not is_kernel(node):
            yield node.lineno, getattr(node, "name", "lambda")


def packed_arguments(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Calls with a tuple of arguments that the function itself packed under a name."""
    for function in ast.walk(tree):
        if not isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        packed = set()
        for node in ast.walk(function):
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple):
                packed |= {
                    target.id for target in node.targets if isinstance(target, ast.Name)
                }
        for node in ast.walk(function):
            if isinstance(node, ast.Call):
                for argument in node.args:
                    if not isinstance(argument, ast.Starred):
                        continue
                    value = argument.value
                    if isinstance(value, ast.Name) and value.id in packed:
                        yield node.lineno, f"*{value.id}"
                    elif isinstance(value, ast.Tuple):
                        yield node.lineno, ast.unparse(argument)


def loops_that_raise(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, ast.For) or not isinstance(node.body[-1], ast.Raise):
            continue
        if all(isinstance(line, (ast.Assign, ast.Raise)) for line in node.body):
            yield node.lineno, ast.unparse(node.target)


def chains(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Assignments to several names at once of anything but a plain number, text or name."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.Assign) or len(node.targets) < 2:
            continue
        if not isinstance(node.value, (ast.Constant, ast.Name, ast.UnaryOp)):
            yield node.lineno, ast.unparse(node)[:60]


def unpacked_generators(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, ast.Assign):
            continue
        target, value = node.targets[0], node.value
        is_unpacked = isinstance(target, (ast.Tuple, ast.List)) and not any(
            isinstance(each, ast.Starred) for each in target.elts
        )
        if is_unpacked and isinstance(value, (ast.GeneratorExp, ast.ListComp)):
            yield node.lineno, ast.unparse(target)


LONGEST_WITHOUT_WORDS = 9
"""Lines of a function that needs no docstring: its name and its body say what it takes and gives."""


def without_words(tree: ast.Module) -> Iterator[tuple[int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        lines = (node.end_lineno or node.lineno) - node.lineno + 1
        is_special = node.name.startswith("__")
        needs_words = lines > LONGEST_WITHOUT_WORDS and not is_special
        if needs_words and not ast.get_docstring(node):
            yield node.lineno, node.name


WIDE = "at most five positional arguments"
RULES = {
    WIDE: wide,
    "no arguments packed in a tuple": packed_arguments,
    "no loop whose body only raises": loops_that_raise,
    "no chain of assignments": chains,
    "no generator unpacked into names": unpacked_generators,
    "what a function of ten lines takes and gives is said": without_words,
}


@pytest.mark.parametrize("rule", RULES)
def test_code_is_open(rule):
    found = [
        f"{name}:{line}: {words}"
        for name, tree in modules().items()
        for line, words in RULES[rule](tree)
        if not (rule == WIDE and name in COMPILED)
    ]
    assert not found, f"{rule}:\n" + "\n".join(found)


@pytest.mark.parametrize(
    ("rule", "code"),
    [
        ("at most five positional arguments", "def f(a, b, c, d, e, f): ..."),
        ("no arguments packed in a tuple", "def f():\n x = (1, 2)\n g(*x)"),
        ("no loop whose body only raises", "for x in y:\n raise E(x)"),
        ("no chain of assignments", "a = b = f()"),
        ("no generator unpacked into names", "a, b = (f(x) for x in (1, 2))"),
        (
            "what a function of ten lines takes and gives is said",
            "def f():\n" + 9 * " x = 1\n",
        ),
    ],
)
def test_each_rule_sees_what_it_forbids(rule, code):
    assert list(RULES[rule](ast.parse(code)))


def templates() -> dict[str, str]:
    """Texts of all templates by their paths."""
    found = {}
    for folder in SOURCES:
        for path in sorted(folder.rglob("*.j2")):
            name = path.relative_to(folder / "rockfrag").as_posix()
            found[name] = path.read_text(encoding="utf-8")
    assert found
    return found


BLOCK = re.compile(r"\{%-?(.*?)-?%\}|\{\{-?(.*?)-?\}\}", re.DOTALL)
DECIDES = re.compile(r"==|!=|<=|>=|[<>]|[-+*/%](?![-%}])|\bsum\b|\bround\b")
TEXT = re.compile(r"\"[^\"]*\"|'[^']*'")
EQUALS_A_WORD = re.compile(r"\w+ == \"\"")


def decisions(text: str) -> list[str]:
    """Comparisons of numbers and arithmetic in a template; a comparison with a word lays out."""
    found = []
    for block in BLOCK.finditer(text):
        code = block[1] or block[2]
        plain = EQUALS_A_WORD.sub("", TEXT.sub('""', code))
        if DECIDES.search(plain):
            found.append(code.strip())
    return found


@pytest.mark.parametrize("name", templates())
def test_a_template_lays_out_and_decides_nothing(name):
    assert not decisions(templates()[name])


@pytest.mark.parametrize(
    "code",
    [
        "{% if p < 0.05 %}",
        "{{ 100 * share }}",
        "{% set bound = 1.0 - 0.1 ** n %}",
        "{% if a == b %}",
    ],
)
def test_a_decision_in_a_template_is_seen(code):
    assert decisions(code)


def test_no_macro_is_called_by_a_string_and_no_form_feed_separates_words():
    for name, tree in modules().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                is_class = node.value.startswith("[")
                assert "\f" not in node.value or is_class, f"{name}:{node.lineno}"
            if isinstance(node, ast.Attribute) and node.attr == "module":
                owner = ast.unparse(node.value)
                assert "get_template" not in owner, f"{name}:{node.lineno}"


def test_macros_have_at_most_five_arguments():
    for name, text in templates().items():
        for macro, arguments in re.findall(r"\{%-? *macro (\w+)\((.*?)\)", text):
            count = len([each for each in arguments.split(",") if each.strip()])
            assert count <= MOST_POSITIONAL, f"{name}: {macro}"


MOST_LETTERS = 88
SCRIPTS = (ROOT / "src", ROOT / "tests")


def long_lines(text: str) -> list[str]:
    """Lines of a script that are too long, but for those that are one text."""
    too_long = [line.strip() for line in text.splitlines() if len(line) > MOST_LETTERS]
    return [line for line in too_long if not re.fullmatch(r"([\"'`]).*\1[,;]?", line)]


def declared_together(text: str) -> list[str]:
    """Declarations of a script that name several things, but in the head of a loop."""
    return re.findall(
        r"^ *(?:const|let) .*,$|^ *(?:const|let) \w+, .*", text, re.MULTILINE
    )


def scripts() -> list[Path]:
    """All scripts of the package and of its tests."""
    found = [path for folder in SCRIPTS for path in sorted(folder.rglob("*.js"))]
    assert len(found) > 25
    return found


@pytest.mark.parametrize("seen", [long_lines, declared_together])
def test_scripts_are_open_too(seen):
    """As prettier lays them out (``.prettierrc``)."""
    packed = {path.name: seen(path.read_text(encoding="utf-8")) for path in scripts()}
    assert not {name: lines for name, lines in packed.items() if lines}


def test_packed_scripts_are_seen():
    packed = f"const a = 1,\nlet b, c;\nconst d = [{'1, ' * 40}];\n"
    assert [len(seen(packed)) for seen in (long_lines, declared_together)] == [1, 2]
