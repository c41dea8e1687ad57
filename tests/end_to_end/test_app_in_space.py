"""The page of ``rockfrag app`` answers of a body in space as ``rockfrag assess`` does, and shows it rocking."""

import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.app.writing import write_app
from rockfrag.assess.request import make_request
from rockfrag.assess.words import five_lines

from ..app_forms import settings_of
from .browsers import put, waited

pytestmark = pytest.mark.slow

SHAKEN = {"measure": "PGA", "level": "0.3 g", "years": "475"}
BOX = {"width": "25 cm", "depth": "40 cm", "height": "1 m", "facing": "30"} | SHAKEN
VASE = {"width": "25 cm", "height": "1 m", "round": True} | SHAKEN
PICTURE = "document.getElementById('scene').toDataURL()"


@pytest.mark.parametrize("form", [BOX, VASE], ids=["box", "vase"])
@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_says_and_shows_what_moves_in_space(browser, motions, tmp_path, form, width):
    path = tmp_path / "assess.html"
    write_app(motions, {key: str(value) for key, value in form.items()}, path, made=True)
    browser.open(path, width, 1200)
    waited(browser, "document.body.dataset.stage === 'complete'")
    found = assess_with(make_request(settings_of(form), "form"), motions)
    said = browser.run("document.getElementById('lines').innerText")
    for line in five_lines(found)[:4]:
        title, _, words = line.partition(": ")
        if title in ("Result", "Position"):
            assert words in said
    waited(browser, "document.getElementById('scene').tabIndex === 0")
    waited(browser, "document.getElementById('scene-words').textContent !== ''")
    before = browser.run(PICTURE)
    press = "new KeyboardEvent('keydown', {key: 'ArrowLeft'})"
    browser.run(f"document.getElementById('scene').dispatchEvent({press})")
    assert browser.run(PICTURE) != before
    assert browser.run("document.documentElement.scrollWidth <= innerWidth")
    put(browser, "#field-depth", "1 parsec")
    waited(browser, "document.querySelector('[aria-invalid=true]') !== null")
    assert browser.console == []
