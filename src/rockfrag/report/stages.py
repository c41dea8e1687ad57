"""The stages that end a study: its report, or for a table of somebody's own tests everything."""

import pandas as pd

from rockfrag.report.supplements import (
    ORDER_FIGURE,
    STATEMENTS_FIGURE,
    sensitivity_figures,
    supplement_pictures,
    supplement_tables,
)
from rockfrag.stages.pedestal import PEDESTAL_TABLES
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.measured_table import MeasuredTable
from rockfrag.study.study import Study

MEASURED_TABLES = ("tests", "fragility", "recommendation", "bins", "goodness")


def _report(job: Job[Study]) -> Results:
    """Draw the figures and write the page."""
    from rockfrag.files import write_text
    from rockfrag.report.figure_list import Results as Drawn
    from rockfrag.report.figure_list import pictures, plates
    from rockfrag.report.figures.style import save_figure
    from rockfrag.report.provenance import provenance
    from rockfrag.report.study_report import write_page

    study = job.study
    figures = job.folder / "figures"
    tables = {name: job.table(name) for name in report_tables(study)}
    drawn = Drawn(
        study=study,
        ground=job.motions("motions/ground"),
        sweep=pd.concat([job.table(name) for name in study.sweep_tables], ignore_index=True),
        tests=tables["tests"],
        effects=tables.get("pedestal/effects"),
    )
    for plate in plates(study):
        ends = (figures / f"{plate.name}.{ending}" for ending in ("svg", "png"))
        save_figure(plate.draw(drawn), *ends)
        job.log.info("%s", plate.name)
    _draw_supplements(job, tables)
    found = {**pictures(study, figures), **supplement_pictures(study, figures)}
    page = write_page(study, tables, found, provenance(study, tables))
    write_text(page, job.folder / "report.html")
    job.log.info("%s", job.folder / "report.html")
    yield from ()


def _draw_supplements(job: Job[Study], tables: dict[str, pd.DataFrame]) -> None:
    from rockfrag.report.figures.building import floor_order, floor_statements, shaker_limits
    from rockfrag.report.figures.style import save_figure
    from rockfrag.report.sections.explanation import explanation_figure
    from rockfrag.report.sections.measured import measured_beside
    from rockfrag.shaketable.readings import READING, READINGS

    study, tests = job.study, tables["tests"]
    drawn = {}
    if "explanation/effects" in tables:
        drawn["explanation"] = explanation_figure(tables["explanation/effects"])
    if "shaker" in tables:
        lone = tests[(tests["reading"] == READING) & (tests["pedestal"] == "NP")]
        drawn["shaker_limits"] = shaker_limits(tables["shaker"], lone)
    if "measured/beside" in tables:
        drawn["measured_beside"] = measured_beside(tables["measured/beside"])
    for name in sensitivity_figures(study) if "building_sensitivity/margins" in tables else ():
        margins = tables["building_sensitivity/margins"]
        drawn[name] = (
            floor_order(tables["building_sensitivity/tests"], margins, READINGS)
            if name == ORDER_FIGURE
            else floor_statements(margins, name.removeprefix(STATEMENTS_FIGURE), READING)
        )
    for name, figure in drawn.items():
        ends = (job.folder / "figures" / f"{name}.{ending}" for ending in ("svg", "png"))
        save_figure(figure, *ends)


def report_tables(study: Study) -> list[str]:
    """Names of the tables that the report of a study reads."""
    names = ["tests", "measures", "fragility", "survival_windows", "validity"]
    if study.has_pairs:
        names += [f"pedestal/{name}" for name in PEDESTAL_TABLES]
    if study.compare_with == "thesis":
        names += ["table_3_1", "table_3_3", "table_4_1"]
        names += ["claims", "contradictions"] if study.has_pairs else []
    return [*names, *supplement_tables(study)]


REPORT = Stage(
    name="report",
    run=_report,
    inputs=lambda study: (
        "motions/ground.parquet",
        *study.sweep_tables,
        *report_tables(study),
    ),
    files=lambda study: study.body_files,
    outputs=("figures/", "report.html"),
    settings=("title", "bodies", "amplitudes", "protocol", "fragility", "seed", "compare_with"),
)


def _measured_table(job: Job[MeasuredTable]) -> Results:
    """Yield the fitted tables; draw the figures and write the report."""
    from rockfrag.files import write_text
    from rockfrag.fragility.user_table import fit_user_table
    from rockfrag.report.figures.style import save_figure
    from rockfrag.report.measured_page import draw, result_tables, write_measured_page

    study = job.study
    found = fit_user_table(
        study.table,
        study.measures,
        overturned=study.overturned,
        motion=study.motion,
        event=study.event,
        given=study.given,
        level=study.confidence,
        replicates=study.replicates,
        seed=study.seed,
    )
    yield from result_tables(found).items()
    figures = job.folder / "figures"
    for name, figure in draw(study, found).items():
        save_figure(figure, *(figures / f"{name}.{ending}" for ending in ("svg", "png")))
    write_text(write_measured_page(study, found, figures), job.folder / "report.html")
    job.log.info("%s", found.choice.words)


MEASURED_TABLE = Stage(
    name="measured_table",
    run=_measured_table,
    files=lambda study: [str(study.table)],
    outputs=(*MEASURED_TABLES, "figures/", "report.html"),
    settings=("title", "seed", "table", "columns", "measures", "confidence", "replicates"),
)
