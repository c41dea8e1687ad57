"""The report of a measured table: its curves, the intensity-measure selection, and how well they fit."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.figure_style import note_figure
from rockfrag.fragility.user_table import UserFragility, fit_user_table
from rockfrag.report.figures.fragility import calibration_figure, measures_figure
from rockfrag.report.page import Column, estimated, p_values, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section, finding_of, section_of
from rockfrag.report.sections.curves import two_measures_section
from rockfrag.report.study_report import write_page
from rockfrag.report.wording import Macros, estimates, one_line, said
from rockfrag.stages.job import Job, Results
from rockfrag.study.measured_table import MeasuredTable

_CAPTIONS = {
    "measures": "Probability of overturning over each measure: tests in bins with binomial limits, a local "
    "average (dashed), and the lognormal curve with its band.",
    "calibration": "Observed against fitted fractions of overturned tests; the diagonal is a perfect fit.",
}


says = Macros("rockfrag.report", "measured_page.j2")


def run(job: Job[MeasuredTable]) -> Results:
    """Yield the fitted tables; draw the figures and write the page, ``report.html``."""
    study = job.study
    found = fit_user_table(
        study.table,
        study.measures,
        overturned=study.overturned,
        motion=study.motion,
        earthquake=study.earthquake,
        given=study.given,
        level=study.confidence,
        replicates=study.replicates,
        seed=study.seed,
    )
    tables, specs = result_tables(found), figure_specs(found)
    yield from tables.items()
    answer = _answer(study, found, specs)
    sections = [
        _choice(tables["recommendation"], answer.sentences[0]),
        _curves(study, tables, specs),
    ]
    both = found.two_measures and two_measures_section(found.two_measures, study.confidence)
    if both:
        sections.append(both)
    digest = tables["fragility"]["record_set_sha256"].iloc[0]
    values = f"{study.table.name}, SHA-256 of the values used {digest}"
    lead = one_line(says.lead(found.tests))
    write_page(job, answer, sections, {"Table": values}, lead=lead, basis="measured")
    job.log.info("%s", found.choice.words)


def result_tables(found: UserFragility) -> dict[str, pd.DataFrame]:
    """Return the tables by their names."""
    columns = ["measure", "deviance", "p_value", "brier", "finding"]
    goodness = [
        (measure, fit.deviance, fit.p_value, fit.brier, fit.words)
        for measure, fit in found.goodness.items()
    ]
    return {
        "tests": found.tests,
        "fragility": found.table,
        "recommendation": found.choice.table,
        "bins": found.bins,
        "goodness": pd.DataFrame(goodness, columns=columns),
    }


def figure_specs(found: UserFragility) -> dict[str, FigureSpec]:
    """Figures by name; one that its data cannot carry says so in words."""
    curves = {name: fit for name, fit in found.fits.items() if np.isfinite(fit.fit.theta)}
    outcomes = {name: found.outcomes[name] for name in curves}
    drawings: dict[str, Callable[[], Figure]] = {}
    if curves:
        drawings["measures"] = lambda: measures_figure(curves, outcomes)
    if found.goodness:
        drawings["calibration"] = lambda: calibration_figure(found.goodness)
    words = "No curve: the tests show no measure with which overturning becomes more frequent."
    nothing = partial(note_figure, words)
    return {
        name: FigureSpec(name, f"{text} {found.choice.words}", text, drawings.get(name, nothing))
        for name, text in _CAPTIONS.items()
    }


def _answer(study: MeasuredTable, found: UserFragility, specs: Mapping[str, FigureSpec]) -> Answer:
    """What stands first: which measure, how strong it must be, and whether the curve fits."""
    name = found.choice.name
    sentences = [finding_of(says.choice(found.choice))]
    best = found.table[found.table["theta"].notna()]
    best = best[best["im"] == name] if name in set(best["im"]) else best
    if len(best):
        (theta,), (beta,) = (estimates(best.head(1), key) for key in ("theta", "beta"))
        median = says.median(best.iloc[0], theta, beta, _level(study))
        sentences.append(finding_of(median))
    doubtful = [
        found.fits[measure].fit.im
        for measure, goodness in found.goodness.items()
        if goodness.p_value < 0.05
    ]
    if found.goodness:
        sentences.append(finding_of(says.shape(doubtful, len(found.goodness))))
    return Answer(
        asked="How strong must shaking be to overturn the tested object, and which measure predicts it best?",
        sentences=sentences,
        figure=specs["measures"],
        rests_on=said(says.rests_on(found.tests)),
        could_change=list(dict.fromkeys(note for note in found.table["warnings"] if note)),
    )


def _level(study: MeasuredTable) -> str:
    return f"{100 * study.confidence:g} %"


_CHOICE = (
    Column("im", "Measure"),
    Column("unit", "Unit"),
    Column("theta", "Median θ", 3),
    Column("beta", "β", 3),
    Column("aic", "AIC", 1),
    Column("auc", "AUC", 3),
    Column("chosen_fraction", "Fraction of bootstrap samples in which it is best", 2),
)
_CURVES = (
    Column("im", "Measure"),
    Column("unit", "Unit"),
    estimated("theta", "Median θ"),
    estimated("beta", "β"),
    Column("aic", "AIC", 1),
)
_FITS = (
    Column("measure", "Measure"),
    Column("deviance", "Deviance", 1),
    p_values("p_value", "p"),
    Column("brier", "Brier score", 3),
    Column("finding", "Finding"),
)


def _choice(choice: pd.DataFrame, best: Finding) -> Section:
    given = [name for name in map(str, choice.columns) if name.startswith("p_")]
    columns = [*_CHOICE, *(p_values(name, f"p, {name.removeprefix('p_')}") for name in given)]
    table = table_html(choice, columns, "Measures compared on the same tests, best first.")
    return section_of(says.measures(best), "measure", [table])


def _curves(
    study: MeasuredTable, tables: Mapping[str, pd.DataFrame], figures: Mapping[str, FigureSpec]
) -> Section:
    fitted, goodness = tables["fragility"], tables["goodness"]
    warnings = dict.fromkeys(note for note in fitted["warnings"] if note)
    level, notes = _level(study), [*goodness["finding"], *warnings]
    parts: list[Markup | FigureSpec] = [
        table_html(fitted, _CURVES, f"Medians and dispersions, {level} intervals."),
        table_html(goodness, _FITS, "Goodness of fit."),
        figures["calibration"],
    ]
    return section_of(says.curves(len(goodness), level, notes), "fragility", parts)
