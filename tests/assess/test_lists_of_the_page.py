"""Files that the page writes and opens (``lists.js``): nothing is lost, no cell is a formula, no line stops it."""

import csv
import io
import json
import shutil
import subprocess
from dataclasses import asdict
from pathlib import Path

import pytest

import rockfrag.assess
from rockfrag.assess.app.form import form_fields
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.request import read_request
from rockfrag.base.units import DIMENSIONS

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="Node is not installed")
LISTS = Path(rockfrag.assess.__file__).parent / "app" / "lists.js"
NAMES = ["name", "width", "height", "depth", "round"]
FIELDS = [
    {"name": name, "key": [name], "kind": "flag" if name == "round" else "text"}
    for name in NAMES
]
RUN = """
const [path, units, fields, calls] = JSON.parse(require("fs").readFileSync(0, "utf-8"));
const lists = require(path)({ measures: { PGA: {} }, units: { dimensions: units } }, fields);
const say = (key, facts) => `${key} ${JSON.stringify(facts ?? {})}`;
console.log(JSON.stringify(calls.map(([name, ...rest]) => {
  try { return { found: lists[name](...rest, say) }; }
  catch (error) { return { refused: error.message }; }
})));
"""


def lists(*calls: list, fields: list[dict] = FIELDS) -> list[dict]:
    """What each call of the page's functions gives: what is found, or why it is refused."""
    assert NODE is not None
    done = subprocess.run(
        [NODE, "-e", RUN],
        input=json.dumps([str(LISTS), DIMENSIONS, fields, calls]),
        capture_output=True,
        text=True,
        # a file of the largest size took longer than this once
        timeout=60,
        check=True,
    )
    return json.loads(done.stdout)


def opened(text: str, name: str = "objects.csv") -> dict:
    return lists(["read", name, text])[0]


def table(count: int) -> str:
    rows = (f"object {i},{20 + i % 7}cm,1m" for i in range(count))
    return "\n".join(["name,width,height", *rows]) + "\n"


def test_every_object_of_a_list_is_read_or_the_list_is_refused():
    for count in (1, 2, 499, 500):
        found = opened(table(count))["found"]
        assert [row["name"] for row in found] == [f"object {i}" for i in range(count)]
    for count in (501, 800):
        refused = opened(table(count))["refused"]
        assert refused.startswith("file_too_many")
        assert json.loads(refused.split(maxsplit=1)[1]) == {"count": count, "most": 500}


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        # an unquoted decimal comma makes a cell too many
        (["a,30cm,1m", "b,0,3cm,1m"], 'file_row_cells {"row":3,"found":4,"expected":3}'),
        (["a,30cm", "b,3cm,1m"], 'file_row_cells {"row":2,"found":2,"expected":3}'),
        (["a,30cm,1m", 'b "x,3cm,1m', "c,3cm,1m"], 'file_open_quote {"row":3}'),
        ([], "file_no_rows {}"),
    ],
)  # fmt: skip
def test_a_row_that_is_torn_is_named(rows, words):
    assert opened("\n".join(["name,width,height", *rows]))["refused"] == words


FORMULAS = (
    *("=1+1", "+1", "-2+3+cmd|' /C calc'!A0", "@SUM(A1)", "\t=1", "\r=1", "=1,2", '="x"'),
    *("- 3", "-5 %"),
)  # fmt: skip


@pytest.mark.parametrize("text", FORMULAS)
def test_no_cell_of_a_saved_list_begins_like_a_formula(text):
    written = lists(["csvOf", [{"name": text, "width": "30cm", "height": text}]])[0]
    saved = written["found"]
    rows = [*csv.reader(io.StringIO(saved, newline=""))]
    assert len(rows) == 2
    assert len(rows[1]) == len(NAMES)
    assert not any(cell.startswith(tuple("=+-@\t\r")) for cell in rows[1])
    # opened again it is what it was, but for blanks around it
    assert opened(saved)["found"][0]["name"] == text.strip()


def test_a_list_that_is_saved_is_opened_again():
    forms = [{"name": 'a "b", c\nd', "width": "0.3 m"}, {"name": "é", "height": "1,2"}]
    saved = lists(["csvOf", forms])[0]["found"]
    found = opened(f"\ufeff{saved}")["found"]
    for form, back in zip(forms, found, strict=True):
        assert {name: form.get(name, "") for name in NAMES} == back


@pytest.mark.parametrize(
    "line", [f"name: a{' ' * 190_000}b", f"name: {' #' * 90_000}", "#" * 190_000]
)
def test_a_line_of_blanks_does_not_stop_the_page(line):
    found = opened(f"{line}\nwidth: 30cm # wide\n", "statue.yaml")
    assert found["found"][0]["width"] == "30cm"


def test_what_the_page_saves_the_command_reads_and_the_page_opens(tmp_path):
    form = {
        **{"name": "Stele", "width": "35 cm", "height": "1,2 m", "depth": "0.5 m"},
        **{"facing": "20", "floor": "2/4", "storey_height": "3.2 m"},
        **{"period": "400 ms", "material": "steel", "pedestal_width": "60 cm"},
        **{"pedestal_height": "0.5 m", "measure": "PGA", "level": "0.3 g"},
        **{"years": "475", "round": False},
    }
    fields = [asdict(field) for field in form_fields([PGA])]
    saved = lists(["yamlOf", form], fields=fields)[0]["found"]
    path = tmp_path / "statue.yaml"
    path.write_text(saved, encoding="utf-8")
    request = read_request(path)
    assert request.objects.facing_deg == 20 and request.objects.depth == 0.5
    assert request.objects.pedestals[0].width == 0.6
    assert request.place.building.heights == (3.2,) * 4
    back = lists(["read", "statue.yaml", saved], fields=fields)[0]["found"][0]
    told = {key: text.replace(",", ".") for key, text in form.items() if text}
    assert back == told | {"period": "0.4 s"}
