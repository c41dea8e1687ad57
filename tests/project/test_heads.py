"""The head of a module says what goes in and out and where its theory stands, and what it names is there."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from ..sources import tree_of

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "rockfrag"
ROOMS = (
    "engines/planar",
    "engines/pure_rocking",
    "engines/spatial",
    "simulation",
    "fragility",
    "campaign",
    "effects",
    "building",
    "assess",
    "survival",
)
"""Rooms where computing is hard to follow without knowing what it is for."""

FIRST_LINES = 20
PAGE = re.compile(r'``docs/(?P<page>[\w/-]+\.md)``(?:, "(?P<section>[^"]+)")?')


def head(path: Path) -> str:
    """Docstring of a module as it stands in its first lines, on one line."""
    text, tree = path.read_text(encoding="utf-8"), tree_of(path)
    if not ast.get_docstring(tree):
        return ""
    end = min(tree.body[0].end_lineno or 0, FIRST_LINES)
    return " ".join("\n".join(text.splitlines()[:end]).split())


def modules(*rooms: str) -> Iterator[Path]:
    for room in rooms:
        for path in sorted((SOURCE / room).rglob("*.py")):
            if path.name != "__init__.py":
                yield path


def lacks(words: str) -> list[str]:
    """What a head does not say, of input, output and theory."""
    missing = []
    if not re.search(r"\b(In:|In goes|goes in\b)", words):
        missing.append("what goes in")
    if not re.search(r"\b(Out:|out comes|comes out\b)", words):
        missing.append("what comes out")
    if not PAGE.search(words):
        missing.append("the page of docs on which its theory stands")
    return missing


@pytest.mark.parametrize("room", ROOMS)
def test_a_stranger_sees_what_goes_in_and_out_and_where_the_theory_stands(room):
    found = [
        f"{path.relative_to(SOURCE)}: {', '.join(lacks(head(path)))}"
        for path in modules(room)
        if lacks(head(path))
    ]
    assert not found, "\n".join(found)


def test_pages_and_sections_that_heads_name_are_there():
    wrong, seen = [], 0
    for path in sorted(SOURCE.rglob("*.py")):
        for found in PAGE.finditer(head(path)):
            page = ROOT / "docs" / found["page"]
            seen += 1
            if not page.exists():
                wrong.append(f"{path.relative_to(SOURCE)}: {found['page']}")
            elif found["section"] and found["section"] not in headings(page):
                wrong.append(f"{path.relative_to(SOURCE)}: {found[0]}")
    assert seen > 150
    assert not wrong, "\n".join(wrong)


def headings(page: Path) -> set[str]:
    """Headings of a page, and what begins a paragraph in bold."""
    text = page.read_text(encoding="utf-8")
    found = re.findall(r"^#+ (.+?)\s*$", text, re.MULTILINE)
    found += re.findall(r"^(?:- )?\*\*(.+?)[.:]?\*\*", text, re.MULTILINE)
    return {heading.rstrip(".:") for heading in found}


def test_a_head_that_says_nothing_is_seen():
    assert len(lacks('"""Numbers and what is made of them."""')) == 3
    assert not lacks("In: a body. Out: a rate. Theory: ``docs/space.md``, 4.")
