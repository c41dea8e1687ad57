"""What the command line takes to answer: one object of each kind, in processes that begin anew.

``python benchmarks/answers.py`` prints wall seconds to the first line and to the end, and seconds of processor, of
the least of a few runs of each kind; ``--only round`` one kind, ``--cold`` with an empty folder of machine code.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]

STATUE = "assess --width 35cm --height 130cm --mass 180kg --pga 0.35g"
ROUND = "assess --width 40cm --height 150cm --mass 200kg --pga 0.35g --round"
KINDS = {
    "import": "",
    "plane": STATUE,
    "floor": f"{STATUE} --floor 2/4",
    "pedestal": f"{STATUE} --pedestal 60cm 80cm",
    "box in space": f"{STATUE} --depth 30cm",
    "round": ROUND,
    "round on a pedestal": f"{ROUND} --pedestal 60cm 80cm",
    "two pedestals": f"{STATUE} --pedestal 60cm 80cm --pedestal 70cm 40cm",
}
"""What is asked, by the kind of object; the first only imports the package."""

RUNS = 3


class Wait(NamedTuple):
    """What one process took [s]."""

    first_line: float
    whole: float
    processor: float


def answer_wait(kind: str, kernels: str | None = None) -> Wait:
    """Time one process that answers.

    Parameters
    ----------
    kind : of object, of ``KINDS``
    kernels : folder of machine code; where numba keeps it if None

    Returns
    -------
    The times.
    """
    words = KINDS[kind].split()
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-c", "import rockfrag; print()"]
        if words:
            command = [sys.executable, "-m", "rockfrag.cli.main", *words]
            command += ["--output", folder]
        own = {} if kernels is None else {"NUMBA_CACHE_DIR": kernels}
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        with subprocess.Popen(
            command,
            cwd=ROOT,
            env={**os.environ, **own},
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        ) as process:
            assert process.stdout is not None
            process.stdout.readline()
            first = time.perf_counter() - start
            process.stdout.read()
        whole = time.perf_counter() - start
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(command)} failed")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Wait(first, whole, used)


def least_waits(kind: str, runs: int = RUNS) -> Wait:
    """Time several processes that find their machine code ready; each time is the least of all."""
    answer_wait(kind)
    return Wait(*map(min, zip(*(answer_wait(kind) for _ in range(runs)), strict=True)))


def main() -> None:
    """Time what was asked for and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", action="append", choices=KINDS)
    parser.add_argument("--cold", action="store_true")
    given = parser.parse_args()
    print("| kind | first line [s] | whole [s] | processor [s] |\n|---|--:|--:|--:|")
    for kind in given.only or KINDS:
        if given.cold:
            with tempfile.TemporaryDirectory() as kernels:
                wait = answer_wait(kind, kernels)
        else:
            wait = least_waits(kind)
        numbers = " | ".join(f"{seconds:.2f}" for seconds in wait)
        print(f"| {kind} | {numbers} |", flush=True)


if __name__ == "__main__":
    main()
