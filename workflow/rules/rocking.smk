# Rocking: every configuration under every motion at every amplitude, then read as a laboratory would.


rule sweep_amplitudes:
    input:
        motions=f"{RESULTS}/motions/floors.parquet",
        specimens=str(STUDY.specimens_file),
        configurations=str(STUDY.configurations_file),
    output:
        tables("sweep/{configuration}"),
    log:
        f"{RESULTS}/logs/sweep_{{configuration}}.log",
    conda:
        "../envs/rockfrag.yaml"
    threads: 1
    params:
        study=STUDY_FILE,
        settings=settings("bodies", "amplitudes"),
        code=source_digest("rocking"),
    script:
        "../scripts/sweep_amplitudes.py"


rule apply_protocol:
    input:
        sweeps=expand(
            f"{RESULTS}/sweep/{{configuration}}.parquet", configuration=CONFIGURATIONS
        ),
        limits=[] if STUDY.more.shaker is None else f"{RESULTS}/shaker.parquet",
    output:
        tables("tests"),
    log:
        f"{RESULTS}/logs/apply_protocol.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=settings("amplitudes", "protocol"),
        code=source_digest("shaketable"),
    script:
        "../scripts/apply_protocol.py"
