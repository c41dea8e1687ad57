"""An old study or table is told the new name of a key or a column in one sentence."""

from pathlib import Path

import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.fragility.observations import observations_from_table
from rockfrag.keywords import RENAMED, check_names
from rockfrag.pedestal.paired_tests import check_tests
from rockfrag.records.catalogue import read_catalogue
from rockfrag.schema import checked
from rockfrag.tabular import read_rows


def test_new_names_are_not_old_ones_of_something_else():
    assert not set(RENAMED.values()) & set(RENAMED)


def test_a_name_that_is_known_here_is_no_old_one():
    check_names("table", ["event"], ["event", "earthquake"])
    check_names("table", ["event"], ["motion"])


def table(folder: Path, text: str) -> Path:
    path = folder / "motions.csv"
    path.write_text(text, encoding="utf-8")
    return path


TESTS = pd.DataFrame({"pga_g": [0.1, 0.2], "overturned": [0, 1], "event": ["a", "b"]})


@pytest.mark.parametrize(
    "read",
    [
        lambda folder: read_catalogue(table(folder, "name,event,file\nA,Friuli,a.txt\n")),
        lambda folder: read_rows(table(folder, "event,value\nA,1\n"), ["earthquake", "value"]),
        lambda _: checked(
            {"table": "t.csv", "columns": {"event": "x"}}, "measured_table", "a.yaml"
        ),
        lambda _: observations_from_table(TESTS, "pga_g", motion=None, earthquake="earthquake"),
        lambda _: check_tests(pd.DataFrame({"event": ["a"], "object": ["b"]})),
    ],
)
def test_what_has_an_old_name_is_told_the_new_one(tmp_path, read):
    with pytest.raises(InputError, match=r"event is now called earthquake; rename it\.$"):
        read(tmp_path)
