"""The page: self-contained, escaped, and the same bytes every time."""

import math
import re
from pathlib import Path

import pandas as pd

from rockfrag.report.figures.style import figure_style, new_figure, save_figure
from rockfrag.report.findings import Finding, amplitudes_found, pedestal_effect
from rockfrag.report.page import Column, Picture, Section, cell, render, table_html
from rockfrag.thesis.ledger_html import ledger_html


def figure_files(folder: Path) -> tuple[Path, Path]:
    with figure_style():
        figure = new_figure(3.5, 2)
        figure.subplots().plot([1, 3, 2])
    paths = folder / "one.svg", folder / "one.png"
    save_figure(figure, *paths)
    return paths


def page(folder: Path) -> str:
    svg, _ = figure_files(folder)
    table = pd.DataFrame({"name": ["<b>", "P&T1"], "value": [1.23456, math.nan]})
    columns = [Column("name", "Name"), Column("value", "Value [g]", 2)]
    section = Section(
        "one", "One", ["Text & more"], [table_html(table, columns, "A"), Picture(svg, "B")]
    )
    return render("T", "lead", [Finding("Found", "this")], [section], {"Seed": "1"})


def test_the_page_loads_nothing_from_outside(tmp_path: Path):
    text = page(tmp_path)
    sources = re.findall(r'(?:src|href)="([^"]*)"', text)
    assert sources
    assert all(source.startswith(("data:", "#")) for source in sources)
    assert "url(" not in text


def test_the_page_escapes_what_users_name(tmp_path: Path):
    text = page(tmp_path)
    assert "<b>" not in text
    assert "&lt;b&gt;" in text
    assert "P&amp;T1" in text


def test_the_page_and_its_figures_are_the_same_bytes_every_time(tmp_path: Path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    assert page(tmp_path / "a") == page(tmp_path / "b")
    for one, other in zip(figure_files(tmp_path / "a"), figure_files(tmp_path / "b"), strict=True):
        assert one.read_bytes() == other.read_bytes()


def test_cells_show_digits_truth_and_what_is_missing():
    assert cell(1.23456, 2) == "1.23"
    assert cell(-0.5, 1) == "−0.5"
    assert cell(math.nan, 2) == "–"
    assert cell(None, None) == "–"
    assert cell(True, None) == "yes"
    assert cell("", None) == "–"


def two_tests() -> pd.DataFrame:
    return pd.DataFrame(
        {
            "test": ["T1 a", "T1 b"],
            "amplitude_g": [0.5, math.nan],
            "censored": ["none", "right"],
            "overturned_body": ["statue", ""],
        }
    )


def test_a_test_without_amplitude_is_named_in_the_findings():
    finding = amplitudes_found(two_tests())
    assert finding.headline.startswith("1 of 2")
    assert "T1 b" in finding.text


def effects(lower: float, ratio: float, upper: float, equivalent: bool) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "reading": ["step_protocol"],
            "scope": ["whole"],
            "level": ["all"],
            "pairs": [36],
            "unit": ["event"],
            "units": [4],
            "ratio": [ratio],
            "lower": [lower],
            "upper": [upper],
            "equivalent": [equivalent],
            "detectable_ratio": [1.2],
        }
    )


def test_the_pedestal_is_said_to_have_an_effect_only_where_the_interval_excludes_none():
    assert "raises" in pedestal_effect(effects(1.05, 1.2, 1.4, False)).headline
    assert "lowers" in pedestal_effect(effects(0.7, 0.8, 0.9, False)).headline
    unsure = pedestal_effect(effects(0.8, 1.1, 1.5, False))
    assert "cannot be told" in unsure.headline
    assert "20 %" in unsure.text
    assert "next to nothing" in pedestal_effect(effects(0.99, 1.0, 1.01, True)).headline


def test_the_ledger_marks_each_verdict():
    claims = pd.DataFrame(
        {
            "number": [25],
            "statement": ["a falls & falls"],
            "source": ["4.2"],
            "test": ["regression"],
            "figure": ["-0.1"],
            "verdict": ["supported"],
            "basis": ["simulated"],
            "remark": [None],
        }
    )
    html = ledger_html(claims)
    assert 'class="statement supported"' in html
    assert "falls &amp; falls" in html
