"""The house: data flows one way, and no room knows what belongs to a guest."""

import ast
import re
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[1] / "src" / "rockfrag"
ROOMS = (
    *("records", "motions", "building", "system", "outcomes", "engines", "rocking"),
    *("shaketable", "fragility", "campaign", "pedestal"),
    *("study", "stages", "report", "assess", "survival"),
)
"""From left to right; a room imports from those before it."""

LIBRARY = ROOMS[: ROOMS.index("study")]
SPECIMENS = {"T1", "T2", "T3", "P&T1", "P&T2", "P&T3"}
FLOORS = {"GF", "F3", "F5"}
TEXTS = (".py", ".pyi", ".json", ".j2", ".css", ".js")
STATEMENT = re.compile(r"C[1-9]\d?")


def sources(room: str) -> list[Path]:
    return sorted((SOURCE / room).rglob("*.py"))


def imported_rooms(path: Path) -> set[str]:
    """Rooms that a file imports from, at its top or in a function."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
        elif isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
    split = (name.split(".") for name in names)
    return {parts[1] for parts in split if parts[0] == "rockfrag" and len(parts) > 1}


@pytest.mark.parametrize("room", ROOMS)
def test_room_imports_from_the_left_only(room):
    allowed = set(ROOMS[: ROOMS.index(room) + 1])
    looked_at = 0
    for path in sources(room):
        beyond = (imported_rooms(path) & set(ROOMS)) - allowed
        assert not beyond, f"{path.relative_to(SOURCE)} imports from {', '.join(sorted(beyond))}"
        looked_at += 1
    assert looked_at > 3


@pytest.mark.parametrize("room", LIBRARY)
def test_room_of_the_library_names_no_specimen_floor_or_statement_of_a_study(room):
    looked_at = 0
    for path in sources(room):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                words = {node.value, *re.findall(r"``([^`]+)``", node.value)}
                known = words & (SPECIMENS | FLOORS)
                known |= {word for word in words if STATEMENT.fullmatch(word)}
                assert not known, f"{path.relative_to(SOURCE)}:{node.lineno} names {sorted(known)}"
                looked_at += 1
    assert looked_at > 20


def test_the_library_has_no_word_of_the_thesis():
    files = [path for path in SOURCE.rglob("*") if path.suffix in TEXTS]
    assert len(files) > 400
    for path in files:
        words = re.findall(r"[a-z]*thesis", path.read_text(encoding="utf-8").casefold())
        assert set(words) <= {"hypothesis", "parenthesis"}, path


def test_nothing_imports_snakemake():
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [a.name for a in node.names] if isinstance(node, ast.Import) else []
            assert not [name for name in names if name.split(".")[0] == "snakemake"], path
