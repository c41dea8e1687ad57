"""The one-file page reads a museum's table with sides in columns, and says what to do with dimensions in words."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from rockfrag.assess import app

NODE = shutil.which("node")
SCRIPT = """
const fields = ["name", "width", "height", "depth", "round"].map((name) => ({ name, key: [name], kind: "text" }));
const lists = require(process.argv[1])({ measures: {} }, fields);
const text = require("fs").readFileSync(0, "utf8");
try { console.log(JSON.stringify(lists.read("export.csv", text, (id) => id).forms)); }
catch (error) { console.log(JSON.stringify(error.message)); }
"""


def read(text: str):
    script = Path(app.__file__).with_name("lists.js")
    done = subprocess.run(
        [NODE, "-e", SCRIPT, str(script)],
        input=text,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_sides_in_columns_are_read_and_words_are_sent_to_the_command():
    rows = read(
        "ObjectID,Title,Height (cm),Width (cm),Depth (cm),Diameter (cm)\n"
        '1,"Bust, left",60,20.5,,\n2,Vase,45,,,14\n3,Case,1800,400,300,\n'
    )
    assert rows[0] == {"name": "Bust, left", "width": "20.5 cm", "height": "60 cm"}
    assert rows[1]["width"] == "14 cm" and rows[1]["round"] == "true"
    assert rows[2]["depth"] == "300 cm"
    assert read('Title,Dimensions\nBust,"H 60 x W 20 cm"\n') == "file_in_words"
    usual = read("name,width,height\na,30 cm,90 cm\n")
    assert usual == [{"name": "a", "width": "30 cm", "height": "90 cm"}]
    assert read("name,colour\na,red\n") == "file_keys"
