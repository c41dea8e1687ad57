"""Figures of spectra show every motion, and the blocks that fell."""

import math

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.figure_style import save_figure
from rockfrag.records.motion import Motion
from rockfrag.report.figures.spectra import comparison_figure, spectra_figure

ALPHA = math.atan(1 / 4)
T = np.arange(500) * 0.01
STRONG = Motion(6 * np.sin(np.pi * T / 5) * np.sin(5 * T), 0.01, "strong_one")
WEAK = Motion(1.5 * np.sin(np.pi * T / 5) * np.sin(5 * T), 0.01, "weak")


def test_one_row_per_motion_and_marks_where_blocks_fall(tmp_path) -> None:  # type: ignore[no-untyped-def]
    figure = spectra_figure([STRONG, WEAK], [ALPHA, 0.3])
    assert len(figure.axes) == 6
    assert figure.axes[0].get_title(loc="left") == "strong one"
    rotation = [figure.axes[1], figure.axes[4]]
    fallen = [
        sum(len(line.get_xdata()) for line in axes.lines if line.get_marker() == "|")
        for axes in rotation
    ]
    assert fallen[0] > 0 and fallen[1] == 0
    save_figure(figure, tmp_path / "one.svg")
    assert (tmp_path / "one.svg").stat().st_size > 10_000


def test_oscillators_above_blocks_below() -> None:
    figure = comparison_figure([STRONG, WEAK], ALPHA)
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels[:3] == ["Sd [cm]", "Sv [cm/s]", "Sa [g]"]
    assert [text.get_text() for text in figure.axes[4].get_legend().get_texts()] == [
        "strong one",
        "weak",
    ]


def test_too_many_or_no_motions_are_refused() -> None:
    with pytest.raises(InputError, match="one to six motions"):
        spectra_figure([], [ALPHA])
    with pytest.raises(InputError, match="one to six motions"):
        spectra_figure([WEAK], [0.1, 0.2, 0.3, 0.4])
    with pytest.raises(InputError, match="one to 8 motions"):
        comparison_figure([WEAK] * 9, ALPHA)
