"""Fit lognormal fragility curves for every configuration and intensity measure."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.fragility.empirical import survival_windows
from rockfrag.fragility.sweeps import fragility_table, record_set_hash, with_measures
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "fragility") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    columns = list(study.fragility.measures)
    parts = [pd.read_parquet(path) for path in snakemake.input.sweeps]
    measures = pd.read_parquet(snakemake.input.measures)
    sweep = with_measures(pd.concat(parts, ignore_index=True), measures, columns)
    records = record_set_hash(read_motion_set(snakemake.input.motions))
    curves = fragility_table(sweep, columns, record_set=records, level=study.fragility.confidence)
    write_table(curves, *snakemake.output[:2])
    windows = survival_windows(sweep, by=["configuration", "event", "floor", "motion"])
    write_table(windows, *snakemake.output[2:])
    log.info("%d curves", len(curves))
