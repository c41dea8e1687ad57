"""Draw what the building's assumptions do to the order of the floors and to the statements."""

from pathlib import Path

import pandas as pd

from rockfrag.report.figures.building import floor_order, floor_statements
from rockfrag.report.figures.style import save_figure
from rockfrag.report.supplements import ORDER_FIGURE, STATEMENTS_FIGURE, sensitivity_figures
from rockfrag.shaketable.readings import READING, READINGS
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "sensitivity figures") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    tests = pd.read_parquet(snakemake.input.tests)
    margins = pd.read_parquet(snakemake.input.margins)
    for name in sensitivity_figures(study):
        if name == ORDER_FIGURE:
            figure = floor_order(tests, margins, READINGS)
        else:
            figure = floor_statements(margins, name.removeprefix(STATEMENTS_FIGURE), READING)
        save_figure(figure, *[path for path in snakemake.output if Path(path).stem == name])
        log.info("%s", name)
