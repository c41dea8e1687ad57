"""Read the sweeps as a laboratory would, and in two other ways."""

import pandas as pd

from rockfrag.files import write_table
from rockfrag.shaketable.readings import tests_from_sweep
from rockfrag.stages.log import logged
from rockfrag.stages.protocol import protocol_of
from rockfrag.stages.shaker import limited_tests
from rockfrag.study.study import study_from

with logged(snakemake.log[0], "protocol") as log:
    study = study_from(snakemake.config, snakemake.params.study)
    protocol = protocol_of(study)
    paths = snakemake.input.sweeps
    sweeps = pd.concat([pd.read_parquet(path) for path in paths], ignore_index=True)
    tests = tests_from_sweep(sweeps, protocol)
    if snakemake.input.get("limits"):
        limits = pd.read_parquet(snakemake.input.limits)
        limited = limited_tests(sweeps, protocol, limits)
        tests = pd.concat([tests, limited], ignore_index=True)
    write_table(tests, *snakemake.output)
    for reading, rows in tests.groupby("reading", sort=False):
        log.info("%s: %d tests, %d censored", reading, len(rows), (rows.censored != "none").sum())
