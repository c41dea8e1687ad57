"""Simulate P/NP where one factor at a time departs from the ideal model."""

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.explanation import explanation_tables
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "explanation") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    motions = read_motion_set(snakemake.input.motions)
    ratios, effects = explanation_tables(
        study,
        motions,
        snakemake.threads,
        lambda done, of: log.info("%d of at most %d bodies", done, of),
    )
    write_table(ratios, *snakemake.output[:2])
    write_table(effects, *snakemake.output[2:])
    log.info("%d ratios", len(ratios))
