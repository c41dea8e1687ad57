import math
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.shaketable.definitions import tests_from_ida as read_ida
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.shaketable.tests_table import COLUMNS, read_measured

from .conftest import ida_table

TOWERS, FLOORS = ("T1", "T2", "T3"), ("GF", "F3", "F5")
AMPLITUDES = 0.05 * 1.02 ** np.arange(150)
TEMPLATE = (
    Path(__file__).resolve().parents[2] / "config" / "experiment" / "tests-template.csv"
)

HEADER = "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark"
# synthetic: round numbers that nobody measured
ROWS = (
    "a,T1,NP,Kobe,GF,0.40,0.42,none,statue,1,",
    'b,T1,P,Kobe,F3,0.30,0.33,none,pedestal,1,"loud, and late"',
    "b,T1,P,Kobe,F3,0.33,0.36,none,statue,2,",
    "c,T1,NP,Loma Prieta,GF,0.40,,right,,1,limit of the shaker",
)


@pytest.fixture
def table(tmp_path):
    """Writer of a measured table, which returns its path."""

    def write(*rows, header=HEADER):
        path = tmp_path / "measured.csv"
        path.write_text(
            "\n".join(["# synthetic", header, *rows]) + "\n", encoding="utf-8"
        )
        return path

    return write


def test_a_measured_table_becomes_a_table_of_tests(table):
    tests = read_measured(table(*ROWS))
    assert tuple(tests.columns) == COLUMNS
    assert tests["test"].tolist() == ["a", "b", "b", "c"]
    assert tests["amplitude_g"].tolist()[:3] == [0.40, 0.30, 0.33]
    assert tests["motion"].tolist()[0] == "Kobe_GF"
    assert tests["remark"].tolist()[1] == "loud, and late"
    assert set(tests["definition"]) == {"measured"}
    last = tests.iloc[3]
    assert last["censored"] == "right"
    assert math.isnan(last["upper_g"]) and math.isnan(last["amplitude_g"])


def test_the_laboratory_may_report_another_unit_figure_and_motion(table):
    other = HEADER.replace("_g", "_m_s2")
    tests = read_measured(
        table("a,T1,NP,Kobe,GF,3.924,4.905,none,statue,1,", header=other)
    )
    columns = ["lower_g", "upper_g", "amplitude_g"]
    assert tests.loc[0, columns].tolist() == pytest.approx([0.4, 0.5, 0.4])
    row = "a,T1,NP,Kobe,GF,0.4,0.5,none,statue,1,,0.45,KAK090"
    tests = read_measured(table(row, header=HEADER + ",amplitude_g,motion"))
    assert tests.loc[0, ["amplitude_g", "motion"]].tolist() == [0.45, "KAK090"]


def test_the_template_is_an_empty_table():
    tests = read_measured(TEMPLATE)
    assert len(tests) == 0
    assert tuple(tests.columns) == COLUMNS
    assert tests["lower_g"].dtype == "float64"


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"lower_g": "0.4O"}, r"line 3, column lower_g: .* 0.4O"),
        ({"lower_g": "0.45"}, "line 3, column upper_g: must not be below"),
        ({"lower_g": "-0.1"}, "column lower_g: must be zero or more"),
        ({"censored": "right", "overturned_body": ""}, "column upper_g: must be empty"),
        ({"censored": "left"}, "column censored: must be one of none, right"),
        ({"overturned_body": ""}, "column overturned_body: names what overturned"),
        ({"overturned_body": "pedestal"}, "column overturned_body: is pedestal in"),
        (
            {"repetition": "1.5"},
            "column repetition: must be a whole number from 1, got 1.5",
        ),
        ({"test": ""}, "column test: expected a name"),
        ({"remark": "a,b"}, "line 3: expected 11 cells"),
    ],
)
def test_a_wrong_field_is_named_by_line_and_column(table, change, place):
    row = dict(zip(HEADER.split(","), ROWS[0].split(","), strict=True)) | change
    with pytest.raises(InputError, match=place) as refused:
        read_measured(table(",".join(row.values())))
    assert str(refused.value).endswith(".")


@pytest.mark.parametrize(
    ("header", "message"),
    [
        (HEADER.replace("earthquake", "motion"), "column earthquake is missing"),
        (HEADER.replace("floor", "remark"), "column 'remark' is given twice"),
        (HEADER.replace("upper_g", "upper_m_s2"), "either lower_g and upper_g or"),
        (HEADER, r"line 4.* test: 'a', repetition 1, is on line 3"),
    ],
)
def test_files_that_hold_no_table_are_refused(table, header, message):
    with pytest.raises(InputError, match=message):
        read_measured(table(ROWS[0], ROWS[0], header=header))


def test_measured_and_simulated_tests_are_the_same_table(tmp_path):
    """Tests of synthetic objects that overturn above a threshold of their own, one of them censored."""
    rng = np.random.default_rng(7)
    ida_curves = []
    for name, earthquake, floor, side in product(TOWERS, "ABCD", FLOORS, ("P", "NP")):
        over = 0.3 * np.exp(0.3 * rng.normal()) < AMPLITUDES
        ida_curves.append(ida_table(over, AMPLITUDES, name, side, earthquake, floor))
    simulated = read_ida(
        pd.concat(ida_curves),
        Protocol(GeometricSteps(0.05, 0.05)),
        definitions=["step_protocol"],
        limits_g={"A_GF": 0.3},
    )
    assert (simulated["censored"] == "right").any()
    path = tmp_path / "measured.csv"
    # written down as a laboratory would, and read as a measured table
    simulated[HEADER.split(",")].to_csv(path, index=False)
    pd.testing.assert_frame_equal(
        read_measured(path).drop(columns="definition"),
        simulated.drop(columns="definition"),
    )
