"""Look at the contact forces of every test: was the model allowed to be used?"""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.shaketable.readings import READING
from rockfrag.stages.log import logged
from rockfrag.stages.validity import validity_table
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "validity") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    tests = pd.read_parquet(snakemake.input.tests)
    motions = {one.name: one for one in read_motion_set(snakemake.input.motions)}
    table = validity_table(tests[tests["reading"] == READING], study.configurations, motions)
    write_table(table, *snakemake.output)
    jumps = (table["least_normal_force_n"] <= 0).sum()
    friction = table["friction_demand"]
    log.info("%d tests, %d with a jump, friction up to %.2f", len(table), jumps, friction.max())
