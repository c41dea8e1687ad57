"""Small studies of things that nobody in this project has in mind, from configuration to report."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from rockfrag.study.loading import load_any

from .. import stages_in_process

CATALOGUE = (
    "name,earthquake,date,station,component,magnitude,distance_km,source,file,vertical,sha256,unit,"
    "licence\n"
)
STEP, SAMPLES = 0.02, 250


@dataclass(frozen=True)
class Foreign:
    """A study by somebody else.

    Attributes
    ----------
    blocks
        Width [cm], height [cm] and mass [kg] of each block by name.
    configurations
        Object and pedestal (or None) of each configuration by name, and with what it is compared, if that is said.
    records
        Earthquake of each record by name.
    floors
        Level of each floor by its label, in a building of three storeys; None for no building.
    content
        Keys of the configuration that differ from the usual ones.
    """

    blocks: Mapping[str, tuple[float, float, float]]
    configurations: Mapping[str, tuple[str | None, ...]]
    records: Mapping[str, str]
    floors: Mapping[str, int] | None = None
    content: Mapping[str, Any] = field(default_factory=dict)

    @property
    def names(self) -> list[str]:
        """All names that the user has given, longest first."""
        names = [*self.blocks, *self.configurations, *self.records, *self.records.values()]
        return sorted({*names, *(self.floors or {})}, key=len, reverse=True)


def write(study: Foreign, folder: Path) -> Path:
    """Write everything that the study's user would write, and return the configuration's path."""
    folder.mkdir(parents=True, exist_ok=True)
    _table(
        folder / "blocks.csv",
        "name,width_cm,height_cm,mass_kg",
        [(name, *map(str, values)) for name, values in study.blocks.items()],
    )
    _table(
        folder / "configurations.csv",
        "name,object,pedestal,counterpart",
        [
            (name, *(cell or "" for cell in (*cells, None)[:3]))
            for name, cells in study.configurations.items()
        ],
    )
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
    lines = [
        ",".join(f'"{cell}"' if set(cell) & {",", '"'} else cell for cell in row) for row in rows
    ]
    path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")


def _record(path: Path, seed: int) -> None:
    """Two columns, seconds and g: a burst of band-limited noise."""
    rng = np.random.default_rng(seed)
    time = np.arange(SAMPLES) * STEP
    waves = np.sin(2 * np.pi * np.outer(time, rng.uniform(0.5, 4, 20)) + rng.uniform(0, 6, 20)).sum(
        axis=1
    )
    burst = np.exp(-(((time - 1.5) / 0.8) ** 2)) * waves
    rows = [f"{t:.2f} {a:.6f}" for t, a in zip(time, 0.3 * burst / abs(burst).max(), strict=True)]
    path.write_text("\n".join(rows) + "\n")


def run(study: Foreign, folder: Path) -> Path:
    """Write a study, run all its stages in this process, and return the folder of its results."""
    return run_stages(write(study, folder))


def run_stages(path: Path) -> Path:
    """Run all stages of a configuration in this process, and return the folder of its results."""
    study = load_any(path)
    return stages_in_process.run_stages(study, path.parent / "results" / study.name)
