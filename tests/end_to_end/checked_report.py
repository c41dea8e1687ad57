"""What any report must be: about its own study, whole, and without a number that says nothing."""

import math
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from lxml import html

from rockfrag.base.files import file_name
from rockfrag.report.answer import study_answer
from rockfrag.report.part import Results
from rockfrag.study.loading import load_any

from .studies import Foreign, run

PLUGIN = re.compile(
    r"thesis|towers?\b|\bT[123]\b|\bGF\b|\bF[35]\b|\bC\d\d?\b|Tables? [34]\.\d|figures? [34]\.\d"
    r"|counterpart|statements? (?:are|is) tested|contradict",
    re.IGNORECASE,
)
NO_NUMBER = re.compile(
    r"\b(?:nan|NaN|NaT|inf|infinity|null|True|False)\b|<NA>|mathdefault|\(s\)"
)
INTERVAL = re.compile(r"(?:([−\d.]+) )?\[([−\d.]+|open), ([−\d.]+|open)\]")
NOUNS = "record|test|motion|earthquake|pair|floor|object|configuration|outcome|perturbation|building|row"
PLURALS = re.compile(rf"\b1 (?:simulated |overturning )?(?:{NOUNS})s\b")
SINGULARS = re.compile(rf"\b(?:[2-9]|[1-9]\d+) (?:{NOUNS})\b(?! on a pedestal)")
VOID = {"meta", "link", "br", "img", "input", "hr"}

MOST_WORDS = 900  # words of a page before anything on it is opened


class Page:
    """Texts of a page and of its drawings, its tables cell by cell, and whether its tags close."""

    def __init__(self, text: str) -> None:
        markup = re.sub(
            r"<(script|style)\b.*?</\1>|<!--.*?-->", "", text, flags=re.DOTALL
        )
        opened = Counter(re.findall(r"<(\w+)\b[^>]*(?<!/)>", markup))
        assert set(opened - Counter(re.findall(r"</(\w+)>", markup))) <= VOID, (
            "a tag is left open"
        )
        root = html.document_fromstring(markup)
        self.words = _lines(root.xpath("//text()[not(ancestor::svg)]"))
        self.drawings = _lines(root.xpath("//svg//text()"))
        self.labels = [drawing.get("aria-label", "") for drawing in root.iter("svg")]
        self.tables = [
            [
                ["".join(_lines(cell.itertext())) for cell in row]
                for row in table.iter("tr")
            ]
            for table in root.iter("table")
        ]


def _lines(texts: Iterable[str]) -> list[str]:
    """Texts that say anything, each with one blank between its words."""
    return [line for text in texts if (line := " ".join(text.split()))]


def check_report(
    results: Path, names: Iterable[str] = (), plugin: bool = False
) -> Page:
    """Assert that a report is fit to be shown, whatever the user's names are, and return what is on it."""
    text = (results / "report.html").read_text(encoding="utf-8")
    text = text.replace("\u00a0", " ")
    page = Page(text)
    said = [
        _without(word, names) for word in (*page.words, *page.drawings, *page.labels)
    ]
    whole = " · ".join(said)
    for pattern in (NO_NUMBER, PLURALS, SINGULARS, *(() if plugin else (PLUGIN,))):
        found = pattern.search(whole)
        assert found is None, (
            f"“{found[0]}” in “…{whole[max(0, found.start() - 90) : found.end() + 60]}…”"
        )
    assert len(open_words(text)) < MOST_WORDS
    _check_intervals(whole)
    _check_tables(page)
    _check_figures(results, page)
    sources = re.findall(r'(?:src|href)="([^"]*)"', text)
    assert all(source.startswith(("data:", "#")) for source in sources)
    anchors = set(re.findall(r' id="([^"]*)"', text))
    assert {source[1:] for source in sources if source.startswith("#")} <= anchors
    if not plugin:
        strange = [
            path.name
            for path in results.rglob("*")
            if PLUGIN.search(_without(path.stem, names))
        ]
        assert not strange, f"files of the guest: {strange}"
    return page


def _without(text: str, names: Iterable[str]) -> str:
    """The text with all names, and what they are in names of files, replaced by a sign."""
    for name in names:
        for form in (name, file_name(name)):
            text = re.sub(rf"(?<!\w){re.escape(form)}(?!\w)", "¤", text)
    return text


def _number(text: str) -> float:
    return math.nan if text == "open" else float(text.replace("−", "-"))


def _check_intervals(text: str) -> None:
    for found in INTERVAL.finditer(text):
        value, lower, upper = (
            _number(group) if group else math.nan for group in found.groups()
        )
        assert not lower >= upper, f"an interval without width: {found[0]}"
        assert not value < lower and not value > upper, (
            f"an estimate outside its limits: {found[0]}"
        )


def _check_tables(page: Page) -> None:
    for head, *rows in page.tables:
        assert rows, f"an empty table: {head}"
        for row in rows:
            assert len(row) == len(head), f"a row of {len(row)} cells under {head}"
        for number, title in enumerate(head):
            cells = [row[number] for row in rows]
            assert all(cells), f"an empty cell under {title}"
            assert "None" not in cells, f"a missing value is printed under {title}"
            if re.match(r"p\b", title):
                assert "0.000" not in cells, f"a p value of zero under {title}"


def _check_figures(results: Path, page: Page) -> None:
    drawn = sorted(path.stem for path in (results / "figures").glob("*.svg"))
    assert drawn == sorted(path.stem for path in (results / "figures").glob("*.png"))
    figures = [label for label in page.labels if not label.startswith("Still frames")]
    assert len(figures) == len(drawn), f"{len(figures)} figures on the page of {drawn}"
    assert all(len(label) > 20 for label in page.labels), (
        "a figure without words for it"
    )
    assert all(path.stat().st_size > 500 for path in (results / "figures").glob("*.*g"))


def run_and_check(study: Foreign, folder: Path) -> tuple[Path, Page]:
    """Run a study to its report, which must be fit to be shown; return its results and its page."""
    results = run(study, folder)
    page = check_report(results, study.names)
    check_first_page(Results(load_any(folder / "study.yaml"), results))
    return results, page


def check_first_page(results: Results) -> None:
    """Assert that each number of what stands first is in the study's tables, and that it is short."""
    answer = study_answer(results)
    text = " ".join(sentence.said for sentence in answer.sentences)
    names = sorted(
        (each.name for each in results.study.configurations), key=len, reverse=True
    )
    for name in [
        *names,
        *results.objects,
        *results.tests["test"],
        *results.tests["motion"],
    ]:
        text = text.replace(name, "¤")
    sources = ["fragility", "tests", "as_recorded", "mean_amplitudes"]
    sources += ["pedestal/effects"] if results.study.has_pairs else []
    tables = [results.table(name) for name in sources]
    numbers = [
        table.select_dtypes("number").to_numpy(float).ravel() for table in tables
    ]
    values = np.concatenate(numbers)
    values = values[np.isfinite(values)]
    known = {f"{value:.{digits}f}" for value in values for digits in (0, 1, 2, 3)}
    known |= {
        f"{100 * abs(value - 1):.{digits}f}" for value in values for digits in (0, 1)
    }
    counts = {str(n) for n in range(1 + max(len(table) for table in tables))}
    levels = {f"{100 * results.study.fragility.confidence:g}", "95", "80", "50", "10"}
    strange = set(re.findall(r"\d+(?:\.\d+)?", text)) - known - counts - levels
    # a ratio of amplitudes over IDA curves is of no table of its own
    strange = {item for item in strange if f"{item} times" not in text}
    assert not strange, f"numbers that are in no table: {strange} in {text}"


def open_words(page: str) -> list[str]:
    """Words of a page outside its drawings before anything is opened, with the summaries of what can be."""
    shown = re.sub(r"<(script|style|svg|head)\b.*?</\1>", " ", page, flags=re.DOTALL)
    inside = r"(?:(?!<details\b).)*?"
    innermost = (
        rf"<details\b[^>]*>\s*<summary\b[^>]*>({inside})</summary>{inside}</details>"
    )
    while (fewer := re.sub(innermost, r"\1", shown, flags=re.DOTALL)) != shown:
        shown = fewer
    return re.sub(r"<[^>]*>", " ", shown).split()
