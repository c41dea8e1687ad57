"""Draw the figures of a study."""

from pathlib import Path

import pandas as pd

from rockfrag.records.motion import read_motion_set
from rockfrag.report.figure_list import Results, plates
from rockfrag.report.figures.style import save_figure
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "figures") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    sweeps = [pd.read_parquet(path) for path in snakemake.input.sweeps]
    effects = snakemake.input.get("effects")
    results = Results(
        study=study,
        ground=read_motion_set(snakemake.input.ground),
        sweep=pd.concat(sweeps, ignore_index=True),
        tests=pd.read_parquet(snakemake.input.tests),
        effects=pd.read_parquet(effects) if effects else None,
    )
    for plate in plates(study):
        wanted = [path for path in snakemake.output if Path(path).stem == plate.name]
        save_figure(plate.draw(results), *wanted)
        log.info("%s", plate.name)
