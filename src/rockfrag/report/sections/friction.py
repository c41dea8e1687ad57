"""What friction does to the effect of a pedestal."""

import math

import numpy as np
import pandas as pd

from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import listed
from rockfrag.study.study import Study

ORDINARY = (0.3, 0.7)
"""Friction of dry wood, stone and mortar on each other, as handbooks of engineering give it [-]."""

_COLUMNS = (
    Column("ground_text", "Friction at the ground", numeric=True),
    Column("interface_text", "between pedestal and object", numeric=True),
    Column("here", "P/NP on the ground [95 % interval]", numeric=True),
    Column("above", "above it", numeric=True),
    Column("left_out", "Pairs without a fall", 0),
)


def asks_friction(study: Study) -> bool:
    """Whether a study asks what friction does, and has pairs that could show it."""
    explanation = study.more.explanation
    return explanation is not None and bool(explanation.friction) and study.has_pairs


def _section(results: Results) -> Section | None:
    effects = results.table("explanation/friction")
    whole = effects[effects["object"] == "all"]
    ground = whole[whole["place"] == "ground"].set_index(["ground", "interface"])
    above = whole[whole["place"] == "above"].set_index(["ground", "interface"])
    if ground.empty:
        return None
    shown = pd.DataFrame(
        [
            {
                "ground_text": _coefficient(one),
                "interface_text": _coefficient(two),
                "here": _ratio(ground, (one, two)),
                "above": _ratio(above, (one, two)),
                "left_out": int(ground.loc[(one, two), "left_out"])
                + (int(above.loc[(one, two), "left_out"]) if (one, two) in above.index else 0),
            }
            for one, two in ground.index
        ]
    )
    explanation = results.study.more.explanation
    wanted = {} if explanation is None else explanation.wanted_percent
    return Section(
        "friction",
        "What friction does to the effect of the pedestal",
        " ".join([*_ordinary(ground, above), *_wished(ground, above, dict(wanted))]),
        [
            "Bodies slide, rock and fly on surfaces with these coefficients of friction, on the ladder of the "
            "protocol. Alone, an object stands on the ground. A pair has no ratio where nothing falls with or "
            "without the pedestal: on a surface smoother than its width over its height nothing rocks, however "
            "strong the motion."
        ],
        [table_html(shown, _COLUMNS, "Ratio P/NP by friction.")],
    )


def _coefficient(value: float) -> str:
    return "∞" if math.isinf(value) else f"{value:g}"


def _ratio(table: pd.DataFrame, pair: tuple[float, float]) -> str:
    if pair not in table.index or not math.isfinite(table.loc[pair, "ratio"]):
        return "–"
    return ratio_text(table.loc[pair].to_dict())


def _ordinary(ground: pd.DataFrame, above: pd.DataFrame) -> list[str]:
    """How far P/NP goes with ordinary friction everywhere."""
    words = []
    for place, table in (("on the ground", ground), ("above it", above)):
        inside = [
            ratio
            for (one, two), ratio in table["ratio"].items()
            if all(ORDINARY[0] <= mu <= ORDINARY[1] for mu in (one, two)) and math.isfinite(ratio)
        ]
        if inside:
            words.append(f"from {min(inside):.2f} to {max(inside):.2f} {place}")
    if not words:
        return []
    low, high = ORDINARY
    return [f"With ordinary friction, {low} to {high} everywhere, mean P/NP goes {listed(words)}."]


def _wished(ground: pd.DataFrame, above: pd.DataFrame, wanted: dict[str, float]) -> list[str]:
    """With which friction the mean ratios have the signs that are asked for."""
    asked = [(t, wanted[n]) for n, t in (("ground", ground), ("above", above)) if n in wanted]
    if not asked or any(table.empty for table, _ in asked):
        return []
    signs, clear = [], []
    for pair in ground.index:
        rows = [(table.loc[pair], np.sign(percent)) for table, percent in asked]
        if all(sign * np.log(row["ratio"]) > 0 for row, sign in rows):
            signs.append(pair)
            if all(sign * np.log(row["lower" if sign > 0 else "upper"]) > 0 for row, sign in rows):
                clear.append(pair)
    goal = " and ".join(f"{percent:+g} % {name}" for name, percent in wanted.items())
    goal = (
        goal.replace("-", "−").replace(" ground", " on the ground").replace(" above", " above it")
    )
    if not signs:
        return [f"No pair of coefficients gives the signs asked for ({goal})."]
    words = [f"{_coefficient(one)} and {_coefficient(two)}" for one, two in signs]
    usual = [p for p in signs if all(ORDINARY[0] <= mu <= ORDINARY[1] for mu in p)]
    return [
        f"The signs asked for ({goal}) come with {len(signs)} of {len(ground)} pairs of coefficients, ground and "
        f"interface: {listed(words[:6])}{' among them' if len(words) > 6 else ''}; their intervals leave no doubt "
        f"in {len(clear)}, and {len(usual)} are of ordinary surfaces."
    ]


FRICTION = Part(("explanation/friction",), _section, asked=asks_friction)
