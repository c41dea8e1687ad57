"""Take every record through the study's processing steps."""

from rockfrag.motions import process
from rockfrag.records.motion import read_motion_set, write_motion_set
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "process") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    motions = [process(one, study.processing) for one in read_motion_set(snakemake.input[0])]
    write_motion_set(motions, snakemake.output[0])
    steps = ", ".join(step["step"] for step in study.processing) or "none, as stored"
    log.info("%d records, steps: %s", len(motions), steps)
