"""Fragility curves: figures by object, and a table per measure and reading."""

import math
from collections.abc import Hashable, Mapping
from functools import partial
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.files import file_name
from rockfrag.fragility.checks import REJECTION, TAILS
from rockfrag.fragility.compared import compared_curves
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.report.answer import has_one_record
from rockfrag.report.figures.fragility import fragility_figure
from rockfrag.report.findings import ONE_MOTION, strength_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened
from rockfrag.report.wording import (
    agree,
    decimals_of,
    estimates,
    listed,
    number,
    of_all,
    probability,
    sentence,
)


def _section(results: Results) -> Section:
    if has_one_record(results):
        return Section("fragility", "Fragility", f"{ONE_MOTION.headline}.", [ONE_MOTION.text])
    level = f"{100 * results.study.fragility.confidence:g} %"
    curves = _ordered(results)
    known = curves["theta"].notna()
    known_curves = curves[known]
    without = list(dict.fromkeys(curves.loc[~known, "configuration"]))
    found = strength_found(known_curves, level)
    message = f"{found.headline}." if found else "No curve rises with the motion."
    return Section(
        "fragility",
        "Fragility",
        message,
        [
            *(opened(found) if found else []),
            "Lognormal curves have the form Φ(ln(IM/θ)/β). The definition “mean probability” counts every "
            "amplitude, structural resurrections included; “first overturning” and “always overturning” take one "
            f"amplitude per motion. The {level} intervals resample earthquakes or motions, not amplitudes; "
            "“open” is a limit that the data do not set. A small p of the fit rejects the lognormal curve. "
            "The last column of each table gives the factor on the median without the most influential "
            "earthquake or motion.",
            *_rejected_words(known_curves),
            *([f"Some definitions give no curve for {listed(without)}."] if without else []),
            *_notes(curves),
        ],
        [*_figures(results, curves), *_tables(known_curves, level)],
    )


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
        caption = (
            f"{name}: probability of overturning over {measure}, with {level} limits (band). Points are "
            "fractions of all analyses in bins, with binomial limits."
        )
        if nonparametric:
            caption += (
                " Line: nonparametric monotone curve; dotted: lognormal curve, rejected for at least one of "
                "them. The band is wide where all earthquakes agree, because few earthquakes cannot bound a "
                "probability closely."
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
                    bands[bands["configuration"].isin(own) & (bands["im"] == measure)],
                    bins[bins["configuration"].isin(own) & (bins["im"] == measure)],
                    nonparametric,
                ),
            )
        )
    return specs


def _tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading."""
    tables = []
    for (measure, unit, definition), rows in curves.groupby(
        ["im", "unit", "estimator"], sort=False
    ):
        shown = rows.assign(
            **_nonparametric_texts(rows),
            theta_text=estimates(rows, "theta"),
            beta_text=estimates(rows, "beta"),
            p_text=[probability(p) for p in rows["p_fit"]],
            lean_text=[_lean(row) for row in rows.to_dict("records")],
        )
        columns = (
            Column("configuration", "Configuration"),
            Column("theta_text", f"Median θ [{unit}]", numeric=True),
            Column("beta_text", "Dispersion β", numeric=True),
            Column("p_text", "p of the fit", numeric=True),
            Column("lean_text", "Most influential"),
            *_nonparametric_columns(rows),
        )
        caption = f"{sentence(str(measure))}, {str(definition).replace('_', ' ')}, with {level} intervals."
        tables.append(table_html(shown, columns, caption))
    return tables


def _rejected_words(curves: pd.DataFrame) -> list[str]:
    """What to use where a lognormal curve is rejected."""
    rejected = int((curves["p_fit"] < REJECTED).sum())
    if not rejected:
        return []
    who = sentence(of_all(rejected, len(curves), "lognormal curve"))
    return [
        f"{who} {agree(rejected, len(curves), 'is', 'are')} rejected (p below {REJECTED:g}). Where one is, all "
        "curves of that measure and reading are compared by the nonparametric monotone curve: the columns "
        "“nonparametric” give its median and half the distance from its 16 to its 84 % point; its points with "
        "their intervals are in the table fragility_fractions."
    ]


def _nonparametric_texts(rows: pd.DataFrame) -> dict[str, list[str]]:
    """Median and dispersion of the nonparametric curves, of all rows where one lognormal curve is rejected."""
    if not (rows["p_fit"] < REJECTED).any():
        return {}
    return {
        f"{name}_fraction_text": estimates(rows, f"{name}_isotonic") for name in ("theta", "beta")
    }


def _nonparametric_columns(rows: pd.DataFrame) -> tuple[Column, ...]:
    if not (rows["p_fit"] < REJECTED).any():
        return ()
    return (
        Column("theta_fraction_text", "Nonparametric median", numeric=True),
        Column("beta_fraction_text", "Nonparametric β", numeric=True),
    )


def _lean(row: Mapping[Hashable, Any]) -> str:
    """Group without which the median would change most, and by what factor."""
    if not row["influential"] or not math.isfinite(row["influence"]):
        return "–"
    return f"{row['influential']} (× {number(row['influence'], 2)})"


FRAGILITY = Part(("fragility", "fragility_bands", "fragility_bins"), _section)
