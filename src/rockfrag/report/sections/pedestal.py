"""Effect of the pedestal, ratios of amplitudes with and without it; and tests that were measured.

In: the results of a study (tables ``pedestal/…`` and ``measured/…``). Out: sections of the report with their
tables and figures; ratios are with over without pedestal [-], with 95 % intervals.

Theory: ``docs/pedestal.md``.
"""

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
from rockfrag.base.figure_style import BAND, GREY
from rockfrag.report import figures, page
from rockfrag.report.findings import (
    WITH_PEDESTAL,
    Sides,
    pedestal_effect,
    ratio_of,
    sides_of,
)
from rockfrag.report.page import Column, column, estimated, p_values, table_html
from rockfrag.report.part import FigureSpec, Finding, Results, Section, chapter
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.words.sentences import (
    amplitude,
    counted,
    has_interval,
    listed,
    sentence,
    shortened,
)

MOST_ROWS = 45
"""More rows than this are not legible in one figure; the finest scopes are then left to the table."""

_SCOPES = {"whole": "all pairs", "cell": "floor and object"}


def effect_columns(ratio: str = "With/without pedestal") -> list[Column]:
    """Columns of :func:`rockfrag.effects.study.effects_table` after :func:`shown_effects`."""
    return [
        column("scope"),
        column("level", "Of"),
        column("pairs", decimals=0),
        column("at_bound", "of which bounds", decimals=0),
        estimated("ratio", f"{ratio} [95 % interval]", 3, limits=("lower", "upper")),
        column("detectable_ratio", decimals=2),
        column("within", "Within ±10 %"),
        p_values("p_holm", "p (Holm)"),
    ]


def shown_effects(effects: pd.DataFrame) -> pd.DataFrame:
    """Effects with scopes and levels in words, and without what says nothing where an interval has no width."""
    limits = zip(effects["lower"], effects["upper"], strict=True)
    known = np.array([has_interval(low, high, 3) for low, high in limits], dtype=bool)
    return effects.assign(
        scope=effects["scope"].replace(_SCOPES),
        level=[
            level_in_words(level, scope)
            for level, scope in zip(effects["level"], effects["scope"], strict=True)
        ],
        within=np.where(known & effects["equivalent"].astype(bool), "yes", "–"),
        detectable_ratio=effects["detectable_ratio"].where(known),
        p_holm=effects["p_holm"].where(known),
    )


def level_in_words(level: str, scope: str) -> str:
    """Name of a level of a scope; a slash parts floor and object, and stands in names of earthquakes as it is.

    Parameters
    ----------
    level, scope : as the table of effects has them

    Returns
    -------
    The name.
    """
    if level == "all":
        return "all pairs"
    return level.replace("/", ", ") if scope == "cell" else level


def pedestal(results: Results) -> Section | None:
    """Ratios of amplitudes with and without a pedestal, or of arrangements that are compared."""
    study = results.study
    if not study.has_pairs:
        return None
    effects, whole = results.table("pedestal/effects"), results.table("pedestal/whole")
    here = effects[effects["definition"] == DEFINITION]
    sides = sides_of(study)
    found = pedestal_effect(effects, sides)
    # a name that the user gave stays as it is
    ratio = sentence(sides.ratio) if sides is WITH_PEDESTAL else sides.ratio
    parts: list[Any] = []
    if len(here):
        methods = whole.assign(definition=whole["definition"].str.replace("_", " "))
        interval = f"{ratio} [95 % interval]"
        columns = [
            column("definition"),
            column("method"),
            estimated("estimate", interval, 3, limits=("lower", "upper")),
            p_values("p", "p"),
            p_values("smallest_p", "Smallest possible p"),
            column("remark"),
        ]
        caption = "All pairs, by other methods and other ways to read the amplitude."
        parts = [_forest(here, sides), table_html(methods, columns, caption)]
        caption = "Effect by scope, step protocol."
        if len(here) > page.MOST_TABLE_ROWS:
            each = here["scope"] == "earthquake"
            caption += (
                f" Each of the {each.sum()} earthquakes is in pedestal/effects.csv."
            )
            here = here[~each]
        shown = table_html(
            shown_effects(here), effect_columns(ratio), caption, "pedestal/effects.csv"
        )
        parts.insert(1, shown)
    notes = results.table("pedestal/notes")
    notes = notes[notes["definition"] == DEFINITION] if len(notes) else notes
    title = "Arrangements compared" if study.counterparts else "Effect of the pedestal"
    words = _pedestal_words(found, sides, list(notes["note"]))
    return chapter("pedestal", title, found[0], words, parts)


def _pedestal_words(
    found: Sequence[Finding], sides: Sides, notes: Sequence[str]
) -> list[str]:
    """Paragraphs behind the first finding: the others, how ratios are read, and notes on the pairs."""
    words = [further.said for further in found[1:]]
    words.append(
        f"The ratio is the overturning {sides.divided}, paired by object and motion. Motions of one earthquake "
        "are not independent, so intervals are over earthquakes where there are several. “Detectable” is the "
        "smallest ratio found with 80 % power. There is neither interval nor test where all amplitudes agree to "
        "the steps tested. p values are adjusted within each scope (Holm)."
    )
    for note in dict.fromkeys(notes):
        words.append(f"{sentence(note).removesuffix('.')}.")
    return words


def _forest(effects: pd.DataFrame, sides: Sides) -> FigureSpec:
    """Figure of all effects with their limits, the smallest groups left out where there are too many."""
    shown, left_out = effects, []
    for scope, words in (("cell", "floors by object"), ("earthquake", "earthquakes")):
        if len(shown) > MOST_ROWS:
            shown = shown[shown["scope"] != scope]
            left_out.append(words)
    caption = (
        f"Overturning {sides.divided}, with 95 % intervals; grey is ±10 %, the range that counts as no effect. "
        "Step protocol."
    )
    if left_out:
        caption += f" Not drawn, and in the table only: {listed(left_out)}."
    return FigureSpec(
        name="pedestal_effect",
        alt=f"Ratios by scope. All pairs: {ratio_of(effects, sides)}.",
        caption=caption,
        draw=partial(forest_figure, shown, sides),
    )


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
    names = ["level", "scope", "units", "unit"]
    labels = [
        f"{shortened(level_in_words(level, scope), 30)} ({counted(int(units), unit)})"
        for level, scope, units, unit in effects[names].itertuples(
            index=False, name=None
        )
    ]
    columns = ["lower", "ratio", "upper", "p_holm"]
    figures = effects[columns].to_numpy(dtype=float)
    height = 0.9 + 0.19 * float(place[-1] + 1)
    with style.panels(style.COLUMN_WIDTH + 1.1, height) as (figure, axes):
        axes.axvspan(NONE[0], NONE[1], color=BAND, lw=0)
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


def ratio_axis(
    axes: Axes,
    values: NDArray[np.float64] | Sequence[float],
    sides: Sides = WITH_PEDESTAL,
) -> None:
    """Set a logarithmic axis of ratios with plain ticks that covers all values and the band of none.

    Parameters
    ----------
    axes, values : where ratios are drawn, and the ratios [-]
    sides : the comparison
    """
    known = np.asarray(values, dtype=float)
    known = known[np.isfinite(known) & (known > 0)]
    # one interval without a useful limit may not press all others together
    low = max(0.2, min(0.97 * known.min(initial=1.0), NONE[0] / 1.03))
    high = min(5.0, max(1.03 * known.max(initial=1.0), NONE[1] * 1.03))
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    ticks = [tick for tick in _TICKS if low <= tick <= high]
    for omitted in ((0.9, 1.1), (0.7, 1.2), (0.8, 1.5), (0.3, 3)):
        apart = np.diff(np.log(ticks) / np.log(high / low))
        if len(ticks) > _MOST_TICKS or apart.min(initial=np.inf) < _LEAST_APART:
            ticks = [tick for tick in ticks if tick not in omitted]
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
    words = f"{counted(len(beside), 'measured test')}, {len(ratio)} of them with a simulated counterpart."
    if len(ratio) > 1:
        words += (
            f" Measured over simulated amplitude: {np.exp(ratio.mean()):.2f} in the geometric mean, with a "
            f"scatter of {ratio.std():.2f} in the logarithm."
        )
    parts: list[Markup | FigureSpec] = []
    if beside["simulated_g"].notna().any():
        figure = FigureSpec(
            name="measured_beside",
            alt=f"Measured against simulated amplitudes. {words}",
            caption="Measured against simulated amplitude of the same test; arrows are bounds.",
            draw=lambda: measured_beside(beside),
        )
        parts.append(figure)
    curves = results.table("measured/fragility")
    effects = results.table("measured/effects")
    shown = beside.assign(
        measured=[amplitude(row) for row in beside.to_dict("records")]
    )
    caption = "Measured tests beside simulated ones."
    parts.append(table_html(shown, _MEASURED_COLUMNS, caption))
    caption = "Fragility from the measured tests."
    parts.append(table_html(curves, _CURVES_COLUMNS, caption))
    if len(effects):
        caption = "Measured effect of the pedestal."
        parts.append(table_html(shown_effects(effects), effect_columns(), caption))
    notes = list(results.table("measured/notes")["note"])
    return Section("measured", "Measured tests", words, notes, parts)


_MEASURED_COLUMNS = (
    column("object"),
    column("pedestal", "Side"),
    column("earthquake"),
    column("floor"),
    column("measured", "Measured [g]", numeric=True),
    column("simulated_g", decimals=3),
    column("ratio", "Measured / simulated", decimals=2),
)
_CURVES_COLUMNS = (
    column("configuration"),
    estimated("theta", "Median θ [g]"),
    column("beta", "β", decimals=3),
)


def measured_beside(beside: pd.DataFrame) -> Figure:
    """Draw measured against simulated figures."""
    known = figures.drawn_tests(beside.dropna(subset=["simulated_g"]))
    with style.panels(style.COLUMN_WIDTH, 3.2) as (figure, axes):
        largest = 1.15 * float(known[["a", "simulated_g"]].to_numpy(dtype=float).max())
        axes.plot([0, largest], [0, largest], color=GREY, lw=0.8)
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
