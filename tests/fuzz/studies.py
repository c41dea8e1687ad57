"""Run small studies at random, from configuration to report, and hold their results against themselves.

    python -m tests.fuzz.studies --studies 500

Each study must end with a report that does not contradict its tables, or be refused in one sentence before
anything runs (``tests/end_to_end/asking_studies.py``).  Prints how many ran and were refused, and what went
wrong; exit status 1 if anything did.
"""

import argparse
import os
import random
import sys
import tempfile
import traceback
from collections import Counter
from pathlib import Path

from rockfrag.processes import in_processes

from ..end_to_end import asking_studies

PART = 10

LEAST_RUN = 0.4
"""Fraction of the studies that must run, and not be refused."""


def main() -> int:
    """Run the draws; return 0 if every study agreed with itself."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--studies", type=int, default=500, help="how many")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    parts = [
        (options.seed, first, min(first + PART, options.studies))
        for first in range(0, options.studies, PART)
    ]
    fates: Counter[int] = Counter()
    wrong: list[str] = []
    for found, lines in in_processes(_part, parts, os.cpu_count() or 1):
        fates += found
        wrong += lines
        print("\n".join(lines), end="\n" if lines else "", flush=True)
    print(f"{options.studies} studies: {fates[0]} ran, {fates[2]} refused in one sentence")
    if fates[0] < LEAST_RUN * options.studies:
        print("too few of them ran for this to say anything")
        return 1
    return 1 if wrong else 0


def _part(part: tuple[int, int, int]) -> tuple[Counter[int], list[str]]:
    seed, first, last = part
    fates: Counter[int] = Counter()
    wrong = []
    for number in range(first, last):
        study = asking_studies.draw(random.Random(f"{seed} {number}"))
        with tempfile.TemporaryDirectory(prefix="rockfrag.") as folder:
            try:
                status, found = asking_studies.fate(study, Path(folder))
            except Exception:
                status, found = 1, [traceback.format_exc(limit=-3)]
        fates[status] += 1
        wrong += [f"{number}: {study}\n    {said}" for said in found]
    return fates, wrong


if __name__ == "__main__":
    sys.exit(main())
