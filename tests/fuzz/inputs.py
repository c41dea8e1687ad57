"""Damaged configurations, tables, hazard files and statues; numbers, requests and studies at random."""

import random
import shutil
from collections.abc import Callable
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np
import yaml

from rockfrag import Block, Stack, overturns, simulate
from rockfrag.assess.hazard.curve import read_hazard
from rockfrag.assess.inventory import read_inventory
from rockfrag.assess.request import read_request
from rockfrag.base.errors import InputError
from rockfrag.fragility.tests_file import read_tests
from rockfrag.records.catalogue import read_catalogue
from rockfrag.shaketable.tests_table import read_measured
from rockfrag.study.configurations import read_configurations, read_specimens
from rockfrag.study.loading import load_any

from ..assess import asking
from ..assess.samples import SAMPLES
from ..case_tables import case_tables
from ..conftest import motions_of_noise, write_records
from ..end_to_end import asking_studies
from .damage import Attempt, changed, damage, damaged

CASES = case_tables(__file__)
ROOT = Path(__file__).resolve().parents[2]
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
DUMPER = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
NUMBERS: tuple[Any, ...] = (
    0, 1, -1, 0.5, 1e-12, 1e12, 1e300, -1e300, float("nan"), float("inf"), None, "1", "x", True, 2j,
    [], [1.0], (0.9, 0.8), np.float32(0.3), np.array(0.2), np.array([0.2, np.nan]), {}, object(),
)  # fmt: skip


def configurations(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a configuration, a building or a table of a shaker that is damaged.

    In two of three, values are exchanged, removed and added; in the third, bytes are damaged.
    """
    sources = _sources(folder, ".yaml")
    parsed = {name: yaml.load(content, LOADER) for name, content in sources.items()}
    path = folder / "damaged.yaml"

    def one(rng: random.Random) -> Attempt:
        name = rng.choice(list(sources))
        if rng.random() < 1 / 3:
            path.write_bytes(damage(sources[name], sources["thesis.yaml"], rng))
        else:
            _write_changed(path, parsed[name], rng)
        return path, lambda: _load(_used(parsed["smoke.yaml"], name, path))

    return one


def _write_changed(path: Path, content: Any, rng: random.Random) -> None:
    for _ in range(rng.randint(1, 3)):
        content = changed(content, rng)
    text = yaml.dump(content, Dumper=DUMPER, allow_unicode=True, sort_keys=False)
    path.write_text(text, encoding="utf-8")


def tables(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a table with damaged bytes."""
    sources = _sources(folder, ".csv")
    return damaged(
        folder, [(name, sources[name], read) for name, read in TABLES.items()]
    )


def numbers(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a body, a motion and what else a simulation takes, some of it unusable."""
    good = np.random.default_rng(1).normal(size=200)
    # kernels are compiled once, before anything is timed
    for body in (BLOCKS["T1"], Stack(BLOCKS["P"], BLOCKS["T1"])):
        simulate(body, np.zeros(9), 0.01)
        overturns([body], [np.ones(9)], [0.01], [1.0])

    def one(rng: random.Random) -> Attempt:
        def some(usual: Any) -> Any:
            return rng.choice(NUMBERS) if rng.random() < 0.2 else usual

        def attempt() -> None:
            statue = Block(some(0.2), some(0.6), some(30.0))
            pedestal = rng.random() < 0.5
            body = (
                Stack(Block(some(0.4), some(0.3), some(50.0)), statue)
                if pedestal
                else statue
            )
            acceleration = some(good * 10.0 ** rng.randint(-3, 3))
            if rng.random() < 0.5:
                simulate(
                    body, acceleration, some(0.01), theta0=some(None), omega0=some(None)
                )
            else:
                overturns(
                    [some(body)],
                    [acceleration],
                    [some(0.01)],
                    some([0.5, 1.0]),
                    threads=some(1),
                )

        return folder / "numbers", attempt

    return one


BLOCKS = {"T1": Block(0.124, 0.372, 2.172), "P": Block(0.184, 0.208, 2.3)}
TABLES: dict[str, Callable[[Path], object]] = {
    "specimens.csv": read_specimens,
    "configurations.csv": lambda path: read_configurations(path, dict(BLOCKS)),
    "thesis.csv": read_catalogue,
    "tests-template.csv": read_measured,
    "campaign-template.csv": lambda path: read_tests(
        path, ["pga_g"], overturned="overturned", motion="test"
    ),
}


def _sources(folder: Path, ending: str) -> dict[str, bytes]:
    """The files of the shipped studies, copied to where damaged ones are used."""
    shutil.copytree(ROOT / "config", folder, dirs_exist_ok=True)
    paths = (
        path for path in sorted((ROOT / "config").rglob("*")) if path.suffix == ending
    )
    return {path.name: path.read_bytes() for path in paths}


def _load(path: Path) -> None:
    assert load_any(path).name


def _used(smoke: dict[str, Any], name: str, damaged: Path) -> Path:
    """The study that a damaged file belongs to: itself, or one that names it."""
    key = (
        "shaker"
        if name == "shaker.yaml"
        else "building"
        if name.startswith("building")
        else None
    )
    if key is None:
        return damaged
    path = damaged.with_name("whole.yaml")
    path.write_text(yaml.dump({**smoke, key: damaged.name}, Dumper=DUMPER))
    return path


def hazard_files(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a hazard file with damaged bytes."""
    return damaged(
        folder,
        [
            (name, text.encode(), lambda path: read_hazard([path]))
            for name, text in SAMPLES.items()
        ],
    )


def objects(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes a statue, with other values or damaged bytes, or an inventory."""
    (folder / "table.csv").write_text(SAMPLES["table.csv"])
    (folder / "building.yaml").write_bytes(
        (ROOT / "config" / "building.yaml").read_bytes()
    )
    statues = CASES["statues"]
    texts = [
        yaml.dump(statue, Dumper=DUMPER, sort_keys=False).encode() for statue in statues
    ]
    path, table = folder / "statue.yaml", folder / "inventory.csv"

    def one(rng: random.Random) -> Attempt:
        kind = rng.randrange(3)
        if kind == 0:
            _write_changed(path, rng.choice(statues), rng)
        elif kind == 1:
            path.write_bytes(damage(rng.choice(texts), rng.choice(texts), rng))
        if kind < 2:
            return path, lambda: read_request(path)
        table.write_bytes(damage(CASES["inventory"].encode(), texts[0], rng))
        return table, lambda: read_inventory(table, {"pga": "0.3 g"})

    return one


def requests(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what asks `rockfrag assess` at random (``tests/assess/asking.py``)."""
    records, hazard = write_records(folder, motions_of_noise(6)), folder / "hazard.csv"
    hazard.write_text(SAMPLES["table.csv"])

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
