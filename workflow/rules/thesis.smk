# What only a study asks for that is compared with the thesis (key `compare_with`).
MEASURED = ["measured"] if STUDY.more.measured_tests else []
BUILDINGS = ["building_sensitivity"] if STUDY.more.sensitivity else []


rule thesis:
    """Set the printed tables beside computed ones, and judge every statement."""
    input:
        read("motions/ground", "motions/floors", "tests", "validity", "measures"),
        read(*[f"{folder}/tests" for folder in MEASURED + BUILDINGS]),
        bodies=STUDY.body_files,
    output:
        table("table_3_1", "table_3_3", "table_4_1", "claims_theory", "standing"),
        pairs=table("claims", "contradictions") if STUDY.has_pairs else [],
        measured=table(*[f"{folder}/claims" for folder in MEASURED]),
        buildings=table(*[f"{folder}/margins" for folder in BUILDINGS]),
    log:
        f"{RESULTS}/logs/thesis.log",
    priority: 2
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.thesis.stages:run",
        study=STUDY_FILE,
        settings=settings(
            *("bodies", "seed", "amplitudes", "protocol"),
            *("measured_tests", "building_sensitivity"),
        ),
    script:
        "../scripts/run_stage.py"
