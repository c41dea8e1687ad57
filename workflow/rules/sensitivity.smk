# The building as an axis: one of its assumptions changed at a time.


rule vary_building:
    input:
        motions=f"{RESULTS}/motions/ground.parquet",
        building=str(STUDY.building or []),
        specimens=str(STUDY.specimens_file),
        configurations=str(STUDY.configurations_file),
    output:
        tables("building_sensitivity/tests", "building_sensitivity/margins"),
    log:
        f"{RESULTS}/logs/vary_building.log",
    conda:
        "../envs/rockfrag.yaml"
    # one fat job: the motions of the ground are swept once for all buildings
    threads: workflow.cores or 1
    params:
        study=STUDY_FILE,
        settings=settings("building_sensitivity", "bodies", "amplitudes", "protocol"),
        code=source_digest("shaketable"),
    script:
        "../scripts/vary_building.py"


rule draw_sensitivity:
    input:
        tests=f"{RESULTS}/building_sensitivity/tests.parquet",
        margins=f"{RESULTS}/building_sensitivity/margins.parquet",
    output:
        figures(*sensitivity_figures(STUDY)),
    log:
        f"{RESULTS}/logs/draw_sensitivity.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        code=source_digest("report"),
    script:
        "../scripts/draw_sensitivity.py"
