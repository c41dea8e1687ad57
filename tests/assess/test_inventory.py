"""A gallery is ranked, and a wrong row is named."""

import pandas as pd
import pytest

from rockfrag.assess.inventory import assess_inventory
from rockfrag.cli import main
from rockfrag.errors import InputError

GALLERY = """name,width,height,mass,pedestal_width,pedestal_height,floor
stout,60 cm,90 cm,500 kg,,,
slender,20 cm,120 cm,60 kg,,,
Hermes,50 cm,120 cm,400 kg,60 cm|80 cm,50 cm|20 cm,
Venus,35 cm,120 cm,180 kg,50 cm,90 cm,1/2
"""


def test_objects_are_ranked_by_risk(own_records, tmp_path, capsys):
    path = tmp_path / "gallery.csv"
    path.write_text(GALLERY)
    arguments = [
        *("assess", str(path), "--pga", "0.4g", "--return-period", "475"),
        *("--record", str(own_records / "catalogue.csv"), "--output", str(tmp_path / "out")),
    ]
    assert main(arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 7
    assert "slender" in lines[1]
    assert "stout" in lines[4]
    table = pd.read_csv(tmp_path / "out" / "inventory.csv")
    assert table["probability"].is_monotonic_decreasing


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name,width,height\na,35 cm,120 cm\na,35 cm,120 cm\n", "twice"),
        ("name,width,height\na,35 cm,120\n", "line 2"),
        ("name,width,height,mass\na,35 cm,120 cm,1 g\n", "line 2.*density"),
        ("name,width,height,colour\na,35 cm,120 cm,white\n", "colour"),
        ("name,width,height,floor\na,35 cm,120 cm,attic\n", "line 2.*attic"),
        (
            "name,width_cm,height_cm,pedestal_width_cm,pedestal_height_cm\na,35,120,50|80,30\n",
            "line 2.*pedestal_height.*as many pedestals",
        ),
        (
            "name,width_cm,height_cm,pedestal_width_cm,pedestal_height_cm\na,35,120,50|x,30|30\n",
            "line 2.*pedestal_width",
        ),
        ("name,width_cm,height_cm\ninventory,35,120\n", "the page of the gallery"),
    ],
)
def test_a_wrong_row_is_named(text, words, tmp_path):
    path = tmp_path / "gallery.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        assess_inventory(path)
