"""The workflow as its users call it: Snakemake by itself, and the launcher of ``make run``."""

import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
SNAKEFILE = str(ROOT / "workflow" / "Snakefile")
LAUNCHER = [sys.executable, str(ROOT / "workflow" / "run.py")]


def called(
    folder: Path, *command: str, **more: Any
) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder and return what it said."""
    return subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
        **more,
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


def finished(
    done: subprocess.CompletedProcess[str],
) -> subprocess.CompletedProcess[str]:
    """Return a run that has ended well."""
    assert done.returncode == 0, f"{done.stdout[-1000:]}{done.stderr[-3000:]}"
    return done


def free_port() -> int:
    """A port of this machine on which nobody listens."""
    with socket.socket() as item:
        item.bind(("127.0.0.1", 0))
        return int(item.getsockname()[1])
