# A laboratory's tests, through the statistics of the simulated ones.


rule study_measured_tests:
    input:
        measured=str(STUDY.more.measured_tests or []),
        simulated=f"{RESULTS}/tests.parquet",
        measures=f"{RESULTS}/measures.parquet",
    output:
        tables(*MEASURED_TABLES),
    log:
        f"{RESULTS}/logs/study_measured_tests.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("measured_tests", "fragility", "seed", "bodies"),
        code=source_digest("thesis"),
    script:
        "../scripts/study_measured_tests.py"


rule draw_measured_tests:
    input:
        f"{RESULTS}/measured/beside.parquet",
    output:
        figures("measured_beside"),
    log:
        f"{RESULTS}/logs/draw_measured_tests.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        code=source_digest("report"),
    script:
        "../scripts/draw_measured_tests.py"
