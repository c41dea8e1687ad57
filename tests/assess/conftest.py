"""Motions of assessments: made ones, which need no network, and the default set."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag.assess.motions import MotionSet
from rockfrag.motions import bandpass, scale_to_pga
from rockfrag.records.motion import Motion

EARTHQUAKES = 6


def made_motions(noise, count: int = 24) -> tuple[Motion, ...]:
    """Motions of several earthquakes, each with its own frequencies."""
    found = []
    for i in range(count):
        about = {"earthquake": f"earthquake {i % EARTHQUAKES}", "station": f"station {i // 2}"}
        raw = noise(i, 1500, tapered=True, name=f"motion {i}", metadata=about)
        filtered = bandpass(raw, 0.2, 1.0 + 0.5 * (i % EARTHQUAKES))
        found.append(scale_to_pga(filtered, 0.2 + 0.01 * i))
    return tuple(found)


@pytest.fixture(scope="session")
def motions(noise) -> MotionSet:
    """Twenty-four made motions of six earthquakes, two components a record."""
    made = made_motions(noise)
    return MotionSet(made, made, tuple((i, i + 1) for i in range(0, len(made), 2)), "made motions")


@pytest.fixture(scope="session")
def own_records(noise, tmp_path_factory) -> Path:
    """A folder of records that are texts of seconds and g, with a catalogue."""
    folder = tmp_path_factory.mktemp("records")
    rows = ["name,earthquake,station,file,unit"]
    for motion in made_motions(noise, 12):
        file = f"{motion.name.replace(' ', '')}.txt"
        lines = [
            f"{t:.2f} {a:.7f}" for t, a in zip(motion.time, motion.acceleration / 9.81, strict=True)
        ]
        (folder / file).write_text("\n".join(lines) + "\n")
        rows.append(
            f"{motion.name},{motion.metadata['earthquake']},{motion.metadata['station']},{file},g"
        )
    (folder / "catalogue.csv").write_text("\n".join(rows) + "\n")
    return folder


@pytest.fixture
def random() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(7)
