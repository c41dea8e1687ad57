"""Read the records of a study, whatever their formats, into one file."""

from pathlib import Path

from rockfrag.records.catalogue import load_motion
from rockfrag.records.motion import write_motion_set
from rockfrag.stages.log import logged
from rockfrag.study.study import RECORDS_FOLDER, study_from

with logged(snakemake.log[0], "read") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    folder = study.catalogue_file.parent
    rows = study.catalogue.to_dict("records")
    motions = [load_motion(row, folder, Path(RECORDS_FOLDER)) for row in rows]
    write_motion_set(motions, snakemake.output[0])
    log.info("%d records", len(motions))
