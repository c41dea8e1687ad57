"""Pages as browsers show them: nothing wrong, nothing cut, nothing from outside, fit for every reader."""

import re
from pathlib import Path

import pytest

from .browsers import FITS, Browser, barriers, expression, opened, put

pytestmark = pytest.mark.slow

OPEN = "document.querySelectorAll('details').forEach(one => { one.open = true; })"

TOO_WIDE = expression("too_wide.js")
"""Elements that reach beyond their room, or beyond the window."""


@pytest.fixture(params=["report", "play_page"])
def page(request: pytest.FixtureRequest) -> Path:
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("dark", [False, True])
@pytest.mark.parametrize("width", [400, 800, 1400, 2200])
def test_nothing_is_cut_and_no_error_is_written(browser, page, width, dark):
    opened(browser, page, width, 900, dark=dark)
    browser.run(OPEN)
    seen = browser.run("innerWidth")
    # Firefox's windows are no narrower than this
    assert abs(seen - max(width, 450)) <= 60 or seen == width
    assert browser.run(TOO_WIDE) == []
    assert browser.run(FITS)
    assert browser.console == []


def test_readers_of_every_kind_can_use_it(browser: Browser, page: Path):
    for dark in (False, True):
        opened(browser, page, 1400, 900, dark=dark)
        browser.run(OPEN)
        assert barriers(browser) == []
    # as while a browser takes a picture of a whole page: canvases have no pixels to copy then
    browser.run("document.querySelector('#live .app').style.display = 'none'")
    browser.run(
        "dispatchEvent(new Event('resize')), new Promise(done => setTimeout(done, 500))"
    )
    assert browser.console == []


def test_a_link_opens_the_chapter_that_it_names(browser: Browser, report: Path):
    browser.open(report)
    links = "[...document.querySelectorAll('.questions a')]"
    asked = browser.run(f"{links}.map(one => one.hash.slice(1))")
    assert {"as_recorded", "pedestal", "fragility", "grounds", "live"} == set(asked)
    for anchor in asked:
        browser.run(
            f"document.querySelector('.questions a[href=\"#{anchor}\"]').click()"
        )
        place = f"document.getElementById('{anchor}')"
        assert browser.run(f"{place}.open !== false")
        assert browser.run(f"{place}.getBoundingClientRect().top < innerHeight")


def test_tables_can_be_sorted_and_filtered(browser: Browser, report: Path):
    browser.open(report)
    browser.run(OPEN)
    table = "document.querySelector('#as_recorded table')"
    cells = f"[...{table}.tBodies[0].rows].filter(one => !one.hidden).map(one => one.cells[3].textContent)"
    peaks = browser.run(cells)
    browser.run(f"{table}.tHead.querySelectorAll('button')[3].click()")
    assert browser.run(cells) == sorted(peaks, key=float)
    browser.run(f"{table}.tHead.querySelectorAll('button')[3].click()")
    assert browser.run(cells) == sorted(peaks, key=float, reverse=True)
    put(browser, "#as_recorded .table input[type=search]", "record 7")
    assert len(browser.run(cells)) == 1


def test_paper_has_every_chapter(browser: Browser, report: Path):
    if browser.name != "chromium":
        pytest.skip("only Chromium prints without a dialogue")
    opened(browser, report)
    closed = browser.run("document.querySelectorAll('details:not([open])').length")
    assert closed > 8
    document = browser.printed()  # type: ignore[attr-defined]
    assert document.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", document)) > 4


@pytest.mark.parametrize(
    ("width", "dark"), [(1400, False), (1400, True), (390, False), (390, True)]
)
def test_readers_of_every_kind_can_use_the_site(browser, site, width, dark):
    pages = sorted(page for page in site.rglob("*.html") if "_static" not in page.parts)
    assert len(pages) > 60
    for page in pages:
        browser.open(page, width, 900, dark=dark)
        assert barriers(browser) == [], page.name
        assert browser.run(FITS), page.name
