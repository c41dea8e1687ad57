"""Test the thesis's statements on the simulated tests."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.shaketable.readings import READING
from rockfrag.stages.log import logged
from rockfrag.study.study import study_from
from rockfrag.thesis.statements import Evidence, contradictions, ledger

with logged(snakemake.log[0], "claims") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    tests = pd.read_parquet(snakemake.input.tests)
    forces = pd.read_parquet(snakemake.input.validity)
    forces = forces[["test", "friction_demand", "least_normal_force_n"]]
    tests = tests[tests["reading"] == READING].merge(forces, on="test", how="left")
    measures = pd.read_parquet(snakemake.input.measures)
    claims = ledger(
        tests, basis="simulated", seed=study.seed, measures=measures, bodies=study.tested_blocks
    )
    theory = pd.read_parquet(snakemake.input.theory)
    claims = pd.concat([theory, claims], ignore_index=True)
    write_table(claims, *snakemake.output[:2])
    evidence = Evidence(tests, "simulated", study.seed, measures, study.tested_blocks)
    write_table(contradictions(evidence), *snakemake.output[2:])
    log.info("%s", ", ".join(f"{n} {v}" for v, n in claims["verdict"].value_counts().items()))
