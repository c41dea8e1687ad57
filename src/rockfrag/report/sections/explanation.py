"""What could produce a pedestal effect: a forest of ratios by factor and level, and a section."""

from collections.abc import Hashable, Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from rockfrag.pedestal.simulated_explanation import REFERENCE
from rockfrag.report.estimate_columns import P_HOLM, PAIRS, with_limits
from rockfrag.report.figures.building import FLOOR_STYLES
from rockfrag.report.figures.style import BLACK, PAGE_WIDTH, figure_style, new_figure
from rockfrag.report.page import Column, Picture, Section, table_html

FACTORS = {
    "statue_restitution": ("Object's restitution everywhere", "× {}"),
    "interface_restitution": ("Object's restitution on the pedestal", "× {}"),
    "ground_restitution": ("Pedestal's restitution", "× {}"),
    "pedestal_lean_deg": ("Pedestal leans", "{}°"),
    "statue_offset_mm": ("Object off the pedestal's middle", "{} mm"),
    "statue_cg_offset_mm": ("Object's centre of gravity off its middle", "{} mm"),
    "pedestal_width_cm": ("Width of the pedestal", "{} cm"),
    "pedestal_not_counted": ("Pedestal's mass not counted, table of", "{} kg"),
    "table_not_counted": ("Table's mass not counted, table of", "{} kg"),
    "step_percent": ("Step of the protocol", "{} %"),
    "tolerances": ("Tolerances of lengths and restitution", "{} %"),
}
"""Names of the factors and of their levels for a reader, in the order of the figure."""

Floats = NDArray[np.float64]

NONE = (1 / 1.1, 1.1)
"""Ratios between which an effect counts as none."""


def explanation_section(
    tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]
) -> Section:
    """Return the section on what could produce an effect."""
    effects = tables["explanation/effects"]
    whole = effects[(effects["floor"] == "all") & (effects["level"] != REFERENCE)]
    order = list(FACTORS)
    whole = whole.sort_values(
        "factor", key=lambda names: names.map(order.index), kind="stable", ignore_index=True
    )
    clear = whole[(whole["ratio"] > NONE[1]) | (whole["ratio"] < NONE[0])]
    small = len(whole) - len(clear)
    strong = "; ".join(
        f"{_name(row)} {row['ratio']:.2f} [{row['ratio_lower']:.2f}, {row['ratio_upper']:.2f}]"
        for row in clear.to_dict("records")
    )
    signs = whole[whole["pattern"].astype(bool)]
    named = ", ".join(_name(row) for row in signs.to_dict("records"))
    shown = whole.assign(
        name=[_name(row) for row in whole.to_dict("records")],
        signs=["yes" if one else "no" for one in whole["pattern"]],
    )
    columns = (
        Column("name", "Departure from the ideal model"),
        *with_limits("ratio", "P/NP", "ratio_lower", "ratio_upper"),
        P_HOLM,
        PAIRS,
        Column("left_out", "Left out", 0),
        Column("signs", "Signs of the thesis"),
    )
    return Section(
        "explanation",
        "What could produce a pedestal effect",
        [
            "One factor at a time departs from the ideal model, on the ladder of the protocol; the "
            "rest is as in the study.",
            f"{small} of {len(whole)} departures leave the mean ratio P/NP within ±10 %."
            + (f" Beyond: {strong}." if strong else ""),
            f"The mean ratios have the signs that the thesis reports, above one on the ground floor and "
            f"below one on the others, with: {named}. The sign of a mean alone says nothing about its "
            "interval, which the table gives."
            if named
            else "No departure gives the signs that the thesis reports, above one on the ground floor "
            "and below one on the others.",
        ],
        [
            pictures["explanation"],
            table_html(shown, columns, "Ratio P/NP over all floors, 95 % intervals."),
        ],
    )


def _name(row: Mapping[Hashable, Any]) -> str:
    factor, unit = FACTORS[str(row["factor"])]
    return f"{factor} {_level(unit, str(row['level']))}"


def _level(unit: str, level: str) -> str:
    return "as in the study" if level == REFERENCE else unit.format(level.replace("-", "−"))


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
    floors = [floor for floor in FLOOR_STYLES if floor in set(effects["floor"])]
    with figure_style():
        figure = new_figure(PAGE_WIDTH, 0.9 + 0.155 * len(rows))
        axes = figure.subplots()
        axes.axvspan(*NONE, color="#e9e9e9", lw=0)
        axes.axvline(1.0, color="#777777", lw=0.8)
        labels, drawn = [], []
        for y, (factor, level) in enumerate(rows):
            if not level:
                labels.append(FACTORS[factor][0])
                continue
            labels.append(
                "ideal model" if level == REFERENCE else _level(FACTORS[factor][1], level)
            )
            key = (factor or factors[0], level)
            for number, floor in enumerate(floors):
                if (*key, floor) in known.index and len(floors) > 1:
                    _, colour, marker = FLOOR_STYLES[floor]
                    value = float(known.loc[(*key, floor), "ratio"])
                    drawn.append(value)
                    place = y + 0.16 * (number - 1)
                    axes.plot(value, place, marker, color=colour, ms=2.8, mew=0, zorder=2)
            low, middle, high = (
                float(known.loc[(*key, "all"), n]) for n in ("ratio_lower", "ratio", "ratio_upper")
            )
            drawn += [low, middle, high]
            axes.plot([low, high], [y, y], color=BLACK, lw=1.0, zorder=3)
            axes.plot(middle, y, "D", color=BLACK, mfc="white", ms=3.5, zorder=4)
        axes.set_yticks(range(len(rows)), labels)
        for (_, level), text in zip(rows, axes.get_yticklabels(), strict=True):
            text.set_fontweight("bold" if level in ("", REFERENCE) else "normal")
        axes.set_ylim(len(rows) - 0.4, -0.6)
        axes.tick_params(axis="y", length=0)
        _ratio_axis(axes, np.array(drawn))
        handles = [Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label="all floors")]
        if len(floors) > 1:
            handles += [
                Line2D([], [], color=colour, marker=marker, ls="", ms=4, label=name)
                for floor, (name, colour, marker) in FLOOR_STYLES.items()
                if floor in floors
            ]
        handles.append(Line2D([], [], color="#e9e9e9", lw=6, label="±10 %"))
        figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
        return figure


def _ratio_axis(axes: Axes, values: Floats) -> None:
    finite = values[np.isfinite(values) & (values > 0)]
    low, high = max(0.2, finite.min() / 1.05), min(5.0, finite.max() * 1.05)
    ticks = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.3, 1.5, 2, 3, 4)
    axes.set_xscale("log")
    axes.set_xlim(min(low, NONE[0] / 1.02), max(high, NONE[1] * 1.02))
    shown = [t for t in ticks if axes.get_xlim()[0] <= t <= axes.get_xlim()[1]]
    axes.set_xticks(shown, [f"{t:g}" for t in shown])
    axes.minorticks_off()
    axes.set_xlabel("Ratio of overturning accelerations P/NP [-]")
