"""Figures show every test, and are the same bytes for the same data."""

import numpy as np
import pytest

from rockfrag.pedestal import effects_table, pair_tests
from rockfrag.report.figures.pedestal import (
    forest_figure,
    pedestal_scatter,
    sides_figure,
    slenderness_figure,
)
from rockfrag.report.figures.style import save_figure

SLENDERNESS = {"T1": 3.0, "T2": 4.0, "T3": 5.0}


def points(axes):
    """Markers drawn without a line [x, y]."""
    drawn = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "None"]
    return np.vstack([xy for xy in drawn if len(xy)])


@pytest.mark.parametrize(("panels", "count"), [(None, 1), ("floor", 3), ("event", 4)])
def test_scatter_shows_36_pairs(tests_table, panels, count):
    tests = tests_table(1)
    shown = [axes for axes in pedestal_scatter(tests, panels).axes if axes.get_visible()]
    assert len(shown) == count
    drawn = np.vstack([points(axes) for axes in shown])
    pairs = pair_tests(tests).table
    assert len(drawn) == 36
    assert np.sort(drawn[:, 1] / drawn[:, 0]) == pytest.approx(np.sort(np.exp(pairs["d"])))


def test_slenderness_panels_show_72_tests_and_the_arithmetic_means(tests_table):
    tests = tests_table(1)
    figure = slenderness_figure(tests, slenderness=SLENDERNESS)
    assert sum(len(points(axes)) for axes in figure.axes) == 72
    means = next(x.get_ydata() for x in figure.axes[0].lines if x.get_marker() == "_")
    without = tests[tests["pedestal"] == "NP"].groupby("object")["amplitude_g"].mean()
    assert means == pytest.approx(without.to_numpy())
    assert len(slenderness_figure(tests, by_floor=True, slenderness=SLENDERNESS).axes) == 6


def test_censored_tests_are_arrows_and_not_in_the_means(tests_table):
    tests = tests_table(1)
    row = tests.index[(tests["object"] == "T1") & (tests["pedestal"] == "P")][0]
    tests.loc[row, ["censored", "lower_g", "upper_g", "amplitude_g"]] = ["right", 0.9, None, None]
    for figure in (
        pedestal_scatter(tests),
        slenderness_figure(tests, slenderness=SLENDERNESS),
        sides_figure(tests, "object", slenderness=SLENDERNESS),
    ):
        arrows = [text for axes in figure.axes for text in axes.texts if text.arrow_patch]
        assert len(arrows) == 1


def test_sides_by_floor_for_each_object(tests_table):
    figure = sides_figure(tests_table(1), "floor", panels="object", slenderness=SLENDERNESS)
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["T1", "T2", "T3"]
    labels = [tick.get_text().replace("\n", " ") for tick in figure.axes[0].get_xticklabels()]
    assert labels == ["ground floor", "3rd floor", "5th floor"]


def test_forest_has_a_line_per_scope_and_the_same_bytes_twice(tests_table, tmp_path):
    effects = effects_table(pair_tests(tests_table(1)).table, ("GF", "F3", "F5"))
    for name in ("one", "two"):
        save_figure(forest_figure(effects), tmp_path / f"{name}.svg")
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()
    labels = [tick.get_text() for tick in forest_figure(effects).axes[0].get_yticklabels()]
    assert len(labels) == 20
    assert labels[:4] == [
        "all pairs (4 events)",
        "ground floor (4 events)",
        "3rd floor (4 events)",
        "5th floor (4 events)",
    ]


def test_effect_without_scatter_can_be_drawn(tests_table):
    tests = tests_table(1, effect=0, sd_event=0, sd_motion=0, sd_pair=0)
    forest_figure(effects_table(pair_tests(tests).table))
