# Snakemake runs without the package beside it: the whole study is one job in an environment that has it.
RESULTS = f"results/{config['study']}"


rule study:
    output:
        f"{RESULTS}/report.html",
    log:
        f"{RESULTS}/logs/study.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: workflow.cores or 1
    params:
        snakefile=workflow.main_snakefile,
        configfile=workflow.configfiles[-1],
        missing="The package rockfrag is not installed here: run `make run`, or let Snakemake make an"
        " environment with `snakemake --software-deployment-method conda`.",
    shell:
        "python -c 'import rockfrag' 2> {log} || {{ echo '{params.missing}' >&2; exit 1; }}; "
        # the outer run holds the lock of this folder
        "python -m snakemake --nolock --cores {threads} --snakefile {params.snakefile:q}"
        " --configfile {params.configfile:q} 2> {log}"
