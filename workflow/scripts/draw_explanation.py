"""Draw the ratio P/NP at every level of every factor."""

import pandas as pd

from rockfrag.report.figures.style import save_figure
from rockfrag.report.sections.explanation import explanation_figure
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "explanation figure") as log:
    save_figure(explanation_figure(pd.read_parquet(snakemake.input[0])), *snakemake.output)
    log.info("explanation")
