"""What a user waits for: whole studies and the tests, on this machine, in wall seconds.

``python benchmarks/latency.py`` takes about ten minutes on two idle cores; ``--only smoke`` one study.  Studies
run as ``make run`` runs them, in a copy of the project that shares its environment and its fetched records, so
that results of yours stay as they are.  Everything goes to ``results/bench/latency.csv``.
"""

import argparse
import json
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pandas as pd
from answers import least_waits
from app import app_seconds
from gallery import gallery_seconds

from rockfrag.base.files import write_table
from rockfrag.motions.measures import measure_motions
from rockfrag.records.motion import Motion
from rockfrag.stages.log import last_seconds

ROOT = Path(__file__).resolve().parents[1]
COPIED = (
    "Makefile",
    "pyproject.toml",
    "requirements",
    "workflow",
    "profiles",
    "config",
)
SHARED = (".venv", "resources", "src")

REACH = {
    ("thesis", "cold kernels"): 75,
    ("thesis", "warm"): 40,
    ("thesis", "nothing to do"): 4,
    ("smoke", "warm"): 18,
    ("wide", "warm"): 80,
    ("make test", ""): 300,
    ("measures of a motion", ""): 0.004,
    ("gallery", "300 objects, 2 floors"): 60,
    ("answer", "import"): 0.5,
    ("answer", "plane"): 2,
    ("answer", "floor"): 5,
    ("answer", "pedestal"): 5,
    ("answer", "box in space"): 4,
    ("answer", "round"): 6,
    ("answer", "two pedestals"): 10,
    ("app", "first answer"): 2,
    ("app", "further answer"): 1,
    ("app", "in space"): 1,
    ("app", "round"): 1,
}
"""What is to be reached on two idle cores [s]."""

MEASURED = 100
"""Motions that are measured for the time of one."""

FRACTIONS = {
    "rocking": ("ida", "sensitivity_analysis", "building_sensitivity"),
    "drawing": ("report", "campaign_report"),
    "records and motions": ("fetch_records", "motions"),
}
"""What a stage mostly does, by its name; all others are statistics."""


def main() -> None:
    """Run what was asked for and print it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    names = [*dict.fromkeys(name for name, _ in REACH)]
    parser.add_argument(
        "--only", action="append", choices=names, help="leave the others out"
    )
    wanted = parser.parse_args().only or names
    rows, fractions = [], []
    with tempfile.TemporaryDirectory() as scratch:
        project = copy_of_project(Path(scratch))
        for name, state in REACH:
            if name not in wanted:
                continue
            if name == "make test":
                seconds = timed(["make", "test"], ROOT, {})
            elif name == "measures of a motion":
                seconds = measuring_seconds()
            elif name == "gallery":
                seconds = gallery_seconds()[0]
            elif name == "answer":
                seconds = least_waits(state).whole
            elif name == "app":
                seconds = app_seconds().get(f"{state}: first", float("nan"))
            else:
                seconds = study_seconds(project, name, state)
            rows.append(
                {"wait": f"{name} {state}".strip(), "seconds": float(f"{seconds:.3g}")}
            )
            rows[-1]["reach"] = REACH[name, state]
            print(
                f"{rows[-1]['wait']:<30} {seconds:7.3g} s   (to reach: {REACH[name, state]} s)",
                flush=True,
            )
            if state in ("warm", "cold kernels"):
                item = fractions_of(project, name)
                fractions.append({"wait": rows[-1]["wait"], **item})
                told = ", ".join(f"{kind} {part:.0%}" for kind, part in item.items())
                print(f"{'':<30} of the time of all jobs: {told}", flush=True)
    table = pd.DataFrame(rows)
    if fractions:
        table = table.merge(pd.DataFrame(fractions), on="wait", how="left")
    write_table(table, ROOT / "results" / "bench" / "latency.csv")


def copy_of_project(scratch: Path) -> Path:
    """Copy what a study needs, and link what is large or does not change."""
    project = scratch / "project"
    project.mkdir()
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, project / name)
        else:
            shutil.copy2(ROOT / name, project / name)
    (ROOT / "resources").mkdir(exist_ok=True)
    for name in SHARED:
        (project / name).symlink_to(ROOT / name)
    return project


def study_seconds(project: Path, study: str, state: str) -> float:
    """Run a study from its records on with cold or warm kernels, or once more."""
    kernels = project.parent / "kernels"
    if state == "cold kernels":
        shutil.rmtree(kernels, ignore_errors=True)
    if state != "nothing to do":
        shutil.rmtree(project / "results", ignore_errors=True)
        shutil.rmtree(project / ".snakemake", ignore_errors=True)
    # -o: the environment is the one that runs this
    command = ["make", "-o", ".venv/installed", "run", f"STUDY=config/{study}.yaml"]
    if state == "warm" and not kernels.exists():
        timed(command, project, {"NUMBA_CACHE_DIR": str(kernels)})
        return study_seconds(project, study, state)
    return timed(command, project, {"NUMBA_CACHE_DIR": str(kernels)})


def measuring_seconds() -> float:
    """Wall seconds that all intensity measures of a motion of 40 s take, its compiling aside."""
    # noise without the highest frequencies, of which records have little
    noise = np.convolve(
        np.random.default_rng(1).normal(size=4000), np.hanning(15), mode="same"
    )
    samples = noise * np.hanning(4000)
    motions = [
        Motion(name=f"noise {k}", acceleration=samples * (1 + k), dt=0.01)
        for k in range(MEASURED)
    ]
    measure_motions(motions[:1])
    start = time.perf_counter()
    measure_motions(motions)
    return (time.perf_counter() - start) / MEASURED


def timed(command: list[str], folder: Path, more: dict[str, str]) -> float:
    """Wall seconds of a command that must succeed."""
    start = time.perf_counter()
    done = subprocess.run(
        command,
        cwd=folder,
        env={**os.environ, **more},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise SystemExit(
            f"{' '.join(command)} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        )
    return time.perf_counter() - start


def fractions_of(project: Path, study: str) -> dict[str, float]:
    """Fraction of the jobs' seconds by what they do; start-up is what a job takes beyond its stage."""
    seconds: dict[str, float] = {}
    for rule, whole in job_seconds(project / ".snakemake" / "metadata").items():
        kinds = [kind for kind, stages in FRACTIONS.items() if rule in stages]
        kind = kinds[0] if kinds else "statistics"
        own = min(
            last_seconds(project / "results" / study / "logs" / f"{rule}.log") or whole,
            whole,
        )
        seconds[kind] = seconds.get(kind, 0.0) + own
        seconds["start-up"] = seconds.get("start-up", 0.0) + whole - own
    total = sum(seconds.values())
    return {kind: value / total for kind, value in seconds.items()} if total else {}


def job_seconds(metadata: Path) -> dict[str, float]:
    """Seconds of each rule's jobs, as Snakemake remembers them with every output."""
    jobs = set()
    for path in metadata.rglob("*"):
        if path.is_file():
            content = json.loads(path.read_text(encoding="utf-8"))
            if content.get("starttime") and content.get("endtime"):
                jobs.add((content["rule"], content["starttime"], content["endtime"]))
    seconds: dict[str, float] = {}
    for rule, start, end in jobs:
        seconds[rule] = max(seconds.get(rule, 0.0), end - start)
    return seconds


if __name__ == "__main__":
    main()
