"""How every figure of a report looks, and how it is written to the same bytes in every run."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from cycler import cycler
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from rockfrag.files import whole_file

BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, RED, PURPLE = (
    "#000000",
    "#E69F00",
    "#56B4E9",
    "#009E73",
    "#F0E442",
    "#0072B2",
    "#D55E00",
    "#CC79A7",
)
"""Colours of Okabe and Ito (2008), told apart by readers with any colour vision."""

OKABE_ITO = (BLUE, ORANGE, GREEN, RED, SKY, PURPLE, BLACK, YELLOW)

COLUMN_WIDTH, PAGE_WIDTH = 3.5, 7.0
"""Widths of figures for one and for two columns of a journal [in]."""

STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.grid": False,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "lines.markersize": 4.5,
    "axes.prop_cycle": cycler(color=OKABE_ITO),
    "figure.constrained_layout.use": True,
    "savefig.dpi": 200,
    # identifiers inside an SVG are random unless they are salted
    "svg.hashsalt": "rockfrag",
    "svg.fonttype": "path",
    "path.simplify": True,
}


@contextmanager
def figure_style() -> Iterator[None]:
    """Draw and save figures inside this block."""
    with mpl.rc_context(STYLE):
        yield


def new_figure(width: float = PAGE_WIDTH, height: float = 3.0) -> Figure:
    """Return an empty figure [in] that belongs to no window and needs no closing."""
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


def save_figure(figure: Figure, *paths: str | os.PathLike[str]) -> None:
    """Write a figure to each path, by its ending as ``.svg`` or ``.png``, without dates."""
    for path in paths:
        ending = os.path.splitext(path)[1].lstrip(".")
        # matplotlib records its version and the time unless told not to
        empty = {"svg": {"Date": None, "Creator": None}, "png": {"Software": None}}
        with figure_style(), whole_file(path) as part:
            figure.savefig(part, format=ending, metadata=empty[ending])
