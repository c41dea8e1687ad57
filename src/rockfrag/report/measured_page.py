"""The report of a measured table: its curves, the intensity-measure selection, and how well they fit."""

from collections.abc import Mapping
from functools import partial
from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from rockfrag.base import figure_style as style
from rockfrag.fragility.checks import GoodnessOfFit
from rockfrag.fragility.empirical import fraction_in_bins, local_fraction
from rockfrag.fragility.estimators import Fragility
from rockfrag.fragility.ida_curves import levels_drawn
from rockfrag.fragility.observations import Observations
from rockfrag.fragility.user_table import UserFragility, fit_user_table
from rockfrag.report.figures import GREY
from rockfrag.report.page import p_values
from rockfrag.report.part import Answer, FigureSpec, Says, Section
from rockfrag.report.sections.curves import (
    axis_label,
    draw_fractions,
    probability_axis,
    two_measures_section,
)
from rockfrag.report.study_report import write_page
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import MeasuredTable
from rockfrag.words.sentences import estimates

says = Says("rockfrag.report", "measured_page.j2")


def run(job: Job[MeasuredTable]) -> Results:
    """Yield the fitted tables; draw the figures and write the page, ``report.html``."""
    study = job.study
    settings: dict[str, Any] = {
        "level": study.confidence,
        "replicates": study.replicates,
    }
    settings |= {**study.columns, "seed": study.seed}
    found = fit_user_table(study.table, study.measures, **settings)
    goodness = pd.DataFrame(
        [
            (name, g.deviance, g.p_value, g.brier, g.words)
            for name, g in found.goodness.items()
        ],
        columns=["measure", "deviance", "p_value", "brier", "finding"],
    )
    yield "tests", found.tests
    yield "fragility", found.table
    yield "recommendation", found.choice.table
    yield "bins", found.bins
    yield "goodness", goodness
    measures, calibration = _figures(found)
    answer = _answer(study, found, measures)
    choice = found.choice.table
    given = [name for name in map(str, choice.columns) if name.startswith("p_")]
    columns = [p_values(name, f"p, {name.removeprefix('p_')}") for name in given]
    sections = [
        says.section(
            "measure", [says.table("choice", choice, more=columns)], answer.sentences[0]
        ),
        _curves(study, found.table, goodness, calibration),
    ]
    both = found.two_measures and two_measures_section(
        found.two_measures, study.confidence
    )
    if both:
        sections.append(both)
    digest = found.table["record_set_sha256"].iloc[0]
    values = f"{study.table.name}, SHA-256 of the values used {digest}"
    lead = says.line("lead", found.tests)
    write_page(job, answer, sections, {"Table": values}, lead=lead, basis="measured")
    job.log.info("%s", found.choice.words)


def _figures(found: UserFragility) -> tuple[FigureSpec, FigureSpec]:
    """Curves over each measure and how well they fit; what the data cannot carry says so in words."""
    words = "No curve: the tests show no measure with which overturning becomes more frequent."
    curves = {
        name: fit for name, fit in found.fits.items() if np.isfinite(fit.fit.theta)
    }
    over = calibration = partial(style.note_figure, words)
    if curves:
        over = partial(measures_figure, curves, found.outcomes)
    if found.goodness:
        calibration = partial(calibration_figure, found.goodness)
    best = found.choice.words
    return says.figure("measures", over, best), says.figure(
        "calibration", calibration, best
    )


def _answer(study: MeasuredTable, found: UserFragility, measures: FigureSpec) -> Answer:
    """What stands first: which measure, how strong it must be, and whether the curve fits."""
    name = found.choice.name
    sentences = [says.finding("choice", found.choice)]
    best = found.table[found.table["theta"].notna()]
    best = best[best["im"] == name] if name in set(best["im"]) else best
    if len(best):
        (theta,), (beta,) = (estimates(best.head(1), key) for key in ("theta", "beta"))
        sentences.append(
            says.finding("median", best.iloc[0], theta, beta, _level(study))
        )
    judged = found.goodness.items()
    doubtful = [found.fits[name].fit.im for name, fit in judged if fit.p_value < 0.05]
    if found.goodness:
        sentences.append(says.finding("shape", doubtful, len(found.goodness)))
    return Answer(
        asked="How strong must shaking be to overturn the tested object, and which measure predicts it best?",
        sentences=sentences,
        figure=measures,
        rests_on=says("rests_on", found.tests),
        could_change=list(
            dict.fromkeys(note for note in found.table["warnings"] if note)
        ),
    )


def _level(study: MeasuredTable) -> str:
    return f"{100 * study.confidence:g} %"


def _curves(
    study: MeasuredTable,
    fitted: pd.DataFrame,
    goodness: pd.DataFrame,
    calibration: FigureSpec,
) -> Section:
    warnings = dict.fromkeys(note for note in fitted["warnings"] if note)
    level, notes = _level(study), [*goodness["finding"], *warnings]
    tables = says.table("curves", fitted, level), says.table("fits", goodness)
    return says.section(
        "fragility", [*tables, calibration], len(goodness), level, notes
    )


def measures_figure(
    curves: Mapping[str, Fragility], outcomes: Mapping[str, Observations]
) -> Figure:
    """Draw the curve of each measure in a panel of its own, with AIC and β, to compare measures."""
    columns = min(len(curves), 2)
    rows = -(-len(curves) // columns)
    width, shape = style.COLUMN_WIDTH if columns == 1 else style.WIDEST, (rows, columns)
    with style.panels(width, 2.4 * rows, *shape, squeeze=False, sharey=True) as (
        figure,
        panels,
    ):
        for axes in panels.flat[len(curves) :]:
            axes.set_visible(False)
        for axes, (label, curve) in zip(panels.flat, curves.items(), strict=False):
            data = outcomes[label]
            grid = levels_drawn(curve, data, 400)
            draw_fractions(
                axes, fraction_in_bins(data).rename(columns={"im": "x"}), style.BLACK
            )
            inside = grid[(grid >= data.im.min()) & (grid <= data.im.max())]
            if inside.size and np.ptp(data.log_im) > 0:
                local = local_fraction(data, inside)
                axes.plot(inside, local, "--", color=style.BLACK, linewidth=0.8)
            lower, upper = curve.interval.band(grid)
            if np.isfinite(lower).any():
                axes.fill_between(
                    grid, lower, upper, color=style.BLUE, alpha=0.18, linewidth=0
                )
            axes.plot(grid, curve.fit.probability(grid), color=style.BLUE)
            probability_axis(axes, grid)
            fit = curve.fit
            axes.set_title(
                f"{fit.im}: AIC {fit.aic:.1f}, β = {fit.beta:.2f}", loc="left"
            )
            axes.set_xlabel(axis_label(fit.im, fit.unit))
        for axes in panels[:, 0]:
            axes.set_ylabel("Probability of overturning")
        style.letter_panels(panels.flat[: len(curves)])
        return figure


def calibration_figure(judged: Mapping[str, GoodnessOfFit]) -> Figure:
    """Draw observed against fitted fractions in bins; points on the diagonal are well calibrated."""
    with style.panels(style.COLUMN_WIDTH, 3.0) as (figure, axes):
        axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        marks = zip(judged.items(), cycle("os^Dv"), cycle(style.OKABE_ITO))
        for (label, fit), mark, colour in marks:
            names = ("predicted", "observed", "observed_lower", "observed_upper")
            x, y, lower, upper = (fit.calibration[name].to_numpy() for name in names)
            reach = [np.maximum(y - lower, 0.0), np.maximum(upper - y, 0.0)]
            words = f"{label} (p = {fit.p_value:.2g})"
            axes.errorbar(
                x, y, reach, fmt=mark, color=colour, ms=3.5, elinewidth=0.8, label=words
            )
        axes.set(aspect="equal", xlim=(-0.02, 1.02), ylim=(-0.02, 1.02))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(PercentFormatter(1.0, decimals=0, symbol=" %"))
        axes.set(xlabel="Fitted probability", ylabel="Fraction overturned")
        axes.legend(loc="upper left", handletextpad=0.3)
        return figure
