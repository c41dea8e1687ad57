# The report: everything that the study computed on one page.


rule report:
    """Draw the figures and write the page."""
    input:
        rules.motions.output,
        IDA_CURVES,
        table("as_recorded"),
        rules.tests.output,
        rules.fragility.output,
        rules.pedestal.output if STUDY.has_pairs else [],
        rules.measured_tests.output if STUDY.measured_tests else [],
        ADDED,
    output:
        figures=report(
            directory(f"{RESULTS}/figures"),
            patterns=["{figure}.svg"],
            category="Figures",
            subcategory=lambda wildcards: captions(wildcards.figure)["chapter"],
            labels=lambda wildcards: {"shows": captions(wildcards.figure)["caption"]},
            caption="../report/figure.rst",
        ),
        page=report(
            f"{RESULTS}/report.html",
            category="Report",
            labels={
                "shows": "The answer, and all chapters with their figures and tables"
            },
            caption="../report/report.rst",
        ),
    log:
        f"{RESULTS}/logs/report.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: CORES
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.report.study_report:run",
        study=study_file,
        settings=settings(
            *("title", "bodies", "amplitudes", "protocol", "fragility", "seed"),
            *("friction", "vertical"),
            *(key for plugin in PLUGINS for key in plugin.schema),
            files=STUDY.body_files,
        ),
    script:
        "../scripts/run_stage.py"
