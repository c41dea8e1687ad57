"""Estimate the effect of the pedestal from each reading of the tests."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.stages.log import logged
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "pedestal") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    slenderness = {name: block.slenderness for name, block in study.specimens.items()}
    found = pedestal_tables(pd.read_parquet(snakemake.input[0]), study.seed, slenderness)
    for number, table in enumerate(found.values()):
        write_table(table, *snakemake.output[2 * number : 2 * number + 2])
    log.info("%d pairs", len(found["pairs"]))
