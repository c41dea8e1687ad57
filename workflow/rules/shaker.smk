# The shaking table: what every motion asks of it, and up to which amplitude it fits.


rule limit_shaker:
    input:
        motions=f"{RESULTS}/motions/floors.parquet",
        shaker=str(STUDY.more.shaker or []),
    output:
        tables("shaker"),
    log:
        f"{RESULTS}/logs/limit_shaker.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("shaker", "bodies"),
        code=source_digest("shaketable"),
    script:
        "../scripts/limit_shaker.py"


rule draw_shaker:
    input:
        limits=f"{RESULTS}/shaker.parquet",
        tests=f"{RESULTS}/tests.parquet",
    output:
        figures("shaker_limits"),
    log:
        f"{RESULTS}/logs/draw_shaker.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        code=source_digest("report"),
    script:
        "../scripts/draw_shaker.py"
