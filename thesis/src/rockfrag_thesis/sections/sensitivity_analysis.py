"""Sensitivity analysis: one parameter of the ideal model at a time is perturbed.

In: the table ``sensitivity_analysis/effects``, ratios with over without pedestal [-] with 95 % intervals. Out: a
section of the report. Theory: ``docs/pedestal.md``, "What could produce an effect".
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.base.figure_style import BAND, BLACK, GREY, OKABE_ITO, WIDEST, panels
from rockfrag.effects.cluster_means import benjamini_hochberg
from rockfrag.report.figures import MARKERS
from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, Row, by_row, estimated, table_html
from rockfrag.report.part import FigureSpec, Results, Section
from rockfrag.report.sections.pedestal import NONE, ratio_axis
from rockfrag.study.study import Study
from rockfrag.words.sentences import (
    agree,
    counted,
    has_interval,
    listed,
    of_all,
    probability,
    sentence,
    shortened,
)
from rockfrag_thesis.sensitivity_analysis.simulated import LAW_OF, REFERENCE
from rockfrag_thesis.settings import settings_of


class Factor(NamedTuple):
    """A parameter of the ideal model that is perturbed, in words that stand in a sentence as they are."""

    title: str  # The factor, whatever its level
    phrase: str  # The factor at a level, whose value stands at ``{}``

    def at(self, level: str) -> str:
        """The factor at a level, as a phrase."""
        return self.phrase.format(level.replace("-", "−"))


RESTITUTIONS = {
    "statue_restitution": "the object's restitution everywhere",
    "interface_restitution": "the object's restitution on the pedestal",
    "ground_restitution": "the pedestal's restitution",
}
"""Restitutions that are perturbed, in words."""

IMPACT_LAWS = {"": "", "_couple": " (by a couple)", "_ratio": " (as a ratio)"}
"""Impact laws that follow a perturbed restitution, in words; that of position is the usual one."""

FACTORS = {
    **{
        f"{name}{law}": Factor(f"{title}{words}", f"{title}{words} × {{}}")
        for law, words in IMPACT_LAWS.items()
        for name, title in RESTITUTIONS.items()
    },
    "pedestal_lean_deg": Factor("a leaning pedestal", "a pedestal leaning by {}°"),
    "statue_offset_mm": Factor(
        "the object off the pedestal's middle",
        "the object {} mm off the pedestal's middle",
    ),
    "statue_cg_offset_mm": Factor(
        "the object's centre of gravity off its middle",
        "the object's centre of gravity {} mm off its middle",
    ),
    "pedestal_width_cm": Factor("the width of the pedestal", "a pedestal {} cm wide"),
    "pedestal_not_counted": Factor(
        "the pedestal's mass neglected",
        "neglecting the pedestal's mass on a {} kg table",
    ),
    "table_not_counted": Factor(
        "the table's mass neglected", "neglecting the mass of a {} kg table"
    ),
    "ground_friction": Factor(
        "the friction of the ground", "a friction coefficient of {} on the ground"
    ),
    "interface_friction": Factor(
        "the friction between pedestal and object",
        "a friction coefficient of {} between pedestal and object",
    ),
    "step_percent": Factor("the step of the protocol", "a protocol with steps of {} %"),
    "tolerances": Factor(
        "tolerances of lengths and restitution",
        "tolerances of {} % in lengths and restitution",
    ),
}
"""Words for the factors at their levels."""

ARITHMETIC = ("pedestal_not_counted", "table_not_counted")
"""Factors that multiply every amplitude by a known number: computed without a simulation, and without chance."""

# so many perturbations are drawn, those with the largest effect; the table has all
MOST_DRAWN = 16


def _p(row: Row) -> str:
    known = has_interval(row["lower"], row["upper"], 3)
    return probability(row["p_adjusted"]) if known else "–"


_COLUMNS = (
    Column("name", "Perturbed parameter"),
    estimated("ratio", "With/without pedestal [95 % interval]", 3),
    Column("pairs", "Pairs", 0),
    Column("left_out", "Left out", 0),
    Column("p_adjusted", "p (Benjamini–Hochberg)", by_row(_p)),
)


def asks_sensitivity_analysis(study: Study) -> bool:
    """Whether a study asks what could produce an effect, and has pairs that could show one."""
    return bool(settings_of(study).sensitivity_analysis) and study.has_pairs


def perturbations(effects: pd.DataFrame) -> pd.DataFrame:
    """Every perturbation over all floors, in the order of ``FACTORS``.

    Returns rows of the effects with ``name`` (for a sentence), ``lower`` and ``upper``, ``arithmetic`` (whether it
    is computed without a simulation) and ``p_adjusted`` (Benjamini and Hochberg over the simulated ones; NaN of
    the others).
    """
    whole = effects[(effects["floor"] == "all") & (effects["level"] != REFERENCE)]
    order = {name: place for place, name in enumerate(FACTORS)}
    whole = whole.sort_values(
        "factor", key=lambda names: names.map(order), kind="stable", ignore_index=True
    )
    arithmetic = whole["factor"].isin(ARITHMETIC)
    levels = zip(whole["factor"], whole["level"].astype(str), strict=True)
    return whole.assign(
        name=[FACTORS[factor].at(level) for factor, level in levels],
        lower=whole["ratio_lower"],
        upper=whole["ratio_upper"],
        arithmetic=arithmetic,
        p_adjusted=benjamini_hochberg(whole["p"].astype(float).mask(arithmetic)),
    )


def sensitivity_analysis(results: Results) -> Section | None:
    """What each perturbed parameter does to the ratio; None where the study perturbs none."""
    if not asks_sensitivity_analysis(results.study):
        return None
    effects = results.table("sensitivity_analysis/effects")
    whole = perturbations(effects)
    if whole.empty:
        return None
    named = whole.assign(name=whole["name"].map(sentence))
    simulated = whole[~whole["arithmetic"]]
    message = _within(simulated)
    tables = [
        table_html(
            named[~named["arithmetic"]],
            _COLUMNS,
            "Ratio over all floors, one simulated perturbation at a time.",
        ),
        table_html(
            named[named["arithmetic"]],
            _COLUMNS[:2],
            "Ratio over all floors, errors of arithmetic (not simulated).",
        ),
    ]
    figures = []
    if len(simulated):
        draw = partial(sensitivity_analysis_figure, effects, list(results.study.floors))
        figures.append(_figure(message, len(simulated), draw))
    return Section(
        "sensitivity_analysis",
        "What could produce an effect of the pedestal",
        message,
        _paragraphs(simulated, len(whole) - len(simulated)),
        [*figures, *tables],
    )


def _within(simulated: pd.DataFrame) -> str:
    """Number of simulated perturbations that leave the mean ratio within ±10 %."""
    total = len(simulated)
    if not total:
        return "No perturbation was simulated."
    small = int(simulated["ratio"].between(NONE[0], NONE[1]).sum())
    return (
        f"{sentence(of_all(small, total, 'simulated perturbation'))} {agree(small, total, 'leaves', 'leave')} "
        "the mean ratio with/without pedestal within ±10 %."
    )


def _figure(message: str, simulated: int, draw: Callable[[], Figure]) -> FigureSpec:
    caption = (
        "Overturning amplitude with over that without pedestal, where one parameter of the ideal model is "
        "perturbed: diamonds with 95 % intervals are all floors, small marks single floors. Grey is ±10 %."
    )
    if simulated > MOST_DRAWN:
        caption += f" Shown are the {MOST_DRAWN} of {simulated} perturbations with the largest effect."
    words = "Ratios with over without pedestal where one parameter is perturbed."
    return FigureSpec("sensitivity_analysis", f"{words} {message}", caption, draw)


def _paragraphs(simulated: pd.DataFrame, computed: int) -> list[str]:
    """Paragraphs on the simulated perturbations, and on the number of those that are arithmetic."""
    words = [
        "One parameter at a time is perturbed, with the amplitudes and steps of the protocol; the rest is as in "
        "the study."
    ]
    beyond, undecided = _beyond(simulated)
    if beyond:
        words.append(f"Beyond ±10 %: {listed(beyond)}.")
    if undecided:
        words.append(
            "Undecided, because the laws of impact that agree with a measured restitution disagree here: "
            f"{listed(undecided)}."
        )
    words.append(adjusted_words(simulated))
    if computed:
        words.append(
            f"{sentence(counted(computed, 'further value'))} {'is' if computed == 1 else 'are'} arithmetic and "
            "not simulation: a mass that is moved but not counted multiplies each amplitude by a known factor. "
            "Their intervals are scatter of the same pairs, and no adjustment applies."
        )
    return words


def adjusted_words(simulated: pd.DataFrame, level: float = 0.05) -> str:
    """Number of intervals that exclude 1, also when all of them are counted, in sentences."""
    tests = len(simulated)
    outside = int(((simulated["lower"] > 1) | (simulated["upper"] < 1)).sum())
    left = int((simulated["p_adjusted"] < level).sum())
    verb = agree(
        outside,
        tests,
        "has a 95 % interval that excludes",
        "have 95 % intervals that exclude",
    )
    return (
        f"{sentence(of_all(outside, tests, 'simulated perturbation'))} {verb} 1. Chance alone produces some of "
        f"these: after the Benjamini–Hochberg adjustment for {counted(tests, 'test')}, {left or 'none'} "
        f"{agree(left, tests, 'differs', 'differ')} from 1 at the {100 * level:g} % level."
    )


def _beyond(simulated: pd.DataFrame) -> tuple[list[str], list[str]]:
    """Perturbations beyond ±10 % with their ratios, and those on whose side of it the laws disagree."""
    beyond = (simulated["ratio"] > NONE[1]).astype(int) - (
        simulated["ratio"] < NONE[0]
    ).astype(int)
    base = simulated["factor"].map(lambda factor: LAW_OF.get(factor, (factor, ""))[0])
    differ = beyond.groupby([base, simulated["level"]]).transform("nunique") > 1
    return _named(simulated[(beyond != 0) & ~differ]), _named(simulated[differ])


def _named(perturbed: pd.DataFrame) -> list[str]:
    """Names of perturbations with their ratios."""
    return [
        f"{row['name']} ({ratio_text(row)})" for row in perturbed.to_dict("records")
    ]


def sensitivity_analysis_figure(
    effects: pd.DataFrame, order: Sequence[str] = ()
) -> Figure:
    """Draw the ratio with over without pedestal of the perturbations with the largest effect.

    Floors are in the given order in the legend; others follow.
    """
    simulated = perturbations(effects)
    simulated = simulated[~simulated["arithmetic"]]
    largest = (
        simulated["ratio"].astype(float).map(np.log).abs().nlargest(MOST_DRAWN).index
    )
    shown = simulated.loc[largest].sort_values("ratio", kind="stable")
    ideal = effects[(effects["floor"] == "all") & (effects["level"] == REFERENCE)].head(
        1
    )
    ideal = ideal.assign(
        name="ideal model", lower=ideal["ratio_lower"], upper=ideal["ratio_upper"]
    )
    rows = pd.concat([ideal, shown], ignore_index=True)
    own = set(effects["floor"]) - {"all"}
    floors = [
        floor for floor in dict.fromkeys([*order, *effects["floor"]]) if floor in own
    ]
    styles: dict[str, dict[str, Any]] = {
        floor: {
            "color": OKABE_ITO[k % len(OKABE_ITO)],
            "marker": MARKERS[k % len(MARKERS)],
        }
        for k, floor in enumerate(floors if len(floors) > 1 else [])
    }
    with panels(WIDEST, 1.0 + 0.26 * len(rows)) as (figure, axes):
        axes.axvspan(NONE[0], NONE[1], color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        drawn: list[float] = []
        for y, row in enumerate(rows.to_dict("records")):
            low, middle = float(row["lower"]), float(row["ratio"])
            high = float(row["upper"])
            drawn += [low, middle, high]
            if np.isfinite([low, high]).all():
                axes.plot([low, high], [y - 0.14] * 2, color=BLACK, lw=1.0, zorder=3)
            axes.plot(middle, y - 0.14, "D", color=BLACK, mfc="white", ms=3.8, zorder=4)
            drawn += _draw_floors(axes, effects, row, y + 0.22, styles)
        axes.set_yticks(
            range(len(rows)), [_figure_label(str(name)) for name in rows["name"]]
        )
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.tick_params(axis="y", length=0, labelsize=7)
        ratio_axis(axes, drawn)
        handles = [
            Line2D(
                [], [], color=BLACK, marker="D", mfc="white", ms=4, label="all floors"
            ),
            *(
                Line2D([], [], ls="", ms=4, label=shortened(floor), **style)
                for floor, style in styles.items()
            ),
            Line2D([], [], color=BAND, lw=6, label="±10 %"),
        ]
        figure.legend(
            handles=handles, loc="outside upper center", ncols=5, columnspacing=1.2
        )
    return figure


def _figure_label(name: str) -> str:
    """A name of a perturbation on two lines at most, without words that stand in the caption."""
    short = name.replace("the object's ", "").replace("a friction", "friction")
    return fill(sentence(short.replace(" × ", "\u00a0×\u00a0")), 34)


def _draw_floors(
    axes: Axes,
    effects: pd.DataFrame,
    row: Row,
    y: float,
    styles: Mapping[str, dict[str, Any]],
) -> list[float]:
    """Draw the ratios on single floors below the mean, where there are several; return them."""
    if not styles:
        return []
    own = effects[
        (effects["factor"] == row["factor"]) & (effects["level"] == row["level"])
    ]
    ratios = own.drop_duplicates("floor").set_index("floor")["ratio"].astype(float)
    for floor, style in styles.items():
        if floor in ratios.index:
            axes.plot(ratios[floor], y, ls="", ms=3.2, mew=0, zorder=2, **style)
    return [float(value) for value in ratios]
