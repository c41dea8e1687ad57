# Snakemake runs without rockfrag beside it: the whole study is one job in an environment that has it.
RESULTS = f"results/{config['study']}"


rule study:
    """Run the whole study in an environment with rockfrag."""
    output:
        f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/study.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: workflow.cores or 1
    params:
        snakefile=workflow.main_snakefile,
        # a function, for the path may hold what Snakemake takes for a wildcard
        configfile=lambda wildcards: (workflow.configfiles or ["config/config.yaml"])[
            -1
        ],
        missing="rockfrag is not installed beside Snakemake: install it there (make run does), or let Snakemake"
        " make an environment with --software-deployment-method conda.",
    shell:
        "python -c 'import rockfrag' 2> {log} || {{ echo '{params.missing}' >&2; exit 1; }}; "
        # the outer run holds the lock of this folder
        "python -m snakemake --nolock --cores {threads} --snakefile {params.snakefile:q}"
        " --configfile {params.configfile:q} 2> {log}"
