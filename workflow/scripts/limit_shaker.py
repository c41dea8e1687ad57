"""Say up to which amplitude each motion fits the shaker."""

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.stages.shaker import limits_table
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "shaker") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    table = limits_table(study, read_motion_set(snakemake.input.motions))
    write_table(table, *snakemake.output)
    log.info("%d motions, the least limit is %.2f g", len(table), table["limit_g"].min())
