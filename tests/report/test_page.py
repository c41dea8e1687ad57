"""The page: self-contained, escaped, short until it is opened, and with its terms explained."""

import math
import os
import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from rockfrag.base.errors import InputError
from rockfrag.base.figure_style import figure_style, new_figure
from rockfrag.report import pdf
from rockfrag.report.page import (
    MOST_TABLE_ROWS,
    TERMS,
    Column,
    Page,
    table_html,
    terms_used,
)
from rockfrag.report.part import Answer, FigureSpec, Finding, Section


def drawing() -> Figure:
    with figure_style():
        figure = new_figure(3.5, 2)
        axes = figure.subplots()
        axes.plot([1, 3, 2], label="P&T1 <i>")
        axes.legend()
    return figure


def spec(name: str) -> FigureSpec:
    return FigureSpec(name, "It rises & falls.", "Caption <u>", drawing)


def test_the_page_loads_nothing_from_outside_and_escapes_what_users_name(tmp_path):
    table = pd.DataFrame({"name": ["<b>", "P&T1"], "value": [1.23456, math.nan]})
    shown = table_html(
        table, [Column("name", "Name"), Column("value", "Value [g]", 2)], "A"
    )
    first, second = spec("one"), spec("two")
    answer = Answer("Does it fall?", [Finding("Found", "this")], first)
    section = Section("one", "One", "Message <s>", ["Text & more"], [shown, second])
    text = Page("T", "lead", answer, [section]).html(tmp_path)
    sources = re.findall(r'(?:src|href)="([^"]*)"', text)
    sources += re.findall(r"url\(([^)]*)\)", text)
    assert sources
    assert all(source.startswith(("data:", "#")) for source in sources)
    assert not {"<b>", "<i>", "<u>", "<s>"} & set(re.findall("<[^>]*>", text))
    assert "&lt;b&gt;" in text
    # cells carry their title for narrow screens
    assert '<td class="number" data-title="Value [g]">1.23</td>' in text
    # figures are part of the page with text and identifiers of their own
    assert text.count('role="img" aria-label="It rises &amp; falls."') == 2
    assert ">P&amp;T1 &lt;i&gt;<" in text
    identifiers = re.findall(r' id="([^"]*)"', text)
    assert len(identifiers) == len(set(identifiers))
    wanted = re.findall(r'(?:url\(#|href="#)([^")]+)', text)
    assert set(wanted) <= set(identifiers)


def test_a_long_table_names_the_file_that_has_all():
    table = pd.DataFrame({"a": range(MOST_TABLE_ROWS + 1)})
    shown = table_html(table, [Column("a", "A", 0)], "Many.", "many.csv")
    assert shown.count("<tr>") == MOST_TABLE_ROWS + 1  # and its head
    assert (
        f"The first {MOST_TABLE_ROWS} of {MOST_TABLE_ROWS + 1}; many.csv has all."
        in shown
    )


def page(said: str = "AvgSA predicts best.", **answer) -> str:
    given = {
        "asked": "How strong?",
        "sentences": [Finding("It holds", "So far", "P/NP 1.01")],
    }
    section = Section("a", "A", "Short.", [said])
    return Page("T", "lead", Answer(**given | answer), [section]).html()


def test_what_to_do_stands_open_and_numbers_wait_behind_a_click():
    text = page(advice=["Secure the urn first."], could_change=["Sliding."])
    before, _, after = text.partition("<details")
    assert "It holds" in before and "P/NP 1.01" not in before
    assert "P/NP 1.01" in after and "Secure the urn first." in after
    assert "What could change this result" in after


def test_a_page_explains_the_terms_that_it_uses_and_no_others():
    text = page()
    assert "<dt>P/NP</dt>" in text and "<dt>AvgSA</dt>" in text
    assert "<dt>AUC</dt>" not in text
    assert "Glossary" not in page("", sentences=[Finding("So")])
    # as words of their own
    assert set(terms_used("The PGAs of P&NP")) == set()
    assert set(terms_used("PGA and beta")) == {"PGA, PGV, PGD"}
    for language, terms in TERMS.items():
        assert all(meaning.endswith(".") for meaning in terms.values())
        assert terms_used(" ".join(terms), language).keys() == terms.keys()
    # a page in another language is not explained in English
    assert "PGA, PGV, PGD" in terms_used("PGA", "it")
    assert not terms_used("PGA amplitude", "xx")


def test_a_page_is_printed_beside_itself(tmp_path: Path):
    if not any(map(shutil.which, pdf.BROWSERS)):
        pytest.skip("no browser that prints is installed")
    file = tmp_path / "report.html"
    file.write_text("<details><summary>closed</summary>behind it</details>")
    assert pdf.print_page(file) == tmp_path / "report.pdf"
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")


def test_without_a_page_or_a_browser_one_sentence_says_what_to_do(
    tmp_path, monkeypatch
):
    file = tmp_path / "report.html"
    with pytest.raises(InputError, match="run the study first"):
        pdf.print_page(file)
    file.write_text("words")
    monkeypatch.setattr(pdf, "BROWSERS", ())
    with pytest.raises(InputError, match="in any browser and print it"):
        pdf.print_page(file)


@pytest.mark.skipif(os.name != "posix", reason="a program that is a script")
@pytest.mark.parametrize(
    "does", ["sleep 30", "exit 3", "for last; do :; done; exit 0", "kill -9 $$"]
)
def test_a_browser_that_hangs_or_fails_is_one_sentence(tmp_path, monkeypatch, does):
    (tmp_path / "browser").write_text(f"#!/bin/sh\n{does}\n")
    (tmp_path / "browser").chmod(0o755)
    (tmp_path / "report.html").write_text("words")
    monkeypatch.setattr(pdf, "BROWSERS", ("browser",))
    monkeypatch.setattr(pdf, "_PATIENCE", 0.2)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(InputError, match="did not print"):
        pdf.print_page(tmp_path / "report.html")
    assert not (tmp_path / "report.pdf").exists()


@pytest.mark.parametrize("named", ["base-uri 'none'", "form-action 'none'"])
def test_a_report_sends_no_form_and_has_no_other_base(named: str):
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page("words"))
    assert policy is not None
    assert named in policy[1].split("; ")
