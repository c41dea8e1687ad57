"""Random requests of `rockfrag assess` and random studies, whose answers may not contradict themselves."""

import random
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from rockfrag.errors import InputError
from rockfrag.motions import scale_to_pga
from rockfrag.motions.filtering import bandpass
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY

from ..assess import asking, samples
from ..end_to_end import asking_studies
from .damage import Attempt

EARTHQUAKES = 6


def requests(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what asks `rockfrag assess` at random (``tests/assess/asking.py``)."""
    records, hazard = folder / "catalogue.csv", folder / "hazard.csv"
    write_records(folder)
    hazard.write_text(samples.table_csv())

    def draw(rng: random.Random) -> Attempt:
        asked = asking.request(rng, records, hazard)

        def attempt() -> None:
            status, out, err = asking.answered(asked, folder / "answer")
            settle(" ".join(asked), status, asking.contradictions(status, out, err))

        return folder / "request", attempt

    return draw


def studies(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what runs small studies at random, to their reports (``tests/end_to_end/asking_studies.py``)."""

    def draw(rng: random.Random) -> Attempt:
        study = asking_studies.draw(rng)
        return folder / "study", lambda: settle(
            repr(study), *asking_studies.fate(study, Path(mkdtemp(dir=folder)))
        )

    return draw


def settle(drawn: str, status: int, wrong: list[str]) -> None:
    """Raise what became of a draw: contradictions, or a refusal."""
    assert not wrong, f"{'; '.join(wrong)} of {drawn}"
    if status == 2:
        raise InputError("It is refused.")


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
