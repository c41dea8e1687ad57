"""How every figure of a report looks, and how it is written to the same bytes in every run."""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, RED, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
"""Colours of Okabe and Ito (2008), told apart by readers with any colour vision."""

GUIDE = "#999999"  # of lines and shapes that others are seen against
GREY, BAND = "#777777", "#e9e9e9"  # of what is a bound only, and of ranges
OKABE_ITO = (BLUE, ORANGE, GREEN, RED, SKY, PURPLE, BLACK, YELLOW)

COLUMN_WIDTH, PAGE_WIDTH = 3.5, 7.0  # of one and of two columns of a journal [in]
WIDEST = 4.4  # [in], of figures wider than a column that can still be read on a phone
DOTS_PER_INCH = 200

CONFIGURATION_COLOURS = (ORANGE, BLUE, *OKABE_ITO[2:])
"""Colours of the configurations of one object; alone and on its pedestal as in all other figures."""

STYLE = {
    **mpl.rc_params_from_file(
        Path(__file__).with_suffix(".mplstyle"), use_default_template=False
    ),
    "axes.prop_cycle": cycler(color=OKABE_ITO),
    # laid out for the same dots as written: lengths of text depend on them
    "figure.dpi": DOTS_PER_INCH,
    "savefig.dpi": DOTS_PER_INCH,
}


@contextmanager
def figure_style() -> Iterator[None]:
    """Draw and save figures inside this block.

    Returns
    -------
    A context in which matplotlib draws with :data:`STYLE`.
    """
    with mpl.rc_context(STYLE):
        yield


def new_figure(width: float = PAGE_WIDTH, height: float = 3.0) -> Figure:
    """Return an empty figure [in] that belongs to no window and needs no closing.

    Parameters
    ----------
    width, height : of the figure [in]

    Returns
    -------
    The figure, drawn by Agg.
    """
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    return figure


@contextmanager
def panels(
    width: float, height: float, *shape: int, **shared: Any
) -> Iterator[tuple[Figure, Any]]:
    """Draw an empty figure [in] and its panels inside this block: one, or as ``Figure.subplots`` makes them.

    Parameters
    ----------
    width, height : of the figure [in]
    shape : rows and columns of panels; one panel without them
    **shared : keywords of ``Figure.subplots``, such as ``sharex``

    Returns
    -------
    A context that gives the figure, and its panel or an array of panels.
    """
    with figure_style():
        figure = new_figure(width, height)
        yield figure, figure.subplots(*shape, **shared)


def draw_history(panel: Axes, time: Floats, values: Floats, **line: Any) -> float:
    """Draw values over time with zero and a dot at the largest, and return that in magnitude; shapes (n,).

    Parameters
    ----------
    panel : axes to draw in
    time, values : of the samples, shape (n,)
    **line : keywords of the line, in the place of those that all histories have

    Returns
    -------
    The largest magnitude of the values, in their unit.
    """
    peak = int(np.abs(values).argmax())
    panel.axhline(0, color=GUIDE, linewidth=0.6, zorder=1)
    panel.plot(time, values, **{"color": BLUE, "linewidth": 0.6, **line})
    panel.plot(time[peak], values[peak], "o", color=RED, markersize=3)
    return float(abs(values[peak]))


def plain_log(axes: Axes, which: str) -> None:
    """Make axes logarithmic, ``x``, ``y`` or ``xy``, with ticks such as 0.1, 0.2, 0.5 instead of powers of ten.

    Parameters
    ----------
    axes : that have their data already
    which : ``x``, ``y`` or ``xy``
    """
    near = (1.0, 2.0, 3.0, 5.0, 7.0)
    for name in which:
        axes.set(**{f"{name}scale": "log"})
        axis, ends = (
            (axes.xaxis, axes.get_xlim) if name == "x" else (axes.yaxis, axes.get_ylim)
        )
        low, high = ends()
        decades = np.log10(high / low)
        # fewer ticks over more decades
        known = (
            (1.0, near),
            (2.5, (1.0, 2.0, 5.0)),
            (4.0, (1.0, 3.0)),
            (np.inf, (1.0,)),
        )
        steps = next(steps for most, steps in known if decades < most)
        axis.set_major_locator(LogLocator(base=10.0, subs=steps, numticks=30))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())


def letter_panels(axes: Iterable[Axes], size: float = 8.5) -> None:
    """Name panels (a), (b), … above their upper left corners, where there is more than one.

    Parameters
    ----------
    axes : panels in the order of their letters
    size : of the letters [points]
    """
    panels = list(axes)
    for letter, panel in zip(
        "abcdefghijklmnop", panels if len(panels) > 1 else [], strict=False
    ):
        title = panel.get_title(loc="left")
        panel.set_title(f"({letter}) {title}".strip(), loc="left", pad=3, fontsize=size)


def checked_title(title: object) -> str:
    """Return the heading of a figure, which is a text.

    Parameters
    ----------
    title : heading that a user gave

    Returns
    -------
    The heading.
    """
    if not isinstance(title, str):
        raise InputError(
            f"title: expected a text that heads the figure, got {title!r}."
        )
    return title


def note_figure(words: str) -> Figure:
    """Return a figure that says in words why there is nothing to draw.

    Parameters
    ----------
    words : one sentence

    Returns
    -------
    The figure, one column wide.
    """
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.6)
        figure.text(0.5, 0.5, words, ha="center", va="center", wrap=True)
        return figure


def save_figure(figure: Figure, *paths: str | os.PathLike[str]) -> None:
    """Write a figure to each path, by its ending as ``.svg`` or ``.png``, without dates.

    Parameters
    ----------
    figure : that is drawn ready
    paths : of the files; their folders are made
    """
    # matplotlib records its version and the time unless told not to
    options: dict[str, dict[str, Any]] = {
        "svg": {"metadata": {"Date": None, "Creator": None}},
        "png": {"metadata": {"Software": None}, "pil_kwargs": {"compress_level": 4}},
    }
    with figure_style(), mpl.rc_context({"figure.constrained_layout.use": False}):
        # laid out once, not twice for each file, and nothing is drawn for it
        if engine := figure.get_layout_engine():
            engine.execute(figure)
        figure.set_layout_engine(None)
        for path in paths:
            ending = os.path.splitext(path)[1].lstrip(".")
            with whole_file(path) as part:
                figure.savefig(part, format=ending, **options[ending])
