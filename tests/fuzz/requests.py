"""Ask `rockfrag assess` at random, and hold every answer against itself.

    python -m tests.fuzz.requests --requests 2000

Each request must be answered without a contradiction, or be refused in one sentence (``tests/assess/asking.py``).
Prints how many were answered and refused, and what went wrong; exit status 1 if anything did.
"""

import random
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from rockfrag.motions import scale_to_pga
from rockfrag.motions.filtering import bandpass
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY

from ..assess import asking, samples
from .draws import run_draws

EARTHQUAKES = 6
PART = 50

LEAST_ANSWERED = 0.25
"""Fraction of the requests that must be answered, and not refused."""


def main() -> int:
    """Run the draws; return 0 if every answer agreed with itself."""
    return run_draws(_request, "requests", 2000, PART, LEAST_ANSWERED, __doc__)


def _request(rng: random.Random, folder: Path) -> tuple[str, Callable[[], tuple[int, list[str]]]]:
    records, hazard = folder / "catalogue.csv", folder / "hazard.csv"
    if not hazard.exists():
        write_records(folder)
        hazard.write_text(samples.table_csv())
    asked = asking.request(rng, records, hazard)

    def answer() -> tuple[int, list[str]]:
        status, out, err = asking.answered(asked, folder / "answer")
        return status, asking.contradictions(status, out, err)

    return " ".join(asked), answer


def write_records(folder: Path) -> None:
    """Write a catalogue of short records of noise, one an earthquake and two a station."""
    rng = np.random.default_rng(0)
    rows = ["name,earthquake,station,file,unit"]
    for i in range(EARTHQUAKES):
        raw = Motion(rng.standard_normal(1500) * np.hanning(1500), 0.01, name=f"noise {i}")
        motion = scale_to_pga(bandpass(raw, 0.2, 1.0 + 0.5 * i), 0.2 + 0.01 * i)
        values = zip(motion.time, motion.acceleration / GRAVITY, strict=True)
        (folder / f"{i}.txt").write_text("".join(f"{t:.2f} {a:.7f}\n" for t, a in values))
        rows.append(f"noise {i},earthquake {i},station {i // 2},{i}.txt,g")
    (folder / "catalogue.csv").write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    sys.exit(main())
