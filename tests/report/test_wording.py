"""Reports speak as an engineer writes, in words of the field, and numbers are neither NaN nor without width."""

import ast
import math
import re
from functools import cache, partial
from pathlib import Path

import pandas as pd
import pytest

from rockfrag.report.page import TERMS, Page, cell, terms_used
from rockfrag.report.part import Answer, Finding, Says, Section
from rockfrag.sentences import (
    agree,
    amplitude,
    counted,
    decimals_of,
    estimate,
    estimates,
    listed,
    number,
    of_all,
    probability,
    shortened,
)
from rockfrag.stages.fragility import best_of

NAN, INF = math.nan, math.inf


@pytest.mark.parametrize(
    ("value", "lower", "upper", "words"),
    [
        (1.008, 0.987, 1.03, "1.01 [0.99, 1.03]"),
        (1.0, 1.0, 1.0, "1.00"),
        (0.516, NAN, NAN, "0.52"),
        (0.5, 0.2, INF, "0.50 [0.20, open]"),
        (0.5, 0.0, 0.9, "0.50 [open, 0.90]"),
        (0.5, 0.0, INF, "0.50"),
        (0.12, 1e-9, 2e12, "0.12"),
        (0.12, 0.1, 2e12, "0.12 [0.10, open]"),
        (NAN, NAN, NAN, "–"),
        (INF, 1.0, INF, "–"),
    ],
)
def test_an_estimate_has_limits_only_where_they_say_something(value, lower, upper, words):
    assert estimate(value, lower, upper, 2) == words


def test_a_column_of_estimates_has_one_number_of_decimals():
    table = pd.DataFrame({"a": [12.34, 0.123], "a_lower": [10.0, 0.1], "a_upper": [15.0, 0.2]})
    assert estimates(table, "a") == ["12.340 [10.000, 15.000]", "0.123 [0.100, 0.200]"]


WORDS = {
    "p values are never zero": [
        (probability(1e-9), "< 0.001"),
        (probability(0.0421), "0.042"),
        (probability(NAN), "–"),
    ],
    "numbers of things agree with their nouns": [
        (counted(1, "record"), "1 record"),
        (counted(2, "record"), "2 records"),
        (counted(0, "pair"), "no pair"),
        (of_all(1, 1, "test"), "the only test"),
        (of_all(3, 3, "test"), "all 3 tests"),
        (of_all(1, 3, "test"), "1 of 3 tests"),
        (of_all(0, 3, "test"), "none of 3 tests"),
        *((agree(n, 3, "needs", "need"), "needs" if n < 2 else "need") for n in range(4)),
        (agree(1, 1, "needs", "need"), "needs"),
    ],
    "lists read as sentences and stay short": [
        (listed(["a"]), "a"),
        (listed(["a", "b", "c"]), "a, b and c"),
        (listed([str(i) for i in range(20)])[-13:], "7 and 12 more"),
    ],
    "an amplitude that is not known is its bound": [
        (amplitude({"amplitude_g": 0.5234, "lower_g": 0.5, "upper_g": 0.55}), "0.523"),
        (amplitude({"amplitude_g": NAN, "lower_g": 2.0, "upper_g": NAN}), "> 2.000"),
        (amplitude({"amplitude_g": NAN, "lower_g": 0.0, "upper_g": 0.1}), "< 0.100"),
        (amplitude({"amplitude_g": NAN, "lower_g": 0.0, "upper_g": NAN}), "–"),
    ],
    "an estimate on its own limit is a bound": [
        (estimate(0.0445, 0.0, 0.0445, 3), "≤ 0.044"),
        (estimate(0.03, 0.0, 0.0445, 3), "0.030 [open, 0.044]"),
    ],
    "decimals show three digits": [
        *((decimals_of(x), n) for x, n in ((0.0123, 4), (1.23, 2), (123.0, 0), (0.0, 3))),
        (number(-0.5, 1), "−0.5"),
    ],
    "cells show digits, truth and what is missing": [
        *((cell(1.23456, 2), "1.23"), (cell(-0.5, 1), "−0.5"), (cell(NAN, 2), "–")),
        *((cell(None, None), "–"), (cell(True, None), "yes"), (cell("", None), "–")),
    ],
}


@pytest.mark.parametrize("what", WORDS)
def test_words_are_those_that_a_reader_expects(what):
    for said, expected in WORDS[what]:
        assert said == expected


def test_long_names_keep_their_head_and_tail():
    assert shortened("short") == "short"
    cut = shortened("Figure of a saint, left niche", 12)
    assert len(cut) == 12 and cut.startswith("Figur") and cut.endswith("niche")


SPEAKING = ("report", "assess", "survival", "pedestal", "fragility", "campaign", "stages")
"""Subpackages whose sentences stand in reports and on the screen of a run."""

ROOT = Path(__file__).resolve().parents[2]

RIDDLES = {
    r"could overturn it\b": "What could change this result",
    r"[Ii]n a repeat|there fall": "Recorded at full strength, 9 of 12 motions overturn T1",
    r"survived above one that overturns": "a stronger motion was survived",
    r"[Hh]ow strong must shaking be that": "How strong must shaking be to overturn",
    r"tell it from|told apart from": "not distinguishable from",
    r"hang together": "dependent tests",
    r"foretell": "predict",
    r"without a form": "nonparametric",
    r"\bLuck\b|luck decides": "Non-monotone response",
    r"not counted \(": "neglecting a 20 kg table mass",
    r"None can that": "No mechanism acting on only one of them can",
    r"that the model leaves out": "implies an effect that the model omits",
    r"\bholds for the specimens": "confirmed for the specimens",
    r"printed values .* come out": "All printed values are reproduced",
    r"What is needed to get the same results": "Software, data and settings used",
    r"The numbers behind it": "Tables",
    r"The least median of overturning": "is the most fragile",
    r"are another|is another if": "flips",
}
"""Sentences that readers stumbled over, and how an engineer says them."""


@cache
def sentences() -> list[tuple[Path, str]]:
    """Texts of all speaking modules and templates that are not docstrings."""
    folders = [ROOT / "src" / "rockfrag" / name for name in SPEAKING]
    found = []
    for folder in (*folders, ROOT / "thesis" / "src"):
        assert folder.is_dir()
        for path in sorted(folder.rglob("*.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            silent = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
            found += [
                (path, node.value)
                for node in ast.walk(tree)
                if isinstance(node, ast.Constant)
                and isinstance(node.value, str)
                and id(node) not in silent
            ]
        found += [(path, path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.j2"))]
    return found


@pytest.mark.parametrize("riddle", RIDDLES)
def test_no_report_speaks_in_riddles(riddle):
    said = [(path.name, text) for path, text in sentences() if re.search(riddle, text)]
    assert not said, f"say instead: {RIDDLES[riddle]}"


def page(said: str = "AvgSA predicts best.", **answer) -> str:
    given = {"asked": "How strong?", "sentences": [Finding("It holds", "So far", "P/NP 1.01")]}
    section = Section("a", "A", "Short.", [said])
    return Page("T", "lead", Answer(**given | answer), [section]).html()


def test_numbers_wait_behind_a_click():
    text = page()
    before, _, after = text.partition("<details")
    assert "It holds" in before and "P/NP 1.01" not in before
    assert "P/NP 1.01" in after


def test_what_to_do_stands_open_and_what_could_change_the_result_has_its_own_name():
    text = page(advice=["Secure the urn first."], could_change=["Sliding."])
    assert "Secure the urn first." in text
    assert "What could change this result" in text


def test_a_page_explains_the_terms_that_it_uses_and_no_others():
    text = page()
    assert "<dt>P/NP</dt>" in text and "<dt>AvgSA</dt>" in text
    assert "<dt>AUC</dt>" not in text
    assert "Glossary" not in page("", sentences=[Finding("So")])


def test_terms_are_found_as_words_of_their_own():
    assert set(terms_used("The PGAs of P&NP")) == set()
    assert set(terms_used("PGA and beta")) == {"PGA, PGV, PGD"}
    assert all(meaning.endswith(".") for meaning in TERMS.values())


def test_an_open_chapter_says_what_its_headline_rests_on():
    section = partial(Says("rockfrag.report", "opening.j2").section, "opening", [], "Title")
    assert section(Finding("A", "b", "c")) == Section("opening", "Title", "A.", ["b", "c"], [])
    assert section(Finding("A")).paragraphs == []


def test_best_measures_are_among_those_asked_for():
    measures = {"measure": ["avgsa_g", "pga_g", "pgv_cm_s"] * 2, "im": ["AvgSA", "PGA", "PGV"] * 2}
    choice = pd.DataFrame({"configuration": list("aaabbb"), **measures})
    choice["score"] = [-1.0, -2.0, -3.0, -1.0, NAN, -3.0]
    assert best_of(choice, ["pga_g", "pgv_cm_s"]) == ["PGA", "PGV"]
