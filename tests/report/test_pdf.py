"""The report on paper: a browser prints it, and without one a sentence says what to do."""

import shutil
from pathlib import Path

import pytest

from rockfrag.errors import InputError
from rockfrag.report import pdf


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
