"""An old study or table is told the new name of a key or a column in one sentence."""

import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.fragility.observations import observations_from_table
from rockfrag.pedestal.paired_tests import check_tests
from rockfrag.records.catalogue import read_catalogue
from rockfrag.renamed_keys import RENAMED, check_names
from rockfrag.schema import checked
from rockfrag.tabular import read_rows


def test_new_names_are_not_old_ones_of_something_else():
    assert not set(RENAMED.values()) & set(RENAMED)


def test_a_name_that_is_known_here_is_no_old_one():
    check_names("table", ["event"], ["event", "earthquake"])
    check_names("table", ["event"], ["motion"])


def test_a_catalogue_with_the_old_column_is_told_the_new_one(tmp_path):
    path = tmp_path / "motions.csv"
    path.write_text("name,event,file\nA,Friuli,a.txt\n", encoding="utf-8")
    with pytest.raises(
        InputError, match=r"motions\.csv: event is now called earthquake; rename it\.$"
    ):
        read_catalogue(path)


def test_a_table_with_the_old_column_is_told_the_new_one(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("event,value\nFriuli,1\n", encoding="utf-8")
    with pytest.raises(InputError, match="event is now called earthquake"):
        read_rows(path, ["earthquake", "value"])


def test_a_study_with_an_old_key_is_told_the_new_one():
    with pytest.raises(InputError, match=r"my.yaml: key columns: event is now called earthquake"):
        checked({"table": "t.csv", "columns": {"event": "quake"}}, "measured_table", "my.yaml")


def test_a_data_frame_with_the_old_column_is_told_the_new_one():
    table = pd.DataFrame({"pga_g": [0.1, 0.2], "overturned": [0, 1], "event": ["a", "b"]})
    with pytest.raises(InputError, match="event is now called earthquake"):
        observations_from_table(table, "pga_g", motion=None, earthquake="earthquake")
    with pytest.raises(InputError, match="event is now called earthquake"):
        check_tests(pd.DataFrame({"event": ["a"], "object": ["b"]}))
