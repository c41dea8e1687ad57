"""The effect of the pedestal, ratios of amplitudes with and without it; and tests that were measured."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockfrag.base import figure_style as style
from rockfrag.report import figures, page
from rockfrag.report.figures import BAND, GREY
from rockfrag.report.findings import (
    WITH_PEDESTAL,
    Sides,
    pedestal_effect,
    ratio_of,
    sides_of,
)
from rockfrag.report.page import Columns, estimated, table_html
from rockfrag.report.part import FigureSpec, Results, Section, says
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.words.sentences import (
    amplitude,
    counted,
    has_interval,
    sentence,
    shortened,
)

MOST_ROWS = 45
"""More rows than this are not legible in one figure; the finest scopes are then left to the table."""

_SCOPES = {"whole": "all pairs", "cell": "floor and object"}


def effect_columns(ratio: str = "With/without pedestal") -> Columns:
    """What is shown of :func:`rockfrag.effects.study.effects_table` after :func:`shown_effects`."""
    return (
        "scope; level = Of; pairs .0; at_bound = of which bounds .0",
        estimated("ratio", f"{ratio} [95 % interval]", 3, limits=("lower", "upper")),
        "detectable_ratio .2; within = Within ±10 %; p_holm = p (Holm) p",
    )


def shown_effects(effects: pd.DataFrame) -> pd.DataFrame:
    """Effects with scopes and levels in words, and without what says nothing where an interval has no width."""
    limits = zip(effects["lower"], effects["upper"], strict=True)
    known = np.array([has_interval(*ends, 3) for ends in limits], dtype=bool)
    return effects.assign(
        scope=effects["scope"].replace(_SCOPES),
        level=effects["level"].str.replace("/", ", "),
        within=np.where(known & effects["equivalent"].astype(bool), "yes", "–"),
        detectable_ratio=effects["detectable_ratio"].where(known),
        p_holm=effects["p_holm"].where(known),
    )


def pedestal(results: Results) -> Section | None:
    """Ratios of amplitudes with and without a pedestal, or of arrangements that are compared."""
    study = results.study
    if not study.has_pairs:
        return None
    effects, whole = results.table("pedestal/effects"), results.table("pedestal/whole")
    here = effects[effects["definition"] == DEFINITION]
    about = sides_of(study)
    found = pedestal_effect(effects, about)
    # a name that the user gave stays as it is
    ratio = sentence(about.ratio) if about is WITH_PEDESTAL else about.ratio
    parts: list[Any] = []
    if len(here):
        methods = whole.assign(definition=whole["definition"].str.replace("_", " "))
        columns: Columns = (
            "definition; method",
            estimated(
                "estimate", f"{ratio} [95 % interval]", 3, limits=("lower", "upper")
            ),
            "p = p p; smallest_p = Smallest possible p p; remark",
        )
        caption = "All pairs, by other methods and other ways to read the amplitude."
        parts = [_forest(here, about), table_html(methods, columns, caption)]
        caption = "Effect by scope, step protocol."
        if len(here) > page.MOST_TABLE_ROWS:
            each = here["scope"] == "earthquake"
            caption += (
                f" Each of the {each.sum()} earthquakes is in pedestal/effects.csv."
            )
            here = here[~each]
        file, columns = "pedestal/effects.csv", effect_columns(ratio)
        parts.insert(1, table_html(shown_effects(here), columns, caption, file))
    notes = results.table("pedestal/notes")
    notes = notes[notes["definition"] == DEFINITION] if len(notes) else notes
    return says.section(
        "pedestal", parts, found, about, study.counterparts, notes["note"]
    )


def _forest(effects: pd.DataFrame, about: Sides) -> FigureSpec:
    shown, left_out = effects, []
    for scope, words in (("cell", "floors by object"), ("earthquake", "earthquakes")):
        if len(shown) > MOST_ROWS:
            shown = shown[shown["scope"] != scope]
            left_out.append(words)
    ratio = ratio_of(effects, about)
    draw = partial(forest_figure, shown, about)
    return says.figure("pedestal_effect", draw, about, left_out, ratio)


NONE = (1 / 1.1, 1.1)  # ratios between which an effect counts as none

_TICKS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.5, 2, 3, 5, 10)
_MOST_TICKS = 7
# ticks nearer than this part of the axis would print over each other
_LEAST_APART = 0.11


def forest_figure(effects: pd.DataFrame, sides: Sides = WITH_PEDESTAL) -> Figure:
    """Ratio of amplitudes of every scope with its 95 % interval, and the ±10 % that counts as none."""
    scope = effects["scope"].to_numpy()
    # room for one empty line between the scopes
    place = np.arange(len(effects)) + 0.7 * np.cumsum(
        np.r_[False, scope[1:] != scope[:-1]]
    )
    names = ["level", "units", "unit"]
    labels = [_label(*row) for row in effects[names].itertuples(index=False, name=None)]
    columns = ["lower", "ratio", "upper", "p_holm"]
    figures = effects[columns].to_numpy(dtype=float)
    height = 0.9 + 0.19 * float(place[-1] + 1)
    with style.panels(style.COLUMN_WIDTH + 1.1, height) as (figure, axes):
        axes.axvspan(*NONE, color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        for y, (lower, ratio, upper, p) in zip(place, figures, strict=True):
            if np.isfinite([lower, upper]).all():
                axes.plot([lower, upper], [y, y], color=style.BLUE, lw=1.2)
            axes.plot(
                ratio,
                y,
                "o",
                mec=style.BLUE,
                mfc=style.BLUE if p < 0.05 else "white",
                ms=5,
            )
        axes.set_yticks(place, labels)
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        ratio_axis(axes, figures[:, :3].ravel(), sides)
        mark = partial(Line2D, [], [], color=style.BLUE, marker="o")
        handles = [
            mark(mfc=style.BLUE, label="differs from 1 (Holm, 5 %)"),
            mark(mfc="white", label="does not"),
            Line2D([], [], color=BAND, lw=6, label="±10 %"),
        ]
        figure.legend(
            handles=handles, loc="outside upper center", ncols=3, handlelength=1.4
        )
    return figure


def _label(level: str, units: int, unit: str) -> str:
    name = "all pairs" if level == "all" else shortened(level.replace("/", ", "), 30)
    return f"{name} ({counted(int(units), 'earthquake' if unit == 'earthquake' else unit)})"


def ratio_axis(
    axes: Axes,
    values: NDArray[np.float64] | Sequence[float],
    sides: Sides = WITH_PEDESTAL,
) -> None:
    """A logarithmic axis of ratios with plain ticks that covers all values and the band of none."""
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known) & (known > 0)]
    # one interval without a useful limit may not press all others together
    low = max(0.2, min(0.97 * known.min(initial=1.0), NONE[0] / 1.03))
    high = min(5.0, max(1.03 * known.max(initial=1.0), NONE[1] * 1.03))
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    ticks = [tick for tick in _TICKS if low <= tick <= high]
    for crowded in ((0.9, 1.1), (0.7, 1.2), (0.8, 1.5), (0.3, 3)):
        apart = np.diff(np.log(ticks) / np.log(high / low))
        if len(ticks) > _MOST_TICKS or apart.min(initial=np.inf) < _LEAST_APART:
            ticks = [tick for tick in ticks if tick not in crowded]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    words = "with / without pedestal" if sides == WITH_PEDESTAL else "over the other's"
    axes.set_xlabel(f"Amplitude {words}")


def measured(results: Results) -> Section | None:
    """Measured tests, their curves and the effect of the pedestal in them."""
    if results.study.measured_tests is None:
        return None
    beside = results.table("measured/beside")
    ratio = np.log(beside["ratio"].dropna())
    words = says.line(
        "beside", len(beside), len(ratio), np.exp(ratio.mean()), ratio.std()
    )
    parts: list[Markup | FigureSpec] = []
    if beside["simulated_g"].notna().any():
        parts.append(
            says.figure("measured_beside", lambda: measured_beside(beside), words)
        )
    curves, effects = (
        results.table("measured/fragility"),
        results.table("measured/effects"),
    )
    shown = beside.assign(
        measured=[amplitude(row) for row in beside.to_dict("records")]
    )
    parts += [says.table("measured", shown), says.table("measured_curves", curves)]
    if len(effects):
        caption = "Measured effect of the pedestal."
        parts.append(table_html(shown_effects(effects), effect_columns(), caption))
    notes = results.table("measured/notes")["note"]
    return says.section("measured", parts, words, notes)


def measured_beside(beside: pd.DataFrame) -> Figure:
    """Draw measured against simulated figures."""
    known = figures.drawn_tests(beside.dropna(subset=["simulated_g"]))
    with style.panels(style.COLUMN_WIDTH, 3.2) as (figure, axes):
        largest = 1.15 * float(known[["a", "simulated_g"]].to_numpy(dtype=float).max())
        axes.plot([0, largest], [0, largest], color=figures.GREY, lw=0.8)
        for side, name in figures.SIDE_NAME.items():
            rows = known[known["pedestal"] == side]
            if rows.empty:
                continue
            marker, colour = figures.SIDE_MARKER[side], figures.SIDE_COLOUR[side]
            figures.plot_tests(
                axes, rows["simulated_g"].to_numpy(float), rows, marker, colour
            )
            axes.plot([], [], marker, mfc="none", color=colour, label=name)
        axes.set(xlim=(0, largest), ylim=(0, largest), aspect="equal")
        axes.set(xlabel="Simulated amplitude [g]", ylabel="Measured amplitude [g]")
        axes.legend()
        return figure
