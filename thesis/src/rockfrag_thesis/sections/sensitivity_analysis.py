"""What could produce an effect of the pedestal: one parameter of the ideal model at a time is perturbed."""

from collections.abc import Hashable, Mapping, Sequence
from functools import partial
from textwrap import fill
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import BLACK, OKABE_ITO, WIDEST, figure_style, new_figure
from rockfrag.pedestal.multiplicity import benjamini_hochberg
from rockfrag.report.figures.amplitudes import BAND, GREY, MARKERS
from rockfrag.report.figures.effects import NONE, ratio_axis
from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.report.wording import has_interval, one_line, probability, sentence, shortened
from rockfrag.study.study import Study
from rockfrag_thesis.sections.words import sentences
from rockfrag_thesis.sensitivity_analysis.simulated import LAW_OF, REFERENCE
from rockfrag_thesis.settings import settings_of


class Factor(NamedTuple):
    """A parameter of the ideal model that is perturbed, in words that stand in a sentence as they are."""

    title: str  # The factor, whatever its level
    level: str  # How a level is written, its value at ``{}``
    phrase: str  # The factor at a level, which stands at ``{}``

    def at(self, level: str) -> str:
        """The factor at a level, as a phrase."""
        return self.phrase.format(self.written(level))

    def written(self, level: str) -> str:
        """A level with its unit."""
        return self.level.format(level.replace("-", "−"))


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
        f"{name}{law}": Factor(f"{title}{words}", "× {}", f"{title}{words} {{}}")
        for law, words in IMPACT_LAWS.items()
        for name, title in RESTITUTIONS.items()
    },
    "pedestal_lean_deg": Factor("a leaning pedestal", "{}°", "a pedestal leaning by {}"),
    "statue_offset_mm": Factor(
        "the object off the pedestal's middle", "{} mm", "the object {} off the pedestal's middle"
    ),
    "statue_cg_offset_mm": Factor(
        "the object's centre of gravity off its middle",
        "{} mm",
        "the object's centre of gravity {} off its middle",
    ),
    "pedestal_width_cm": Factor("the width of the pedestal", "{} cm", "a pedestal {} wide"),
    "pedestal_not_counted": Factor(
        "the pedestal's mass neglected", "{} kg table", "neglecting the pedestal's mass on a {}"
    ),
    "table_not_counted": Factor(
        "the table's mass neglected", "{} kg table", "neglecting the mass of a {}"
    ),
    "ground_friction": Factor(
        "the friction of the ground", "{}", "a friction coefficient of {} on the ground"
    ),
    "interface_friction": Factor(
        "the friction between pedestal and object",
        "{}",
        "a friction coefficient of {} between pedestal and object",
    ),
    "step_percent": Factor("the step of the protocol", "{} %", "a protocol with steps of {}"),
    "tolerances": Factor(
        "tolerances of lengths and restitution",
        "{} %",
        "tolerances of {} in lengths and restitution",
    ),
}
"""Words for the factors and for their levels."""

ARITHMETIC = ("pedestal_not_counted", "table_not_counted")
"""Factors that multiply every amplitude by a known number: computed without a simulation, and without chance."""

MOST_DRAWN = 16
"""So many perturbations are drawn, those with the largest effect; the table has all."""

_COLUMNS = (
    Column("name", "Perturbed parameter"),
    Column("ratio_text", "With/without pedestal [95 % interval]", numeric=True),
    Column("pairs", "Pairs", 0),
    Column("left_out", "Left out", 0),
    Column("p_text", "p (Benjamini–Hochberg)", numeric=True),
)


def asks_sensitivity_analysis(study: Study) -> bool:
    """Whether a study asks what could produce an effect, and has pairs that could show one."""
    return settings_of(study).sensitivity_analysis is not None and study.has_pairs


def perturbations(effects: pd.DataFrame) -> pd.DataFrame:
    """Every perturbation over all floors, in the order of ``FACTORS``.

    Returns rows of the effects with ``name`` (for a sentence), ``lower`` and ``upper``, ``arithmetic`` (whether it
    is computed without a simulation) and ``p_adjusted`` (Benjamini and Hochberg over the simulated ones; NaN of
    the others).
    """
    whole = effects[(effects["floor"] == "all") & (effects["level"] != REFERENCE)]
    order = list(FACTORS)
    whole = whole.sort_values(
        "factor", key=lambda names: names.map(order.index), kind="stable", ignore_index=True
    )
    arithmetic = whole["factor"].isin(ARITHMETIC)
    return whole.assign(
        name=[
            FACTORS[factor].at(str(level))
            for factor, level in zip(whole["factor"], whole["level"], strict=True)
        ],
        lower=whole["ratio_lower"],
        upper=whole["ratio_upper"],
        arithmetic=arithmetic,
        p_adjusted=benjamini_hochberg(whole["p"].astype(float).mask(arithmetic)),
    )


def _section(results: Results) -> Section | None:
    effects = results.table("sensitivity_analysis/effects")
    whole = perturbations(effects)
    if whole.empty:
        return None
    simulated, computed = whole[~whole["arithmetic"]], whole[whole["arithmetic"]]
    small = int(simulated["ratio"].between(*NONE).sum())
    message = one_line(sentences().within(small, len(simulated)))
    tables = [
        table_html(
            _shown(simulated),
            _COLUMNS,
            "Ratio over all floors, one simulated perturbation at a time.",
        ),
        table_html(
            _shown(computed),
            _COLUMNS[:2],
            "Ratio over all floors, errors of arithmetic (not simulated).",
        ),
    ]
    text = sentences().sensitivity_figure(message, len(simulated), MOST_DRAWN)
    draw = partial(sensitivity_analysis_figure, effects, list(results.study.floors))
    figures = [figure_of(text, "sensitivity_analysis", draw)] if len(simulated) else []
    adjusted = adjusted_words(simulated)
    about = (message, *_beyond(simulated), adjusted, len(computed))
    text = sentences().sensitivity_analysis(*about)
    return section_of(text, "sensitivity_analysis", [*figures, *tables])


def adjusted_words(simulated: pd.DataFrame, level: float = 0.05) -> str:
    """Say how many intervals exclude 1, and how many still do when all of them are counted."""
    tests = len(simulated)
    outside = int(((simulated["lower"] > 1) | (simulated["upper"] < 1)).sum())
    left = int((simulated["p_adjusted"] < level).sum())
    return one_line(sentences().adjusted(outside, left, tests, level))


def _beyond(simulated: pd.DataFrame) -> tuple[list[str], list[str]]:
    """Perturbations beyond ±10 % with their ratios, and those on which the laws of impact disagree."""
    beyond = (simulated["ratio"] > NONE[1]).astype(int) - (simulated["ratio"] < NONE[0]).astype(int)
    differ = _laws_differ(simulated, beyond)
    clear, open_ones = (
        [f"{row['name']} ({ratio_text(row)})" for row in rows.to_dict("records")]
        for rows in (simulated[(beyond != 0) & ~differ], simulated[differ])
    )
    return clear, open_ones


def _shown(rows: pd.DataFrame) -> pd.DataFrame:
    return rows.assign(
        name=rows["name"].map(sentence),
        ratio_text=[ratio_text(row) for row in rows.to_dict("records")],
        p_text=[
            probability(row["p_adjusted"]) if has_interval(row["lower"], row["upper"], 3) else "–"
            for row in rows.to_dict("records")
        ],
    )


def _laws_differ(whole: pd.DataFrame, beyond: pd.Series) -> pd.Series:
    """Whether the laws of a perturbed parameter do not agree on which side of ±10 % its ratio is."""
    base = whole["factor"].map(lambda factor: LAW_OF.get(factor, (factor, ""))[0])
    return beyond.groupby([base, whole["level"]]).transform("nunique") > 1


def sensitivity_analysis_figure(effects: pd.DataFrame, order: Sequence[str] = ()) -> Figure:
    """Draw the ratio with over without pedestal of the perturbations with the largest effect.

    Floors are in the given order in the legend; others follow.
    """
    simulated = perturbations(effects)
    simulated = simulated[~simulated["arithmetic"]]
    largest = simulated["ratio"].astype(float).map(np.log).abs().nlargest(MOST_DRAWN).index
    shown = simulated.loc[largest].sort_values("ratio", kind="stable")
    ideal = effects[(effects["floor"] == "all") & (effects["level"] == REFERENCE)].head(1)
    ideal = ideal.assign(name="ideal model", lower=ideal["ratio_lower"], upper=ideal["ratio_upper"])
    rows = pd.concat([ideal, shown], ignore_index=True)
    own = set(effects["floor"]) - {"all"}
    floors = [floor for floor in dict.fromkeys([*order, *effects["floor"]]) if floor in own]
    with figure_style():
        figure = new_figure(WIDEST, 1.0 + 0.26 * len(rows))
        axes = figure.subplots()
        axes.axvspan(*NONE, color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        drawn: list[float] = []
        for y, row in enumerate(rows.to_dict("records")):
            drawn += _draw_row(axes, row, y - 0.14)
            if len(floors) > 1:
                drawn += _draw_floors(axes, effects, row, y + 0.22, floors)
        axes.set_yticks(range(len(rows)), [_figure_label(name) for name in rows["name"]])
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.tick_params(axis="y", length=0, labelsize=7)
        ratio_axis(axes, drawn)
        handles = [Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label="all floors")]
        if len(floors) > 1:
            handles += [
                Line2D([], [], color=colour, marker=marker, ls="", ms=4, label=shortened(floor))
                for floor, (colour, marker) in _floor_styles(floors).items()
            ]
        handles.append(Line2D([], [], color=BAND, lw=6, label="±10 %"))
        figure.legend(handles=handles, loc="outside upper center", ncols=5, columnspacing=1.2)
        return figure


_LABEL_WIDTH = 34


def _figure_label(name: str) -> str:
    """A name of a perturbation on two lines at most, without words that stand in the caption."""
    return fill(
        sentence(
            str(name)
            .replace("the object's ", "")
            .replace("a friction", "friction")
            .replace(" × ", "\u00a0×\u00a0")
        ),
        _LABEL_WIDTH,
    )


def _floor_styles(floors: Sequence[str]) -> dict[str, tuple[str, str]]:
    return {
        floor: (OKABE_ITO[number % len(OKABE_ITO)], MARKERS[number % len(MARKERS)])
        for number, floor in enumerate(floors)
    }


def _draw_row(axes: Axes, row: Mapping[Hashable, Any], y: float) -> list[float]:
    """Draw a mean ratio with its interval; return what was drawn."""
    low, middle, high = (float(row[name]) for name in ("lower", "ratio", "upper"))
    if np.isfinite([low, high]).all():
        axes.plot([low, high], [y, y], color=BLACK, lw=1.0, zorder=3)
    axes.plot(middle, y, "D", color=BLACK, mfc="white", ms=3.8, zorder=4)
    return [low, middle, high]


def _draw_floors(
    axes: Axes, effects: pd.DataFrame, row: Mapping[Hashable, Any], y: float, floors: Sequence[str]
) -> list[float]:
    """Draw the ratios on single floors below the mean; return them."""
    own = effects[(effects["factor"] == row["factor"]) & (effects["level"] == row["level"])]
    ratios = own.drop_duplicates("floor").set_index("floor")["ratio"].astype(float)
    for floor, (colour, marker) in _floor_styles(floors).items():
        if floor in ratios.index:
            axes.plot(ratios[floor], y, marker, color=colour, ms=3.2, mew=0, zorder=2)
    return [float(value) for value in ratios]


SENSITIVITY_ANALYSIS = Part(
    ("sensitivity_analysis/effects",), _section, asked=asks_sensitivity_analysis
)
