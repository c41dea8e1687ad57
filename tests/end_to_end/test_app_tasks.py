"""Tasks of a conservator with the page of ``rockfrag app``, from opening the file to printed sheets."""

import json
import re
import time
from pathlib import Path

import pytest

from rockfrag.cli.main import main

from .browsers import (
    ANSWERED,
    FITS,
    QUICK_IN_ONE,
    Browser,
    opened,
    put,
    put_file,
    waited,
)

LINES = "[...document.querySelectorAll('#lines dd')].map(line => line.textContent)"


@pytest.fixture(scope="module")
def page(own_records, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("app") / "assess.html"
    records = str(own_records / "catalogue.csv")
    assert main(["app", "--record", records, "--output", str(path)]) == 0
    return path


def reach(browser: Browser, where: str) -> None:
    """Go on from key to key until an element has the focus."""
    for _ in range(80):
        if browser.run(f"document.activeElement.matches({json.dumps(where)})"):
            return
        browser.press("Tab")
    raise AssertionError(f"no way by the keyboard to {where}")


def type_into(browser: Browser, **fields: str) -> None:
    """Type into fields, in the order in which they come."""
    for field, text in fields.items():
        reach(browser, f"#field-{field}")
        browser.run("document.activeElement.select && document.activeElement.select()")
        browser.press(text)


def answered(browser: Browser, *, of: str) -> list[str]:
    """The headline of the answer about an object, its first screen, and the lines behind it."""
    text = "document.getElementById('{}').textContent"
    waited(browser, f"{ANSWERED} && {text.format('answer')}.includes({json.dumps(of)})")
    time.sleep(0.3)
    waited(browser, ANSWERED)
    shown = [browser.run(text.format(id)) for id in ("headline", "screen")]
    return [*shown, *browser.run(LINES)]


def printed(browser: Browser) -> str:
    """What the sheets of the page on paper say."""
    browser.run("dispatchEvent(new Event('beforeprint'))")
    return browser.run("document.getElementById('sheets').textContent")


@QUICK_IN_ONE
def test_a_bust_on_a_plinth_on_the_first_floor_of_a_masonry_house(browser, page):
    opened(browser, page, 1400, 1000, ready=ANSWERED)
    type_into(browser, name="Marble bust", width="28 cm", height="62 cm", mass="85 kg")
    reach(browser, "#form summary")  # what more is known of it: nothing
    browser.press("Tab")
    reach(browser, "#form summary")
    browser.press("Enter")
    type_into(browser, pedestal_width="34 cm", pedestal_height="1,10 m")
    reach(browser, "#form summary")
    browser.press("Enter")
    type_into(browser, floor="1/3")
    type_into(browser, level="0,15 g", years="475")
    result, screen, _, risk, position, *_ = answered(browser, of="level 1 of 3")
    assert "Marble bust" in result and "In 50 years" in screen
    assert "in 50 years" in risk and "its pedestal" in position
    sheet = printed(browser)
    assert (
        "Width of the pedestal: 34 cm" in sheet
        and "PGA: 0,15 g" in sheet
        and result in sheet
    )
    assert browser.run("document.querySelectorAll('.sheet').length") == 1
    assert browser.console == []


@QUICK_IN_ONE
def test_a_vase_in_a_gallery_on_a_phone_in_italian(browser, page):
    opened(browser, page, 390, 844, ready=ANSWERED)
    reach(browser, "#language")
    put(browser, "#language", "it", "change")
    type_into(browser, name="Vaso", width="16 cm", height="48 cm", mass="6,5 kg")
    reach(browser, "#form summary")
    browser.press("Enter")
    type_into(browser, cg_height="55 cm")
    waited(
        browser,
        "document.getElementById('field-cg_height-error').textContent.endsWith('.')",
    )
    browser.run("document.activeElement.select()")
    browser.press("26 cm")
    lines = answered(browser, of="Vaso")
    assert "Vaso" in lines[0]
    said = " ".join(lines).lower()
    assert not any(
        word in said for word in ("topple", "height", "motions that", "interval ")
    )
    text = browser.run("document.body.innerText")
    assert all(word in text for word in ("Si ribalta?", "Larghezza", "I numeri"))
    rows = "[...document.querySelectorAll('#compared tr')].map(row => [...row.cells].map(one => one.textContent))"
    # beside the sliders stands the number of the answer
    assert f"({browser.run(rows)[0][1]})" in lines[0]
    put(browser, "#slide-width", 30)
    cells = f"{rows}[1]"
    waited(browser, f"{cells}[2] !== '–'")
    before, after = (
        float(text.replace(",", ".").split()[0]) for text in browser.run(cells)[1:]
    )
    assert after < before
    assert "Vaso" in printed(browser)
    assert browser.run(FITS)
    assert browser.console == []


CABINET = {"width": "80 cm", "height": "1.8 m", "mass": "90 kg", "depth": "30 cm"}
BUST = {"width": "22 cm", "height": "55 cm", "mass": "45 kg", "depth": "22 cm"}
SHOWCASE = {"width": "60 cm", "height": "1.9 m", "mass": "160 kg", "depth": "60 cm"}
AT_A_WALL = {"there": "2", "hold": "bracket"}
HELD = {
    "Cabinet": (CABINET, AT_A_WALL, "a bracket", "bracket to the wall that bears"),
    "Bust": (BUST, {"hold": "putty"}, "wax or putty", "that holds a pull of"),
    "Showcase": (SHOWCASE, {"hold": "isolator"}, "a sliding isolator", "isolator with"),
}
"""Objects, what a conservator chooses beside them, how a sheet names it, and what is said of it."""


@pytest.mark.slow
@pytest.mark.parametrize("browser", ["chromium"], indirect=True)
@pytest.mark.parametrize("name", HELD)
def test_what_holds_an_object_is_tried_and_printed_on_a_sheet(browser, page, name):
    """The last two lines of the sheet of a cabinet stood on a second one."""
    sizes, chosen, held, says = HELD[name]
    opened(browser, page, 390, 844, ready=ANSWERED)
    for field, text in {"name": name, **sizes}.items():
        put(browser, f"#field-{field}", text)
    put(browser, "#field-level", "0.6 g")
    answered(browser, of=name)
    for choice, value in chosen.items():
        put(browser, f"#slide-{choice}", value)
    tried = "document.getElementById('tried').textContent"
    waited(browser, f"{tried}.includes({json.dumps(says)})")
    waited(browser, ANSWERED)
    if "there" in chosen:
        before = "document.getElementById('before').textContent"
        waited(browser, f"{before}.includes('{chosen['there']} cm')")
        assert "is of the object standing free" in browser.run(tried)
    said = browser.run(tried)
    # numbers do not part from their units
    bound = "[...document.querySelectorAll('#tried .together')].map(e => e.innerText)"
    assert browser.run(f"{bound}.some(text => / (N|cm)$/.test(text))")
    assert browser.run(FITS)
    sheet = printed(browser)
    assert said in sheet and f"Held by: {held}" in sheet
    assert len(re.findall(rb"/Type\s*/Page\b(?!s)", browser.printed())) == 1
    assert browser.console == []


CURVE = "PGA annual rate\n0.05 2e-2\n0.1 8e-3\n0.2 2.1e-3\n0.4 4e-4\n0.8 5e-5"

LIST = """name,width,height,mass,floor,measure,level,years
Archive cabinet,45 cm,1.9 m,140 kg,2/5,PGA,0.2 g,475
Drug cabinet,60 cm,1.8 m,90 kg,2/5,PGA,0.2 g,475
Broken row,tall,1.8 m,90 kg,2/5,PGA,0.2 g,475
Trolley,40 cm,1.3 m,60 kg,0/5,PGA,0.2 g,475
"""


@QUICK_IN_ONE
def test_cabinets_of_a_hospital_with_a_hazard_curve(browser, page):
    opened(browser, page, 1400, 1000, dark=True, ready=ANSWERED)
    type_into(browser, name="Server rack", width="60 cm", height="2 m", mass="350 kg")
    browser.run("document.getElementById('field-floor').closest('details').open = true")
    type_into(browser, floor="3/5", level=" ", years=" ")
    reach(browser, "#field-hazard")
    # pasted, not typed: a line's end is no key
    put(browser, "#field-hazard", CURVE)
    _, screen, *_ = answered(browser, of="once in 475 years")
    assert "In 50 years" in screen
    reach(browser, "#keep")
    browser.press("Enter")
    waited(browser, "document.querySelectorAll('#objects tr').length === 1")
    put_file(browser, "list.csv", LIST)
    waited(browser, "document.querySelectorAll('#objects tr').length === 4")
    waited(
        browser,
        "document.getElementById('file-error').textContent.includes('Row 4, Width')",
    )
    rows = "[...document.querySelectorAll('#objects tr')]"
    risks = browser.run(f"{rows}.map(row => parseFloat(row.cells[3].textContent))")
    assert risks == sorted(risks, reverse=True)
    sheets = printed(browser)
    assert browser.run("document.querySelectorAll('.sheet').length") == 5
    assert "hazard curve in PGA, 6 lines" in sheets and "PGA: ;" not in sheets
    for name in ("Server rack", "Archive cabinet", "Drug cabinet", "Trolley"):
        assert name in sheets
    assert browser.console == []
