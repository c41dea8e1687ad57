"""A body in space rocks live in a page: with the outcomes of the package, by keys, in any width."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag import Block
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live.space import AMPLITUDES_G, Standing, live_in_space
from rockfrag.report.page import render
from rockfrag.report.part import Answer
from rockfrag.system.system import turned_about_vertical

from .browsers import Browser, put

pytestmark = pytest.mark.slow

TIME = np.arange(900) * 0.01
BOX = turned_about_vertical(Block(0.35, 1.2, 300.0, depth=0.45).system(), 20.0)
VASE = Block(0.3, 1.0, 120.0, round=True).system()
READY = (
    "new Promise(done => { const go = () => document.querySelector('#live').dataset.bar ? done(true) "
    ": setTimeout(go, 30); go(); })"
)


def waves() -> GroundMotion:
    """Two components of a made motion."""
    x, y = (
        np.sin(rate * TIME + at) * np.exp(-(((TIME - 2.5) / 1.3) ** 2))
        for rate, at in ((6.3, 0), (5.1, 1))
    )
    return GroundMotion(Motion(4.0 * x, 0.01, "wave </script>", {}), Motion(5.0 * y, 0.01, "b", {}))


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A box that stands turned, and a vase on a pedestal that stays."""
    bodies = {"box": Standing(BOX), "vase": Standing(VASE, Block(0.5, 0.8, 400.0))}
    path = tmp_path_factory.mktemp("live") / "space.html"
    element = live_in_space(bodies, [waves()])
    answer = Answer(asked="Does it topple?", sentences=[])
    path.write_text(
        render(
            title="In space",
            lead="Live.",
            answer=answer,
            sections=[],
            pictures={},
            provenance={},
            live=element,
        )
    )
    assert len(element) < 130_000
    return path


@pytest.mark.parametrize(("body", "system"), [("0", BOX), ("1", VASE)])
def test_outcomes_over_the_amplitudes_are_those_of_the_package(browser, page, body, system):
    from rockfrag.engines.spatial import run_in_space

    browser.open(page)
    assert browser.run(READY)
    put(browser, "#live .body", body, "change")
    assert browser.run(READY)
    motion = waves()
    peak = browser.run(
        "JSON.parse(document.getElementById('live-data').textContent).motions[0].peak_g"
    )
    expected = run_in_space([system], [motion], np.array(AMPLITUDES_G) / peak).overturned.ravel()
    bar = browser.run("document.querySelector('#live').dataset.bar")
    assert bar == "".join("1" if fell else "0" for fell in expected)
    assert 0 < expected.sum() < expected.size
    assert browser.console == []


def test_keys_and_sizes_change_what_is_seen(browser: Browser, page: Path):
    browser.open(page)
    assert browser.run(READY)
    seen = "document.querySelector('#live .scene').toDataURL()"
    pictures = [browser.run(seen)]
    for key in ("ArrowLeft", "ArrowUp", "+"):
        press = f"new KeyboardEvent('keydown', {{key: '{key}'}})"
        browser.run(f"document.querySelector('#live .scene').dispatchEvent({press})")
        pictures.append(browser.run(seen))
    browser.run(
        "document.querySelector('#live .scene').dispatchEvent(new KeyboardEvent('keydown', {key: '0'}))"
    )
    assert browser.run(seen) == pictures[0]
    assert len(set(pictures)) == 4
    state = "document.querySelector('#live .state').textContent"
    browser.run("document.querySelector('#live .stronger').click()")
    assert browser.run(state).startswith("It falls")
    assert browser.run(READY)
    browser.run("document.querySelector('#live .weaker').click()")
    before = browser.run(state)
    assert before.startswith("It stands")
    put(browser, "#live .sizes input", "60")
    assert browser.run(state) != before
    put(browser, "#live .amplitude", "0")
    assert browser.run(state) == "It stays at rest."


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_is_wider_than_the_window(browser: Browser, page: Path, width: int):
    browser.open(page, width, 900)
    assert browser.run(READY)
    assert browser.run("document.documentElement.scrollWidth <= innerWidth")
