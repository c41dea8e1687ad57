# Bodies in space under both components of records, beside planar ones.


rule space:
    """Shake every body in space and in the plane, and compare the medians of overturning."""
    output:
        table("medians", "fractions"),
        motions=read("motions/ground"),
    log:
        f"{RESULTS}/logs/space.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: CORES
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.stages.space_study:run",
        study=study_file,
        settings=settings("seed", "space", files=STUDY.files),
    script:
        "../scripts/run_stage.py"


rule space_report:
    """Draw the figures and write the page."""
    input:
        read("medians", "fractions", "motions/ground"),
    output:
        figures=report(directory(f"{RESULTS}/figures"), patterns=["{figure}.svg"]),
        page=report(f"{RESULTS}/report.html", category="Report"),
    log:
        f"{RESULTS}/logs/space_report.log",
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.report.space_page:run",
        study=study_file,
        settings=settings("title"),
    script:
        "../scripts/run_stage.py"
