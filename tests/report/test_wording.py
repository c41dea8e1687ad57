"""Reports speak as an engineer writes, in words of the field, and numbers are neither NaN nor without width."""

import ast
import re
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

from rockfrag.report.page import cell
from rockfrag.report.part import Finding, Section, chapter
from rockfrag.stages.fragility import best_of
from rockfrag.words import sentences

from ..case_tables import case_tables
from ..sources import nodes_of

CASES = case_tables(__file__)


@pytest.mark.parametrize(("function", "given", "words"), CASES["words"])
def test_words_are_those_that_a_reader_expects(function, given, words):
    assert (cell if function == "cell" else getattr(sentences, function))(
        *given
    ) == words


def test_a_column_of_estimates_has_one_number_of_decimals():
    table = pd.DataFrame(
        {"a": [12.34, 0.123], "a_lower": [10.0, 0.1], "a_upper": [15.0, 0.2]}
    )
    found = sentences.estimates(table, "a")
    assert found == ["12.340 [10.000, 15.000]", "0.123 [0.100, 0.200]"]


SPEAKING = (
    "report",
    "assess",
    "survival",
    "effects",
    "fragility",
    "campaign",
    "stages",
)
"""Subpackages whose sentences stand in reports and on the screen of a run."""

ROOT = Path(__file__).resolve().parents[2]


@cache
def spoken() -> list[tuple[str, str]]:
    """Texts of all speaking modules and templates, by file, that are not docstrings."""
    folders = [ROOT / "src" / "rockfrag" / name for name in SPEAKING]
    found = []
    for folder in (*folders, ROOT / "thesis" / "src"):
        assert folder.is_dir()
        for path in sorted(folder.rglob("*.py")):
            nodes = nodes_of(path)
            silent = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
            texts = [node for node in nodes if isinstance(node, ast.Constant)]
            found += [
                (path.name, str(node.value)) for node in texts if id(node) not in silent
            ]
        found += [
            (path.name, path.read_text(encoding="utf-8"))
            for path in folder.rglob("*.j2")
        ]
    return found


@pytest.mark.parametrize(("riddle", "instead"), CASES["riddles"])
def test_no_report_speaks_in_riddles(riddle, instead):
    said = [(name, text) for name, text in spoken() if re.search(riddle, text)]
    assert not said, f"say instead: {instead}"


def test_an_open_chapter_says_what_its_headline_rests_on():
    found = chapter("opening", "Title", Finding("A", "b", "c"), ["d"])
    assert found == Section("opening", "Title", "A.", ["b", "c", "d"])
    assert chapter("opening", "Title", Finding("A")).paragraphs == []


def test_best_measures_are_among_those_asked_for():
    measures = {
        "measure": ["avgsa_g", "pga_g", "pgv_cm_s"] * 2,
        "im": ["AvgSA", "PGA", "PGV"] * 2,
    }
    choice = pd.DataFrame({"configuration": list("aaabbb"), **measures})
    choice["score"] = [-1.0, -2.0, -3.0, -1.0, float("nan"), -3.0]
    assert best_of(choice, ["pga_g", "pgv_cm_s"]) == ["PGA", "PGV"]
