"""Recommend an intensity measure for every configuration, and export curves."""

from pathlib import Path

import pandas as pd

from rockfrag.files import write_table
from rockfrag.fragility.sweeps import record_set_hash
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.stages.measure_choice import export_curves, ground_curves, measure_choice
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "measures") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    level = study.fragility.confidence
    parts = [pd.read_parquet(path) for path in snakemake.input.sweeps]
    sweep = pd.concat(parts, ignore_index=True)
    measures = pd.read_parquet(snakemake.input.measures)
    choice = measure_choice(sweep, measures, level, study.seed)
    write_table(choice, *snakemake.output[:2])
    motions = read_motion_set(snakemake.input.motions)
    curves = ground_curves(sweep, measures, record_set_hash(motions), level)
    write_table(curves, *snakemake.output[2:4])
    folder = Path(snakemake.output.exports)
    folder.mkdir(parents=True, exist_ok=True)
    log.info("exported %s", ", ".join(export_curves(curves, folder)) or "no curve")
