"""Fragility of an inventory for ShakeCast, NED and pelicun: as documented, and by their own readers."""

import csv
import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from scipy import special

from rockfrag.aftermath.component_tables import (
    fragility_rows,
    ned_reference,
    ned_table,
)
from rockfrag.aftermath.object_fragility import object_fragilities
from rockfrag.aftermath.shakecast import shakecast_tables, shakecast_xml
from rockfrag.aftermath.shakemap import LARGER_OF_TWO
from rockfrag.assess import motions as of_motions
from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.motions import motion_set
from rockfrag.base.errors import InputError
from rockfrag.base.files import write_table
from rockfrag.cli.main import main
from rockfrag.fragility.exports import write_simcenter

INVENTORY = """\
name,width,height,latitude,longitude,floor
"Stele, ""A"" & <B>",20 cm,100 cm,35.0,135.0,
urn,15 cm,60 cm,-35.5,-70.25,3/4
"""


@pytest.fixture(scope="module")
def asked(own_records, tmp_path_factory):
    path = tmp_path_factory.mktemp("export") / "inventory.csv"
    path.write_text(INVENTORY)
    shared = {"records": {"paths": [str(own_records / "catalogue.csv")]}}
    requests, faults = read_inventory(path, shared)
    assert not faults
    motions = motion_set(requests[0].records, requests[0].place, Path())
    return requests, motions


@pytest.fixture(scope="module")
def of_ground(asked):
    return object_fragilities(*asked, PGV)[0]


@pytest.fixture(scope="module")
def on_floor(asked):
    return object_fragilities(*asked, PGA, on_floor=True)[0]


def test_medians_are_those_of_the_motions_and_a_floor_makes_an_object_more_fragile(
    of_ground, on_floor, asked
):
    stele, urn = of_ground
    assert list(stele.states) == ["rocks", "overturns"]
    for each in of_ground:
        assert each.states["rocks"].median <= each.states["overturns"].median
        assert 0.2 < each.states["overturns"].beta < 1.0
    # on its floor the urn rocks from b/h, upstairs from less of the ground's shaking
    (_, upstairs), _ = object_fragilities(*asked, PGA)
    assert on_floor[1].states["rocks"].median == pytest.approx(0.25, rel=0.02)
    assert upstairs.states["rocks"].median < 0.2
    assert urn.request.name == "urn"


def test_what_never_topples_is_left_out_by_name(asked, tmp_path):
    path = tmp_path / "stout.csv"
    path.write_text("name,width,height\nblock,3 m,1 m\n")
    requests, _ = read_inventory(path, {})
    found, without = object_fragilities(requests, asked[1], PGV)
    assert not found and without == ["block"]


def test_facilities_of_version_4_have_the_elements_that_its_import_reads(of_ground):
    root = ET.fromstring(shakecast_xml(of_ground))
    assert root.tag == "FacilityTable"
    rows = root.findall("FacilityRow")
    assert len(rows) == 2
    for row, each in zip(rows, of_ground, strict=True):
        assert row.findtext("COMPONENT_CLASS") == "CONTENTS"
        assert row.findtext("FACILITY_NAME") == each.request.name
        assert len(row.findtext("EXTERNAL_FACILITY_ID")) <= 32
        longitude, latitude, _ = map(float, row.findtext("FEATURE/GEOM").split(","))
        assert (latitude, longitude) == each.request.coordinates
        assert row.findtext("FEATURE/GEOM_TYPE") == "POINT"
        red = row.find("FRAGILITY/RED")
        curve = each.states["overturns"]
        assert red.findtext("METRIC") == "PGV"
        # maps show the larger of two components
        alpha = float(red.findtext("ALPHA"))
        assert alpha == pytest.approx(LARGER_OF_TWO * curve.median, rel=1e-3)
        assert float(red.findtext("BETA")) == pytest.approx(curve.beta, abs=1e-3)


def test_acceleration_is_in_per_cent_of_g_as_in_maps(asked):
    curves, _ = object_fragilities(*asked, PGA)
    _, table = shakecast_tables(curves)
    alpha = float(table["METRIC:PGA:ALPHA:RED"][0])
    expected = 100 * LARGER_OF_TWO * curves[0].states["overturns"].median
    assert alpha == pytest.approx(expected, rel=1e-3)


def test_tables_of_version_3_have_the_columns_and_lengths_of_its_guide(of_ground):
    facilities, curves = shakecast_tables(of_ground)
    for table in (facilities, curves):
        assert list(table.columns[:2]) == ["EXTERNAL_FACILITY_ID", "FACILITY_TYPE"]
        assert table["EXTERNAL_FACILITY_ID"].is_unique
        pattern = (
            r"METRIC:(MMI|PGV|PGA|PSA\d\d)(:(ALPHA|BETA))?:(GREEN|YELLOW|ORANGE|RED)"
        )
        others = [name for name in table.columns if name.startswith("METRIC")]
        assert others and all(re.fullmatch(pattern, name) for name in others)
    assert {"FACILITY_NAME", "LAT", "LON"} <= set(facilities)
    assert {"CLASS", "COMPONENT"} <= set(curves)
    assert facilities["SHORT_NAME"].str.len().max() <= 10
    assert facilities["DESCRIPTION"].str.len().max() <= 255


def test_names_that_are_alike_in_32_letters_give_facilities_of_their_own(of_ground):
    stele = of_ground[0]
    long = [
        replace(stele, request=replace(stele.request, name=f"{'x' * 60} {end}"))
        for end in "ab"
    ]
    facilities, _ = shakecast_tables(long)
    assert facilities["EXTERNAL_FACILITY_ID"].is_unique
    nowhere = replace(stele, request=replace(stele.request, coordinates=None))
    with pytest.raises(InputError, match="no place"):
        shakecast_xml([nowhere])
    # a longer type would be cut off where it is imported
    with pytest.raises(InputError, match="1 to 10 letters"):
        shakecast_xml([stele], "MUSEUM CONTENTS")


NED_COLUMNS = (
    *("reference", "model_id", "p58_fragility", "comp_detail", "material"),
    *("size_class", "comp_description", "reviewer", "source", "edp_metric"),
    *("edp_unit", "component_ids", "ds_rank", "ds_description", "median", "beta"),
    *("probability", "basis", "num_observations"),
)
"""Columns of NED's template of fragilities."""


def test_the_table_of_ned_has_its_columns_choices_and_units(on_floor, asked):
    table = ned_table(on_floor, "E.20.2.1")
    assert tuple(table.columns) == NED_COLUMNS
    assert set(table["edp_metric"]) == {"Peak Floor Acceleration, horizontal"}
    assert set(table["edp_unit"]) == {"g"} and set(table["basis"]) == {
        "Analytical Study"
    }
    of_model = table.groupby("model_id")
    assert (of_model["ds_rank"].apply(list).map(tuple) == (1, 2)).all()
    # rows of one model agree in all that is of the model
    for name in NED_COLUMNS[:12]:
        assert (of_model[name].nunique() == 1).all()
    velocity, _ = object_fragilities(*asked, PGV, on_floor=True)
    rows = ned_table(velocity)
    assert set(rows["edp_unit"]) == {"Meters Per Second"}
    median = velocity[0].states["overturns"].median / 100
    assert float(rows["median"][1]) == pytest.approx(median, abs=1e-4)
    assert ned_reference()["reference_label"][0] == "rockfrag"
    assert set(table["reference"]) == {f"rockfrag-{ned_reference()['csl_year'][0]}"}


HELD = {
    "putty": ("200 N", "Anchored", "wax or putty"),
    "bracket": ("300 N", "Anchored", "a bracket"),
    "cord": ("300 N", "Anchored", "cords"),
    "isolator": ("20 cm", "Isolated", "a sliding isolator"),
    "wall": ("5 cm", "Unanchored", "a wall behind it"),
    "casters": ("locked", "Unanchored", "locked casters"),
}
"""By columns of an inventory: what stands in them, how NED says it is attached, and with what."""


@pytest.mark.parametrize("column", HELD)
def test_the_words_follow_what_holds_an_object_as_the_numbers_do(
    column, on_floor, of_ground, tmp_path
):
    """All of them called it free-standing and unanchored."""
    value, attached, words = HELD[column]
    table = tmp_path / "held.csv"
    table.write_text(f"name,width,height,{column}\nurn,15 cm,60 cm,{value}\n")
    (request,), faults = read_inventory(table, {})
    assert not faults
    free = on_floor[1]
    held = replace(free, request=request)
    rows = ned_table([free, held])
    detail, about = rows["comp_detail"].tolist(), rows["comp_description"].tolist()
    assert detail == ["Unanchored"] * 2 + [attached] * 2
    assert about[0] == "Free-standing object, urn, 0.15 × 0.6 m"
    assert about[2] == f"Object with {words}, urn, 0.15 × 0.6 m"
    placed = replace(request, coordinates=(35.0, 135.0))
    in_facilities = replace(of_ground[1], request=placed)
    facilities, _ = shakecast_tables([of_ground[1], in_facilities])
    said = facilities["DESCRIPTION"].tolist()
    assert "free-standing" in said[0] and words not in said[0]
    assert "free-standing" not in said[1] and f", with {words};" in said[1]
    named = replace(held, request=replace(request, name="held"))
    curves, notes = fragility_rows([free, named]), tmp_path / "notes.json"
    write_simcenter(curves, tmp_path / "curves.csv", notes, model_error=False)
    known = json.loads(notes.read_text(encoding="utf-8"))
    assert known["ROCKFRAG.urn"]["Description"] == "Free-standing urn"
    assert known["ROCKFRAG.held"]["Description"] == f"held, with {words}"


def test_ned_imports_and_ingests_the_table(on_floor, tmp_path):
    """``NED_HOME`` is a checkout of usnistgov/NED, ``NED_PYTHON`` a Python with its requirements."""
    home = os.environ.get("NED_HOME")
    if not home:
        pytest.skip("NED_HOME names no checkout of NED")
    python = os.environ.get("NED_PYTHON", sys.executable)
    write_table(ned_table(on_floor), tmp_path / "ned.csv")
    write_table(ned_reference(), tmp_path / "reference.csv")

    def manage(*arguments: str) -> str:
        done = subprocess.run(
            [python, "manage.py", *arguments], cwd=home, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return done.stdout + done.stderr

    about = ["--model", "Reference", "--input_file", str(tmp_path / "reference.csv")]
    manage("import_model", *about, "--dry_run")
    said = manage(
        "import_fragility", "--input_file", str(tmp_path / "ned.csv"), "--dry_run"
    )
    assert "unrecognized column" not in said and "2 unique fragility model(s)" in said


def test_pelicun_reads_the_curves(on_floor, tmp_path):
    assessment = pytest.importorskip(
        "pelicun.assessment", reason="pelicun is not installed", exc_type=ImportError
    )
    path = tmp_path / "fragility.csv"
    notes = tmp_path / "fragility.json"
    write_simcenter(fragility_rows(on_floor), path, notes, model_error=False)
    with path.open(newline="") as file:
        names = {row["ID"] for row in csv.DictReader(file)}
    model = assessment.Assessment({"PrintLog": False})
    model.damage.load_model_parameters([str(path)], names)
    read = model.damage.ds_model.damage_params
    median = on_floor[1].states["overturns"].median
    found = read.loc["ROCKFRAG.urn", ("LS2", "Theta_0")]
    assert float(found) / 9.80665 == pytest.approx(median, rel=1e-3)


def test_curves_for_pelicun_are_of_the_floor_and_count_nothing_twice(
    on_floor, tmp_path
):
    path = tmp_path / "fragility.csv"
    notes = tmp_path / "fragility.json"
    write_simcenter(fragility_rows(on_floor), path, notes, model_error=False)
    with path.open(newline="") as file:
        rows = {row["ID"]: row for row in csv.DictReader(file)}
    urn = rows["ROCKFRAG.urn"]
    assert urn["Demand-Type"] == "Peak Floor Acceleration" and urn["Demand-Unit"] == "g"
    theta, beta = float(urn["LS2-Theta_0"]), float(urn["LS2-Theta_1"])
    curve = on_floor[1].states["overturns"]
    chance = special.ndtr(np.log(0.4 / theta) / beta)
    assert chance == pytest.approx(
        special.ndtr(np.log(0.4 / curve.median) / curve.beta)
    )
    notes = (tmp_path / "fragility.json").read_text()
    assert "together" not in notes and "beta holds all" in notes


def test_the_command_writes_all_files(
    asked, own_records, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr(of_motions, "motion_set", lambda *_: asked[1])
    path = tmp_path / "inventory.csv"
    path.write_text("name,width,height\nurn,15 cm,60 cm\nblock,3 m,1 m\n")
    out = tmp_path / "out"
    place = ["--at", "35", "135", "--floor", "1/2"]
    assert main(["export", str(path), *place, "--output", str(out)]) == 0
    printed = capsys.readouterr()
    assert "1 of 2 objects" in printed.out and "left out: block" in printed.err
    assert {each.name for each in out.iterdir()} == {
        *("shakecast.xml", "shakecast_facilities.csv", "shakecast_fragility.csv"),
        *("ned.csv", "ned_reference.csv", "fragility.csv", "fragility.json"),
    }
