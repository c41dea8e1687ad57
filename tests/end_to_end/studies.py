"""Small studies of things that nobody in this project has in mind, from configuration to report."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from rockfrag.study.loading import load_any

from .. import stages_in_process
from ..case_tables import case_tables
from ..workflow.conftest import CATALOGUE as COLUMNS
from ..workflow.conftest import study_content, write_record

CATALOGUE = COLUMNS.replace(",file,", ",file,vertical,")


@dataclass(frozen=True)
class Foreign:
    """A study by somebody else; all but ``content`` is by name."""

    # width [cm], height [cm], mass [kg]
    blocks: Mapping[str, tuple[float, float, float]]
    # object, pedestal or None, and with what it is compared, if that is said
    configurations: Mapping[str, tuple[str | None, ...]]
    records: Mapping[str, str]  # their earthquakes
    floors: Mapping[str, int] | None = None  # levels in a building of three storeys
    # keys that differ from the usual ones
    content: Mapping[str, Any] = field(default_factory=dict)
    # whether it takes five seconds and more, and others have every part of it
    slow: bool = False

    @property
    def names(self) -> list[str]:
        """All names that the user has given, longest first."""
        names = [
            *self.blocks,
            *self.configurations,
            *self.records,
            *self.records.values(),
        ]
        return sorted({*names, *(self.floors or {})}, key=len, reverse=True)


def write(study: Foreign, folder: Path) -> Path:
    """Write everything that the study's user would write, and return the configuration's path."""
    folder.mkdir(parents=True, exist_ok=True)
    blocks = [(name, *values) for name, values in study.blocks.items()]
    _table(folder / "blocks.csv", "name,width_cm,height_cm,mass_kg", blocks)
    standing = [
        (name, *(*cells, None)[:3]) for name, cells in study.configurations.items()
    ]
    _table(folder / "configurations.csv", "name,object,pedestal,counterpart", standing)
    rows = []
    for number, (name, earthquake) in enumerate(study.records.items()):
        names = f"record{number}.txt", f"record{number}-up.txt"
        for seed, item in zip((number, 100 + number), names, strict=True):
            write_record(folder / item, seed, samples=250, dt=0.02)
        rows.append((name, earthquake, *[""] * 5, "folder", *names, "", "g", "own"))
    _table(folder / "motions.csv", CATALOGUE.strip(), rows)
    content = study_content() | {
        "study": "own",
        "title": "A study of my own",
        "bodies": {"specimens": "blocks.csv", "configurations": "configurations.csv"},
        "amplitudes": {"lowest_g": 0.1, "highest_g": 1.5, "step_percent": 20},
        "protocol": {"step_percent": 20},
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


def _table(path: Path, header: str, rows: Sequence[Sequence[Any]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header.split(","), *rows])


def run(study: Foreign, folder: Path) -> Path:
    """Write a study, run all its stages in this process, and return the folder of its results."""
    return run_stages(write(study, folder))


def run_stages(path: Path) -> Path:
    """Run all stages of a configuration in this process, and return the folder of its results."""
    study = load_any(path)
    return stages_in_process.run_stages(study, path.parent / "results" / study.name)


def alone(*names: str) -> dict[str, tuple[str | None, ...]]:
    """Configurations of objects that stand on the floor."""
    return {name: (name, None) for name in names}


STUDIES = {name: Foreign(**about) for name, about in case_tables(__file__).items()}
