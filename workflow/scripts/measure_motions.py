"""Measure the intensity of every motion that shakes a body."""

from rockfrag.files import write_table
from rockfrag.motions.measures import measure_motions
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged

with logged(snakemake.log[0], "measure") as log:
    table = measure_motions(read_motion_set(snakemake.input[0]))
    write_table(table, *snakemake.output)
    log.info("%d motions, %d measures", len(table), len(table.columns) - 3)
