"""The page of ``rockfrag app`` as browsers show it: it answers, loads nothing, and refuses in sentences."""

import json
import random
import time
from collections import Counter
from pathlib import Path

import pytest
import yaml

from rockfrag.assess.answer import assess_with
from rockfrag.assess.app.writing import write_app
from rockfrag.assess.findings import details_of, lines_of
from rockfrag.assess.request import make_request, read_request
from rockfrag.cli.main import main
from rockfrag.words.catalogue import catalogue

from ..app_forms import options_of, settings_of, some_form_of_any_kind
from ..case_tables import case_tables
from .browsers import (
    ANSWERED,
    FITS,
    QUICK_IN_ONE,
    Browser,
    barriers,
    expression,
    opened,
    put,
    put_file,
    waited,
)

REFUSED_FIELDS = case_tables(__file__)["fields"]
FORM = {
    "width": "25 cm",
    "height": "1 m",
    "measure": "PGA",
    "level": "0.4 g",
    "years": "475",
}
SETTINGS = {"width": "25 cm", "height": "1 m", "pga": "0.4 g", "return_period": "475"}


@pytest.fixture(scope="module")
def app_page(motions, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("app") / "assess.html"
    write_app(motions, FORM, path, made=True)
    return path


def shown_in(browser: Browser) -> list[str]:
    """The lines behind the first screen."""
    return browser.run(
        "[...document.querySelectorAll('#lines dd')].map(line => line.textContent)"
    )


@pytest.mark.parametrize(("width", "dark"), [(1400, False), (390, True)])
def test_it_answers_in_the_words_of_assess(browser, app_page, motions, width, dark):
    opened(browser, app_page, width, 900, ready=ANSWERED, dark=dark)
    request = make_request(SETTINGS, "form")
    found = assess_with(request, motions.at(request.place), holders=False)
    verdict, *others = lines_of(found)
    assert (
        browser.run("document.getElementById('headline').textContent") + "." == verdict
    )
    assert browser.run("document.getElementById('screen').textContent") == " ".join(
        others
    )
    said = [line.partition(": ")[2] for line in details_of(found)]
    lines = shown_in(browser)
    assert [lines[i] for i in (0, 1, 3)] == [said[i] for i in (0, 1, 3)]
    assert browser.run(FITS)
    assert browser.console == []


ANSWER = expression("answer.js")


@pytest.mark.usefixtures("cabinet")
@pytest.mark.parametrize("count", [1, pytest.param(200, marks=pytest.mark.slow)])
def test_its_figures_are_those_of_the_command(
    browser, own_records, tmp_path, capsys, count
):
    """The page that a command writes gives the shares and intervals of ``assess --json`` to the bit.

    Objects are of every kind, one of one's own among them, in both measures, with and without a hazard.
    """
    records, rng = ["--record", str(own_records / "catalogue.csv")], random.Random(11)
    page = tmp_path / "assess.html"
    assert main(["app", *records, *options_of(FORM), "--output", str(page)]) == 0
    opened(browser, page, ready=ANSWERED)
    compared: Counter[str] = Counter()
    while compared.total() < count:
        form = some_form_of_any_kind(rng, ["on_two_feet"])
        capsys.readouterr()
        # a kind of one's own has a key and no option
        path = tmp_path / "statue.yaml"
        own = {"records": [str(own_records / "catalogue.csv")]}
        path.write_text(yaml.safe_dump(settings_of(form) | own))
        given = [str(path)] if "stands" in form else [*options_of(form), *records]
        asked = ["assess", *given, "--json", "--output", str(tmp_path)]
        if main(asked) != 0:
            continue
        said = json.loads(capsys.readouterr().out)
        found = json.loads(browser.run(ANSWER.replace("FORM", json.dumps(form))))
        assert found["shares"] == said["fragility"]["fraction"], form
        for mine, his in (
            ("fraction", "fraction_toppling"),
            ("probability", "probability"),
        ):
            assert (found.get(mine) is None) == (said[his] is None), form
            for key in ("value", "lower", "upper") if said[his] else ():
                assert found[mine][key] == said[his][key], (form, mine, key)
        kinds = [kind for kind in ("round", "depth", "stands") if kind in form]
        compared[kinds[0] if kinds else "planar"] += 1
    assert browser.console == []
    assert count < 100 or len(compared) == 4, compared
    print(dict(compared))


REFUSED = Path(__file__).with_name("refused.html").read_text()


def test_it_loads_nothing(browser, app_page, tmp_path):
    """There is no network in these tests, the page asks for none, and all ways to ask for one are refused."""
    path = tmp_path / "refused.html"
    path.write_text(app_page.read_text().replace("<head>", f"<head>{REFUSED}", 1))
    opened(browser, path, ready=ANSWERED)
    assert browser.run("location.protocol") == "file:"
    assert browser.run("window.asked") == []
    opened(browser, app_page, ready=ANSWERED)
    loaded = browser.run(
        "performance.getEntriesByType('resource').map(entry => entry.name)"
    )
    assert [name for name in loaded if not name.startswith("blob:")] == []
    refused = browser.run("fetch('data:,x').then(() => false, () => true)")
    assert refused, "its policy refuses every request"


def test_the_last_key_stroke_is_answered(browser, app_page):
    opened(browser, app_page, ready=ANSWERED)
    for text in ("10 cm", "2 m", "45,5 cm"):
        put(browser, "#field-width", text)
        time.sleep(0.15)
    waited(browser, "document.getElementById('lines').textContent.includes('45.5 cm')")
    waited(browser, ANSWERED)
    assert "45.5 cm" in " ".join(shown_in(browser))
    assert browser.console == []


LEFT_OF_AN_ANSWER = (
    "['screen', 'state', 'behind', 'drawing', 'helping']"
    ".filter(id => document.getElementById(id).checkVisibility())"
)
"""Parts of an answer that can be seen."""


@QUICK_IN_ONE
def test_what_cannot_be_used_gets_a_sentence_beside_it(browser, app_page):
    opened(browser, app_page, ready=ANSWERED)
    for field, text in REFUSED_FIELDS:
        before = browser.run(f"document.getElementById('field-{field}').value")
        put(browser, f"#field-{field}", text)
        error = "width" if field == "cg_offset" else field
        waited(
            browser,
            f"document.getElementById('field-{error}-error').textContent.endsWith('.')",
        )
        # nothing of the answer before stands beside it, nor on the phone's bar
        headline = browser.run("document.getElementById('headline').innerText")
        error_text = f"document.getElementById('field-{error}-error').textContent"
        assert headline.endswith(browser.run(error_text)), field
        assert browser.run("document.getElementById('bar').textContent") == headline
        assert browser.run(LEFT_OF_AN_ANSWER) == [], field
        put(browser, f"#field-{field}", before)
        waited(browser, f"!document.getElementById('field-{error}-error').textContent")
    waited(browser, ANSWERED)
    assert len(browser.run(LEFT_OF_AN_ANSWER)) == 5
    assert browser.run("document.querySelectorAll('main img, main b').length") == 0
    assert browser.run("document.title") != "hit"
    assert browser.console == []


@pytest.mark.parametrize(
    ("allowed", "instead", "words"),
    [
        (" 'wasm-unsafe-eval'", "", "WebAssembly"),
        ("worker-src blob:", "worker-src 'none'", "workers"),
    ],
)
def test_a_browser_that_is_not_allowed_to_compute_says_so(
    browser, app_page, tmp_path, allowed, instead, words
):
    text = app_page.read_text()
    assert text.count(allowed) == 1
    path = tmp_path / "blocked.html"
    path.write_text(text.replace(allowed, instead))
    browser.open(path)
    waited(browser, "!document.getElementById('blocked').hidden")
    assert words in browser.run("document.getElementById('blocked').textContent")


INVENTORY = (
    "name,width_cm,height_cm,mass_kg,floor\nUrn,30,60,80,\nBust,35,120,190,2/4\n"
)


def test_objects_are_kept_and_opened_again(browser, app_page, tmp_path):
    opened(browser, app_page, ready=ANSWERED)
    browser.run(
        "URL.createObjectURL = blob => { blob.text().then(text => { window.saved = text; }); return 'blob:x'; }"
    )
    press = "[...document.querySelectorAll('#tools button')][{}].click()"
    put(browser, "#field-name", "=HYPERLINK(1)")
    waited(
        browser,
        "document.getElementById('headline').textContent.includes('=HYPERLINK')",
    )
    waited(browser, ANSWERED)
    browser.run(press.format(0))
    waited(browser, "document.querySelectorAll('#objects tr').length === 1")
    browser.run(press.format(1))
    waited(browser, "window.saved && window.saved.startsWith('name,')")
    assert (
        browser.run("window.saved")
        .splitlines()[1]
        .startswith(" =HYPERLINK(1),25 cm,1 m")
    )
    browser.run("window.saved = ''")
    browser.run(press.format(2))
    waited(browser, "window.saved")
    path = tmp_path / "statue.yaml"
    path.write_text(browser.run("window.saved"))
    request = read_request(path)
    assert (request.objects.block.width, request.hazard[0].measure.imt) == (0.25, "PGA")
    put_file(browser, "statue.yaml", "width: 30 cm\nheight: 1 m\npga: 0.5 g\n")
    waited(browser, "document.getElementById('field-width').value === '30 cm'")
    # an inventory of the command, at the place and under the shaking that stand there
    put_file(browser, "inventory.csv", INVENTORY)
    waited(browser, "document.querySelectorAll('#objects tr').length === 3")
    assert browser.run("document.getElementById('file-error').hidden")
    waited(browser, ANSWERED)
    said = " ".join(shown_in(browser))
    assert browser.run("document.getElementById('field-mass').value") == "190 kg"
    assert browser.run("document.getElementById('field-level').value") == "0.5 g"
    assert "on level 2 of 4" in browser.run("document.body.innerText"), said
    for name, text in (("a.yaml", "!!js/function x"), ("a.csv", "<script>,b\n1,2\n")):
        put_file(browser, name, text)
        waited(browser, "!document.getElementById('file-error').hidden")
        assert browser.run(
            "document.getElementById('file-error').textContent"
        ).endswith(".")


def test_readers_of_every_kind_can_use_it(browser, app_page):
    for width, dark in ((1400, False), (1400, True), (390, False), (390, True)):
        opened(browser, app_page, width, 900, ready=ANSWERED, dark=dark)
        browser.run("document.getElementById('keep').click()")
        waited(browser, "document.querySelectorAll('#objects tr').length === 1")
        browser.run(
            "document.querySelectorAll('details').forEach(one => { one.open = true; })"
        )
        assert barriers(browser) == [], (width, dark)
        assert browser.run(FITS)


SHAKEN = {"measure": "PGA", "level": "0.3 g", "years": "475"}
BOX = {"width": "25 cm", "depth": "40 cm", "height": "1 m", "facing": "30"} | SHAKEN
VASE = {"width": "25 cm", "height": "1 m", "round": True} | SHAKEN
PICTURE = "document.getElementById('scene').toDataURL()"


@pytest.mark.slow
@pytest.mark.parametrize("form", [BOX, VASE], ids=["box", "vase"])
@pytest.mark.parametrize("width", [390, 1280])
def test_the_page_says_and_shows_what_moves_in_space(
    browser, motions, tmp_path, form, width
):
    path = tmp_path / "assess.html"
    write_app(
        motions, {key: str(value) for key, value in form.items()}, path, made=True
    )
    opened(browser, path, width, 1200, ready=ANSWERED)
    found = assess_with(make_request(settings_of(form), "form"), motions)
    said = browser.run("document.getElementById('lines').textContent")
    behind = dict(line.split(": ", 1) for line in details_of(found))
    assert behind["Position"] in said and behind["At this level"] in said
    waited(browser, "document.getElementById('scene').tabIndex === 0")
    waited(browser, "document.getElementById('scene-words').textContent !== ''")
    before = browser.run(PICTURE)
    press = "new KeyboardEvent('keydown', {key: 'ArrowLeft'})"
    browser.run(f"document.getElementById('scene').dispatchEvent({press})")
    assert browser.run(PICTURE) != before
    assert browser.run(FITS)
    put(browser, "#field-depth", "1 parsec")
    waited(browser, "document.querySelector('[aria-invalid=true]') !== null")
    assert browser.console == []


@QUICK_IN_ONE
def test_a_change_of_language_keeps_what_is_chosen_and_says_all_of_it_anew(
    browser, motions, tmp_path
):
    """The picture lost how it is turned, and what holds the object stayed in the first language."""
    path = tmp_path / "assess.html"
    write_app(motions, BOX, path, made=True)
    opened(browser, path, 1280, 1000, ready=ANSWERED)
    words = "document.getElementById('scene-words').textContent"
    tried = "document.getElementById('tried').textContent.toLowerCase()"
    waited(browser, f"{words} !== ''")
    put(browser, "#slide-hold", "putty")
    waited(browser, f"{tried}.includes('wax or putty')")
    put(browser, "#language", "it", "change")
    italian = catalogue("it")
    waited(browser, f"{tried}.includes('cera o mastice')")
    assert browser.run(words).endswith(italian.text("turn_view"))
    label = "document.getElementById('scene').getAttribute('aria-label')"
    assert browser.run(label) == browser.run(words)
    assert browser.run("document.getElementById('slide-hold').value") == "putty"
    assert browser.console == []
