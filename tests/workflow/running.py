"""The workflow as its users call it: Snakemake by itself, and the launcher of ``make run``."""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def snakemake(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [
            *(
                sys.executable,
                "-m",
                "snakemake",
                "--snakefile",
                str(ROOT / "workflow" / "Snakefile"),
            ),
            *("--directory", str(folder), "--configfile", str(folder / "study.yaml")),
            *arguments,
        ],
        capture_output=True,
        text=True,
        timeout=500,
        check=False,
    )


def tables_of(folder: Path) -> dict[str, bytes]:
    results = folder / "results"
    return {
        path.relative_to(results).as_posix(): path.read_bytes()
        for path in sorted(results.rglob("*"))
        if path.suffix in (".csv", ".parquet", ".svg", ".png", ".html")
    }


def run_locally_and_with(folder: Path, *arguments: str) -> str:
    """Run a study here, then from nothing with more arguments; the bytes must agree. Return what was said."""
    launcher = [sys.executable, str(ROOT / "workflow" / "run.py"), "study.yaml"]
    subprocess.run([*launcher, "--cores", "2"], cwd=folder, check=True, capture_output=True)
    wanted = tables_of(folder)
    shutil.rmtree(folder / "results")
    done = subprocess.run(
        [*launcher, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert tables_of(folder) == wanted
    return done.stderr
