"""Write the report."""

from pathlib import Path

import pandas as pd

from rockfrag.files import write_text
from rockfrag.report.figure_list import pictures
from rockfrag.report.provenance import provenance
from rockfrag.report.study_report import write_page
from rockfrag.report.supplements import supplement_pictures
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "report") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    folder = Path(snakemake.output[0]).parent
    tables = {
        Path(path).relative_to(folder).with_suffix("").as_posix(): pd.read_parquet(path)
        for path in snakemake.input.tables
    }
    drawings = Path(snakemake.input.figures[0]).parent
    drawn = {**pictures(study, drawings), **supplement_pictures(study, drawings)}
    write_text(write_page(study, tables, drawn, provenance(study, tables)), snakemake.output[0])
    log.info("the report is %s", snakemake.output[0])
