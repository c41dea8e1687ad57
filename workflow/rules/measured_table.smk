# A study of a measured table: curves, choice of the measure, report; nothing is simulated.
import json
import os
import shlex
import sys

from rockfrag.errors import InputError
from rockfrag.report.measured_page import TABLES as MEASURED_TABLES
from rockfrag.report.measured_page import figure_names as measured_figure_names
from rockfrag.stages.digest import source_digest
from rockfrag.study.measured_table import measured_table_from

sys.executable = shlex.quote(sys.executable)

STUDY_FILE = os.path.relpath(workflow.configfiles[-1])

try:
    STUDY = measured_table_from(config, STUDY_FILE)
except InputError as error:
    # nothing has run yet: one sentence, no traceback, exit status 1
    sys.exit(str(error))

RESULTS = f"results/{STUDY.name}"


rule study_measured_table:
    input:
        str(STUDY.table),
    output:
        report=report(
            f"{RESULTS}/report.html",
            category="Report",
            caption="../report/report.rst",
        ),
        tables=expand(
            f"{RESULTS}/{{name}}.{{ending}}",
            name=MEASURED_TABLES,
            ending=("csv", "parquet"),
        ),
        figures=expand(
            f"{RESULTS}/figures/{{name}}.{{ending}}",
            name=measured_figure_names(STUDY),
            ending=("svg", "png"),
        ),
    log:
        f"{RESULTS}/logs/study_measured_table.log",
    conda:
        "../envs/rockfrag.yaml"
    params:
        study=STUDY_FILE,
        settings=json.dumps(config, sort_keys=True, default=str),
        code=source_digest("report"),
    script:
        "../scripts/study_measured_table.py"
