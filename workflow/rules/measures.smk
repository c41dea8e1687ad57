# Intensity measures: which one foretells overturning, and curves in them for other programs.


rule choose_measures:
    input:
        sweeps=expand(
            f"{RESULTS}/sweep/{{configuration}}.parquet", configuration=CONFIGURATIONS
        ),
        measures=f"{RESULTS}/measures.parquet",
        motions=f"{RESULTS}/motions/floors.parquet",
    output:
        tables("measure_choice", "fragility_ground"),
        exports=directory(f"{RESULTS}/exports"),
    log:
        f"{RESULTS}/logs/choose_measures.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("fragility", "seed"),
        code=source_digest("fragility"),
    script:
        "../scripts/choose_measures.py"
