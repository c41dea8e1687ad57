"""Figures of amplitudes show every test, and what is only a bound as a bound."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.path import Path as Outline

from rockfrag.base.figure_style import figure_style, new_figure, save_figure
from rockfrag.report.figures import amplitudes_by, pedestal_scatter
from rockfrag.report.sections.amplitudes import outcome_map
from rockfrag.report.sections.curves import fragility_figure
from rockfrag.report.sections.pedestal import forest_figure, ratio_axis
from rockfrag.report.sections.tested import shaker_limits
from rockfrag.shaketable.definitions import mean_amplitudes

OBJECTS = ("vase", "column & capital")


def laboratory(unfinished: int = 0) -> pd.DataFrame:
    """Tests of two objects on two floors by three records, the first ones never overturned."""
    sides = (("Alpha", "Beta", "Gamma"), ("cellar", "attic"), OBJECTS, ("P", "NP"))
    names = ["earthquake", "floor", "object", "pedestal"]
    tests = pd.MultiIndex.from_product(sides, names=names).to_frame(index=False)
    a = 0.5 * np.exp(0.2 * np.random.default_rng(4).normal(size=len(tests)))
    censored = tests.index < unfinished
    return tests.assign(
        configuration=tests["object"] + " " + tests["pedestal"],
        motion=tests["earthquake"] + "_" + tests["floor"],
        lower_g=np.where(censored, 2.0, a),
        upper_g=np.where(censored, np.nan, 1.05 * a),
        amplitude_g=np.where(censored, np.nan, a),
        repetition=1,
    )


def drawn(axes: Axes, arrows: bool = False) -> int:
    """Number of markers of tests, or of arrows, in a panel."""
    return sum(
        len(line.get_xdata())
        for line in axes.lines
        if line.get_linestyle() == "None"
        and line.get_marker() != "_"
        and isinstance(line.get_marker(), Outline) == arrows
    )


def test_every_test_is_drawn_and_those_that_never_overturned_have_arrows():
    for unfinished in (0, 5):
        tests = laboratory(unfinished)
        means = mean_amplitudes(tests)
        for by in ("object", "floor"):
            figure = amplitudes_by(by, tests, means)
            assert sum(drawn(axes) for axes in figure.axes) == 24
            assert sum(drawn(axes, arrows=True) for axes in figure.axes) == unfinished
    # the first two tests are both sides of one pair
    (axes,) = pedestal_scatter(laboratory(2), "P/NP 1.00").axes
    assert (drawn(axes), drawn(axes, arrows=True)) == (12, 2)


def test_an_overturning_at_the_first_step_points_down():
    tests = laboratory()
    tests.loc[0, ["lower_g", "upper_g", "amplitude_g"]] = [0.0, 0.1, np.nan]
    figure = amplitudes_by("object", tests, mean_amplitudes(tests))
    markers = [line.get_marker() for line in figure.axes[0].lines]
    (arrow,) = [marker for marker in markers if isinstance(marker, Outline)]
    assert np.asarray(arrow.vertices)[:, 1].min() < 0


def test_a_crowd_of_tests_is_drawn_as_its_distribution():
    tests = laboratory()
    tests = pd.concat(tests.assign(motion=tests["motion"] + f"_{k}") for k in range(20))
    tests = tests.reset_index(drop=True)
    figure = amplitudes_by("floor", tests, mean_amplitudes(tests))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "median, 25–75 %, 5–95 %" in labels
    assert all(drawn(axes) < 20 for axes in figure.axes)


def test_the_forest_draws_an_interval_only_where_there_is_one():
    rows = [
        ("whole", "all", 3, 1.02, 0.97, 1.07),
        ("floor", "cellar", 3, 1.00, np.nan, np.nan),
        ("floor", "attic", 1, 1.04, np.nan, np.nan),
    ]
    columns = ["scope", "level", "units", "ratio", "lower", "upper"]
    effects = pd.DataFrame(rows, columns=columns).assign(unit="earthquake", p_holm=0.4)
    axes = forest_figure(effects).axes[0]
    labels = [tick.get_text() for tick in axes.get_yticklabels()]
    assert labels == [
        "all pairs (3 earthquakes)",
        "cellar (3 earthquakes)",
        "attic (1 earthquake)",
    ]
    # that of one, and one interval
    assert sum(len(line.get_xdata()) == 2 for line in axes.lines) == 2


@pytest.mark.parametrize("span", [(0.55, 1.25), (0.2, 5.0), (0.9, 1.1), (0.7, 1.3)])
def test_ticks_of_ratios_do_not_print_over_each_other(span):
    axes = new_figure(3.5, 2).subplots()
    ratio_axis(axes, span)
    low, high = axes.get_xlim()
    ticks = [tick for tick in axes.get_xticks() if low <= tick <= high]
    assert 1 in ticks
    assert np.diff(np.log(ticks)).min() / np.log(high / low) > 0.1


@pytest.mark.parametrize(
    ("amplitudes", "fallen", "bars"),
    [
        ([0.1, 0.2, 0.4, 0.8], [False, True, False, True], 2),
        ([0.1, 0.2], [False, False], 0),
        ([0.3], [True], 1),
    ],
)
def test_the_map_has_a_bar_for_each_range_that_overturns(amplitudes, fallen, bars):
    # names of records are whole where a reader looks them up
    about = {"configuration": "vase", "motion": "RSN825 CAPEMEND CPM_350_ground"}
    ida = pd.DataFrame(about | {"amplitude_g": amplitudes, "overturned": fallen})
    axes = outcome_map(ida, ["vase"]).axes[0]
    assert len(axes.collections[0].get_paths()) == bars
    assert about["motion"] in [tick.get_text() for tick in axes.get_yticklabels()]


def test_the_shakers_limits_stand_beside_the_objects():
    limits = pd.DataFrame({"motion": ["a", "b"], "limit_g": [0.4, 1.5]})
    limits["limited_by"] = ["stroke", "force"]
    tests = (
        laboratory()
        .iloc[:2]
        .assign(motion=["a", "b"], pedestal="NP", amplitude_g=[0.5, 0.6])
    )
    axes = shaker_limits(limits, tests).axes[0]
    assert [bar.get_width() for bar in axes.patches] == [1.5, 0.4]
    assert sorted(x for line in axes.lines for x in line.get_xdata()) == [0.5, 0.6]
    # each bar says what ends it
    said = {text.get_text().strip(): text.get_position()[0] for text in axes.texts}
    assert said.keys() == {"stroke", "force"}
    # behind the mark that lies beyond the bar
    assert said["stroke"] > 0.5 and said["force"] == 1.5


def test_a_configuration_without_a_curve_keeps_its_outcomes():
    x = np.geomspace(0.1, 1, 5)
    both = pd.DataFrame({"configuration": ["vase", "jug"]})
    known = {"theta": [0.4, np.nan], "beta": [0.3, np.nan], "p_fit": [0.5, np.nan]}
    curves = both.assign(im="PGA", unit="g", **known)
    ends = {
        name: np.repeat([0.5, np.nan], 5) for name in ("probability", "lower", "upper")
    }
    bands = both.loc[[0] * 5 + [1] * 5].assign(x=np.tile(x, 2), **ends)
    bins = both.assign(
        x=0.3, fraction=[0.4, 0.0], fraction_lower=0.0, fraction_upper=0.5
    )
    figure = fragility_figure(curves, bands, bins)
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == ["(a) vase: θ = 0.4 g, β = 0.30", "(b) jug: no median"]


def test_labels_lie_within_the_figure(tmp_path: Path):
    with figure_style():
        figure = new_figure(3.5, 2)
        axes = figure.subplots()
        axes.set_yticks([0, 1], ["a rather long label of a row", "b"])
    save_figure(figure, tmp_path / "a.png")
    assert axes.get_yticklabels()[0].get_window_extent().x0 >= 0
