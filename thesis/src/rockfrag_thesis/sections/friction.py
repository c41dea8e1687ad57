"""What friction does to the effect of a pedestal."""

import math
from typing import Any

import pandas as pd

from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.wording import said
from rockfrag.study.study import Study
from rockfrag_thesis.sections.words import sentences
from rockfrag_thesis.settings import settings_of

ORDINARY = (0.3, 0.7)
"""Friction of dry wood, stone and mortar on each other, as handbooks of engineering give it [-]."""

Means = dict[tuple[float, float], dict[str, Any]]
"""Mean ratios with their intervals, by the coefficients at the ground and at the interface."""

_COLUMNS = (
    Column("ground_text", "Friction at the ground", numeric=True),
    Column("interface_text", "between pedestal and object", numeric=True),
    Column("here", "With/without pedestal on the ground [95 % interval]", numeric=True),
    Column("above", "above it", numeric=True),
    Column("left_out", "Pairs without overturning", 0),
)


def asks_friction(study: Study) -> bool:
    """Whether a study asks what friction does, and has pairs that could show it."""
    sensitivity_analysis = settings_of(study).sensitivity_analysis
    return (
        sensitivity_analysis is not None and bool(sensitivity_analysis.friction) and study.has_pairs
    )


def _section(results: Results) -> Section | None:
    effects = results.table("sensitivity_analysis/friction")
    ground, above = _by_pair(effects, "ground"), _by_pair(effects, "above")
    if not ground:
        return None
    shown = pd.DataFrame(
        [
            {
                "ground_text": _coefficient(pair[0]),
                "interface_text": _coefficient(pair[1]),
                "here": _ratio(ground.get(pair)),
                "above": _ratio(above.get(pair)),
                "left_out": sum(
                    table[pair]["left_out"] for table in (ground, above) if pair in table
                ),
            }
            for pair in ground
        ]
    )
    sensitivity_analysis = settings_of(results.study).sensitivity_analysis
    wanted = {} if sensitivity_analysis is None else dict(sensitivity_analysis.wanted_percent)
    caption = "Ratio of overturning amplitudes with/without pedestal by friction."
    words = _found(ground, above, wanted)
    table = table_html(shown, _COLUMNS, caption)
    return section_of(sentences().friction(words), "friction", [table])


def _by_pair(effects: pd.DataFrame, place: str) -> Means:
    rows = effects[(effects["object"] == "all") & (effects["place"] == place)]
    return {
        (float(row["ground"]), float(row["interface"])): {str(key): row[key] for key in row}
        for row in rows.to_dict("records")
    }


def _coefficient(value: float) -> str:
    return "∞" if math.isinf(value) else f"{value:g}"


def _ratio(row: dict[str, Any] | None) -> str:
    return ratio_text(row) if row is not None and math.isfinite(row["ratio"]) else "–"


def _is_ordinary(pair: tuple[float, float]) -> bool:
    return all(ORDINARY[0] <= mu <= ORDINARY[1] for mu in pair)


def _found(ground: Means, above: Means, wanted: dict[str, float]) -> list[str]:
    """Say how far the mean ratio goes with ordinary friction, and with which it has the signs asked for."""
    ordinary = []
    for place, table in (("on the ground", ground), ("above it", above)):
        inside = [row["ratio"] for pair, row in table.items() if _is_ordinary(pair)]
        inside = [ratio for ratio in inside if math.isfinite(ratio)]
        if inside:
            ordinary.append(f"{min(inside):.2f} to {max(inside):.2f} {place}")
    tables = {"ground": ground, "above": above}
    asked = [(tables[name], percent) for name, percent in wanted.items()]

    def has_signs(pair: tuple[float, float], rising: str, falling: str) -> bool:
        ends = [(table[pair][rising if goal > 0 else falling], goal) for table, goal in asked]
        return all(goal * math.log(end) > 0 for end, goal in ends if math.isfinite(end)) and all(
            math.isfinite(end) for end, _ in ends
        )

    known = ground if asked and all(table for table, _ in asked) else {}
    signs = [pair for pair in known if has_signs(pair, "ratio", "ratio")]
    clear = [pair for pair in signs if has_signs(pair, "lower", "upper")]
    places = {"ground": "on the ground", "above": "above it"}
    goal = " and ".join(
        f"{percent:+g} % {places[name]}".replace("-", "−")
        for name, percent in wanted.items()
        if known
    )
    named = [f"{_coefficient(first)} and {_coefficient(other)}" for first, other in signs]
    usual = sum(map(_is_ordinary, signs))
    about = (ordinary, *ORDINARY, goal, len(ground), named, len(clear), usual)
    return said(sentences().friction_found(*about))


FRICTION = Part(("sensitivity_analysis/friction",), _section, asked=asks_friction)
