"""What friction does to the effect of a pedestal."""

import math
from typing import Any

import pandas as pd

from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import listed
from rockfrag.study.study import Study
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
    words = [*_ordinary(ground, above), *_wished(ground, above, wanted)]
    return Section(
        "friction",
        "What friction does to the effect of the pedestal",
        _first(words),
        [
            *words[1:],
            "Bodies slide, rock and fly on surfaces with these friction coefficients, with the amplitudes of "
            "the protocol. Without pedestal an object stands on the ground. A pair has no ratio where nothing "
            "overturns with or without the pedestal: a body slides and never rocks if the friction "
            "coefficient is below its width over its height.",
        ],
        [
            table_html(
                shown,
                _COLUMNS,
                "Ratio of overturning amplitudes with/without pedestal by friction.",
            )
        ],
    )


def _first(words: list[str]) -> str:
    return words[0] if words else "The ratio is known for these friction coefficients."


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


def _ordinary(ground: Means, above: Means) -> list[str]:
    """Say how far the mean ratio goes with ordinary friction everywhere."""
    words = []
    for place, table in (("on the ground", ground), ("above it", above)):
        inside = [row["ratio"] for pair, row in table.items() if _is_ordinary(pair)]
        inside = [ratio for ratio in inside if math.isfinite(ratio)]
        if inside:
            words.append(f"{min(inside):.2f} to {max(inside):.2f} {place}")
    if not words:
        return []
    low, high = ORDINARY
    return [
        f"Friction of ordinary surfaces ({low} to {high}) changes the mean ratio to {listed(words)}."
    ]


def _wished(ground: Means, above: Means, wanted: dict[str, float]) -> list[str]:
    """Say with which friction the mean ratios have the signs that are asked for."""
    asked = [
        (table, wanted[n]) for n, table in (("ground", ground), ("above", above)) if n in wanted
    ]
    if not asked or not all(table for table, _ in asked):
        return []

    def has_signs(pair: tuple[float, float], rising: str, falling: str) -> bool:
        ends = [(table[pair][rising if goal > 0 else falling], goal) for table, goal in asked]
        return all(goal * math.log(end) > 0 for end, goal in ends if math.isfinite(end)) and all(
            math.isfinite(end) for end, _ in ends
        )

    signs = [pair for pair in ground if has_signs(pair, "ratio", "ratio")]
    clear = [pair for pair in signs if has_signs(pair, "lower", "upper")]
    places = {"ground": "on the ground", "above": "above it"}
    goal = " and ".join(
        f"{percent:+g} % {places[name]}".replace("-", "−") for name, percent in wanted.items()
    )
    if not signs:
        return [f"No pair of friction coefficients gives the signs asked for ({goal})."]
    words = [f"{_coefficient(sign)} and {_coefficient(two)}" for sign, two in signs]
    usual = sum(map(_is_ordinary, signs))
    return [
        f"{len(signs)} of {len(ground)} pairs of friction coefficients (ground, interface) give the signs asked "
        f"for ({goal}): {listed(words[:6])}{' among them' if len(words) > 6 else ''}. The intervals have these "
        f"signs too in {len(clear)}; {usual} are of ordinary surfaces."
    ]


FRICTION = Part(("sensitivity_analysis/friction",), _section, asked=asks_friction)
