# What could produce a pedestal effect: one factor at a time departs from the ideal model.


rule explain_pedestal:
    input:
        motions=f"{RESULTS}/motions/floors.parquet",
        specimens=str(STUDY.specimens_file),
        configurations=str(STUDY.configurations_file),
    output:
        tables("explanation/ratios", "explanation/effects"),
    log:
        f"{RESULTS}/logs/explain_pedestal.log",
    conda:
        "../envs/rockfrag.yaml"
    # one fat job
    threads: workflow.cores or 1
    params:
        study=STUDY_FILE,
        settings=settings("explanation", "bodies", "amplitudes", "protocol", "seed"),
        code=source_digest("pedestal"),
    script:
        "../scripts/explain_pedestal.py"


rule draw_explanation:
    input:
        f"{RESULTS}/explanation/effects.parquet",
    output:
        figures("explanation"),
    log:
        f"{RESULTS}/logs/draw_explanation.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        code=source_digest("report"),
    script:
        "../scripts/draw_explanation.py"
