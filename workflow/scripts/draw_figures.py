"""Draw the figures of a study."""

from pathlib import Path

import pandas as pd

from rockfrag.records.motion import read_motion_set
from rockfrag.report.gallery import draw_all
from rockfrag.report.style import save_figure
from rockfrag.studies import study_from
from rockfrag.studies.log import logged

with logged(snakemake.log[0], "figures") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    sweeps = [pd.read_parquet(path) for path in snakemake.input.sweeps]
    figures = draw_all(
        study,
        ground=read_motion_set(snakemake.input.ground),
        sweep=pd.concat(sweeps, ignore_index=True),
        tests=pd.read_parquet(snakemake.input.tests),
        fragility=pd.read_parquet(snakemake.input.fragility),
    )
    for name, figure in figures.items():
        wanted = [path for path in snakemake.output if Path(path).stem == name]
        save_figure(figure, *wanted)
    log.info("%d figures", len(figures))
