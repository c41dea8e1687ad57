"""Profiles hold what Snakemake knows; on a real SLURM and in a queue a study ends in the same bytes."""

import importlib.util
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from .running import LAUNCHER, ROOT, called, finished, free_port, tables_of

CONF = Path("/etc/slurm/slurm.conf")
"""Where jobs look for the configuration: the executor takes SLURM's variables from their environment."""

DAEMONS = ("munged", "slurmctld", "slurmd")


def _reason() -> str:
    """Why no SLURM can be brought up here, or an empty text."""
    if os.geteuid() != 0:
        return "SLURM's daemons need root"
    missing = [name for name in DAEMONS if _program(name) is None]
    if missing:
        return f"not installed: {', '.join(missing)} (Debian: slurmctld slurmd slurm-client munge)"
    if CONF.exists():
        return f"a SLURM is configured here already ({CONF})"
    return ""


def _program(name: str) -> str | None:
    return shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin:/sbin")


@pytest.fixture
def slurm(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A SLURM of one node, this machine, for as long as a test lasts."""
    if reason := _reason():
        pytest.skip(reason)
    require("slurm")
    # munge trusts no folder that others may write to, and sockets have short names
    folder = Path("/var/lib") / f"rockfrag-slurm-{os.getpid()}"
    for name in ("", "state", "spool"):
        (folder / name).mkdir(mode=0o755)
    (folder / "key").write_bytes(os.urandom(1024))
    (folder / "key").chmod(0o400)
    host = socket.gethostname().split(".")[0]
    about = {
        "host": host,
        "folder": folder,
        "port": free_port(),
        "other_port": free_port(),
    }
    settings = Path(__file__).with_name("slurm.conf").read_text().format(**about)
    CONF.parent.mkdir(exist_ok=True)
    CONF.write_text(settings)
    monkeypatch.setenv("PATH", f"{os.environ['PATH']}:/usr/sbin:/sbin")
    munged = [
        *(
            "munged",
            "--foreground",
            f"--key-file={folder}/key",
            f"--socket={folder}/munge.socket",
        ),
        *(f"--pid-file={folder}/munge.pid", f"--log-file={folder}/munge.log"),
        *(f"--seed-file={folder}/munge.seed", "--force"),
    ]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    daemons = []
    try:
        for command in (munged, ["slurmctld", "-D"], ["slurmd", "-D", "-N", host]):
            daemons.append(subprocess.Popen(command, **quiet))
            time.sleep(1)
        _wait_for_node(folder)
        yield folder
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        CONF.unlink()
        shutil.rmtree(folder, ignore_errors=True)


def _wait_for_node(folder: Path) -> None:
    for _ in range(60):
        done = subprocess.run(
            ["sinfo", "--noheader", "--format=%T"],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.stdout.strip() == "idle":
            return
        time.sleep(1)
    logs = "\n".join(path.read_text()[-500:] for path in folder.glob("*.log"))
    pytest.fail(f"SLURM did not come up: {done.stdout} {done.stderr}\n{logs}")


def run_locally_and_with(folder: Path, *arguments: str) -> str:
    """Run a study here, then from nothing with more arguments; the bytes must agree. Return what was said."""
    finished(called(folder, *LAUNCHER, "study.yaml", "--cores", "2"))
    wanted = tables_of(folder)
    shutil.rmtree(folder / "results")
    done = finished(called(folder, *LAUNCHER, "study.yaml", *arguments))
    assert tables_of(folder) == wanted
    return done.stderr


@pytest.mark.slow
def test_a_study_on_slurm_ends_in_the_same_bytes(study_folder: Path, slurm: Path):
    screen = run_locally_and_with(
        study_folder,
        *("--profile", str(ROOT / "profiles" / "slurm"), "--slurm-no-account"),
        *(
            "--slurm-status-command",
            "squeue",
            "--slurm-init-seconds-before-status-checks",
            "2",
        ),
        *(
            "--seconds-between-status-checks",
            "2",
            "--latency-wait",
            "5",
            "--max-threads",
            "2",
        ),
    )
    assert "SLURM jobid" in screen


PROFILES = ROOT / "profiles"
PLUGINS = {
    "slurm": "snakemake-executor-plugin-slurm",
    "queue": "snakemake-executor-plugin-cluster-generic",
}


def require(profile: str) -> None:
    """Skip a test where the plugin of Snakemake that a profile needs is not installed."""
    plugin = PLUGINS.get(profile)
    if plugin and importlib.util.find_spec(plugin.replace("-", "_")) is None:
        pytest.skip(f"not installed: {plugin} (pip install '.[{profile}]')")


@pytest.mark.parametrize(
    "profile", sorted(PROFILES.iterdir()), ids=lambda path: path.name
)
def test_snakemake_knows_every_key_of_a_profile(profile: Path):
    from snakemake.cli import parse_args

    require(profile.name)
    # ends the process where it does not know a key
    _, options = parse_args(["--profile", str(profile), "--workflow-profile", "none"])
    assert options.rerun_incomplete


SUBMIT = """#!/bin/sh
# a queue of one node: starts the job's script beside this, and prints the job's number
echo "$@" >> {log}
for script in "$@"; do :; done
setsid "$script" > /dev/null 2>&1 < /dev/null &
echo $!
"""


@pytest.mark.slow
def test_a_study_in_a_queue_ends_in_the_same_bytes(study_folder: Path, tmp_path: Path):
    require("queue")
    submit, log = tmp_path / "submit", tmp_path / "submitted"
    submit.write_text(SUBMIT.format(log=log))
    submit.chmod(0o755)
    run_locally_and_with(
        study_folder,
        *("--profile", str(ROOT / "profiles" / "queue")),
        *("--cluster-generic-submit-cmd", f"{submit} {{threads}} {{resources.mem_mb}}"),
        *(
            "--seconds-between-status-checks",
            "2",
            "--latency-wait",
            "5",
            "--max-threads",
            "2",
        ),
    )
    assert len(log.read_text().splitlines()) >= 3
