# Fragility from a table of shake-table tests, without a simulation.


rule measured_table:
    """Fit fragility curves in every intensity measure, compare the measures, and write the page."""
    output:
        table("tests", "fragility", "recommendation", "bins", "goodness"),
        figures=report(directory(f"{RESULTS}/figures"), patterns=["{figure}.svg"]),
        page=report(f"{RESULTS}/report.html", category="Report"),
    log:
        f"{RESULTS}/logs/measured_table.log",
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.report.measured_page:run",
        study=study_file,
        settings=settings(
            *("title", "seed", "table", "columns", "measures"),
            *("confidence", "replicates"),
            files=[STUDY.table],
        ),
    script:
        "../scripts/run_stage.py"
