"""Test the thesis's statements about theory on the study's bodies and ground motions."""

from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from
from rockfrag.thesis.statements.ledger import ledger_table
from rockfrag.thesis.statements.theory import theory_claims

with logged(snakemake.log[0], "theory") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    claims = theory_claims(
        {**study.tested_blocks, **study.stacks},
        read_motion_set(snakemake.input.motions),
        seed=study.seed,
        threads=snakemake.threads,
    )
    write_table(ledger_table(claims), *snakemake.output)
    log.info("%d statements", len(claims))
