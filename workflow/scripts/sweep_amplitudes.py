"""Shake one configuration by every motion at every amplitude."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.stages.sweep import sweep
from rockfrag.study.study import study_from

BATCH = 12

with logged(snakemake.log[0], snakemake.wildcards.configuration) as log:
    study = study_from(snakemake.config, snakemake.params.study)
    configuration = study.configuration(snakemake.wildcards.configuration)
    motions = read_motion_set(snakemake.input.motions)
    parts = []
    for first in range(0, len(motions), BATCH):
        batch = motions[first : first + BATCH]
        parts.append(sweep(configuration, batch, study.amplitudes, snakemake.threads))
        histories = sum(map(len, parts))
        log.info("%d of %d motions, %d histories", first + len(batch), len(motions), histories)
    write_table(pd.concat(parts, ignore_index=True), *snakemake.output)
