"""The report of a measured table: its curves, the choice of the measure, and how well they fit."""

from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from rockfrag.fragility.user_table import UserFragility
from rockfrag.report.estimate_columns import with_limits
from rockfrag.report.figures.fragility import calibration_figure, measures_figure, surface_figure
from rockfrag.report.figures.style import COLUMN_WIDTH, figure_style, new_figure
from rockfrag.report.findings import Finding
from rockfrag.report.page import Column, Picture, Section, render, table_html
from rockfrag.stages.digest import source_digest
from rockfrag.study.measured_table import MeasuredTable

TABLES = ("tests", "fragility", "recommendation", "bins", "goodness")
"""Result tables of a measured table, each as CSV and Parquet."""

_CAPTIONS = {
    "measures": "Probability of overturning over each measure: verdicts in bins with binomial limits, "
    "a local average (dashed), and the lognormal curve with its band.",
    "surface": "Tests in the first two measures, with lines of equal fitted probability.",
    "calibration": "Observed against fitted shares of overturned tests; the diagonal is perfect.",
}


def figure_names(study: MeasuredTable) -> list[str]:
    """Names of the figures, in the order of the report."""
    return [name for name in _CAPTIONS if name != "surface" or len(study.measures) > 1]


def result_tables(found: UserFragility) -> dict[str, pd.DataFrame]:
    """Return the tables named in ``TABLES``."""
    goodness = [
        {
            "measure": measure,
            "deviance": one.deviance,
            "p_value": one.p_value,
            "brier": one.brier,
            "finding": one.words,
        }
        for measure, one in found.goodness.items()
    ]
    columns = ["measure", "deviance", "p_value", "brier", "finding"]
    return {
        "tests": found.tests,
        "fragility": found.table,
        "recommendation": found.choice.table,
        "bins": found.bins,
        "goodness": pd.DataFrame(goodness, columns=columns),
    }


def draw(study: MeasuredTable, found: UserFragility) -> dict[str, Figure]:
    """Draw every figure; one that its data cannot carry says so in words."""
    curves = {name: fit for name, fit in found.fits.items() if np.isfinite(fit.fit.theta)}
    outcomes = {name: found.outcomes[name] for name in curves}
    figures: dict[str, Figure] = {}
    for name in figure_names(study):
        if name == "measures" and curves:
            figures[name] = measures_figure(curves, outcomes)
        elif name == "surface" and found.surface is not None:
            figures[name] = surface_figure(found.surface, found.tests)
        elif name == "calibration" and found.goodness:
            figures[name] = calibration_figure(found.goodness)
        else:
            figures[name] = _note("No curve: these tests do not rise with a measure.")
    return figures


def _note(words: str) -> Figure:
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 0.6)
        figure.text(0.5, 0.5, words, ha="center", va="center")
        return figure


def write_measured_page(study: MeasuredTable, found: UserFragility, figures: Path) -> str:
    """Return the report as HTML.

    Parameters
    ----------
    study
        The configuration.
    found
        What the table says.
    figures
        Folder with the figures as SVG.
    """
    tables = result_tables(found)
    pictures = {
        name: Picture(figures / f"{name}.svg", _CAPTIONS[name]) for name in figure_names(study)
    }
    tests = found.tests
    motions, fell = tests["motion"].nunique(), int(tests["overturned"].sum())
    return render(
        title=study.title,
        lead=f"{len(tests)} measured tests with {motions} motions, {fell} of them overturned.",
        findings=_findings(found),
        sections=[
            _choice(tables["recommendation"], pictures),
            _curves(study, tables, pictures),
        ],
        provenance={
            "Configuration": study.source.name,
            "Table": f"{study.table.name}, SHA-256 of the values used "
            f"{tables['fragility']['record_set_sha256'].iloc[0]}",
            "Seed": str(study.seed),
            "Source": f"rockfrag {version('rockfrag')}, digest {source_digest('rockfrag.guests')}",
        },
        basis="measured",
    )


def _findings(found: UserFragility) -> list[Finding]:
    name = found.choice.name
    headline = f"{name} foretells overturning best" if name else "No measure has a rising curve"
    findings = [Finding(headline, found.choice.words)]
    findings += [
        Finding(f"Fit in {found.fits[measure].fit.im}", one.words)
        for measure, one in found.goodness.items()
    ]
    return findings


def _choice(choice: pd.DataFrame, pictures: Mapping[str, Picture]) -> Section:
    columns = [
        Column("im", "Measure"),
        Column("unit", "Unit"),
        Column("theta", "Median θ", 3),
        Column("beta", "β", 3),
        Column("aic", "AIC", 1),
        Column("auc", "AUC", 3),
        Column("chosen_share", "Best in share of bootstrap samples", 2),
    ]
    given = [name for name in map(str, choice.columns) if name.startswith("p_")]
    columns += [Column(name, f"p, {name.removeprefix('p_')}", 3) for name in given]
    return Section(
        "measure",
        "Choice of the intensity measure",
        [
            "AIC decides; β is the efficiency, AUC the probability that an overturned test had the "
            "larger measure. A small p says that the measure leaves something for that column to tell."
        ],
        [
            table_html(choice, columns, "Measures compared on the same tests, best first."),
            *[pictures[name] for name in ("measures", "surface") if name in pictures],
        ],
    )


def _curves(
    study: MeasuredTable, tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]
) -> Section:
    level = f"{100 * study.confidence:g} %"
    curves = (
        Column("im", "Measure"),
        Column("unit", "Unit"),
        *with_limits("theta", "Median θ", "theta_lower", "theta_upper"),
        *with_limits("beta", "β", "beta_lower", "beta_upper"),
        Column("aic", "AIC", 1),
    )
    fits = (
        Column("measure", "Measure"),
        Column("deviance", "Deviance", 1),
        Column("p_value", "p", 3),
        Column("brier", "Brier score", 3),
        Column("finding", "Finding"),
    )
    warnings = sorted({note for note in tables["fragility"]["warnings"] if note})
    return Section(
        "fragility",
        "Fragility curves",
        [f"Lognormal curves with intervals of {level}, from resampled motions.", *warnings],
        [
            table_html(tables["fragility"], curves, f"Medians and dispersions, {level} intervals."),
            table_html(tables["goodness"], fits, "Goodness of fit."),
            pictures["calibration"],
        ],
    )
