"""The simulation in the page, in a plane and in space, has the study's outcomes, and answers to sizes and keys."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag import Block
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live.live_space import AMPLITUDES_G, Standing, live_in_space
from rockfrag.report.page import Page
from rockfrag.report.part import Answer
from rockfrag.system.system import turned_about_vertical

from .browsers import FITS, Browser, opened, put, waited

pytestmark = pytest.mark.slow


def outcome(browser: Browser) -> str:
    return str(browser.run("document.querySelector('#live .outcomes').textContent"))


def test_the_live_outcome_is_that_of_the_table(browser: Browser, report: Path):
    opened(browser, report)
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
    opened(browser, report)
    before = outcome(browser)
    assert "Live: overturns" in before
    put(browser, "#live .sizes input", "48")
    slender = outcome(browser)
    assert "Live: stands" in slender and "not in the table of the study" in slender
    browser.run("document.querySelector('#live .reset').click()")
    assert outcome(browser) == before
    browser.run("document.querySelector('#live .wider').click()")
    width = browser.run("document.querySelector('#live .sizes input').value")
    assert float(width) == pytest.approx(35)


def test_keys_move_time_and_dimensions_that_cannot_stand_are_said_to(
    browser, play_page
):
    opened(browser, play_page)
    clock = "parseFloat(document.querySelector('#live .clock').textContent)"
    before = browser.run(clock)
    key = "new KeyboardEvent('keydown', {key: 'ArrowLeft'})"
    browser.run(f"document.querySelector('#live .scene').dispatchEvent({key})")
    assert browser.run(clock) == pytest.approx(before - 0.01, abs=0.0051)
    browser.run("document.querySelector('#live .play').click()")
    browser.run("new Promise(done => setTimeout(done, 80))")
    assert browser.run(clock) > before - 0.01
    assert browser.run("document.querySelector('#live .play').textContent") == "Pause"
    put(browser, "#live .sizes input", "900")
    assert any(word in outcome(browser) for word in ("edge", "touch", "stand"))
    assert browser.console == []


TIME = np.arange(900) * 0.01
BOX = turned_about_vertical(Block(0.35, 1.2, 300.0, depth=0.45).system(), 20.0)
VASE = Block(0.3, 1.0, 120.0, round=True).system()
SHAPE = np.exp(-(((TIME - 2.5) / 1.3) ** 2))
WAVES = GroundMotion(
    Motion(4.0 * np.sin(6.3 * TIME) * SHAPE, 0.01, "wave </script>", {}),
    Motion(5.0 * np.sin(5.1 * TIME + 1) * SHAPE, 0.01, "b", {}),
)
COMPUTED = "document.querySelector('#live').dataset.bar"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box that stands turned, and a vase on a pedestal that stays."""
    bodies = {"box": Standing(BOX), "vase": Standing(VASE, Block(0.5, 0.8, 400.0))}
    path = tmp_path_factory.mktemp("live") / "space.html"
    element = live_in_space(bodies, [WAVES])
    answer = Answer(asked="Does it topple?", sentences=[])
    path.write_text(Page("In space", "Live.", answer, live=element).html())
    # of which the module of a body in space, with walls and wax, is more than half
    assert len(element) < 150_000
    return path


@pytest.mark.parametrize(
    ("body", "system", "width"), [("0", BOX, 390), ("1", VASE, 1280)]
)
def test_outcomes_over_the_amplitudes_are_those_of_the_package(
    browser, page, body, system, width
):
    from rockfrag import overturns

    opened(browser, page, width, 900, ready=COMPUTED)
    assert browser.run(FITS)
    put(browser, "#live .body", body, "change")
    waited(browser, COMPUTED)
    data = "JSON.parse(document.getElementById('live-data').textContent)"
    scales = np.array(AMPLITUDES_G) / browser.run(f"{data}.motions[0].peak_g")
    expected = overturns([system], [WAVES], scales=scales).overturned.ravel()
    assert browser.run(COMPUTED) == "".join("1" if fell else "0" for fell in expected)
    assert 0 < expected.sum() < expected.size
    assert browser.console == []


def test_keys_and_sizes_change_what_is_seen(browser: Browser, page: Path):
    opened(browser, page, ready=COMPUTED)
    seen = "document.querySelector('#live .scene').toDataURL()"
    pictures = [browser.run(seen)]
    for key in ("ArrowLeft", "ArrowUp", "+", "0"):
        press = f"new KeyboardEvent('keydown', {{key: '{key}'}})"
        browser.run(f"document.querySelector('#live .scene').dispatchEvent({press})")
        pictures.append(browser.run(seen))
    assert pictures.pop() == pictures[0]
    assert len(set(pictures)) == 4
    state = "document.querySelector('#live .state').textContent"
    browser.run("document.querySelector('#live .stronger').click()")
    assert browser.run(state).startswith("It falls")
    waited(browser, COMPUTED)
    browser.run("document.querySelector('#live .weaker').click()")
    before = browser.run(state)
    assert before.startswith("It stands")
    put(browser, "#live .sizes input", "60")
    assert browser.run(state) != before
    put(browser, "#live .amplitude", "0")
    assert browser.run(state) == "It stays at rest."
