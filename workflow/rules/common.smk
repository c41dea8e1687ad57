# The study, its stages and its folder.
import os
import shlex
import sys

from rockfrag.errors import InputError
from rockfrag.guests import study_stages
from rockfrag.stages.running import RESULTS as ALL_RESULTS
from rockfrag.study.loading import any_study

# Snakemake puts the interpreter's path into shell commands as it is, so spaces in it must be quoted
sys.executable = shlex.quote(sys.executable)

STUDY_FILE = os.path.relpath(workflow.configfiles[-1])

try:
    STUDY = any_study(config, STUDY_FILE)
except InputError as error:
    # nothing has run yet: one sentence, no traceback, exit status 1
    sys.exit(str(error))

RESULTS = f"{ALL_RESULTS}/{STUDY.name}"
STAGES = study_stages(STUDY)
