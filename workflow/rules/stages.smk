# A rule for each stage of the study: what it reads, writes and depends on the stage says itself.


for stage in STAGES:

    rule:
        name:
            stage.name
        input:
            [f"{RESULTS}/{path}" for path in stage.input_files(STUDY)],
            stage.user_files(STUDY),
        output:
            [flagged(path) for path in stage.output_files(STUDY)],
        log:
            f"{RESULTS}/logs/{stage.name}.log",
        priority: PRIORITIES[stage.name]
        localrule: stage.small
        conda:
            "../envs/rockfrag.yaml"
        # a cluster's profile says how many threads a job may have at most
        threads: stage.threads(workflow.resource_settings.cores or 64)
        resources:
            mem_mb=stage.memory_mb(STUDY),
            runtime=stage.minutes,
        params:
            study=STUDY_FILE,
            triggers=stage.triggers(config),
        script:
            "../scripts/run_stage.py"
