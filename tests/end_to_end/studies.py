"""Small studies of things that nobody in this project has in mind, from configuration to report."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from rockfrag.study.loading import load_any

from .. import stages_in_process
from ..workflow.conftest import CATALOGUE as COLUMNS

CATALOGUE = COLUMNS.replace(",file,", ",file,vertical,")
STEP, SAMPLES = 0.02, 250


@dataclass(frozen=True)
class Foreign:
    """A study by somebody else; all but ``content`` is by name."""

    blocks: Mapping[str, tuple[float, float, float]]  # width [cm], height [cm], mass [kg]
    # object, pedestal or None, and with what it is compared, if that is said
    configurations: Mapping[str, tuple[str | None, ...]]
    records: Mapping[str, str]  # their earthquakes
    floors: Mapping[str, int] | None = None  # levels in a building of three storeys
    content: Mapping[str, Any] = field(default_factory=dict)  # keys that differ from the usual ones

    @property
    def names(self) -> list[str]:
        """All names that the user has given, longest first."""
        names = [*self.blocks, *self.configurations, *self.records, *self.records.values()]
        return sorted({*names, *(self.floors or {})}, key=len, reverse=True)


def write(study: Foreign, folder: Path) -> Path:
    """Write everything that the study's user would write, and return the configuration's path."""
    folder.mkdir(parents=True, exist_ok=True)
    blocks = [(name, *map(str, values)) for name, values in study.blocks.items()]
    _table(folder / "blocks.csv", "name,width_cm,height_cm,mass_kg", blocks)
    standing = [
        (name, *(cell or "" for cell in (*cells, None)[:3]))
        for name, cells in study.configurations.items()
    ]
    _table(folder / "configurations.csv", "name,object,pedestal,counterpart", standing)
    rows = []
    for number, (name, earthquake) in enumerate(study.records.items()):
        names = f"record{number}.txt", f"record{number}-up.txt"
        for seed, item in zip((number, 100 + number), names, strict=True):
            _record(folder / item, seed)
        rows.append((name, earthquake, *[""] * 5, "folder", *names, "", "g", "own"))
    _table(folder / "motions.csv", CATALOGUE.strip(), rows)
    content: dict[str, Any] = {
        "study": "own",
        "title": "A study of my own",
        "seed": 5,
        "motions": {"catalogue": "motions.csv"},
        "bodies": {"specimens": "blocks.csv", "configurations": "configurations.csv"},
        "amplitudes": {"lowest_g": 0.1, "highest_g": 1.5, "step_percent": 20},
        "protocol": {"step_percent": 20},
        "fragility": {"measures": ["pga_g"], "confidence": 0.9},
    }
    if study.floors is not None:
        content["building"] = "house.yaml"
        house = {
            "name": "my house",
            "storey_heights_m": [3.5, 3.0, 3.0],
            "masses_kg": [90000, 90000, 60000],
            "first_period_s": 0.3,
            "floors": dict(study.floors),
        }
        (folder / "house.yaml").write_text(yaml.safe_dump(house, allow_unicode=True))
    path = folder / "study.yaml"
    path.write_text(yaml.safe_dump({**content, **study.content}, allow_unicode=True))
    return path


def _table(path: Path, header: str, rows: Sequence[Sequence[str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header.split(","), *rows])


def _record(path: Path, seed: int) -> None:
    """Two columns, seconds and g: a burst of band-limited noise."""
    rng = np.random.default_rng(seed)
    time = np.arange(SAMPLES) * STEP
    phases = np.outer(time, rng.uniform(0.5, 4, 20)) * 2 * np.pi + rng.uniform(0, 6, 20)
    burst = np.exp(-(((time - 1.5) / 0.8) ** 2)) * np.sin(phases).sum(axis=1)
    rows = [f"{t:.2f} {a:.6f}" for t, a in zip(time, 0.3 * burst / abs(burst).max(), strict=True)]
    path.write_text("\n".join(rows) + "\n")


def run(study: Foreign, folder: Path) -> Path:
    """Write a study, run all its stages in this process, and return the folder of its results."""
    return run_stages(write(study, folder))


def run_stages(path: Path) -> Path:
    """Run all stages of a configuration in this process, and return the folder of its results."""
    study = load_any(path)
    return stages_in_process.run_stages(study, path.parent / "results" / study.name)


TEN = {f"record {number}": f"quake {number // 2}" for number in range(10)}
TWO, THREE = {"a": "one", "b": "two"}, {"a": "one", "b": "two", "c": "three"}
MARBLE = {"marble figure": (30.0, 120.0, 110.0), "plinth": (50.0, 60.0, 350.0)}
WITH_BASE = MARBLE | {"base": (40.0, 20.0, 85.0)}
FIGURE = {"figure": ("marble figure", None)}
ON_PLINTH = FIGURE | {"figure on plinth": ("marble figure", "plinth")}


def alone(*names: str) -> dict[str, tuple[str | None, ...]]:
    """Configurations of objects that stand on the floor."""
    return {name: (name, None) for name in names}


LONG_NAME = "a very long name of a figure of a saint with a book in the left niche"

STUDIES = {
    "one marble figure, one record": Foreign(
        blocks={"marble figure": MARBLE["marble figure"]},
        configurations=FIGURE,
        records={"Irpinia": "Irpinia 1980"},
    ),
    "with and without a plinth on one upper floor": Foreign(
        blocks=MARBLE, configurations=ON_PLINTH, records=TEN, floors={"piano nobile": 2}
    ),
    "pairs of which some never overturn": Foreign(
        blocks={**MARBLE, "urn": (45.0, 90.0, 80.0)},
        configurations=ON_PLINTH | alone("urn") | {"urn on plinth": ("urn", "plinth")},
        records=dict(list(TEN.items())[:4]),
        content={"amplitudes": {"lowest_g": 0.1, "highest_g": 0.7, "step_percent": 20}},
    ),
    "the thesis's bodies, but nobody asks for the thesis": Foreign(
        blocks={"T1": (12.4, 37.2, 2.172), "T2": (12.4, 49.6, 2.79), "T3": (12.4, 62.0, 3.456)}
        | {"P": (18.4, 20.8, 2.3)},
        configurations=alone("T1", "T2", "T3") | {"P&T1": ("T1", "P")},
        records={"Friuli": "Friuli", "Gilroy": "Loma Prieta"},
        floors={"GF": 0, "F5": 3},
    ),
    "nothing overturns": Foreign(
        blocks=MARBLE,
        configurations=ON_PLINTH,
        records=TWO,
        content={"amplitudes": {"lowest_g": 0.01, "highest_g": 0.05, "step_percent": 20}},
    ),
    "everything overturns at the first step": Foreign(
        blocks={"pivot": (2.0, 150.0, 1.5), "foot": (30.0, 10.0, 20.0)},
        configurations={"pivot": ("pivot", None), "pivot on foot": ("pivot", "foot")},
        records=TWO,
        content={"amplitudes": {"lowest_g": 0.8, "highest_g": 1.5, "step_percent": 20}},
    ),
    "one amplitude": Foreign(
        blocks={"marble figure": MARBLE["marble figure"]},
        configurations=FIGURE,
        records=THREE,  # one of them topples the figure
        content={"amplitudes": {"lowest_g": 0.4, "highest_g": 0.44, "step_percent": 20}},
    ),
    "two pedestals under one figure": Foreign(
        blocks={**MARBLE, "low plinth": (60.0, 20.0, 180.0)},
        configurations=ON_PLINTH | {"figure on low plinth": ("marble figure", "low plinth")},
        records=THREE,
    ),
    "arrangements compared with each other": Foreign(
        blocks=WITH_BASE,
        configurations={
            "alone": ("marble figure", None),
            "on plinth": ("marble figure", "plinth"),
            "on base": ("marble figure", "base|plinth", "on plinth"),
        },
        records=THREE,
    ),
    "a column that may slide, and nothing else": Foreign(
        blocks=WITH_BASE,
        configurations={"figure on base on plinth": ("marble figure", "base|plinth")},
        records=TWO,
        content={"friction": {"ground": 0.7, "interface": 0.5}},
    ),
    "names that are hard to print": Foreign(
        blocks={
            "Büste „Ä“, $x_1$": (30.0, 90.0, 60.0),
            "<b>&amp; \\alpha^2": (28.0, 110.0, 70.0),
            LONG_NAME: (26.0, 100.0, 60.0),
            "Sockel 50 %": (50.0, 40.0, 200.0),
        },
        configurations=alone("Büste „Ä“, $x_1$", "<b>&amp; \\alpha^2", LONG_NAME)
        | {"Büste $ auf Sockel $": ("Büste „Ä“, $x_1$", "Sockel 50 %")},
        records={"Motion <i>1</i>": "$E$ & Söhne", "2": "2"},
        floors={"1. Stock <hinten>": 1, "Dach $": 3},
    ),
}
