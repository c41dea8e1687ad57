"""The page: self-contained, escaped, and the same bytes every time."""

import math
import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from rockfrag.errors import InputError
from rockfrag.figure_style import figure_style, new_figure
from rockfrag.report import pdf
from rockfrag.report.page import MOST_TABLE_ROWS, Column, Page, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section


def drawing() -> Figure:
    with figure_style():
        figure = new_figure(3.5, 2)
        axes = figure.subplots()
        axes.plot([1, 3, 2], label="P&T1 <i>")
        axes.legend()
    return figure


def spec(name: str = "one") -> FigureSpec:
    return FigureSpec(name, "It rises & falls.", "Caption <u>", drawing)


def page(folder: Path) -> str:
    table = pd.DataFrame({"name": ["<b>", "P&T1"], "value": [1.23456, math.nan]})
    columns = [Column("name", "Name"), Column("value", "Value [g]", 2)]
    specs = [spec("one"), spec("two")]
    parts = [table_html(table, columns, "A"), *specs]
    answer = Answer("Does it fall?", [Finding("Found", "this")], specs[0])
    section = Section("one", "One", "Message <s>", ["Text & more"], [parts[0], specs[1]])
    return Page("T", "lead", answer, [section]).html(folder)


def test_the_page_loads_nothing_from_outside_and_escapes_what_users_name(tmp_path):
    text = page(tmp_path)
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


def test_an_empty_table_is_not_shown():
    assert table_html(pd.DataFrame({"a": []}), [Column("a", "A")], "Nothing") == ""


def test_a_long_table_names_the_file_that_has_all():
    table = pd.DataFrame({"a": range(MOST_TABLE_ROWS + 1)})
    shown = table_html(table, [Column("a", "A", 0)], "Many.", "many.csv")
    assert shown.count("<tr>") == MOST_TABLE_ROWS + 1  # and its head
    assert f"The first {MOST_TABLE_ROWS} of {MOST_TABLE_ROWS + 1}; many.csv has all." in shown


def test_the_page_and_its_figures_are_the_same_bytes_every_time(tmp_path: Path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    assert page(tmp_path / "a") == page(tmp_path / "b")
    for name in ("one.svg", "one.png"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_a_page_is_printed_beside_itself(tmp_path: Path):
    if not any(map(shutil.which, pdf.BROWSERS)):
        pytest.skip("no browser that prints is installed")
    page = tmp_path / "report.html"
    page.write_text("<details><summary>closed</summary>behind it</details>")
    assert pdf.print_page(page) == tmp_path / "report.pdf"
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")


def test_without_a_page_or_a_browser_one_sentence_says_what_to_do(tmp_path, monkeypatch):
    page = tmp_path / "report.html"
    with pytest.raises(InputError, match="run the study first"):
        pdf.print_page(page)
    page.write_text("words")
    monkeypatch.setattr(pdf, "BROWSERS", ())
    with pytest.raises(InputError, match="in any browser and print it"):
        pdf.print_page(page)
