"""A museum's export made an inventory: every row is in it or asked about."""

import math
from pathlib import Path

import pytest

from rockfrag.assess.inventory import read_inventory
from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.collections.exported_table import (
    inventory_table,
    is_export,
    read_export,
)
from rockfrag.collections.materials import HOLLOW, SOLIDS

EXPORT = """\
Title,Artist,Medium,Dimensions,ObjectID
Bust,A,Marble,"H 60 × W 40 × D 30 cm",11
Bust,B,Marble,"Höhe 70 cm, Breite 42 cm",12
"Vase,
two handles",C,Terracotta,"H. 45 cm, Diam. 30 cm",13
=Untitled,D,Bronze,"180 x 60 x 40 cm",14
Stele,E,Granite,"H 180–185 × W 60–62 cm",15
"""


@pytest.fixture
def export(tmp_path):
    path = tmp_path / "export.csv"
    path.write_text(EXPORT, encoding="utf-8")
    return path


def test_every_row_is_in_the_inventory_or_asked_about(export, tmp_path, capsys):
    place, understood = tmp_path / "objects.csv", tmp_path / "understood.csv"
    arguments = ["--output", str(place), "--understood", str(understood)]
    assert main(["collection", str(export), *arguments]) == 1
    printed = capsys.readouterr()
    assert printed.out.startswith("4 of 5 objects")
    assert "line 6, Untitled: which length is the height" in printed.err
    requests, faults = read_inventory(place, {})
    assert not faults
    assert [request.name for request in requests] == [
        "Bust",
        "Bust (12)",
        "Vase, two handles",
        "Stele",
    ]
    assert understood.read_text(encoding="utf-8").count("\n") == 6


def test_the_order_of_the_museum_answers_the_question(export, tmp_path):
    arguments = ["--order", "HWD", "--output", str(tmp_path / "objects.csv")]
    assert main(["collection", str(export), *arguments]) == 0


def test_a_range_is_taken_to_the_side_that_topples_first(export):
    stele = inventory_table(read_export(export)).set_index("name").loc["Stele"]
    assert (stele["height_m"], stele["width_m"]) == ("1.85", "0.6")


def test_columns_of_numbers_come_before_words(tmp_path):
    path = tmp_path / "numbers.csv"
    path.write_text(
        "Title,Dimensions,Height (cm),Width (cm),Depth (cm)\n"
        'A,"see file",180.5,60,\nB,"H 20 × W 10 cm",,,\n',
        encoding="utf-8",
    )
    first, second = read_export(path)
    assert first.dimensions.understood == "height 180.5 cm, width 60 cm"
    assert second.dimensions.understood == "height 20 cm, width 10 cm"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("Title,Medium\nA,Marble\n", "expected a column Dimensions"),
        ("Title,Dimensions\nA,H 20 cm,more\n", "line 2: expected 2 cells"),
        ("Title,Height (cm)\nA,tall\n", "column height: expected a number"),
        ("Title,Dimensions\n", "expected a header line and a row"),
    ],
)
def test_what_cannot_be_read_is_said_with_its_line(tmp_path, text, says):
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says):
        read_export(path)


def test_assess_and_after_read_a_museums_table_as_it_was_exported(
    export, tmp_path, own_records, capsys
):
    shaken = ["--record", str(own_records / "catalogue.csv"), "--pga", "0.3 g"]
    shaken += ["--output", str(tmp_path / "out")]
    assert main(["assess", str(export), *shaken]) == 2
    assert "line 6, Untitled: which length is the height" in capsys.readouterr().err
    assert main(["assess", str(export), *shaken, "--keep-going"]) == 0
    assert "Vase, two handles" in capsys.readouterr().out
    assert main(["after", str(export), *shaken, "--order", "HWD"]) == 0
    assert capsys.readouterr().out.count("rocked and stands") == 5


def test_an_inventory_is_no_export_and_an_export_is_no_inventory(export, tmp_path):
    assert is_export(export)
    path = tmp_path / "inventory.csv"
    path.write_text("name,width,height\na,30 cm,90 cm\n")
    assert not is_export(path)
    path.write_text("Title,Height (cm),Width (cm)\na,90,30\n")
    assert is_export(path)
    assert not is_export(tmp_path / "nowhere.csv")


def test_solid_materials_give_masses_and_hollow_ones_none(tmp_path):
    rows = {
        "Stele": ("Carrara marble", "H 100 x W 40 x D 20 cm", 0.08 * 2700),
        "Säule": ("Kalkstein, Farbreste", "Höhe 100 cm, Dm. 20 cm", math.pi * 25),
        "Figure": ("Lindenholz", "H 100 × B 20 × T 20 cm", 0.04 * 455),
        "Saint": ("oak wood, traces of paint", "H 100 x W 20 x D 20 cm", 0.04 * 750),
        # stated, or not to be known: hollow, of two materials, without a depth
        "Weighed": ("marbre", "H. 100 ; L. 40 ; P. 20 cm ; poids 90 kg", 90),
        "Bronze": ("bronze", "H 100 x W 40 x D 20 cm", None),
        "Vase": ("terracotta", "H 45 cm, Diam. 30 cm", None),
        "Cast": ("plaster", "H 100 x W 40 x D 20 cm", None),
        "Both": ("marble and wood", "H 100 x W 40 x D 20 cm", None),
        "Based": ("bronze on a marble base", "H 100 x W 40 x D 20 cm", None),
        "Relief": ("marble", "H 100 x W 40 cm", None),
        "Unknown": ("mixed media", "H 100 x W 40 x D 20 cm", None),
    }
    path = tmp_path / "export.csv"
    lines = [f'{name},"{rows[name][0]}","{rows[name][1]}"' for name in rows]
    path.write_text("\n".join(["Title,Medium,Dimensions", *lines]) + "\n")
    for each in read_export(path):
        expected = rows[each.name][2]
        if expected is None:
            assert each.mass is None, each.name
        else:
            assert each.mass == pytest.approx(expected, rel=1e-3), each.name
    table = inventory_table(read_export(path)).set_index("name")
    assert float(table["mass_kg"]["Stele"]) == pytest.approx(216)
    assert table["mass_kg"]["Bronze"] == ""
    stele = read_export(path)[0]
    assert stele.understood.endswith(
        "solid Carrara marble of 2600 to 2800 kg/m³ (Bolz and Tuve 1973)"
    )


def test_densities_stand_in_the_docs_with_their_sources():
    text = (Path(__file__).parents[2] / "docs" / "collections.md").read_text()
    rows = {
        tuple(cell.strip() for cell in line.strip("|").split("|"))
        for line in text.splitlines()
        if line.startswith("|")
    }
    for solid in SOLIDS:
        between = f"{solid.low:.0f} to {solid.high:.0f}"
        assert (solid.name, between, solid.source) in rows
    words = [word for solid in SOLIDS for word in solid.words]
    assert len(set(words)) == len(words) and not set(words) & HOLLOW
