# What only a study asks for that has a key of the thesis: compare_with, building_sensitivity, sensitivity_analysis.
from rockfrag_thesis.settings import settings_of

ASKED = settings_of(STUDY)
MEASURED = ["measured"] if STUDY.measured_tests else []
BUILDINGS = ["building_sensitivity"] if ASKED.sensitivity else []


if ASKED.sensitivity:

    rule building_sensitivity:
        """Repeat the tests on the floors of other buildings, one assumption changed at a time."""
        input:
            read("motions/ground"),
        output:
            table("building_sensitivity/tests", "building_sensitivity/means"),
        log:
            f"{RESULTS}/logs/building_sensitivity.log",
        conda:
            ENVIRONMENT
        threads: CORES
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag_thesis.building_sensitivity:run",
            study=study_file,
            settings=settings(
                *("building_sensitivity", "building", "bodies", "amplitudes"),
                *("protocol", "friction"),
                files=[*STUDY.body_files, STUDY.building_file],
            ),
        script:
            RUN_STAGE

    ADDED.append(rules.building_sensitivity.output)


if ASKED.sensitivity_analysis:

    rule sensitivity_analysis:
        """Simulate what could produce an effect of the pedestal, one perturbed parameter of the ideal model at a time."""
        input:
            read("motions/floors"),
        output:
            table("sensitivity_analysis/ratios", "sensitivity_analysis/effects"),
            friction=(
                table(
                    "sensitivity_analysis/friction_ratios",
                    "sensitivity_analysis/friction",
                )
                if ASKED.friction
                else []
            ),
            inverse_problem=(
                table("sensitivity_analysis/inverse_problem")
                if ASKED.wanted_percent
                else []
            ),
        log:
            f"{RESULTS}/logs/sensitivity_analysis.log",
        priority: 3
        conda:
            ENVIRONMENT
        # half of the cores, so that tests and fragility need not wait for it
        threads: max(1, CORES // 2)
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag_thesis.stages.sensitivity_analysis:run",
            study=study_file,
            settings=settings(
                *("sensitivity_analysis", "bodies", "amplitudes", "protocol", "seed"),
                files=STUDY.body_files,
            ),
        script:
            RUN_STAGE

    ADDED.append(rules.sensitivity_analysis.output)


if ASKED.compares:

    rule thesis:
        """Set the printed tables beside computed ones, and judge every hypothesis."""
        input:
            read("motions/ground", "motions/floors", "tests", "validity", "measures"),
            read(*[f"{folder}/tests" for folder in MEASURED + BUILDINGS]),
        output:
            table(
                "table_3_1", "table_3_3", "table_4_1", "hypotheses_theory", "standing"
            ),
            pairs=table("hypotheses", "contradictions") if STUDY.has_pairs else [],
            measured=table(*[f"{folder}/hypotheses" for folder in MEASURED]),
            buildings=table(*[f"{folder}/margins" for folder in BUILDINGS]),
        log:
            f"{RESULTS}/logs/thesis.log",
        priority: 2
        conda:
            ENVIRONMENT
        resources:
            mem_mb=MEMORY_MB,
            runtime=120,
        params:
            stage="rockfrag_thesis.stages.hypotheses:run",
            study=study_file,
            settings=settings(
                *("bodies", "seed", "amplitudes", "protocol"),
                *("measured_tests", "building_sensitivity"),
                files=STUDY.body_files,
            ),
        script:
            RUN_STAGE

    ADDED.append(rules.thesis.output)
