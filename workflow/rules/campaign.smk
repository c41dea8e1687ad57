# A campaign on a shake table: every test simulated with the table's own motion, and compared.
TABLES = (
    *("tests", "trials", "agreement", "rocking", "fragility"),
    *("regions", "conditioning", "contact", "footprint"),
    *("two_measures", "contours", "cells"),
)


rule campaign:
    """Simulate every test with many guesses of what was not measured, and compare the outcomes."""
    output:
        table(*TABLES),
    log:
        f"{RESULTS}/logs/campaign.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: CORES
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.stages.campaign:run",
        study=study_file,
        settings=settings(
            *("seed", "fetch", "campaign", "object", "conditioning"),
            *("varied_conditioning", "unknowns", "trials", "folds", "repeats"),
            "confidence",
            files=STUDY.files,
        ),
    script:
        "../scripts/run_stage.py"


rule campaign_report:
    """Draw the figures and write the page."""
    input:
        read(*TABLES),
    output:
        figures=report(directory(f"{RESULTS}/figures"), patterns=["{figure}.svg"]),
        page=report(f"{RESULTS}/report.html", category="Report"),
    log:
        f"{RESULTS}/logs/campaign_report.log",
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.report.campaign_page:run",
        study=study_file,
        settings=settings("title", "conditioning", "confidence"),
    script:
        "../scripts/run_stage.py"
