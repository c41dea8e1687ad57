from itertools import product

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.censored import brackets_from_table, fit_brackets
from rockfrag.pedestal.paired_tests import pair_tests
from rockfrag.shaketable.definitions import tests_from_ida as read_ida
from rockfrag.shaketable.laboratory_table import read_measured
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.steps import GeometricSteps

TOWERS, FLOORS = ("T1", "T2", "T3"), ("GF", "F3", "F5")
AMPLITUDES = 0.05 * 1.02 ** np.arange(150)


@pytest.fixture
def simulated():
    """Tests of synthetic objects that overturn above a threshold of their own, one of them censored."""
    rng = np.random.default_rng(7)
    ida_curves = []
    for name, earthquake, floor, side in product(TOWERS, "ABCD", FLOORS, ("P", "NP")):
        over = 0.3 * np.exp(0.3 * rng.normal()) < AMPLITUDES
        about = {
            "configuration": f"P&{name}" if side == "P" else name,
            "object": name,
            "pedestal": side,
            "motion": f"{earthquake}_{floor}",
            "earthquake": earthquake,
            "floor": floor,
        }
        body = np.where(over, "statue", "")
        curve = {"amplitude_g": AMPLITUDES, "overturned": over, "overturned_body": body}
        ida_curves.append(pd.DataFrame(about | curve))
    return read_ida(
        pd.concat(ida_curves),
        Protocol(GeometricSteps(0.05, 0.05)),
        definitions=["step_protocol"],
        limits_g={"A_GF": 0.3},
    )


@pytest.fixture
def measured(simulated, tmp_path):
    """The same tests, written down as a laboratory would and read as a measured table."""
    path = tmp_path / "measured.csv"
    names = "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark"
    simulated[names.split(",")].to_csv(path, index=False)
    return read_measured(path)


def test_measured_and_simulated_tests_are_the_same_table(simulated, measured):
    assert (simulated["censored"] == "right").any()
    pd.testing.assert_frame_equal(
        measured.drop(columns="definition"), simulated.drop(columns="definition")
    )


def test_measured_tests_go_through_the_statistics_of_the_simulated_ones(simulated, measured):
    pd.testing.assert_frame_equal(pair_tests(measured).table, pair_tests(simulated).table)
    fits = [fit_brackets(brackets_from_table(table)) for table in (measured, simulated)]
    assert fits[0].theta == fits[1].theta
    assert fits[0].beta == fits[1].beta
    assert fits[0].theta == pytest.approx(0.3, rel=0.15)
