"""The architecture: data flows one way, no subpackage knows a plugin, identifiers hold the words of the field."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from ..case_tables import case_tables
from ..sources import nodes_of

SOURCE = Path(__file__).resolve().parents[2] / "src" / "rockfrag"
THESIS = SOURCE.parents[1] / "thesis" / "src"
SUBPACKAGES = (
    *("base", "runtime", "words", "collections"),
    *("records", "motions", "system", "laws", "outcomes", "config", "building"),
    *("engines", "simulation", "web", "shaketable"),
    *("fragility", "campaign", "effects"),
    *("study", "stages", "report", "assess", "aftermath", "survival", "cli"),
)
"""From left to right; a room imports from those before it."""

LIBRARY = SUBPACKAGES[: SUBPACKAGES.index("study")]
SPECIMENS = {"T1", "T2", "T3", "P&T1", "P&T2", "P&T3"}
FLOORS = {"GF", "F3", "F5"}
TESTS = SOURCE.parents[1] / "tests"
ACROSS_ROOMS = {"project", "workflow", "end_to_end", "validation"}
"""Folders of tests of the project as a whole, of its workflow, its pages and its statistics."""

TEXTS = (".py", ".pyi", ".json", ".j2", ".css", ".js")
STATEMENT = re.compile(r"C[1-9]\d?")


def sources(subpackage: str) -> list[Path]:
    return sorted((SOURCE / subpackage).rglob("*.py"))


def imported(path: Path) -> set[str]:
    """Modules that a file imports, at its top or in a function; relative ones begin with dots."""
    names = set()
    for node in nodes_of(path):
        if isinstance(node, ast.ImportFrom):
            names.add("." * node.level + (node.module or ""))
        elif isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
    return names


def imported_subpackages(path: Path) -> set[str]:
    """Rooms that a file imports from."""
    split = (name.split(".") for name in imported(path))
    return {parts[1] for parts in split if parts[0] == "rockfrag" and len(parts) > 1}


@pytest.mark.parametrize("subpackage", SUBPACKAGES)
def test_subpackage_imports_from_the_left_only(subpackage):
    later = set(SUBPACKAGES[SUBPACKAGES.index(subpackage) + 1 :])
    assert sources(subpackage)
    for path in sources(subpackage):
        beyond = imported_subpackages(path) & later
        assert not beyond, (
            f"{path.relative_to(SOURCE)} imports from {', '.join(sorted(beyond))}"
        )


def test_every_module_stands_in_a_room():
    homes = {path.relative_to(SOURCE).parts[0] for path in SOURCE.rglob("*.py")}
    assert homes == {"__init__.py", "__main__.py", *SUBPACKAGES}


def test_tests_stand_in_the_room_that_they_test():
    folders = {path.parent.name for path in TESTS.glob("*/test_*.py")}
    assert folders <= {*SUBPACKAGES, *ACROSS_ROOMS}
    assert not list(TESTS.glob("test_*.py"))


@pytest.mark.parametrize("subpackage", LIBRARY)
def test_subpackage_of_the_library_names_no_specimen_floor_or_statement_of_a_study(
    subpackage,
):
    looked_at = 0
    for path in sources(subpackage):
        for node in nodes_of(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                words = {node.value, *re.findall(r"``([^`]+)``", node.value)}
                known = words & (SPECIMENS | FLOORS)
                known |= {word for word in words if STATEMENT.fullmatch(word)}
                assert not known, (
                    f"{path.relative_to(SOURCE)}:{node.lineno} names {sorted(known)}"
                )
                looked_at += 1
    assert looked_at > 20


def test_the_library_has_no_word_of_the_thesis():
    files = [path for path in SOURCE.rglob("*") if path.suffix in TEXTS]
    assert len(files) > 300
    for path in files:
        words = re.findall(r"[a-z]*thesis", path.read_text(encoding="utf-8").casefold())
        assert set(words) <= {"hypothesis", "parenthesis"}, path


def test_tests_import_neither_tests_nor_benchmarks():
    tests = Path(__file__).parents[1]
    benchmarks = {path.stem for path in (tests.parent / "benchmarks").glob("*.py")} | {
        "benchmarks"
    }
    for path in [*tests.rglob("*.py"), *(THESIS.parent / "tests").rglob("*.py")]:
        homes = [name.split(".") for name in imported(path)]
        assert not [home for home in homes if home[-1].startswith("test_")], path
        assert not {home[0] for home in homes} & benchmarks, path


def test_nothing_imports_snakemake():
    for path in SOURCE.rglob("*.py"):
        assert "snakemake" not in {name.split(".")[0] for name in imported(path)}, path


ASKS = re.compile(r"isinstance\([^)]*\b(Block|Stack|Column)\b")
ROLE = re.compile(
    r"[a-z0-9_]+_(pedestal|statue|ground|interface)(_(m|s|n|rad|rad_s|g))?"
)
NO_BODY = {
    # acceleration of the ground, in kernels
    *("was_ground", "before_ground", "per_ground"),
    *("with_pedestal", "with_and_without_pedestal"),  # sides of a comparison
    *("simulated_ground", "shakes_as_ground", "on_ground"),  # places
}
"""Names that end like a role and say nothing of one of several bodies or contacts."""


def test_nothing_outside_of_systems_asks_whether_a_thing_is_a_block_or_a_stack():
    asking = [
        f"{path.name}: {found[0]}"
        for path in [*SOURCE.rglob("*.py"), *THESIS.rglob("*.py")]
        if path.parent.name != "system"
        for found in [ASKS.search(path.read_text(encoding="utf-8"))]
        if found
    ]
    assert not asking


def test_no_field_or_column_is_named_after_the_role_of_a_body():
    looked_at = 0
    for path in [*SOURCE.rglob("*.py"), *THESIS.rglob("*.py")]:
        for node in nodes_of(path):
            names = []
            if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                names = [node.target.id]
            elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                names = [node.value]
            named = [
                name for name in names if ROLE.fullmatch(name) and name not in NO_BODY
            ]
            assert not named, f"{path}:{node.lineno} names {named[0]}"
            looked_at += len(names)
    assert looked_at > 1000


# words that no identifier holds, and what says it
REPLACED = case_tables(__file__)["replaced"]

NO_NAMES = {"one", "item"}  # what no variable is called: it says nothing of what it is


def bound(path: Path) -> Iterator[tuple[int, str, bool]]:
    """Line and name of what a file binds, and whether it is a variable."""
    for node in nodes_of(path):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.lineno, node.id, True
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.lineno, node.name, False
            for given in getattr(node, "args", ast.arguments()).__dict__.get(
                "args", []
            ):
                yield given.lineno, given.arg, True


def wrong(name: str, variable: bool) -> str:
    """What is wrong with an identifier, empty if nothing is."""
    plain = name.strip("_").lower()
    if variable and plain in NO_NAMES:
        return "says nothing"
    if "contact_event" in plain:
        return ""
    return next((REPLACED[part] for part in plain.split("_") if part in REPLACED), "")


def test_identifiers_hold_the_words_of_the_field():
    every = [*SOURCE.rglob("*.py"), *THESIS.rglob("*.py")]
    # lanes of stacks are those of which one part rotates, and those of which two do
    files = [path for path in every if path.parent.name != "lanes"]
    assert len(files) > 200
    found = [
        f"{path}:{line}: {name}: {wrong(name, variable)}"
        for path in files
        for line, name, variable in bound(path)
        if wrong(name, variable)
    ]
    assert not found, "\n".join(found)


CAME_BACK = case_tables(__file__)["came_back"]


def came_back(name: str) -> str:
    """Word that says instead what a part of an identifier says, empty if none is needed."""
    parts = name.strip("_").lower().split("_")
    return next((CAME_BACK[part] for part in parts if part in CAME_BACK), "")


def test_words_that_came_back_are_gone():
    files = [*SOURCE.rglob("*.py"), *THESIS.rglob("*.py")]
    assert len(files) > 200
    found = [
        f"{path}:{line}: {name}: {came_back(name)}"
        for path in files
        for line, name, _ in bound(path)
        if came_back(name)
    ]
    assert not found, "\n".join(found)
    assert came_back("pull_x") and not came_back("pullover")


def test_a_wrong_identifier_is_seen():
    assert wrong("_closest_approach", True) and wrong("item", True)
    assert not wrong("contact_events", True)
