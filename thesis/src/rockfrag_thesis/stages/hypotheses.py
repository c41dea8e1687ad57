"""What a study does beyond its own when it is compared with the thesis: one stage."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study
from rockfrag_thesis.settings import settings_of, stacks_of, tested_blocks

TABLES = ("table_3_1", "table_3_3", "table_4_1")


def run(job: Job[Study]) -> Results:
    """Yield printed tables beside computed ones, hypotheses with outcomes, contradictions."""
    yield from _printed_tables(job)
    yield from _hypotheses(job)
    yield "standing", _standing(job)
    if job.study.measured_tests is not None:
        yield "measured/hypotheses", _measured_hypotheses(job)
    if settings_of(job.study).sensitivity is not None:
        from rockfrag_thesis.floor_order import margins_table

        tests = job.table("building_sensitivity/tests")
        margins = margins_table(tests, tested_blocks(job.study))
        yield "building_sensitivity/margins", margins


def _printed_tables(job: Job[Study]) -> Results:
    """Yield the printed tables beside what the study has in their place."""
    from rockfrag_thesis import printed_tables as printed

    study, motions = job.study, job.motions("motions/ground")
    things: tuple[tuple[Mapping[str, Any], Any], ...] = (
        (study.specimens, printed.TABLE_3_1),
        ({motion.name: motion for motion in motions}, printed.TABLE_3_3),
        ({system.name: system for system in study.configurations}, printed.TABLE_4_1),
    )
    for name, (named, quantities) in zip(TABLES, things, strict=True):
        beside = printed.compare(named, quantities, printed.FOLDER / f"{name}.csv")
        yield name, beside
        known = beside["agrees"].dropna()
        job.log.info("%s: %d of %d printed values agree", name, known.sum(), len(known))


def _hypotheses(job: Job[Study]) -> Results:
    """Yield the hypotheses with what data and theory say of each."""
    from rockfrag.shaketable.definitions import DEFINITION
    from rockfrag_thesis.hypotheses import (
        Evidence,
        contradictions,
        hypothesis_table,
        theory_table,
    )

    study = job.study
    theory = theory_table(
        tested_blocks(study),
        job.motions("motions/ground"),
        seed=study.seed,
        threads=job.threads,
        assemblies=stacks_of(study),
    )
    yield "hypotheses_theory", theory
    if not study.has_pairs:
        return
    tests, measures = job.table("tests"), job.table("measures")
    forces = job.table("validity")[["test", "friction_demand", "least_normal_force_n"]]
    tests = tests[tests["definition"] == DEFINITION].merge(
        forces, on="test", how="left"
    )
    bodies = tested_blocks(study)
    evidence = Evidence(tests, "simulated", measures, bodies)
    hypotheses = pd.concat([theory, hypothesis_table(evidence)], ignore_index=True)
    yield "hypotheses", hypotheses
    yield "contradictions", contradictions(evidence)
    outcomes = hypotheses["outcome"].value_counts().items()
    job.log.info(
        "hypotheses: %s", ", ".join(f"{n} {outcome}" for outcome, n in outcomes)
    )


def _standing(job: Job[Study]) -> pd.DataFrame:
    """Return which definitions stand when motion and body differ a little."""
    from rockfrag.stages.tests import protocol_of
    from rockfrag_thesis.standing import standing_definitions

    study = job.study
    table = standing_definitions(
        study.configurations,
        job.motions("motions/floors"),
        study.amplitudes.values_g,
        protocol_of(study),
        seed=study.seed,
        threads=job.threads,
    )
    columns = [name for name in table.columns if name.startswith("stands_")]
    for definition, part in table.groupby("definition", sort=False):
        fallen = ", ".join(f"{(~part[name]).sum()} at {name[7:]}" for name in columns)
        job.log.info("%s: of %d definitions change %s", definition, len(part), fallen)
    return table


def _measured_hypotheses(job: Job[Study]) -> pd.DataFrame:
    from rockfrag_thesis.hypotheses import Evidence, hypothesis_table

    tests, measures = job.table("measured/tests"), job.table("measures")
    return hypothesis_table(
        Evidence(tests, "measured", measures, tested_blocks(job.study))
    )
