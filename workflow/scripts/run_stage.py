"""Run the stage that a rule is named after."""

import sys

from rockfrag.stages.loaded import run_in_copy

job = {
    "name": snakemake.rule,
    "config": snakemake.config,
    "study_file": snakemake.params.study,
    "threads": snakemake.threads,
    "log_file": snakemake.log[0],
}
status = run_in_copy(job)
if status is None:
    from rockfrag.guests import run_job

    run_job(**job)
sys.exit(status)
