"""Random requests of `rockfrag assess` and random studies, whose answers may not contradict themselves."""

import random
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp

from rockfrag.errors import InputError

from ..assess import asking, samples
from ..conftest import write_records
from ..end_to_end import asking_studies
from .damage import Attempt


def requests(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what asks `rockfrag assess` at random (``tests/assess/asking.py``)."""
    records, hazard = write_records(folder, 6), folder / "hazard.csv"
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
