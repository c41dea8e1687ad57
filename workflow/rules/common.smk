# What the rules share: the study as its configuration says it, the folder of its results, names of files.
import json
import os
import shlex
import sys

from snakemake.logging import logger
from snakemake.utils import update_config

from rockfrag.base.errors import InputError
from rockfrag.config.plugins import plugins_of
from rockfrag.stages.job import files_digest, memory_mb, package_digest
from rockfrag.stages.running import RUN, prepared, same_numbers
from rockfrag.base.yaml_file import read_yaml

# jobs inherit it: no number depends on what the processor at hand could do beyond others of its kind
os.environ |= same_numbers(os.environ)
# and they end with this process, however it ends
os.environ[RUN] = str(os.getpid())
# Snakemake puts the interpreter's path into shell commands as it is, so spaces in it must be quoted
sys.executable = shlex.quote(sys.executable)

STUDY_FILE = os.path.relpath((workflow.configfiles or ["config/config.yaml"])[-1])

try:
    # read once more, strictly: Snakemake takes the last of two equal keys without a word; a workflow that uses
    # this one as a module hands over what it has read
    if not workflow.modifier.skip_configfile:
        config.clear()
        for path in workflow.configfiles:
            update_config(config, read_yaml(path))
        update_config(config, workflow.config_settings.config or {})
    STUDY, FOLDER = prepared(config, STUDY_FILE)
except InputError as error:
    # nothing has run yet: one sentence, no traceback
    sys.exit(str(error))

KIND = type(STUDY).__name__
PLUGINS = plugins_of(STUDY)
# what the report shows of the outputs of their rules, which stand elsewhere and need whole paths
ADDED = []
RUN_STAGE = workflow.source_path("../scripts/run_stage.py")
ENVIRONMENT = workflow.source_path("../envs/rockfrag.yaml")
RESULTS = str(FOLDER)
MEMORY_MB = memory_mb(STUDY)
PACKAGE = package_digest(*(plugin.rules.parent for plugin in PLUGINS))
# a cluster's profile says how many threads a job may have at most
CORES = workflow.resource_settings.cores or 64

logger.info(
    f"The report will be {RESULTS}/report.html",
    extra={"report": f"{RESULTS}/report.html"},
)


def table(*names):
    """Files of tables of results: CSV for people, Parquet for the stages that read them."""
    return [f"{RESULTS}/{name}{end}" for name in names for end in (".csv", ".parquet")]


def read(*names):
    """Files of tables as the stages behind them read them."""
    return [f"{RESULTS}/{name}.parquet" for name in names]


def settings(*keys, files=()):
    """What a stage depends on beside tables of others: keys of the configuration, the user's files, the package.

    The user's files are no inputs: of those Snakemake looks at the times alone, so it would miss one that was
    replaced by an older file, and end with an error where the time of one lies in the future.
    """
    asked = {key: config.get(key) for key in keys}
    return asked | {"files": files_digest(files), "package": PACKAGE}


def study_file(wildcards):
    """Path of the configuration; as a function, for it may hold what Snakemake takes for a wildcard."""
    return STUDY_FILE


def captions(figure):
    """What the study's report says of a figure: its chapter and its caption."""
    with open(f"{RESULTS}/figures/captions.json", encoding="utf-8") as file:
        return json.load(file)[figure]
