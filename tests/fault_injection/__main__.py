"""Interrupt, starve and misuse studies, and see that they end in the same bytes by themselves.

    python -m tests.fault_injection                 # all of it
    python -m tests.fault_injection --only memory   # one kind of trials

Each trial starts from the results of an undisturbed run, or from nothing, does what a machine or a person
might do, and then gives the same command once more. It passes if that command ends well without any other
step, all results have the bytes of the undisturbed run, and nothing lies outside of ``results`` and
``.snakemake`` that was not there before. Two kinds of trials run at a time, each in a folder of its own.
Prints a table in Markdown, and puts it into ``docs/reliability.md`` if all trials of all kinds passed; exit
status 1 if one failed.
"""

import argparse
import random
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pandas as pd

from ..validation.made import document, markdown
from . import kills, trials
from .studies import Study, Tally, write_shipped

COLUMNS = {
    "kind": "trial", "trials": "runs", "steps": "steps by hand", "differing": "differing files",
    "outside": "files outside", "seconds": "time [s]",
}  # fmt: skip

KINDS: Mapping[str, Callable[[Study, Tally, random.Random], None]] = {
    **kills.KINDS,
    "full disk": trials.full_disk,
    "too little memory": trials.little_memory,
    "read-only folders": trials.read_only,
    "damaged downloads and caches": trials.damaged,
    "two runs at once": trials.at_once,
    "foreign names": trials.foreign_names,
    "foreign processors and places": trials.foreign_processors,
}
"""All kinds of trials; the longest first, as two run at a time."""


def main() -> int:
    """Run the trials; return 0 if all passed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1, help="seed of the moments")
    parser.add_argument(
        "--only", default="", help="kinds of trials, by a word of their names"
    )
    options = parser.parse_args()
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="torture ") as scratch:
        whole = Study(Path(scratch) / "whole")
        if any("killed" in name for name in KINDS if options.only in name):
            whole.beside = [
                Study(Path(scratch) / name, partial(write_shipped, name=name))
                for name in ("smoke", "thesis")
            ]

        def tried(name: str) -> Tally:
            tally, started = Tally(name), time.monotonic()
            rng = random.Random(f"{options.seed} {name}")
            KINDS[name](whole.twin(Path(scratch) / name), tally, rng)
            tally.seconds = time.monotonic() - started
            print("\n".join([str(tally), *tally.noise]), file=sys.stderr, flush=True)
            return tally

        with ThreadPoolExecutor(2) as lanes:
            tallies = list(
                lanes.map(tried, (name for name in KINDS if options.only in name))
            )
    failed = any(
        tally.steps or tally.differing or tally.outside or tally.noise
        for tally in tallies
    )
    table = pd.DataFrame([vars(tally) for tally in tallies])[list(COLUMNS)].rename(
        columns=COLUMNS
    )
    print(f"{markdown(table, 0)}\n\n{time.monotonic() - begin:.0f} s")
    if not failed and len(tallies) == len(KINDS):
        document("reliability.md", "results of make torture", table, 0)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
