"""Fragility curves: figures by object, and a table per measure and reading."""

import math
from collections.abc import Hashable, Mapping
from functools import partial
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.files import file_name
from rockfrag.fragility.checks import REJECTION, TAILS
from rockfrag.fragility.curve_facts import REJECTED, compared_curves
from rockfrag.report.answer import has_one_record
from rockfrag.report.figures.fragility import fragility_figure
from rockfrag.report.findings import ONE_MOTION, strength_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.wording import decimals_of, estimates, number, probability, sentence


def _section(results: Results) -> Section:
    if has_one_record(results):
        return Section("fragility", "Fragility", f"{ONE_MOTION.headline}.", [ONE_MOTION.text])
    level = f"{100 * results.study.fragility.confidence:g} %"
    curves = _ordered(results)
    known = curves["theta"].notna()
    known_curves = curves[known]
    without = list(dict.fromkeys(curves.loc[~known, "configuration"]))
    found = strength_found(known_curves, level)
    rejected = int((known_curves["p_fit"] < REJECTED).sum())
    total, notes = len(known_curves), _notes(curves)
    text = sentences().fragility(found, level, rejected, total, REJECTED, without, notes)
    figures, tables = _figures(results, curves), _tables(known_curves, level)
    return section_of(text, "fragility", [*figures, *tables])


def _notes(curves: pd.DataFrame) -> list[str]:
    """Warnings of the curves, without those that the tables show number by number."""
    notes = [REJECTION.sub("", str(note)).strip() for note in curves["warnings"] if note]
    tails = any(TAILS in note for note in notes)
    others = dict.fromkeys(rest for note in notes if (rest := note.replace(TAILS, "").strip()))
    return [*others, *([TAILS] if tails else [])]


def _ordered(results: Results) -> pd.DataFrame:
    order = {configuration.name: i for i, configuration in enumerate(results.study.configurations)}
    return results.table("fragility").sort_values(
        "configuration", key=lambda names: names.map(order), kind="stable"
    )


def _figures(results: Results, curves: pd.DataFrame) -> list[FigureSpec]:
    bands, bins = results.table("fragility_bands"), results.table("fragility_bins")
    measure = str(results.table("fragility")["im"].iloc[0])
    level = f"{100 * results.study.fragility.confidence:g} %"
    same = curves[(curves["im"] == measure) & (curves["estimator"] == "mean_probability")]
    same, nonparametric, _ = compared_curves(same)
    specs = []
    for name in results.objects:
        own = [
            configuration.name
            for configuration in results.study.configurations
            if configuration.names[-1] == name
        ]
        chosen = same[same["configuration"].isin(own)]
        medians = [
            f"{row['configuration']} {number(row['theta'], decimals_of(row['theta']))} {row['unit']}"
            for row in chosen.dropna(subset=["theta"]).to_dict("records")
        ]
        text = sentences().fragility_figure(name, measure, level, nonparametric, medians)
        band, points = (
            table[table["configuration"].isin(own) & (table["im"] == measure)]
            for table in (bands, bins)
        )
        draw = partial(fragility_figure, chosen, band, points, nonparametric)
        specs.append(figure_of(text, f"fragility_{file_name(name)}", draw))
    return specs


def _tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading."""
    tables = []
    for (measure, unit, definition), rows in curves.groupby(
        ["im", "unit", "estimator"], sort=False
    ):
        shown = rows.assign(
            theta_text=estimates(rows, "theta"),
            beta_text=estimates(rows, "beta"),
            p_text=[probability(p) for p in rows["p_fit"]],
            lean_text=[_lean(row) for row in rows.to_dict("records")],
        )
        columns = [
            Column("configuration", "Configuration"),
            Column("theta_text", f"Median θ [{unit}]", numeric=True),
            Column("beta_text", "Dispersion β", numeric=True),
            Column("p_text", "p of the fit", numeric=True),
            Column("lean_text", "Most influential"),
        ]
        if (rows["p_fit"] < REJECTED).any():
            for name, words in (("theta", "median"), ("beta", "β")):
                shown[f"{name}_fraction"] = estimates(rows, f"{name}_isotonic")
                columns.append(Column(f"{name}_fraction", f"Nonparametric {words}", numeric=True))
        caption = f"{sentence(str(measure))}, {str(definition).replace('_', ' ')}, with {level} intervals."
        tables.append(table_html(shown, columns, caption))
    return tables


def _lean(row: Mapping[Hashable, Any]) -> str:
    """Group without which the median would change most, and by what factor."""
    if not row["influential"] or not math.isfinite(row["influence"]):
        return "–"
    return f"{row['influential']} (× {number(row['influence'], 2)})"


FRAGILITY = Part(("fragility", "fragility_bands", "fragility_bins"), _section)
