"""What may be changed in a line of code: an operator, a number, a function for its counterpart.

Left alone is what means the same if it is a little larger, because it guards only: a tolerance (a number below
1e-5), what stands for infinity (above 1e6), an integer constant whose name says a limit of steps or room, and
arguments that only check or lay out. All else is changed: signs, comparisons, coefficients, indices, constants.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass

OPERATORS: dict[type[ast.AST], tuple[str, ...]] = {
    ast.Lt: ("<", "<=", ">"),
    ast.LtE: ("<=", "<", ">="),
    ast.Gt: (">", ">=", "<"),
    ast.GtE: (">=", ">", "<="),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Pow: ("**", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
}
"""Each operator, and what is written in its place."""

FUNCTIONS = {
    **{"min": "max", "sin": "cos", "all": "any", "argmin": "argmax", "floor": "ceil"},
    **{"minimum": "maximum", "nanmin": "nanmax", "first": "second", "left": "right"},
}
FUNCTIONS |= {other: name for name, other in FUNCTIONS.items()}
"""Names of functions and of attributes that have a counterpart."""

SAID = (ast.Raise, ast.JoinedStr, ast.Assert)
"""What a change of concerns words alone, or nothing."""

GUARDS = re.compile(
    r"_?(MOST|MANY|LONGEST|LARGEST|DEEPEST|TRIES|HALVINGS|NEWTON_STEPS|SWEEPS|PATIENCE|GIVE_UP|ROOM|CHUNK|AT_ONCE"
    r"|KEPT_AT_ONCE|MEMORY|STATE|LANES|BLOCK|PASSES|SEED)(_[A-Z_]+)?"
)
"""Names of constants, integers, that bound steps or room and do not enter a result."""

CHECKS = ("strict", "align", "ensure_ascii", "allow_nan", "low_memory")
"""Arguments that check, or say how something lies in memory or in a file."""

SMALLEST, LARGEST = 1e-5, 1e6
"""Numbers with a fraction beyond these are tolerances or stand for infinity."""


@dataclass(frozen=True)
class Change:
    """A part of a line, and what stands there instead; columns are of bytes."""

    line: int
    start: int
    end: int
    old: str
    new: str

    def applied(self, source: str) -> str:
        """The source with the change."""
        lines = source.encode().split(b"\n")
        whole = lines[self.line - 1]
        assert whole[self.start : self.end] == self.old.encode()
        lines[self.line - 1] = (
            whole[: self.start] + self.new.encode() + whole[self.end :]
        )
        return b"\n".join(lines).decode()


def changes_of(source: str) -> list[Change]:
    """All changes of a file that leave it a program, in their order."""
    lines = source.encode().split(b"\n")
    tree = ast.parse(source)
    found = [
        Change(line, start, start + len(old), old, new)
        for node in _of_numbers(tree)
        for line, start, old, news in _in(node, lines)
        for new in news
    ]
    return sorted(
        set(found), key=lambda change: (change.line, change.start, change.new)
    )


def _of_numbers(node: ast.AST) -> Iterator[ast.AST]:
    """The parts of a program that are not words, annotations, decorators, imports or guards."""
    if isinstance(node, SAID) or _is_a_guard(node):
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        if isinstance(node, ast.Call) and _is_of_words(node.func):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _of_numbers(child)


def _is_a_guard(node: ast.AST) -> bool:
    """Whether a part only bounds steps or room, checks, or stands for rounding or infinity."""
    if isinstance(node, ast.keyword):
        return node.arg in CHECKS
    if isinstance(node, ast.Assign):
        of_integer = isinstance(getattr(node.value, "value", None), int)
        names = [getattr(each, "id", "") for each in node.targets]
        return of_integer and all(GUARDS.fullmatch(name) for name in names)
    value = getattr(node, "value", None)
    if not isinstance(node, ast.Constant) or not isinstance(value, float):
        return False
    return value != 0.0 and not SMALLEST < abs(value) < LARGEST


def _is_of_words(function: ast.expr) -> bool:
    """Whether a call gives words to people, or types to a checker."""
    name = getattr(function, "id", getattr(function, "attr", ""))
    return name.endswith(("Error", "warn", "info", "debug", "cast", "TypeVar", "log"))


Spot = tuple[int, int, str, tuple[str, ...]]
"""Line, column, what stands there, and what may stand there instead."""


def _in(node: ast.AST, lines: list[bytes]) -> Iterator[Spot]:
    if isinstance(node, ast.Compare):
        sides = [node.left, *node.comparators]
        for k, operator in enumerate(node.ops):
            yield from _between(sides[k], sides[k + 1], operator, lines)
    elif isinstance(node, ast.BinOp):
        yield from _between(node.left, node.right, node.op, lines)
    elif isinstance(node, ast.BoolOp):
        for first, second in zip(node.values[:-1], node.values[1:], strict=True):
            yield from _between(first, second, node.op, lines)
    elif isinstance(node, ast.AugAssign) and type(node.op) in OPERATORS:
        old, new, *_ = OPERATORS[type(node.op)]
        place = lines[node.lineno - 1].find(
            f"{old}=".encode(), node.target.end_col_offset
        )
        if place >= 0:
            yield node.lineno, place, f"{old}=", (f"{new}=",)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield node.lineno, node.col_offset, "-", ("+",)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield node.lineno, node.col_offset, "not ", ("",)
    elif isinstance(node, ast.Constant):
        yield from _number(node, lines)
    elif isinstance(node, ast.Call):
        name = node.func
        word = getattr(name, "id", getattr(name, "attr", ""))
        if word in FUNCTIONS and name.end_col_offset and name.end_lineno:
            start = name.end_col_offset - len(word)
            yield name.end_lineno, start, word, (FUNCTIONS[word],)


def _between(
    first: ast.expr, second: ast.expr, operator: ast.AST, lines: list[bytes]
) -> Iterator[Spot]:
    """The operator between two parts that stand in one line."""
    old, *news = OPERATORS.get(type(operator), ("",))
    if not old or first.end_lineno != second.lineno or first.end_col_offset is None:
        return
    gap = lines[second.lineno - 1][first.end_col_offset : second.col_offset]
    if gap.count(old.encode()) == 1:
        start = first.end_col_offset + gap.index(old.encode())
        yield second.lineno, start, old, tuple(news)


def _number(node: ast.Constant, lines: list[bytes]) -> Iterator[Spot]:
    """A number or a truth that is written out."""
    value = node.value
    if node.end_col_offset is None or not isinstance(value, (bool, int, float)):
        return
    old = lines[node.lineno - 1][node.col_offset : node.end_col_offset].decode()
    if isinstance(value, bool):
        new = str(not value)
    elif isinstance(value, int):
        new = str(value + 1)
    else:
        new = repr(value * 1.25 if value else 1.0)
    yield node.lineno, node.col_offset, old, (new,)
