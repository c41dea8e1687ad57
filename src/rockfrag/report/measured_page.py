"""Report of a measured table: its curves, the intensity-measure selection, and goodness of fit.

In: a table of tests of anybody's (:class:`rockfrag.study.campaign.MeasuredTable`). Out: the fitted tables and
the page ``report.html``; medians θ in the unit of their measure, β [-].

Theory: ``docs/fragility.md``, "A user's table" and "Which intensity measure?".
"""

from collections.abc import Callable, Mapping
from functools import partial
from itertools import cycle
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from rockfrag.base import figure_style as style
from rockfrag.base.figure_style import GREY
from rockfrag.fragility.checks import GoodnessOfFit
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.empirical import fraction_in_bins, local_fraction
from rockfrag.fragility.estimators import Fragility
from rockfrag.fragility.ida_curves import levels_drawn
from rockfrag.fragility.observations import Observations
from rockfrag.fragility.user_table import UserFragility, fit_user_table
from rockfrag.report.page import column, estimated, p_values, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section, chapter
from rockfrag.report.sections.curves import (
    axis_label,
    draw_fractions,
    probability_axis,
    two_measures_section,
)
from rockfrag.report.study_report import write_page
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import MeasuredTable
from rockfrag.words.sentences import counted, estimates, listed


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
    sections = [
        _measure(choice, answer.sentences[0]),
        _curves(study, found.table, goodness, calibration),
    ]
    both = found.two_measures and two_measures_section(
        found.two_measures, study.confidence
    )
    if both:
        sections.append(both)
    digest = found.table["record_set_sha256"].iloc[0]
    values = f"{study.table.name}, SHA-256 of the values used {digest}"
    motions = counted(found.tests["motion"].nunique(), "motion")
    write_page(
        job,
        answer,
        sections,
        about={"Table": values},
        lead=(
            f"{counted(len(found.tests), 'measured test')} with {motions}, "
            f"{int(found.tests['overturned'].sum())} of them overturned."
        ),
        basis="measured",
    )
    job.log.info("%s", found.choice.words)


def _measure(choice: pd.DataFrame, found: Finding) -> Section:
    """Section of the intensity-measure selection."""
    columns = [
        column("im", "Measure"),
        column("unit"),
        column("theta", "Median θ", decimals=3),
        column("beta", "β", decimals=3),
        column("aic", "AIC", decimals=1),
        column("auc", "AUC", decimals=3),
        column(
            "chosen_fraction",
            "Fraction of bootstrap samples in which it is best",
            decimals=2,
        ),
    ]
    given = [name for name in map(str, choice.columns) if name.startswith("p_")]
    columns += [p_values(name, f"p, {name.removeprefix('p_')}") for name in given]
    caption = "Measures compared on the same tests, best first."
    words = (
        "β is the efficiency, AUC the probability that an overturned test had the larger measure. A small p "
        "says that the residuals depend on that column."
    )
    return chapter(
        "measure",
        "Choice of the intensity measure",
        found,
        [words],
        [table_html(choice, columns, caption)],
    )


def _figures(found: UserFragility) -> tuple[FigureSpec, FigureSpec]:
    """Figures of the curves over each measure and of their calibration, or words where there is no curve."""
    words = "No curve: the tests show no measure with which overturning becomes more frequent."
    curves = {
        name: fit for name, fit in found.fits.items() if np.isfinite(fit.fit.theta)
    }
    over: Callable[[], Figure] = partial(style.note_figure, words)
    calibration: Callable[[], Figure] = partial(style.note_figure, words)
    if curves:
        over = partial(measures_figure, curves, found.outcomes)
    if found.goodness:
        calibration = partial(calibration_figure, found.goodness)
    best = found.choice.words
    caption = (
        "Probability of overturning over each measure: tests in bins with binomial limits, a local average "
        "(dashed), and the lognormal curve with its band."
    )
    measures = FigureSpec("measures", f"{caption} {best}", caption, over)
    caption = "Observed against fitted fractions of overturned tests; the diagonal is a perfect fit."
    return measures, FigureSpec(
        "calibration", f"{caption} {best}", caption, calibration
    )


def _answer(study: MeasuredTable, found: UserFragility, measures: FigureSpec) -> Answer:
    """Answer on the first screen: the measure, how strong it must be, and whether the curve fits."""
    name = found.choice.name
    headline = (
        f"{name} predicts overturning best" if name else "No measure has a rising curve"
    )
    sentences = [Finding(headline, "", found.choice.words)]
    best = found.table[found.table["theta"].notna()]
    best = best[best["im"] == name] if name in set(best["im"]) else best
    if len(best):
        sentences.append(_median(best.head(1), _level(study)))
    if found.goodness:
        sentences.append(_shape(found))
    motions = counted(found.tests["motion"].nunique(), "motion")
    return Answer(
        asked="How strong must shaking be to overturn the tested object, and which measure predicts it best?",
        sentences=sentences,
        figure=measures,
        rests_on=[f"{counted(len(found.tests), 'measured test')} under {motions}."],
        could_change=list(
            dict.fromkeys(note for note in found.table["warnings"] if note)
        ),
    )


def _median(best: pd.DataFrame, level: str) -> Finding:
    """Median and dispersion of the one curve in ``best``."""
    row = best.iloc[0]
    theta, beta = estimates(best, "theta")[0], estimates(best, "beta")[0]
    median = f"{theta} {row['unit']}" if row["unit"] else theta
    return Finding(
        f"The probability of overturning reaches 50 % at a {row['im']} of {median}",
        "",
        f"Dispersion β {beta}; {level} intervals from resampled motions.",
    )


def _shape(found: UserFragility) -> Finding:
    """Measures whose lognormal curve is rejected."""
    judged = found.goodness.items()
    rejected = [
        found.fits[name].fit.im for name, fit in judged if fit.p_value < REJECTED
    ]
    headline = "The lognormal curves are not rejected"
    if rejected:
        headline = f"The lognormal curve is rejected for {listed(rejected)}"
    measures = counted(len(found.goodness), "measure")
    return Finding(
        headline, "", f"Tested for {measures}; the deviances are with the curves."
    )


def _level(study: MeasuredTable) -> str:
    return f"{100 * study.confidence:g} %"


def _curves(
    study: MeasuredTable,
    fitted: pd.DataFrame,
    goodness: pd.DataFrame,
    calibration: FigureSpec,
) -> Section:
    """Fitted curves, how well they describe the tests, and their warnings.

    Parameters
    ----------
    study : the table of tests
    fitted, goodness : tables, a row a measure, of curves and of tests of their fit
    calibration : figure of predicted and measured fractions
    """
    warnings = dict.fromkeys(note for note in fitted["warnings"] if note)
    level = _level(study)
    curves = table_html(
        fitted, _CURVES_COLUMNS, f"Medians and dispersions, {level} intervals."
    )
    fits = table_html(goodness, _FITS_COLUMNS, "Goodness of fit.")
    message = "No measure has a rising curve."
    if len(goodness):
        message = "Lognormal curves of the tests."
    words = [
        f"The {level} intervals resample motions.",
        *goodness["finding"],
        *warnings,
    ]
    return Section(
        "fragility", "Fragility curves", message, words, [curves, fits, calibration]
    )


_CURVES_COLUMNS = (
    column("im", "Measure"),
    column("unit"),
    estimated("theta", "Median θ"),
    estimated("beta", "β"),
    column("aic", "AIC", decimals=1),
)
_FITS_COLUMNS = (
    column("measure"),
    column("deviance", decimals=1),
    p_values("p_value", "p"),
    column("brier", "Brier score", decimals=3),
    column("finding"),
)


def measures_figure(
    curves: Mapping[str, Fragility], outcomes: Mapping[str, Observations]
) -> Figure:
    """Draw the curve of each measure in a panel of its own, with AIC and β, to compare measures."""
    columns = min(len(curves), 2)
    rows = -(-len(curves) // columns)
    width = style.COLUMN_WIDTH if columns == 1 else style.WIDEST
    with style.panels(
        width, 2.4 * rows, nrows=rows, ncols=columns, squeeze=False, sharey=True
    ) as (figure, panels):
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
            bins = fit.calibration
            x, y = bins["predicted"].to_numpy(), bins["observed"].to_numpy()
            lower = y - bins["observed_lower"].to_numpy()
            upper = bins["observed_upper"].to_numpy() - y
            reach = [np.maximum(lower, 0.0), np.maximum(upper, 0.0)]
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
