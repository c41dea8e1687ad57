"""Fragility curves: figures by object, and a table per measure and reading."""

import math
from collections.abc import Hashable, Mapping
from functools import partial
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.files import file_name
from rockfrag.report.figures.fragility import fragility_figure
from rockfrag.report.findings import strength_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import decimals_of, estimates, listed, number, probability


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
        )
        caption = f"{measure}, {str(reading).replace('_', ' ')}: with {level} intervals."
        tables.append(table_html(shown, columns, caption))
    return tables


def _lean(row: Mapping[Hashable, Any]) -> str:
    """Group without which the median would change most, and by what factor."""
    if not row["influential"] or not math.isfinite(row["influence"]):
        return "–"
    return f"{row['influential']} (× {number(row['influence'], 2)})"


FRAGILITY = Part(("fragility", "fragility_bands", "fragility_bins"), _section)
