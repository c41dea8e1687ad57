"""A study that is given to a queue by a command, as on most clusters, ends in the same bytes."""

import importlib.util
from pathlib import Path

import pytest

from .running import ROOT, run_locally_and_with

SUBMIT = """#!/bin/sh
# a queue of one node: starts the job's script beside this, and prints the job's number
echo "$@" >> {log}
for script in "$@"; do :; done
setsid "$script" > /dev/null 2>&1 < /dev/null &
echo $!
"""


@pytest.mark.slow
def test_a_study_in_a_queue_ends_in_the_same_bytes(study_folder: Path, tmp_path: Path):
    if importlib.util.find_spec("snakemake_executor_plugin_cluster_generic") is None:
        pytest.skip(
            "not installed: snakemake-executor-plugin-cluster-generic (pip install '.[queue]')"
        )
    submit, log = tmp_path / "submit", tmp_path / "submitted"
    submit.write_text(SUBMIT.format(log=log))
    submit.chmod(0o755)
    run_locally_and_with(
        study_folder,
        *("--profile", str(ROOT / "profiles" / "queue")),
        *("--cluster-generic-submit-cmd", f"{submit} {{threads}} {{resources.mem_mb}}"),
        *("--seconds-between-status-checks", "2", "--latency-wait", "5", "--max-threads", "2"),
    )
    assert len(log.read_text().splitlines()) >= 3
