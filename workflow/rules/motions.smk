# Motions: records processed, felt by the floors of a building, and measured.


rule process_records:
    input:
        f"{RESULTS}/motions/records.parquet",
    output:
        f"{RESULTS}/motions/ground.parquet",
    log:
        f"{RESULTS}/logs/process_records.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("motions"),
        code=source_digest("motions"),
    script:
        "../scripts/process_records.py"


rule shake_building:
    input:
        motions=f"{RESULTS}/motions/ground.parquet",
        building=[] if STUDY.building is None else str(STUDY.building),
    output:
        f"{RESULTS}/motions/floors.parquet",
    log:
        f"{RESULTS}/logs/shake_building.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("building"),
        code=source_digest("building"),
    script:
        "../scripts/shake_building.py"


rule measure_motions:
    input:
        f"{RESULTS}/motions/floors.parquet",
    output:
        tables("measures"),
    log:
        f"{RESULTS}/logs/measure_motions.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        code=source_digest("motions"),
    script:
        "../scripts/measure_motions.py"
