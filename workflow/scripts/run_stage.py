"""Run the stage of a rule: the function that its parameter ``stage`` names."""

from rockfrag.stages.running import run_job

run_job(
    snakemake.params.stage,
    snakemake.config,
    snakemake.params.study,
    inputs=snakemake.input,
    outputs=snakemake.output,
    part=int(snakemake.wildcards.get("part", 0)),
    threads=snakemake.threads,
    log_file=snakemake.log[0],
)
