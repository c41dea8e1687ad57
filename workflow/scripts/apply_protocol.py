"""Read the sweeps as a laboratory would, and in two other ways."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.steps import GeometricSteps
from rockfrag.shaketable.sweeps import tests_from_sweep
from rockfrag.studies.log import logged
from rockfrag.studies.study import study_from

with logged(snakemake.log[0], "protocol") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    amplitudes = study.amplitudes
    growth = study.protocol_step_percent / 100
    protocol = Protocol(GeometricSteps(amplitudes.lowest_g, growth), amplitudes.highest_g)
    sweeps = pd.concat([pd.read_parquet(path) for path in snakemake.input], ignore_index=True)
    tests = tests_from_sweep(sweeps, protocol)
    write_table(tests, *snakemake.output)
    steps = tests[tests["reading"] == "step_protocol"]
    log.info("%d tests, %d censored", len(steps), (steps["censored"] != "none").sum())
