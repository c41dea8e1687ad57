"""Run small studies at random, from configuration to report, and hold their results against themselves.

    python -m tests.fuzz.studies --studies 500

Each study must end with a report that does not contradict its tables, or be refused in one sentence before
anything runs (``tests/end_to_end/asking_studies.py``).  Prints how many ran and were refused, and what went
wrong; exit status 1 if anything did.
"""

import random
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from ..end_to_end import asking_studies
from .draws import run_draws

PART = 10

LEAST_RUN = 0.4
"""Fraction of the studies that must run, and not be refused."""


def main() -> int:
    """Run the draws; return 0 if every answer agreed with itself."""
    return run_draws(_study, "studies", 500, PART, LEAST_RUN, __doc__)


def _study(rng: random.Random, folder: Path) -> tuple[Any, Callable[[], tuple[int, list[str]]]]:
    study = asking_studies.draw(rng)
    return study, partial(asking_studies.fate, study, Path(mkdtemp(dir=folder)))


if __name__ == "__main__":
    sys.exit(main())
