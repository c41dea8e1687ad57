"""Draw measured tests beside simulated ones."""

import pandas as pd

from rockfrag.report.figures.style import save_figure
from rockfrag.report.sections.measured import measured_beside
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "measured figure") as log:
    save_figure(measured_beside(pd.read_parquet(snakemake.input[0])), *snakemake.output)
    log.info("measured_beside")
