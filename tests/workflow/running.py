"""The workflow as its users call it: Snakemake by itself, and the launcher of ``make run``."""

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]


SNAKEFILE = str(ROOT / "workflow" / "Snakefile")
LAUNCHER = [sys.executable, str(ROOT / "workflow" / "run.py")]


def called(folder: Path, *command: str, **more: Any) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder and return what it said."""
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=900, check=False, **more
    )


def snakemake(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    study = ("--directory", str(folder), "--configfile", str(folder / "study.yaml"))
    command = (sys.executable, "-m", "snakemake", "--snakefile", SNAKEFILE)
    return called(ROOT, *command, *study, *arguments)


def tables_of(folder: Path) -> dict[str, bytes]:
    results = folder / "results"
    return {
        path.relative_to(results).as_posix(): path.read_bytes()
        for path in sorted(results.rglob("*"))
        if path.suffix in (".csv", ".parquet", ".svg", ".png", ".html")
    }


def run_locally_and_with(folder: Path, *arguments: str) -> str:
    """Run a study here, then from nothing with more arguments; the bytes must agree. Return what was said."""
    here = called(folder, *LAUNCHER, "study.yaml", "--cores", "2")
    assert here.returncode == 0, here.stderr[-3000:]
    wanted = tables_of(folder)
    shutil.rmtree(folder / "results")
    done = called(folder, *LAUNCHER, "study.yaml", *arguments)
    assert done.returncode == 0, done.stderr[-3000:]
    assert tables_of(folder) == wanted
    return done.stderr
