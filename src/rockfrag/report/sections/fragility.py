"""Fragility curves: figures by object, and a table per measure and reading."""

import math
from collections.abc import Hashable, Mapping
from functools import partial
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.files import file_name
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.report.figures.fragility import fragility_figure
from rockfrag.report.findings import strength_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import (
    decimals_of,
    estimates,
    listed,
    number,
    of_all,
    probability,
    sentence,
)


def _section(results: Results) -> Section:
    level = f"{100 * results.study.fragility.confidence:g} %"
    curves = _ordered(results)
    known = curves["theta"].notna()
    known_curves = curves[known]
    notes = list(dict.fromkeys(note for note in curves["warnings"] if note))
    without = list(dict.fromkeys(curves.loc[~known, "configuration"]))
    return Section(
        "fragility",
        "Fragility",
        _message(known_curves, level),
        [
            "Lognormal curves: the probability to overturn is Φ(ln(IM/θ)/β). Mean probability "
            "counts every amplitude, survival windows included; first and always overturning take "
            f"one amplitude a motion. Intervals are {level} intervals that resample earthquakes or motions, "
            "not amplitudes; “open” is a limit that the data do not set. A small p says that the tests "
            "do not lie on such a curve; the last column says how many times the median would be "
            "without the earthquake or motion on which it leans most.",
            *_rejected_words(known_curves),
            *([f"There is not a curve of every reading for {listed(without)}."] if without else []),
            *notes,
        ],
        [*_figures(results, curves), *_tables(known_curves, level)],
    )


def _message(curves: pd.DataFrame, level: str) -> str:
    found = strength_found(curves, level)
    return found.said if found else "No curve rises with the motion."


def _ordered(results: Results) -> pd.DataFrame:
    order = {one.name: i for i, one in enumerate(results.study.configurations)}
    return results.table("fragility").sort_values(
        "configuration", key=lambda names: names.map(order), kind="stable"
    )


def _figures(results: Results, curves: pd.DataFrame) -> list[FigureSpec]:
    bands, bins = results.table("fragility_bands"), results.table("fragility_bins")
    measure = str(results.table("fragility")["im"].iloc[0])
    specs = []
    for name in results.objects:
        own = [one.name for one in results.study.configurations if one.object == name]
        chosen = curves[
            curves["configuration"].isin(own)
            & (curves["im"] == measure)
            & (curves["estimator"] == "mean_probability")
        ]
        caption = (
            f"{name}: probability of overturning over {measure}, with intervals; points are shares of "
            "all runs in bins, the dashed line is the local share."
        )
        if (chosen["p_fit"] < REJECTED).any():
            caption += " Dotted: a lognormal curve that is rejected; the line with the band assumes no form."

        medians = "; ".join(
            f"{row['configuration']} {number(row['theta'], decimals_of(row['theta']))} {row['unit']}"
            for row in chosen.dropna(subset=["theta"]).to_dict("records")
        )
        alt = f"Fragility of {name} over {measure}: " + (
            f"medians {medians}." if medians else "no curve."
        )
        specs.append(
            FigureSpec(
                f"fragility_{file_name(name)}",
                alt,
                caption,
                partial(
                    fragility_figure,
                    chosen,
                    *(
                        t[t["configuration"].isin(own) & (t["im"] == measure)]
                        for t in (bands, bins)
                    ),
                ),
            )
        )
    return specs


def _tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading."""
    tables = []
    for (measure, unit, reading), rows in curves.groupby(["im", "unit", "estimator"], sort=False):
        shown = rows.assign(
            **_rejected_texts(rows),
            theta_text=estimates(rows, ("theta", "theta_lower", "theta_upper")),
            beta_text=estimates(rows, ("beta", "beta_lower", "beta_upper")),
            p_text=[probability(p) for p in rows["p_fit"]],
            lean_text=[_lean(row) for row in rows.to_dict("records")],
        )
        columns = (
            Column("configuration", "Configuration"),
            Column("theta_text", f"Median θ [{unit}]", numeric=True),
            Column("beta_text", "Dispersion β", numeric=True),
            Column("p_text", "p of the fit", numeric=True),
            Column("lean_text", "Leans on"),
            *_without_form(rows),
        )
        caption = f"{measure}, {str(reading).replace('_', ' ')}: with {level} intervals."
        tables.append(table_html(shown, columns, caption))
    return tables


def _rejected_words(curves: pd.DataFrame) -> list[str]:
    """What to use where a lognormal curve is rejected."""
    rejected = int((curves["p_fit"] < REJECTED).sum())
    if not rejected:
        return []
    who = sentence(of_all(rejected, len(curves), "curve"))
    return [
        f"{who} {'does' if rejected == 1 else 'do'} not describe the tests (p below {REJECTED:g}). In their place "
        "use the never-falling share closest to the tests, which assumes no form: its median and half the "
        "distance from its 16 to its 84 % point stand in the last columns, its points with their intervals in the "
        "table fragility_shares."
    ]


_TEXTS = {
    "theta": ("theta_isotonic", "theta_isotonic_lower", "theta_isotonic_upper"),
    "beta": ("beta_isotonic", "beta_isotonic_lower", "beta_isotonic_upper"),
}


def _rejected_texts(rows: pd.DataFrame) -> dict[str, list[str]]:
    """Median and dispersion without a form, of the curves that are rejected."""
    texts = {}
    for name, columns in _TEXTS.items():
        known = (rows["p_fit"] < REJECTED) & rows[columns[0]].notna()
        known_texts = iter(estimates(rows[known], columns))
        texts[f"{name}_share_text"] = [next(known_texts) if one else "–" for one in known]
    return texts


def _without_form(rows: pd.DataFrame) -> tuple[Column, ...]:
    if not (rows["p_fit"] < REJECTED).any():
        return ()
    return (
        Column("theta_share_text", "Median without a form", numeric=True),
        Column("beta_share_text", "β without a form", numeric=True),
    )


def _lean(row: Mapping[Hashable, Any]) -> str:
    """Group without which the median would change most, and by what factor."""
    if not row["influential"] or not math.isfinite(row["influence"]):
        return "–"
    return f"{row['influential']} (× {number(row['influence'], 2)})"


FRAGILITY = Part(("fragility", "fragility_bands", "fragility_bins"), _section)
