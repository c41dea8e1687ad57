# What all rules share: the study, its folder, and the fingerprint of the source that computes a stage.
import json
import os
import shlex
import sys

from rockfrag.errors import InputError
from rockfrag.report.figure_list import figure_names
from rockfrag.study.loading import checked_study
from rockfrag.report.supplements import (
    sensitivity_figures,
    supplement_figures,
    supplement_tables,
)
from rockfrag.stages.digest import source_digest
from rockfrag.stages.measured_tests import MEASURED_TABLES
from rockfrag.stages.pedestal import PEDESTAL_TABLES
from rockfrag.study.study import PRINTED_TABLES
from rockfrag.study.study import RECORDS_FOLDER as RECORDS

# Snakemake puts the interpreter's path into shell commands as it is, so spaces in it must be quoted
sys.executable = shlex.quote(sys.executable)

STUDY_FILE = os.path.relpath(workflow.configfiles[-1])

try:
    STUDY = checked_study(config, STUDY_FILE)
except InputError as error:
    # nothing has run yet: one sentence, no traceback, exit status 1
    sys.exit(str(error))

RESULTS = f"results/{STUDY.name}"
CONFIGURATIONS = [one.slug for one in STUDY.configurations]
PRINTED = (
    []
    if STUDY.printed is None
    else [str(STUDY.printed / name) for name in PRINTED_TABLES]
)
REPORT_TABLES = [
    "tests",
    "measures",
    "fragility",
    "survival_windows",
    "validity",
    "table_3_1",
    "table_3_3",
    "table_4_1",
]
if STUDY.has_pairs:
    REPORT_TABLES += [f"pedestal/{name}" for name in PEDESTAL_TABLES]
    REPORT_TABLES += ["claims", "contradictions"]
REPORT_TABLES += supplement_tables(STUDY)


wildcard_constraints:
    source="[a-z0-9-]+",
    configuration="|".join(map(re.escape, CONFIGURATIONS)),


def tables(*names):
    """Both forms of result tables: CSV for people, Parquet for programs."""
    return [
        f"{RESULTS}/{name}.{ending}" for name in names for ending in ("csv", "parquet")
    ]


def figures(*names):
    """Both forms of figures."""
    return [
        f"{RESULTS}/figures/{name}.{ending}"
        for name in names
        for ending in ("svg", "png")
    ]


def settings(*keys):
    """Parts of the configuration that a rule depends on, as a parameter that triggers a rerun."""
    return json.dumps({key: config.get(key) for key in keys}, sort_keys=True)
