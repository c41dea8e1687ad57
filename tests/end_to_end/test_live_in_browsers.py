"""The simulation in the page is the simulation: the same bits, and the study's outcomes."""

import base64
import json
from pathlib import Path

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack, simulate

from .browsers import READY, Browser, put

pytestmark = pytest.mark.slow

CASES = 50
DT = 0.01

RUN = """
(() => {
  const kernel = document.getElementById('live').kernel;
  const bytes = (values) => {
    const found = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
    let text = '';
    for (const one of found) text += String.fromCharCode(one);
    return btoa(text);
  };
  return CASES.map(({ body, samples, gravity }) => {
    const made = kernel.bodyOf({ ...body, g: gravity });
    const response = kernel.integrate({ body: made, samples: Float64Array.from(samples), dt: DT, history: true });
    return {
      theta1: bytes(response.theta1), theta2: bytes(response.theta2),
      omega1: bytes(response.omega1), omega2: bytes(response.omega2),
      times: response.contact_events.map(one => one.time), fallen: response.fallen,
    };
  });
})()
"""


def random_body(rng: np.random.Generator) -> Block | Stack:
    """A block, or a stack of two: some lean, some have their weight off the middle."""

    def block(width: float) -> Block:
        height = width * rng.uniform(1.5, 4.5)
        odd = rng.random() < 0.5
        return Block(
            width,
            height,
            1000 * width**2 * height,
            cg_offset=rng.uniform(-0.1, 0.1) * width if odd else 0.0,
            lean=rng.uniform(-0.03, 0.03) if odd else 0.0,
        )

    statue = block(rng.uniform(0.1, 0.5))
    if rng.random() < 0.4:
        return statue
    width = statue.width * rng.uniform(1.2, 2.0)
    pedestal = Block(
        width, width * rng.uniform(0.5, 1.5), 1500 * width**3, lean=rng.uniform(-0.01, 0.01)
    )
    return Stack(pedestal, statue, offset=rng.uniform(-0.05, 0.05) * width)


def measured(rng: np.random.Generator, body: Block | Stack) -> float | list[float] | None:
    """A measured restitution of some bodies; momentum is conserved in the others."""
    if rng.random() < 0.6:
        return None
    ratio = float(rng.uniform(0.5, 0.8))
    return ratio if isinstance(body, Block) else [ratio, ratio]


def as_given(body: Block | Stack) -> dict[str, object]:
    """Dimensions as the script takes them."""

    def block(block: Block) -> dict[str, float]:
        return {
            "width": block.width,
            "height": block.height,
            "mass": block.mass,
            "cgOffset": block.cg_offset,
            "lean": block.lean,
        }

    if isinstance(body, Block):
        return {"statue": block(body)}
    return {"statue": block(body.upper), "pedestal": block(body.lower), "offset": body.offset}


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
def test_histories_have_the_bits_of_simulate(browser: Browser, play_page: Path):
    rng = np.random.default_rng(50)
    cases, responses = [], []
    while len(cases) < CASES:
        body = random_body(rng)
        time = np.arange(500) * DT
        samples = sum(
            rng.normal() * np.sin(2 * np.pi * rng.uniform(0.4, 5) * time + rng.uniform(0, 6))
            for _ in range(8)
        )
        samples *= rng.uniform(2, 9) / np.abs(samples).max()
        restitution = measured(rng, body)
        responses.append(simulate(body, samples, DT, restitution=restitution, g=9.81))
        given = {**as_given(body), "restitution": restitution}
        cases.append({"body": given, "samples": samples.tolist(), "gravity": 9.81})
    browser.open(play_page)
    assert browser.run(READY)
    found = browser.run(RUN.replace("CASES", json.dumps(cases)).replace("DT", repr(DT)))
    moving = 0
    for response, live in zip(responses, found, strict=True):
        names = ["1", "2"][-response.system.count :]
        for column, name in enumerate(names):
            for quantity in ("theta", "omega"):
                values = np.frombuffer(base64.b64decode(live[quantity + name]))
                expected = getattr(response, quantity)[:, column]
                assert values.tobytes() == np.ascontiguousarray(expected).tobytes()
        assert live["times"] == response.contact_events["time"].tolist()
        assert bool(live["fallen"]) == response.overturned
        moving += len(live["times"]) > 0
    assert moving > 0.7 * CASES
    assert 0 < sum(response.overturned for response in responses) < CASES


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
