# Every configuration under every motion at every amplitude: what all statistics start from.
SHAKING = read("motions/floors", *VERTICAL)
IDA_CURVES = [f"{RESULTS}/{path}" for path in STUDY.ida_files]
SWEPT_BY = settings(
    *("bodies", "amplitudes", "friction", "vertical"),
    files=STUDY.body_files,
)
LONG_JOB = 2_000_000  # response histories


if STUDY.ida_jobs == 1:

    rule ida:
        """Simulate all response histories, and those under the motions as strong as they were recorded."""
        input:
            SHAKING,
        output:
            ida_curves=IDA_CURVES,
            as_recorded=table("as_recorded"),
        log:
            f"{RESULTS}/logs/ida.log",
        priority: 8
        conda:
            "../envs/rockfrag.yaml"
        threads: CORES
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag.stages.ida:run",
            study=study_file,
            settings=SWEPT_BY,
        script:
            "../scripts/run_stage.py"

else:

    rule ida:
        """Simulate the response histories of a part of the motions; parts share the motions of a large study."""
        input:
            SHAKING,
        output:
            ida_curves=[
                f"{RESULTS}/{STUDY.ida_file(configuration)}"
                for configuration in STUDY.configurations
            ],
        log:
            f"{RESULTS}/logs/ida_{{part}}.log",
        wildcard_constraints:
            part=r"\d{3}",
        priority: 8
        conda:
            "../envs/rockfrag.yaml"
        # parts run side by side; only very long ones get all cores of a machine each
        threads: CORES if STUDY.histories > LONG_JOB * STUDY.ida_jobs else 1
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag.stages.ida:run_part",
            study=study_file,
            settings=SWEPT_BY,
        script:
            "../scripts/run_stage.py"

    rule as_recorded:
        """Simulate the responses to the motions as strong as they were recorded, and a little weaker and stronger."""
        input:
            SHAKING,
        output:
            as_recorded=table("as_recorded"),
        log:
            f"{RESULTS}/logs/as_recorded.log",
        conda:
            "../envs/rockfrag.yaml"
        threads: CORES
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag.stages.ida:run_as_recorded",
            study=study_file,
            settings=SWEPT_BY,
        script:
            "../scripts/run_stage.py"
