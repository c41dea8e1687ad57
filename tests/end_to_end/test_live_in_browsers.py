"""The simulation in the page has the study's outcomes, and answers to sizes and keys."""

from pathlib import Path

import pytest

from .browsers import READY, Browser, put

pytestmark = pytest.mark.slow

DT = 0.01


def outcome(browser: Browser) -> str:
    return str(browser.run("document.querySelector('#live .outcomes').textContent"))


def test_the_live_outcome_is_that_of_the_table(browser: Browser, report: Path):
    browser.open(report)
    assert browser.run(READY)
    bodies = browser.run("document.querySelectorAll('#live .body option').length")
    most = int(browser.run("document.querySelector('#live .amplitude').max"))
    seen = []
    for body in range(bodies):
        put(browser, "#live .body", str(body), "change")
        for motion in ("0", "3", "8"):
            put(browser, "#live .motion", motion, "change")
            for place in range(0, most + 1, 2):
                put(browser, "#live .amplitude", str(place))
                seen.append(outcome(browser))
    assert all(words.endswith("Equal.") and "Not equal" not in words for words in seen)
    assert any("Live: overturns" in words for words in seen)
    assert any("Live: stands" in words for words in seen)


def test_another_width_is_another_body_at_once(browser: Browser, report: Path):
    browser.open(report)
    assert browser.run(READY)
    before = outcome(browser)
    assert "Live: overturns" in before
    put(browser, "#live .sizes input", "48")
    assert "Live: stands" in outcome(browser) and "not in the table of the study" in outcome(
        browser
    )
    browser.run("document.querySelector('#live .reset').click()")
    assert outcome(browser) == before
    browser.run("document.querySelector('#live .wider').click()")
    assert float(
        browser.run("document.querySelector('#live .sizes input').value")
    ) == pytest.approx(35)


def test_dimensions_that_cannot_stand_are_said_to(browser: Browser, play_page: Path):
    browser.open(play_page)
    assert browser.run(READY)
    put(browser, "#live .sizes input", "900")
    assert "edge" in outcome(browser) or "touch" in outcome(browser) or "stand" in outcome(browser)
    assert browser.console == []


def test_keys_move_time(browser: Browser, play_page: Path):
    browser.open(play_page)
    assert browser.run(READY)
    clock = "parseFloat(document.querySelector('#live .clock').textContent)"
    before = browser.run(clock)
    key = "new KeyboardEvent('keydown', {key: 'ArrowLeft'})"
    browser.run(f"document.querySelector('#live .scene').dispatchEvent({key})")
    assert browser.run(clock) == pytest.approx(before - DT, abs=0.0051)
    browser.run("document.querySelector('#live .play').click()")
    browser.run("new Promise(done => setTimeout(done, 80))")
    assert browser.run(clock) > before - DT
    assert browser.run("document.querySelector('#live .play').textContent") == "Pause"
