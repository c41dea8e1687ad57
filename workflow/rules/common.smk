# The study, its stages and its folder.
import json
import os
import shlex
import sys

from snakemake.logging import logger
from snakemake.utils import update_config

from rockfrag.errors import InputError
from rockfrag.guests import study_stages
from rockfrag.stages.running import prepared
from rockfrag.stages.same_numbers import same_numbers
from rockfrag.stages.stage import priorities
from rockfrag.yaml_file import read_yaml

# jobs inherit it: no number depends on what the processor at hand could do beyond others of its kind
os.environ |= same_numbers(os.environ)

# Snakemake puts the interpreter's path into shell commands as it is, so spaces in it must be quoted
sys.executable = shlex.quote(sys.executable)

STUDY_FILE = os.path.relpath(workflow.configfiles[-1])

try:
    # read once more, strictly: Snakemake takes the last of two equal keys without a word
    config.clear()
    for path in workflow.configfiles:
        update_config(config, read_yaml(path))
    update_config(config, workflow.config_settings.config or {})
    STUDY, FOLDER = prepared(config, STUDY_FILE)
except InputError as error:
    # nothing has run yet: one sentence, no traceback, exit status 1
    sys.exit(str(error))

RESULTS = str(FOLDER)
STAGES = study_stages(STUDY)
PRIORITIES = priorities(STAGES, STUDY)
logger.info(
    f"The report will be {RESULTS}/report.html",
    extra={"report": f"{RESULTS}/report.html"},
)


def captions(figure):
    """What the study's report says of a figure: its chapter and its caption."""
    with open(f"{RESULTS}/figures/captions.json", encoding="utf-8") as file:
        return json.load(file)[figure]


def flagged(path):
    """An output as Snakemake wants it: folders marked, figures and the page put into its report."""
    if path == "figures/":
        return report(
            directory(f"{RESULTS}/figures"),
            patterns=["{figure}.svg"],
            category="Figures",
            subcategory=lambda wildcards: captions(wildcards.figure)["chapter"],
            labels=lambda wildcards: {"shows": captions(wildcards.figure)["caption"]},
            caption="../report/figure.rst",
        )
    if path == "report.html":
        return report(
            f"{RESULTS}/report.html",
            category="Report",
            labels={
                "shows": "The answer, and all chapters with their figures and tables"
            },
            caption="../report/report.rst",
        )
    if path.endswith("/"):
        return directory(f"{RESULTS}/{path.rstrip('/')}")
    return f"{RESULTS}/{path}"
