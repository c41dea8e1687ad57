"""Names are data: whatever they are, they stay in their folder, in their cell and in their line."""

import csv
import io
import re
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rockfrag.base.errors import LONGEST_MESSAGE, InputError
from rockfrag.base.figure_style import figure_style, new_figure, save_figure
from rockfrag.base.files import FORMULA, check_name, csv_text, file_name, write_table
from rockfrag.fragility.exports import identifiers
from rockfrag.report.page import Column, inline_svg, table_html

HOSTILE = st.one_of(
    st.text(max_size=300),
    st.text(alphabet="./\\-_ {}*?<>|:\"'&;$%=+@~\n\t\x00T1é像", max_size=30),
    st.sampled_from(
        [".", "..", "../x", "con", "NUL.txt", "com1", "-rf", "~", "$x^{2$", "</svg><script>", "=1+1", "]]>", "a."]
    ),
)  # fmt: skip


def usable(name: str) -> bool:
    try:
        check_name(name)
    except InputError:
        return False
    return True


@given(HOSTILE)
def test_a_message_is_one_short_line_whatever_it_quotes(name: str):
    said = str(InputError(f"begins {name * 40} ends."))
    assert said.isprintable() and len(said) <= LONGEST_MESSAGE
    assert said.startswith("begins ") and said.endswith(" ends.")


@given(HOSTILE)
def test_every_name_is_a_file_in_its_folder(name: str):
    made = file_name(name)
    assert re.fullmatch(r"[\w][\w.-]{0,89}", made, re.ASCII) and made[-1] != "."
    assert made.split(".")[0].casefold() not in ("con", "nul", "aux", "prn", "com1")


@given(HOSTILE)
def test_names_that_are_taken_show_in_tables_and_are_no_formula(name: str):
    if usable(name):
        assert name.isprintable()
        assert not name.startswith(FORMULA)
        assert csv_text(pd.DataFrame({"name": [name]})).count("\n") == 2


@given(st.lists(HOSTILE, min_size=1, max_size=6), st.lists(HOSTILE, max_size=6))
def test_no_cell_of_a_csv_file_is_a_formula(names: list[str], titles: list[str]):
    # no table of ours holds what the reader of this test would stumble over
    names, titles = (
        [re.sub("[\0\r]", "", text) for text in texts] for texts in (names, titles)
    )
    table = pd.DataFrame(
        {"name": names, **{title: "-x" for title in titles if title != "name"}}
    )
    for row in csv.reader(io.StringIO(csv_text(table))):
        for cell in row:
            # what begins as a formula may be a number, and nothing else
            if len(cell) > 1 and cell.startswith(("=", "+", "-", "@", "\t")):
                float(cell)


def test_numbers_and_plain_names_are_written_as_they_are(tmp_path: Path):
    table = pd.DataFrame(
        {"name": ["P&T1", "-3", "-", None], "change": [-1.5, -0.0, 1e-300, 2.0]}
    )
    assert csv_text(table) == "name,change\nP&T1,-1.5\n-3,-0.0\n-,1e-300\n,2.0\n"
    write_table(pd.DataFrame({"station": ["=1+1"]}), tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text() == "station\n'=1+1\n"


@given(HOSTILE)
def test_every_name_that_is_taken_is_text_in_html(name: str):
    if usable(name):
        page = str(table_html(pd.DataFrame({"a": [name]}), [Column("a", name)], name))
        root = ElementTree.fromstring(page)
        assert root.find("figcaption").text == name  # type: ignore[union-attr]
        assert next(root.iter("td")).text == name
        assert {item.tag for item in root.iter()} == {
            *("figure", "figcaption", "table", "thead", "tbody", "tr", "th", "td")
        }


@pytest.mark.parametrize(
    "name",
    ["$x^{2$", r"$\frac{1}{0}$", "a_b^c", "</text><script>", "&amp;", "像", "%s{x}"],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore:Glyph")
def test_every_name_is_text_in_a_figure(tmp_path: Path, name: str):
    with figure_style():
        figure = new_figure()
        axes = figure.subplots()
        axes.plot([0, 1], [0, 1], label=name)
        axes.set_title(name)
        axes.legend()
    save_figure(figure, tmp_path / "f.svg")
    svg = inline_svg(
        (tmp_path / "f.svg").read_text(encoding="utf-8"), file_name(name), name
    )
    root = ElementTree.fromstring(str(svg))
    assert root.get("aria-label") == name
    texts = [
        "".join(item.itertext())
        for item in root.iter("{http://www.w3.org/2000/svg}text")
    ]
    assert texts.count(name) == 2
    assert not list(root.iter("{http://www.w3.org/2000/svg}script"))


@given(st.lists(HOSTILE, unique=True, max_size=8))
def test_other_programs_tell_configurations_apart(names: list[str]):
    made = identifiers(
        (name.encode("utf-8", "replace").decode() for name in names), "_-:"
    )
    assert len(set(made.values())) == len(made)
    for item in made.values():
        assert len(item) <= 75
        assert all(c.isascii() and (c.isalnum() or c in "_-:") for c in item)
