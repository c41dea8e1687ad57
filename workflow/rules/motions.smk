# Motions of the ground and of the floors of a building, out of records.
VERTICAL = ["motions/vertical"] if STUDY.vertical else []


rule fetch_records:
    """Fetch the records of a pinned package into a folder that all studies share."""
    output:
        "resources/records/{source}/provenance.json",
    log:
        "resources/logs/fetch_{source}.log",
    wildcard_constraints:
        source="[a-z0-9-]+",
    retries: 2
    conda:
        "../envs/rockfrag.yaml"
    script:
        "../scripts/fetch_records.py"


rule motions:
    """Read and process the records, let the building respond, and measure the motion of every floor."""
    input:
        STUDY.fetched_records("resources/records"),
    output:
        motions=read("motions/records", "motions/ground", "motions/floors", *VERTICAL),
        measures=table("measures", "scaling", "left_out"),
        written=(
            [directory(f"{RESULTS}/motions/written")] if STUDY.write_motions else []
        ),
    log:
        f"{RESULTS}/logs/motions.log",
    priority: 10
    conda:
        "../envs/rockfrag.yaml"
    threads: CORES
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.stages.motions:run",
        study=study_file,
        settings=settings(
            *(
                "motions",
                "building",
                "write_motions",
                "keep_going",
                "vertical",
                "amplitudes",
            ),
            files=STUDY.motion_files,
        ),
    script:
        "../scripts/run_stage.py"
