"""What could produce an effect of the pedestal: one factor at a time departs from the ideal model."""

from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import (
    BLACK,
    OKABE_ITO,
    WIDEST,
    figure_style,
    new_figure,
)
from rockfrag.pedestal.simulated_explanation import LAW_OF, REFERENCE
from rockfrag.report.figures.amplitudes import BAND, GREY, MARKERS
from rockfrag.report.figures.effects import NONE, ratio_axis
from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import has_interval, listed, of_all, probability, sentence, shortened
from rockfrag.study.study import Study


class Factor(NamedTuple):
    """What departs from the ideal model, in words that stand in a sentence as they are.

    Attributes
    ----------
    title
        The factor, whatever its level.
    level
        How a level is written, its value at ``{}``.
    phrase
        The factor at a level, which stands at ``{}``.
    """

    title: str
    level: str
    phrase: str

    def at(self, level: str) -> str:
        """The factor at a level, as a phrase."""
        return self.phrase.format(self.written(level))

    def written(self, level: str) -> str:
        """A level with its unit."""
        return self.level.format(level.replace("-", "−"))


def _restitution(title: str) -> Factor:
    return Factor(title, "× {}", f"{title} {{}}")


FACTORS = {
    "statue_restitution": _restitution("the object's restitution everywhere"),
    "interface_restitution": _restitution("the object's restitution on the pedestal"),
    "ground_restitution": _restitution("the pedestal's restitution"),
    "statue_restitution_couple": _restitution("the object's restitution everywhere (by a couple)"),
    "interface_restitution_couple": _restitution(
        "the object's restitution on the pedestal (by a couple)"
    ),
    "ground_restitution_couple": _restitution("the pedestal's restitution (by a couple)"),
    "statue_restitution_ratio": _restitution("the object's restitution everywhere (as a ratio)"),
    "interface_restitution_ratio": _restitution(
        "the object's restitution on the pedestal (as a ratio)"
    ),
    "ground_restitution_ratio": _restitution("the pedestal's restitution (as a ratio)"),
    "pedestal_lean_deg": Factor("a pedestal that leans", "{}°", "a pedestal that leans by {}"),
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
        "the pedestal's mass not counted",
        "table of {} kg",
        "the mass of a pedestal on a {} not counted",
    ),
    "table_not_counted": Factor(
        "the table's mass not counted", "table of {} kg", "the mass of a {} not counted"
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
"""Words for the factors and for their levels, in the order of the figure."""

_COLUMNS = (
    Column("name", "Departure from the ideal model"),
    Column("ratio_text", "P/NP [95 % interval]", numeric=True),
    Column("pairs", "Pairs", 0),
    Column("left_out", "Left out", 0),
    Column("p_text", "p (Holm)", numeric=True),
)


def asks_explanation(study: Study) -> bool:
    """Whether a study asks what could produce an effect, and has pairs that could show one."""
    return study.more.explanation is not None and study.has_pairs


def departures(effects: pd.DataFrame) -> pd.DataFrame:
    """Every departure over all floors, in the order of ``FACTORS``, with its ``name`` for a sentence."""
    whole = effects[(effects["floor"] == "all") & (effects["level"] != REFERENCE)]
    order = list(FACTORS)
    whole = whole.sort_values(
        "factor", key=lambda names: names.map(order.index), kind="stable", ignore_index=True
    )
    return whole.assign(
        name=[
            FACTORS[factor].at(str(level))
            for factor, level in zip(whole["factor"], whole["level"], strict=True)
        ],
        lower=whole["ratio_lower"],
        upper=whole["ratio_upper"],
    )


def _section(results: Results) -> Section | None:
    effects = results.table("explanation/effects")
    whole = departures(effects)
    if whole.empty:
        return None
    beyond = (whole["ratio"] > NONE[1]).astype(int) - (whole["ratio"] < NONE[0]).astype(int)
    differ = _laws_differ(whole, beyond)
    clear = whole[(beyond != 0) & ~differ]
    small = int((beyond == 0).sum())
    leaves = "leaves" if 1 in (small, len(whole)) else "leave"
    words = f"{sentence(of_all(small, len(whole), 'departure'))} {leaves} the mean ratio P/NP within ±10 %."
    if len(clear):
        strong = [f"{row['name']} ({ratio_text(row)})" for row in clear.to_dict("records")]
        words += f" Beyond: {listed(strong)}."
    if differ.any():
        unclear = [f"{row['name']} ({ratio_text(row)})" for row in whole[differ].to_dict("records")]
        words += (
            " No conclusion where the laws of impact, which a measured restitution leaves open, differ: "
            f"{listed(unclear)}."
        )
    rows = whole.to_dict("records")
    shown = whole.assign(
        name=whole["name"].map(sentence),
        ratio_text=[ratio_text(row) for row in rows],
        p_text=[
            probability(row["p_holm"]) if has_interval(row["lower"], row["upper"], 3) else "–"
            for row in rows
        ],
    )
    figure = FigureSpec(
        "explanation",
        f"Ratios P/NP where one factor departs from the ideal model. {words}",
        "Ratio P/NP where one factor at a time departs from the ideal model, with 95 % intervals; small "
        "marks are floors. Grey is ±10 %.",
        lambda: explanation_figure(effects),
    )
    return Section(
        "explanation",
        "What could produce an effect of the pedestal",
        words,
        [
            "One factor at a time departs from the ideal model, on the ladder of the protocol; the "
            "rest is as in the study."
        ],
        [figure, table_html(shown, _COLUMNS, "Ratio P/NP over all floors.")],
    )


def _laws_differ(whole: pd.DataFrame, beyond: pd.Series) -> pd.Series:
    """Whether the laws of a departure do not agree on which side of ±10 % its ratio is."""
    base = whole["factor"].map(lambda factor: LAW_OF.get(factor, (factor, ""))[0])
    return beyond.groupby([base, whole["level"]]).transform("nunique") > 1


def explanation_figure(effects: pd.DataFrame) -> Figure:
    """Draw the ratio P/NP at every level of every factor.

    Parameters
    ----------
    effects
        As :func:`rockfrag.stages.explanation.explanation_tables` returns them.
    """
    factors = [name for name in FACTORS if name in set(effects["factor"])]
    rows = []
    for factor in factors:
        levels = effects.loc[effects["factor"] == factor, "level"]
        rows += [(factor, ""), *((factor, level) for level in dict.fromkeys(levels))]
    # the ideal model is the same for all factors and drawn once, at the top
    rows = [("", REFERENCE), *(row for row in rows if row[1] != REFERENCE)]
    known = effects.set_index(["factor", "level", "floor"]).sort_index()
    floors = [floor for floor in dict.fromkeys(effects["floor"]) if floor != "all"]
    styles = {
        floor: (OKABE_ITO[number % len(OKABE_ITO)], MARKERS[number % len(MARKERS)])
        for number, floor in enumerate(floors)
    }
    with figure_style():
        figure = new_figure(WIDEST, 0.9 + 0.155 * len(rows))
        axes = figure.subplots()
        axes.axvspan(*NONE, color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        labels, drawn = [], []
        for y, (factor, level) in enumerate(rows):
            if not level:
                labels.append(sentence(FACTORS[factor].title))
                continue
            labels.append("ideal model" if level == REFERENCE else FACTORS[factor].written(level))
            key = (factor or factors[0], level)
            if (*key, "all") not in known.index:
                continue
            for number, floor in enumerate(floors):
                if (*key, floor) in known.index and len(floors) > 1:
                    colour, marker = styles[floor]
                    value = float(known.loc[(*key, floor), "ratio"])
                    drawn.append(value)
                    place = y + 0.16 * (number - 0.5 * (len(floors) - 1))
                    axes.plot(value, place, marker, color=colour, ms=2.8, mew=0, zorder=2)
            low, middle, high = (
                float(known.loc[(*key, "all"), n]) for n in ("ratio_lower", "ratio", "ratio_upper")
            )
            drawn += [low, middle, high]
            if np.isfinite([low, high]).all():
                axes.plot([low, high], [y, y], color=BLACK, lw=1.0, zorder=3)
            axes.plot(middle, y, "D", color=BLACK, mfc="white", ms=3.5, zorder=4)
        axes.set_yticks(range(len(rows)), labels)
        for (_, level), text in zip(rows, axes.get_yticklabels(), strict=True):
            text.set_fontweight("bold" if level in ("", REFERENCE) else "normal")
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.tick_params(axis="y", length=0)
        ratio_axis(axes, drawn)
        handles = [Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label="all floors")]
        if len(floors) > 1:
            handles += [
                Line2D([], [], color=colour, marker=marker, ls="", ms=4, label=shortened(floor))
                for floor, (colour, marker) in styles.items()
            ]
        handles.append(Line2D([], [], color=BAND, lw=6, label="±10 %"))
        figure.legend(handles=handles, loc="outside upper center", ncols=min(len(handles), 3))
        return figure


EXPLANATION = Part(("explanation/effects",), _section, asked=asks_explanation)
