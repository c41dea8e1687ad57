"""Counterparts of the thesis's figures show every test, or the distribution of very many."""

import pandas as pd
from matplotlib.figure import Figure

from rockfrag.shaketable.definitions import mean_amplitudes
from rockfrag_thesis.sections.counterparts import slenderness_figure
from tests.paired_tests import build


def drawn(tests: pd.DataFrame) -> tuple[Figure, int]:
    """The figure of tests by slenderness, and how many of its markers are tests."""
    tests = tests.assign(configuration=tests["object"] + " " + tests["pedestal"])
    figure = slenderness_figure(
        tests, mean_amplitudes(tests), {"T1": 3.0, "T2": 4.0, "T3": 5.0}
    )
    lines = [
        line
        for axes in figure.axes
        for line in axes.lines
        if line.get_linestyle() == "None"
    ]
    return figure, sum(
        len(line.get_xdata()) for line in lines if line.get_marker() != "_"
    )


def test_every_test_is_drawn_and_a_crowd_as_its_distribution():
    figure, markers = drawn(build())
    assert markers == 72
    assert [axes.get_title(loc="left")[:3] for axes in figure.axes] == ["(a)", "(b)"]
    crowd, markers = drawn(build(motions=10))
    assert markers < 40
    labels = [text.get_text() for text in crowd.legends[0].get_texts()]
    assert "median, 25–75 %, 5–95 %" in labels
