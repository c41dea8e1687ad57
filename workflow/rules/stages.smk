# A rule for each stage of the study: what it reads, writes and depends on the stage says itself.


def flagged(path):
    """An output as Snakemake wants it: folders marked, figures and the page put into its report."""
    if path == "figures/":
        return report(
            directory(f"{RESULTS}/figures"),
            patterns=["{figure}.svg"],
            category="Figures",
            caption="../report/figure.rst",
        )
    if path == "report.html":
        return report(
            f"{RESULTS}/report.html",
            category="Report",
            caption="../report/report.rst",
        )
    if path.endswith("/"):
        return directory(f"{RESULTS}/{path.rstrip('/')}")
    return f"{RESULTS}/{path}"


for stage in STAGES:

    rule:
        name:
            stage.name
        input:
            [f"{RESULTS}/{path}" for path in stage.input_files(STUDY)],
            stage.user_files(STUDY),
        output:
            [flagged(path) for path in stage.output_files(STUDY)],
        log:
            f"{RESULTS}/logs/{stage.name}.log",
        conda:
            "../envs/rockfrag.yaml"
        threads: (workflow.cores or 1) if stage.parallel else 1
        params:
            study=STUDY_FILE,
            triggers=stage.triggers(config),
        script:
            "../scripts/run_stage.py"
