import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockfrag.base.errors import InputError
from rockfrag_thesis.floor_order import HYPOTHESES, floor_margins, margins_table
from rockfrag_thesis.hypotheses.evidence import THESIS_BODIES
from rockfrag_thesis.hypotheses.floors import FLOORS
from rockfrag_thesis.sections.building import floor_amplitudes
from rockfrag_thesis.sections.floor_order import floor_hypotheses, floor_order
from tests.paired_tests import build


def table_of(order=(1.2, 1.0, 1.1), gains=(0.1, -0.05, -0.05)):
    """Tests of two earthquakes; amplitude = object × floor, times 1 + gain with the pedestal."""

    def of_floor(values):
        logs = dict(zip(FLOORS, np.log(values), strict=True))
        return lambda name, earthquake, floor: logs[floor]

    return build(
        of_floor(1 + np.array(gains)), of_floor(order), noise=0.0, earthquakes="AB"
    )


def test_margins_are_the_logarithms_they_are_said_to_be():
    margins = floor_margins(table_of())
    assert set(HYPOTHESES) | {"order"} == set(margins)
    assert margins["C35"] == pytest.approx(math.log(1.1))
    assert margins["C36"] == pytest.approx(-math.log(0.95))
    assert margins["C37"] == pytest.approx(-math.log(0.95))
    # C34 wants an increase on the ground floor, and none of 10 % or more above it
    assert margins["C34"] == pytest.approx(math.log(1.1))
    assert margins["C41"] == pytest.approx(math.log(1.1) + math.log(0.95))
    assert margins["C43"] == pytest.approx(math.log(1.2 / 1.1))
    assert margins["C44"] == pytest.approx(math.log(1.1))
    assert margins["order"] == pytest.approx(math.log(1.2 / 1.1))
    # all objects gain alike: T1 neither more nor less, and its sign on the 3rd floor is not the
    # exception that C38 wants
    assert margins["C39"] == pytest.approx(0, abs=1e-12)
    assert margins["C38"] == pytest.approx(math.log(0.95))


@settings(max_examples=4, derandomize=True)
@given(
    gain=st.floats(0.001, 0.5),
    loss=st.floats(-0.5, -0.001),
    ground=st.floats(1.001, 2.0),
    third=st.floats(0.3, 1.0),
)
def test_the_thesis_contradicts_itself_on_floors(gain, loss, ground, third):
    # C43 with C35 and C37 puts P on the ground floor above P on the 5th, against C42
    margins = floor_margins(table_of((ground, third, 1.0), (gain, 0.0, loss)))
    assert min(margins["C35"], margins["C37"], margins["C43"]) > 0
    assert margins["C42"] < 0


def test_censored_tests_count_with_what_they_survived():
    table = table_of()
    censored = (table["floor"] == "GF") & (table["pedestal"] == "P")
    table.loc[censored, "lower_g"] = table.loc[censored, "amplitude_g"]
    table.loc[censored, "amplitude_g"] = np.nan
    table["censored"] = np.where(censored, "right", "none")
    assert floor_margins(table) == pytest.approx(floor_margins(table_of()))


def test_tables_without_all_floors_or_pairs_are_refused():
    table = table_of()
    with pytest.raises(InputError, match="F5"):
        floor_margins(table[table["floor"] != "F5"])
    with pytest.raises(InputError, match="with and without pedestal"):
        floor_margins(table[table["pedestal"] == "NP"])


def test_other_buildings_are_compared_for_objects_of_ones_own():
    """They were taken for the thesis's, whose slenderness alone was known."""
    names = {"T1": "bust", "T2": "vase", "T3": "column"}
    own = {names[name]: body for name, body in THESIS_BODIES.items() if name in names}
    tests = table_of().assign(
        axis="reference",
        value=0.0,
        label="reference",
        credible=True,
        definition="laboratory",
    )
    tests["object"] = tests["object"].map(names)
    margins = margins_table(tests, own).set_index("hypothesis")["margin"]
    assert margins["order"] == pytest.approx(math.log(1.2 / 1.1))


def test_a_tower_that_is_missing_leaves_its_statements_without_a_margin():
    table = table_of()
    margins = floor_margins(table[table["object"] != "T3"])
    assert {name for name, margin in margins.items() if math.isnan(margin)} == {
        "C38",
        "C39",
        "C40",
    }
    assert margins["C35"] == pytest.approx(math.log(1.1))


PERIODS = (0.3, 0.5, 0.7)


@pytest.fixture
def tests():
    floors = {"GF": [0.4, 0.4, 0.4], "F3": [0.5, 0.3, 0.2], "F5": [0.6, 0.2, 0.3]}
    means = pd.DataFrame(floors | {"value": PERIODS}).melt(
        "value", None, "floor", "mean_g"
    )
    return means.assign(axis="first_period_s", pedestal="NP", by="floor")


@pytest.fixture
def margins():
    names = pd.DataFrame({"hypothesis": [*HYPOTHESES, "order"]})
    table = names.merge(
        pd.DataFrame({"value": PERIODS, "margin": (-0.5, -0.1, 0.3)}), "cross"
    )
    label = table["value"].map("first period {:g} s".format)
    return table.assign(axis="first_period_s", definition="step_protocol", label=label)


def test_the_order_of_the_floors_is_shaded_where_it_holds(tests, margins):
    figure = floor_order(tests, margins, "step_protocol")
    (axes,) = figure.axes
    lines = {line.get_label(): line.get_ydata().tolist() for line in axes.lines}
    assert lines["3rd floor"] == [0.5, 0.3, 0.2]
    (shaded,) = axes.patches
    assert shaded.get_x() == pytest.approx(0.6)  # half-way between the last two periods
    assert shaded.get_x() + shaded.get_width() == pytest.approx(0.7)


def test_the_map_of_statements_shows_every_margin(margins):
    figure = floor_hypotheses(margins, "first_period_s", "step_protocol")
    (image,) = figure.axes[0].images
    assert np.asarray(image.get_array()) == pytest.approx(
        100 * np.tile([-0.5, -0.1, 0.3], (len(HYPOTHESES), 1))
    )
    (dots,) = figure.axes[0].lines
    assert set(dots.get_xdata()) == {2}


def test_the_building_figure_has_a_line_per_floor_and_marks_what_is_not_to_be_believed(
    tests,
):
    label = tests["value"].map("first period {:g} s".format)
    means = tests.assign(label=label, credible=[True, True, False] * 3)
    axes = floor_amplitudes(means, "first_period_s").axes[0]
    lines = {line.get_label(): line.get_ydata().tolist() for line in axes.lines}
    assert lines["F3"] == [0.5, 0.3, 0.2]
    crosses = [line for line in axes.lines if line.get_marker() == "x"]
    assert [line.get_xdata().tolist() for line in crosses] == [[2]] * 3
