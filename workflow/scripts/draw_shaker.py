"""Draw the shaker's limits beside what lone objects need."""

import pandas as pd

from rockfrag.report.figures.building import shaker_limits
from rockfrag.report.figures.style import save_figure
from rockfrag.shaketable.readings import READING
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "shaker figure") as log:
    limits = pd.read_parquet(snakemake.input.limits)
    tests = pd.read_parquet(snakemake.input.tests)
    lone = tests[(tests["reading"] == READING) & (tests["pedestal"] == "NP")]
    save_figure(shaker_limits(limits, lone), *snakemake.output)
    log.info("shaker_limits")
