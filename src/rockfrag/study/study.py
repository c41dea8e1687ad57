"""A study: its configuration file read, checked, and turned into what the stages need."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.building.model import ShearBuilding
from rockfrag.building.settings import read_building
from rockfrag.errors import InputError
from rockfrag.records.catalogue import read_catalogue
from rockfrag.records.sources.wheel import PROVENANCE, WHEELS
from rockfrag.rocking.bodies import Block, Stack
from rockfrag.schema import checked
from rockfrag.study.amplitudes import Amplitudes
from rockfrag.study.configurations import Configuration, read_configurations, read_specimens
from rockfrag.study.supplementary import Supplementary, supplementary_from

GROUND = "ground"
"""Label of the only floor of a study without a building."""

RECORDS_FOLDER = "resources/records"
"""Where fetched records are kept, from the folder in which the workflow runs."""


@dataclass(frozen=True)
class FragilitySettings:
    """How fragility is estimated: in which measures, and at which level the intervals are."""

    measures: tuple[str, ...]
    confidence: float


@dataclass(frozen=True)
class Study:
    """Everything that a study's configuration says, checked.

    Attributes
    ----------
    name, title, seed
        Folder under ``results/``, heading of the report, seed of every random number.
    source
        The configuration file.
    catalogue_file, catalogue
        Path of the table of motions, and its rows that are used, in order.
    processing
        Steps that each record goes through, in order.
    building_file, building
        Path of the building whose floors are shaken, and the building; None for ground motions alone.
    specimens_file, configurations_file, specimens
        Paths of the tables of bodies, and the blocks by name.
    configurations
        What is tested, in order.
    amplitudes
        Peaks of the input motion.
    protocol_step_percent
        By how much the laboratory raises the amplitude from one run to the next [%].
    fragility
        Settings of the fragility curves.
    compare_with
        ``thesis`` if the study is compared with the thesis that these tests come from, or None.
    more
        Optional parts: shaker, measured tests, sensitivity to the building, explanation.
    """

    name: str
    title: str
    seed: int
    source: Path
    catalogue_file: Path
    catalogue: pd.DataFrame
    processing: tuple[Mapping[str, Any], ...]
    building_file: Path | None
    building: ShearBuilding | None
    specimens_file: Path
    configurations_file: Path
    specimens: Mapping[str, Block]
    configurations: tuple[Configuration, ...]
    amplitudes: Amplitudes
    protocol_step_percent: float
    fragility: FragilitySettings
    compare_with: str | None
    more: Supplementary

    def configuration(self, slug: str) -> Configuration:
        """Return the configuration whose file name is ``slug``."""
        return next(one for one in self.configurations if one.slug == slug)

    @property
    def has_pairs(self) -> bool:
        """Whether an object is tested both with and without a pedestal."""
        sides = {
            side: {one.object for one in self.configurations if one.label == side}
            for side in ("P", "NP")
        }
        return bool(sides["P"] & sides["NP"])

    @property
    def floors(self) -> dict[str, int]:
        """Level of each floor that is shaken, by its label; 0 is the ground."""
        return {GROUND: 0} if self.building is None else dict(self.building.floors)

    @property
    def body_files(self) -> list[str]:
        """Paths of the tables of bodies."""
        return [str(self.specimens_file), str(self.configurations_file)]

    @property
    def sweep_tables(self) -> list[str]:
        """Name of the table of each configuration's sweep."""
        return [f"sweep/{one.slug}" for one in self.configurations]

    @property
    def tested_blocks(self) -> dict[str, Block]:
        """Blocks of the objects tested and, as ``P``, the first pedestal: the ledger's names."""
        blocks = {one.object: self.specimens[one.object] for one in self.configurations}
        pedestals = [one.pedestal for one in self.configurations if one.pedestal]
        if pedestals:
            blocks["P"] = self.specimens[pedestals[0]]
        return blocks

    @property
    def stacks(self) -> dict[str, Stack]:
        """Stacks tested, by the name of their configuration."""
        return {one.name: one.body for one in self.configurations if isinstance(one.body, Stack)}

    def record_files(self, records: str) -> list[str]:
        """Files that must exist before the records can be read, fetched ones under ``records``."""
        wheels = self.catalogue["source"].isin(list(WHEELS))
        fetched = [f"{records}/{name}/{PROVENANCE}" for name in self.catalogue["source"][wheels]]
        folder = self.catalogue_file.parent
        own = self.catalogue["file"][self.catalogue["source"] == "folder"]
        return [*dict.fromkeys(fetched), *(str(folder / name.partition("#")[0]) for name in own)]


def study_from(content: Mapping[str, Any], path: str | os.PathLike[str]) -> Study:
    """Make a study of a configuration that was read from ``path``.

    Steps of processing and the building are left to :func:`rockfrag.study.loading.checked_study`,
    which needs the packages that carry them out.

    Raises
    ------
    InputError
        One sentence with the file, the key or row, what was expected and what was found.
    """
    source = Path(path)
    content = checked(content, "study", str(source))
    bodies, motions = content["bodies"], content["motions"]
    specimens_file = _file(source, "bodies.specimens", bodies["specimens"])
    configurations_file = _file(source, "bodies.configurations", bodies["configurations"])
    specimens = read_specimens(specimens_file)
    known = read_configurations(configurations_file, specimens)
    building = content.get("building")
    building_file = None if building is None else _file(source, "building", building)
    try:
        amplitudes = Amplitudes(**content["amplitudes"])
    except InputError as error:
        raise InputError(f"{source}: {error}") from error
    catalogue_file = _file(source, "motions.catalogue", motions["catalogue"])
    return Study(
        name=content["study"],
        title=content["title"],
        seed=content["seed"],
        source=source,
        catalogue_file=catalogue_file,
        catalogue=_rows(source, read_catalogue(catalogue_file), motions.get("use")),
        processing=tuple(motions.get("processing", ())),
        building_file=building_file,
        building=None if building_file is None else read_building(building_file),
        specimens_file=specimens_file,
        configurations_file=configurations_file,
        specimens=specimens,
        configurations=_chosen(source, known, bodies.get("use")),
        amplitudes=amplitudes,
        protocol_step_percent=float(content["protocol"]["step_percent"]),
        fragility=FragilitySettings(
            measures=tuple(content["fragility"]["measures"]),
            confidence=content["fragility"]["confidence"],
        ),
        compare_with=content.get("compare_with"),
        more=supplementary_from(content, source),
    )


def _file(source: Path, key: str, name: str) -> Path:
    path = Path(os.path.normpath(source.parent / name))
    if not path.is_file():
        raise InputError(f"{source}: key {key}: expected an existing file, found no {path}.")
    return path


def _rows(source: Path, table: pd.DataFrame, names: Sequence[str] | None) -> pd.DataFrame:
    if names is None:
        return table
    known = list(table["name"])
    for i, name in enumerate(names):
        if name not in known:
            raise InputError(
                f"{source}: key motions.use[{i}]: expected one of the motions {', '.join(known)}, "
                f"found {name}."
            )
    return table.set_index("name", drop=False).loc[list(names)].reset_index(drop=True)


def _chosen(
    source: Path, known: Sequence[Configuration], names: Sequence[str] | None
) -> tuple[Configuration, ...]:
    if names is None:
        return tuple(known)
    by_name = {one.name: one for one in known}
    for i, name in enumerate(names):
        if name not in by_name:
            raise InputError(
                f"{source}: key bodies.use[{i}]: expected one of the configurations "
                f"{', '.join(by_name)}, found {name}."
            )
    return tuple(by_name[name] for name in names)
