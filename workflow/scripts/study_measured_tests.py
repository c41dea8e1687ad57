"""Take a laboratory's tests through the statistics of the simulated ones."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.shaketable.laboratory_table import read_measured
from rockfrag.shaketable.readings import READING
from rockfrag.stages.log import logged
from rockfrag.stages.measured_tests import measured_tables
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "measured tests") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    simulated = pd.read_parquet(snakemake.input.simulated)
    found = measured_tables(
        read_measured(snakemake.input.measured),
        simulated[simulated["reading"] == READING],
        pd.read_parquet(snakemake.input.measures),
        study.tested_blocks,
        study.seed,
        study.fragility.confidence,
    )
    for number, table in enumerate(found.values()):
        write_table(table, *snakemake.output[2 * number : 2 * number + 2])
    log.info("%d measured tests", len(found["measured/tests"]))
