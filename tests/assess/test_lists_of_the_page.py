"""Files that the page writes and opens (``lists.js``): nothing is lost, no cell is a formula, no line stops it."""

import csv
import io
import json
import shutil
import subprocess
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

import rockfrag.assess
from rockfrag.assess import page_list
from rockfrag.assess.app.form import form_fields
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.request import read_request
from rockfrag.assess.standing.rolling import Round
from rockfrag.base.errors import InputError
from rockfrag.base.units import DIMENSIONS, quantity

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="Node is not installed")
LISTS = Path(rockfrag.assess.__file__).parent / "app" / "lists.js"
NAMES = ["name", "width", "height", "depth", "round"]
FIELDS = [
    {"name": name, "key": [name], "kind": "flag" if name == "round" else "text"}
    for name in NAMES
]
RUN = """
const [path, fields, units, calls] = JSON.parse(require("fs").readFileSync(0, "utf-8"));
const lists = require(path)({ measures: { PGA: {} }, units }, fields);
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
        input=json.dumps([str(LISTS), fields, {"dimensions": DIMENSIONS}, calls]),
        capture_output=True,
        text=True,
        # a file of the largest size took longer than this once
        timeout=60,
        check=True,
    )
    return json.loads(done.stdout)


def opened(
    text: str, name: str = "objects.csv", fields: list[dict] = FIELDS
) -> dict[str, Any]:
    """What the page finds in a file: its objects and the columns that it does not use."""
    answer = lists(["read", name, text], fields=fields)[0]
    if "refused" in answer:
        return answer
    return {"found": answer["found"]["forms"], "unused": answer["found"]["unused"]}


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
    "line",
    [f"name: a{' ' * 190_000}b", f"name: {' #' * 90_000}", "#" * 190_000],
    ids=["blanks", "marks", "a comment"],
)
def test_a_line_of_blanks_does_not_stop_the_page(line):
    found = opened(f"{line}\nwidth: 30cm # wide\n", "statue.yaml")
    assert found["found"][0]["width"] == "30cm"


def fields_of_the_form() -> list[dict]:
    return [asdict(field) for field in form_fields([PGA])]


def test_what_the_page_saves_the_command_reads_and_the_page_opens(tmp_path):
    form = {
        **{"name": "Stele", "width": "35 cm", "height": "1,2 m", "depth": "0.5 m"},
        **{"facing": "20", "floor": "2/4", "storey_height": "3.2 m"},
        **{"period": "400 ms", "material": "steel", "pedestal_width": "60 cm"},
        **{"pedestal_height": "0.5 m", "measure": "PGA", "level": "0.3 g"},
        **{"years": "475", "round": False},
    }
    fields = fields_of_the_form()
    saved = lists(["yamlOf", form], fields=fields)[0]["found"]
    path = tmp_path / "statue.yaml"
    path.write_text(saved, encoding="utf-8")
    request = read_request(path)
    assert request.objects.facing_deg == 20 and request.objects.depth == 0.5
    assert request.objects.pedestals[0].width == 0.6
    assert request.place.building.heights == (3.2,) * 4
    (back,) = opened(saved, "statue.yaml", fields)["found"]
    told = {key: text.replace(",", ".") for key, text in form.items() if text}
    assert back == told


# ---- an inventory of the command in the page

INVENTORY = """\
name,width_cm,height_cm,mass_kg,floor,cg_height_m,round,pedestal_width_m,pedestal_height_m
Bust,35,120,190,2/4,0.5,no,,
"Vase, tall",22,60,,1/4,,YES,0.5,0.9
Case,60 cm,2 m,300 kg,,,,,
"""


def metres(text: str) -> float:
    return quantity(text.replace(",", "."), "m", None)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_the_page_opens_an_inventory_as_the_command_reads_it(separator, tmp_path):
    rows = list(csv.reader(io.StringIO(INVENTORY)))
    text = io.StringIO()
    csv.writer(text, delimiter=separator).writerows(rows)
    table = text.getvalue()
    if separator == ";":
        table = table.replace("0.5", "0,5")
    path = tmp_path / "inventory.csv"
    path.write_text(table, encoding="utf-8")
    requests, faults = read_inventory(path, {"pga": "0.3 g"})
    assert not faults
    found = opened(table, fields=fields_of_the_form())
    assert found["unused"] == []
    for form, request in zip(found["found"], requests, strict=True):
        block = request.objects.block
        assert form["name"] == request.name
        assert metres(form["width"]) == pytest.approx(block.width)
        assert metres(form["height"]) == pytest.approx(block.height)
        if form["mass"]:
            assert quantity(form["mass"], "kg", None) == pytest.approx(block.mass)
        if form["cg_height"]:
            assert metres(form["cg_height"]) == pytest.approx(block.cg_height)
        assert (form["round"] == "true") == isinstance(request.objects, Round)
        assert bool(form["floor"]) == (request.place.building is not None)
        high = [metres(form[key]) for key in ("pedestal_height",) if form[key]]
        assert high == pytest.approx([one.height for one in request.objects.pedestals])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        # what changes the answer is not left out
        ("name,width_cm,height_cm,wall\na,30,90,2 cm\n", 'file_keys {"key":"wall"}'),
        ("name,width_cm,height_cm,putty_n\na,30,90,9\n", 'file_keys {"key":"putty_n"}'),
        ("name,width_cm,width,height\na,30,3 m,90\n", 'file_twice {"key":"width"}'),
        ("name,width,height,round\na,3cm,9cm,maybe\n",
         'file_flag {"row":2,"column":"round","text":"maybe"}'),
    ],
)  # fmt: skip
def test_an_inventory_that_the_form_cannot_hold_is_refused(text, words):
    assert opened(text, fields=fields_of_the_form())["refused"] == words


def test_columns_that_are_not_used_are_named():
    text = "name,width_cm,height_cm,value,wall\na,30,90,500,\n"
    assert opened(text, fields=fields_of_the_form())["unused"] == ["value"]
    museums = "Title,Height (cm),Width (cm),Medium,Credit\nBust,60,20,marble,\n"
    found = opened(museums)
    assert found["unused"] == ["Medium"]
    assert found["found"][0] == {"name": "Bust", "width": "20 cm", "height": "60 cm"}


# ---- the list in the command

KEPT = [
    {"name": "Urn", "width": "30 cm", "height": "1,2 m", "mass": "180 kg"},
    {"name": "Bust", "width": "0.32 m", "height": "68 cm", "depth": "28 cm"},
    {"name": "Vase, tall", "width": "12cm", "height": "50cm", "round": True},
    {"name": "Rack", "width": "60 cm", "height": "2 m", "restitution": "0,75"},
    {"name": "Leaning", "width": "40 cm", "height": "1 m", "cg_offset": "-2 cm"},
    {"name": "Turned", "width": "40 cm", "height": "1 m", "depth": "0.5 m", "facing": "30"},
    {"name": "High", "width": "35 cm", "height": "1 m", "pedestal_width": "50 cm",
     "pedestal_height": "90 cm", "floor": "2/4", "material": "steel"},
    {"name": "Slow", "width": "35 cm", "height": "1 m", "floor": "1/3",
     "storey_height": "3,2 m", "period": "0.4 s"},
]  # fmt: skip
SHAKEN = [
    {"measure": "PGA", "level": "0,25 g", "years": "475"},
    {"measure": "SA(1)", "level": "0.2 g"},
    {"measure": "PGV", "level": "20 cm/s"},
]


def saved(forms: list[dict]) -> tuple[str, list[str]]:
    """The list that the page saves of forms, and statue.yaml of each."""
    calls = [["csvOf", forms], *(["yamlOf", form] for form in forms)]
    csv_file, *files = lists(*calls, fields=fields_of_the_form())
    return csv_file["found"], [each["found"] for each in files]


def test_the_list_has_the_fields_of_the_form():
    names = {field["name"] for field in fields_of_the_form()}
    assert names == set(page_list.FIELDS)


@pytest.mark.parametrize("shaking", SHAKEN, ids=lambda each: each["measure"])
def test_the_command_reads_a_saved_list_as_the_statue_file_of_each_object(
    shaking, tmp_path
):
    forms = [form | shaking for form in KEPT]
    text, files = saved(forms)
    path, statue = tmp_path / "objects.csv", tmp_path / "statue.yaml"
    path.write_bytes(text.encode())
    requests, faults = read_inventory(path, {})
    assert not faults
    assert [each.name for each in requests] == [form["name"] for form in KEPT]
    for request, alone in zip(requests, files, strict=True):
        statue.write_text(alone, encoding="utf-8")
        other = read_request(statue)
        assert request.level == other.level
        assert request.objects.block == other.objects.block
        assert request.objects.in_space == other.objects.in_space
        assert request.place.key == other.place.key
        assert [c.rates.tolist() for c in request.hazard] == [
            c.rates.tolist() for c in other.hazard
        ]


@pytest.mark.parametrize(
    ("pasted", "rate"),
    [
        ("0.1 0.01\n0.4 0.0004\n", 0.01),
        ("0,1;0,01\n0,4;0,0004", 0.01),
        ("PGA,return period\n0.1,100\n0.4,2500\n", 0.01),
        ("pga\tpoe_50\n0.1\t0.3935\n0.4\t0.0198\n", 0.01),
    ],
)
def test_a_curve_that_was_pasted_counts_for_the_whole_list(pasted, rate, tmp_path):
    forms = [form | {"measure": "PGA", "hazard": pasted} for form in KEPT[:2]]
    path = tmp_path / "objects.csv"
    path.write_bytes(saved(forms)[0].encode())
    requests, _ = read_inventory(path, {})
    for request in requests:
        (curve,) = request.hazard
        assert curve.rate(0.1) == pytest.approx(rate, rel=1e-3)
        assert curve.rate(0.4) == pytest.approx(0.0004, rel=0.01)


def test_a_list_of_two_places_and_shaking_said_twice_are_refused(tmp_path):
    path = tmp_path / "objects.csv"
    two = [KEPT[0] | SHAKEN[0], KEPT[1] | SHAKEN[0] | {"level": "0.3 g"}]
    path.write_bytes(saved(two)[0].encode())
    with pytest.raises(InputError, match=r"line 3, column level: .0\.3 g. differs"):
        read_inventory(path, {})
    path.write_bytes(saved([KEPT[0] | SHAKEN[0]])[0].encode())
    with pytest.raises(InputError, match="says its shaking itself"):
        read_inventory(path, {"pga": "0.4 g"})


def test_a_row_that_the_command_refuses_is_named_and_the_others_are_kept(tmp_path):
    forms = [form | SHAKEN[0] for form in (KEPT[0], KEPT[1] | {"height": "68"})]
    path = tmp_path / "objects.csv"
    path.write_bytes(saved(forms)[0].encode())
    requests, (fault,) = read_inventory(path, {})
    assert [each.name for each in requests] == ["Urn"]
    assert "line 3" in fault and "column height" in fault
