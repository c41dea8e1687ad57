"""The page of ``rockfrag app`` answers of a body in space as ``rockfrag assess`` does, and shows it rocking."""

from pathlib import Path

import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.app.writing import write_app
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.request import make_request
from rockfrag.assess.words import five_lines

from ..app_forms import settings_of
from .browsers import Browser

pytestmark = pytest.mark.slow

SHAKEN = {"measure": "PGA", "level": "0.3 g", "years": "475"}
BOX = {"width": "25 cm", "depth": "40 cm", "height": "1 m", "facing": "30"} | SHAKEN
VASE = {"width": "25 cm", "height": "1 m", "round": True} | SHAKEN
PICTURE = "document.getElementById('scene').toDataURL()"


@pytest.fixture(scope="module")
def motions(made_motions) -> MotionSet:
    made = made_motions(12)
    return MotionSet(made, made, tuple((i, i + 1) for i in range(0, 12, 2)), "12 made motions")


def until(browser: Browser, script: str) -> None:
    """Wait until something is so in the page."""
    look = f"const look = () => {script} ? done(true) : setTimeout(look, 20); look();"
    assert browser.run(f"new Promise(done => {{ {look} }})")


@pytest.mark.parametrize("form", [BOX, VASE], ids=["box", "vase"])
@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_says_and_shows_what_moves_in_space(
    browser: Browser, motions, tmp_path: Path, form, width
):
    path = tmp_path / "assess.html"
    write_app(motions, {key: str(value) for key, value in form.items()}, path, made=True)
    browser.open(path, width, 1200)
    until(browser, "document.body.dataset.stage === 'complete'")
    found = assess_with(make_request(settings_of(form), "form"), motions)
    said = browser.run("document.getElementById('lines').innerText")
    for line in five_lines(found)[:4]:
        title, _, words = line.partition(": ")
        if title in ("Result", "Position"):
            assert words in said
    until(browser, "document.getElementById('scene').tabIndex === 0")
    until(browser, "document.getElementById('scene-words').textContent !== ''")
    before = browser.run(PICTURE)
    press = "new KeyboardEvent('keydown', {key: 'ArrowLeft'})"
    browser.run(f"document.getElementById('scene').dispatchEvent({press})")
    assert browser.run(PICTURE) != before
    assert browser.run("document.documentElement.scrollWidth <= innerWidth")
    browser.run(
        "(() => { const depth = document.getElementById('field-depth'); depth.value = '1 parsec';"
        "depth.dispatchEvent(new Event('input', {bubbles: true})); })()"
    )
    until(browser, "document.querySelector('[aria-invalid=true]') !== null")
    assert browser.console == []
