import numpy as np
import pandas as pd
import pytest

from rockfrag_thesis.floor_order import HYPOTHESES
from rockfrag_thesis.sections.building import floor_amplitudes
from rockfrag_thesis.sections.floor_order import floor_hypotheses, floor_order

PERIODS = (0.3, 0.5, 0.7)


@pytest.fixture
def tests():
    floors = {"GF": [0.4, 0.4, 0.4], "F3": [0.5, 0.3, 0.2], "F5": [0.6, 0.2, 0.3]}
    rows = [
        (period, floor, value)
        for floor, values in floors.items()
        for period, value in zip(PERIODS, values, strict=True)
    ]
    means = pd.DataFrame(rows, columns=["value", "floor", "mean_g"])
    return means.assign(axis="first_period_s", pedestal="NP", by="floor")


@pytest.fixture
def margins():
    rows = [
        {"hypothesis": name, "value": period, "margin": margin}
        for name in (*HYPOTHESES, "order")
        for period, margin in zip(PERIODS, (-0.5, -0.1, 0.3), strict=True)
    ]
    table = pd.DataFrame(rows)
    return table.assign(
        axis="first_period_s",
        definition="step_protocol",
        label=[f"first period {value:g} s" for value in table["value"]],
    )


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


def test_the_building_figure_has_a_line_per_floor_and_marks_what_is_not_to_be_believed(tests):
    means = tests.assign(label="x", credible=[True, True, False] * 3)
    means["label"] = [f"first period {value:g} s" for value in means["value"]]
    axes = floor_amplitudes(means, "first_period_s").axes[0]
    lines = {line.get_label(): line.get_ydata().tolist() for line in axes.lines}
    assert lines["F3"] == [0.5, 0.3, 0.2]
    crosses = [line for line in axes.lines if line.get_marker() == "x"]
    assert [line.get_xdata().tolist() for line in crosses] == [[2]] * 3
