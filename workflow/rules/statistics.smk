# What the response histories say: tests as a laboratory makes them, fragility, the effect of a pedestal.


rule tests:
    """Read the IDA curves as a laboratory would, within the limits of its shaker, and look at the contact forces."""
    input:
        SHAKING,
        IDA_CURVES,
    output:
        table("tests", "mean_amplitudes", "bodies", "validity"),
        sliding=table("sliding") if STUDY.slides else [],
        shaker=table("shaker") if STUDY.shaker_file else [],
    log:
        f"{RESULTS}/logs/tests.log",
    priority: 6
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.stages.tests:run",
        study=study_file,
        settings=settings(
            *("bodies", "amplitudes", "protocol", "shaker", "friction", "vertical"),
            files=[*STUDY.body_files, STUDY.shaker_file],
        ),
    script:
        "../scripts/run_stage.py"


rule fragility:
    """Fit fragility curves, compare intensity measures, and write curves for OpenQuake and SimCenter."""
    input:
        read("measures", "motions/records"),
        IDA_CURVES,
    output:
        table("fragility", "fragility_bands", "fragility_bins", "fragility_fractions"),
        table("fragility_floors", "fragility_floors_fractions"),
        table("resurrections", "measure_selection"),
        table("fragility_two_measures", "fragility_contours", "fragility_cells"),
        exports=directory(f"{RESULTS}/exports"),
    log:
        f"{RESULTS}/logs/fragility.log",
    priority: 4
    conda:
        "../envs/rockfrag.yaml"
    resources:
        mem_mb=MEMORY_MB,
        runtime=120,
    params:
        stage="rockfrag.stages.fragility:run",
        study=study_file,
        settings=settings(
            "fragility", "seed", "bodies", "building", "friction", "vertical"
        ),
    script:
        "../scripts/run_stage.py"


rule pedestal:
    """Estimate the effect of a pedestal from pairs of tests with and without it."""
    input:
        read("tests"),
    output:
        table("pedestal/pairs", "pedestal/effects", "pedestal/whole"),
        table("pedestal/without_earthquake", "pedestal/ranks", "pedestal/notes"),
    log:
        f"{RESULTS}/logs/pedestal.log",
    # seconds, less than a cluster takes to start it
    localrule: True
    conda:
        "../envs/rockfrag.yaml"
    params:
        stage="rockfrag.stages.pedestal:run",
        study=study_file,
        settings=settings("bodies", "seed", files=STUDY.body_files),
    script:
        "../scripts/run_stage.py"


rule measured_tests:
    """Put the tests of a laboratory through the same statistics, and beside the simulated ones."""
    input:
        read("tests"),
    output:
        table("measured/tests", "measured/beside", "measured/notes"),
        table("measured/fragility", "measured/effects"),
    log:
        f"{RESULTS}/logs/measured_tests.log",
    localrule: True
    conda:
        "../envs/rockfrag.yaml"
    params:
        stage="rockfrag.stages.pedestal:run_measured",
        study=study_file,
        settings=settings(
            *("measured_tests", "fragility", "seed", "bodies"),
            files=[*STUDY.body_files, STUDY.measured_tests],
        ),
    script:
        "../scripts/run_stage.py"
