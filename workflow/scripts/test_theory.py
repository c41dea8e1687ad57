"""Test the thesis's statements about theory on the study's bodies and ground motions."""

from rockfrag.claims.ledger import ledger_table
from rockfrag.claims.theory import theory_claims
from rockfrag.files import write_table
from rockfrag.records.motion import read_motion_set
from rockfrag.studies.log import logged
from rockfrag.studies.study import study_from

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
