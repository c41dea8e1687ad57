"""Run the stage that a rule is named after."""

from rockfrag.guests import study_stages
from rockfrag.stages.running import run_stage
from rockfrag.study.loading import any_study

study = any_study(snakemake.config, snakemake.params.study)
run_stage(snakemake.rule, study_stages(study), study, snakemake.threads, snakemake.log[0])
