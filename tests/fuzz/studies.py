"""Run small studies at random, from configuration to report, and hold their results against themselves.

    python -m tests.fuzz.studies --studies 500

Each study must end with a report that does not contradict its tables, or be refused in one sentence before
anything runs (``tests/end_to_end/asking_studies.py``).  Prints how many ran and were refused, and what went
wrong; exit status 1 if anything did.
"""

import random
import sys
import tempfile
import traceback
from collections import Counter
from pathlib import Path

from ..end_to_end import asking_studies
from .draws import Found, Part, run_draws

PART = 10

LEAST_RUN = 0.4
"""Fraction of the studies that must run, and not be refused."""


def main() -> int:
    """Run the draws; return 0 if every answer agreed with itself."""
    return run_draws(_part, "studies", 500, PART, LEAST_RUN, __doc__)


def _part(part: Part) -> Found:
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
