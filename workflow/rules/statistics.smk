# Statistics: fragility curves, the pedestal's effect, and the thesis's statements.


rule fit_fragility:
    input:
        sweeps=expand(
            f"{RESULTS}/sweep/{{configuration}}.parquet", configuration=CONFIGURATIONS
        ),
        measures=f"{RESULTS}/measures.parquet",
        motions=f"{RESULTS}/motions/floors.parquet",
    output:
        tables("fragility", "survival_windows"),
    log:
        f"{RESULTS}/logs/fit_fragility.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("fragility"),
        code=source_digest("fragility"),
    script:
        "../scripts/fit_fragility.py"


rule estimate_pedestal:
    input:
        f"{RESULTS}/tests.parquet",
    output:
        tables(*[f"pedestal/{name}" for name in PEDESTAL_TABLES]),
    log:
        f"{RESULTS}/logs/estimate_pedestal.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "seed"),
        code=source_digest("pedestal"),
    script:
        "../scripts/estimate_pedestal.py"


rule check_validity:
    input:
        tests=f"{RESULTS}/tests.parquet",
        motions=f"{RESULTS}/motions/floors.parquet",
    output:
        tables("validity"),
    log:
        f"{RESULTS}/logs/check_validity.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies"),
        code=source_digest("rocking"),
    script:
        "../scripts/check_validity.py"


rule test_theory:
    input:
        motions=f"{RESULTS}/motions/ground.parquet",
        specimens=str(STUDY.specimens_file),
        configurations=str(STUDY.configurations_file),
    output:
        tables("claims_theory"),
    log:
        f"{RESULTS}/logs/test_theory.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "seed"),
        code=source_digest("thesis"),
    script:
        "../scripts/test_theory.py"


rule test_claims:
    input:
        theory=f"{RESULTS}/claims_theory.parquet",
        tests=f"{RESULTS}/tests.parquet",
        validity=f"{RESULTS}/validity.parquet",
        measures=f"{RESULTS}/measures.parquet",
    output:
        tables("claims", "contradictions"),
    log:
        f"{RESULTS}/logs/test_claims.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "seed"),
        code=source_digest("thesis"),
    script:
        "../scripts/test_claims.py"
