"""Fit, compare and judge fragility curves on a measured table, and write the report."""

from pathlib import Path

from rockfrag.files import write_table, write_text
from rockfrag.fragility import fit_user_table
from rockfrag.report.figures.style import save_figure
from rockfrag.report.measured_page import draw, result_tables, write_measured_page
from rockfrag.stages.log import logged
from rockfrag.study.measured_table import measured_table_from

with logged(snakemake.log[0], "measured table") as log:
    study = measured_table_from(snakemake.config, snakemake.params.study)
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
    folder = Path(snakemake.output.report).parent
    for name, table in result_tables(found).items():
        write_table(table, folder / f"{name}.csv", folder / f"{name}.parquet")
    for name, figure in draw(study, found).items():
        paths = (folder / "figures" / f"{name}.{ending}" for ending in ("svg", "png"))
        save_figure(figure, *paths)
    page = write_measured_page(study, found, folder / "figures")
    write_text(page, snakemake.output.report)
    log.info("%s", found.choice.words)
    log.info("the report is %s", snakemake.output.report)
