"""A study: what its configuration says, read once, checked, and as the stages need it.

In: what :mod:`rockfrag.study.loading` has read. Out: amplitudes [g], jobs, names of files. Docs:
``config/README.md``.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.files import file_name
from rockfrag.base.plausible import size_warning
from rockfrag.building.model import ShearBuilding
from rockfrag.building.settings import read_building
from rockfrag.records.catalogue import own_records
from rockfrag.records.files_beside import with_files_beside
from rockfrag.records.sources.wheel import PROVENANCE, WHEELS
from rockfrag.shaketable.shaker import Shaker
from rockfrag.study.heading import Heading
from rockfrag.system.blocks import Block
from rockfrag.system.system import System

GROUND = "ground"  # label of the only floor of a study without a building
MOST_ROWS = 100_000
"""Most outcomes of a configuration that are kept as rows of a table; more are counted."""

HISTORIES_A_JOB = 1_000_000  # response histories of a job: minutes of one core
MOST_JOBS = 200
"""Most jobs of the IDA curves: what Snakemake plans in a second or two. A larger study has larger jobs."""

RECORDS_FOLDER = "resources/records"
"""Where fetched records are kept, from the folder in which the workflow runs."""


@dataclass(frozen=True)
class Amplitudes:
    """Peaks of the input motion from the lowest to the highest in steps of equal ratio."""

    # First amplitude and the one not to be exceeded [g]
    lowest_g: float
    highest_g: float
    step_percent: float  # Step from one to the next [%]

    def __post_init__(self) -> None:
        if self.highest_g <= self.lowest_g:
            raise InputError(
                f"key amplitudes.highest_g: expected more than lowest_g = {self.lowest_g}, "
                f"found {self.highest_g}."
            )

    @property
    def values_g(self) -> NDArray[np.float64]:
        """Amplitudes [g], shape (n,), increasing."""
        ratio = 1 + self.step_percent / 100
        steps = math.floor(
            math.log(self.highest_g / self.lowest_g) / math.log(ratio) + 1e-9
        )
        return np.asarray(self.lowest_g * ratio ** np.arange(steps + 1))


@dataclass(frozen=True)
class FragilitySettings:
    """How fragility is estimated: in which measures, and at which level the intervals are."""

    measures: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]
    confidence: float
    # Whether exported curves hold the errors of estimate and model beside the scatter of the motions
    model_error: bool = True


@dataclass(frozen=True)
class Study(Heading):
    """Everything that a study's configuration says, checked; see :mod:`rockfrag.study.loading`."""

    # Path of the table of motions, and its rows that are used, in order
    catalogue_file: Path
    catalogue: pd.DataFrame
    # Steps that each record goes through, in order
    processing: tuple[Mapping[str, Any], ...]
    # Path of the building whose floors are shaken; None for ground motions alone
    building_file: Path | None
    # Level of each floor that is shaken, by its label; 0 is the ground
    floors: Mapping[str, int]
    # Paths of the tables of bodies, the second None where each block stands alone, the third where nothing stands
    # on an isolator, and the blocks by name
    specimens_file: Path
    configurations_file: Path | None
    isolators_file: Path | None
    specimens: Mapping[str, Block]
    # What is tested, in order: systems whose bodies have the names of their blocks
    configurations: tuple[System, ...]
    amplitudes: Amplitudes  # Peaks of the input motion
    # By how much the laboratory raises the amplitude from one run to the next [%]
    protocol_step_percent: float
    fragility: FragilitySettings  # Settings of the fragility curves
    # Whether records that cannot be used are left out, and said to be, instead of ending the study
    keep_going: bool
    # Largest factor that the lowest amplitude may need, beyond which a motion is left out; infinite for any
    largest_factor: float
    slides: bool  # Whether friction is limited, so that bodies slide and fly
    vertical: bool  # Whether the vertical components of the records shake too
    # Format in which the motions of all floors are written too, or None
    write_motions: str | None
    # A shaking table whose limits are read beside the unlimited protocol, and its YAML file, or None
    shaker_file: Path | None
    shaker: Shaker | None
    # CSV file of a laboratory's tests, which go through the same statistics, or None
    measured_tests: Path | None
    # Name of the configuration with which one is compared, where that is not its object alone on the floor
    counterparts: Mapping[str, str] = field(default_factory=dict)
    # Settings of the plugins that it asks for, by name; see :mod:`rockfrag.config.plugins`
    added: Mapping[str, Any] = field(default_factory=dict)

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        return (
            f"{len(self.catalogue)} records, {len(self.floors)} floors, "
            f"{len(self.configurations)} configurations, {len(self.amplitudes.values_g)} amplitudes"
        )

    @property
    def histories(self) -> int:
        """Number of response histories of its IDA curves."""
        return self.ida_curves * len(self.amplitudes.values_g)

    @property
    def ida_curves(self) -> int:
        """Number of its IDA curves: configurations under motions."""
        return len(self.catalogue) * len(self.floors) * len(self.configurations)

    def quality_flags(self) -> list[str]:
        """Warnings about sizes that look as if they were in another unit."""
        sizes = (
            (name, block.width, block.height) for name, block in self.specimens.items()
        )
        flags = ((name, size_warning(*size)) for name, *size in sizes)
        return [
            f"{self.specimens_file}, {name}: {flag}." for name, flag in flags if flag
        ]

    @property
    def slenderness(self) -> dict[str, float]:
        """Height over width of each specimen by its name."""
        return {name: block.slenderness for name, block in self.specimens.items()}

    @property
    def has_pairs(self) -> bool:
        """Whether an arrangement is tested together with what it is compared with."""
        return bool(self.counterparts) or self.with_and_alone

    @property
    def with_and_alone(self) -> bool:
        """Whether an object is compared with itself alone on the floor, where nothing holds it."""
        lone = {
            system.names[-1]
            for system in self.configurations
            if system.count == 1 and not system.holding
        }
        return any(
            system.names[-1] in lone
            for system in self.configurations
            if system.count > 1 and system.name not in self.counterparts
        )

    @property
    def simulated_in_page(self) -> bool:
        """Whether the simulation in a page has the outcomes of any of its configurations."""
        from rockfrag.web import in_page

        return not self.vertical and any(map(in_page, self.configurations))

    @cached_property
    def building(self) -> ShearBuilding | None:
        """Building whose floors are shaken; None for ground motions alone.

        Most stages need the labels of its floors alone, so its modes are solved for when it is first asked for.
        """
        return None if self.building_file is None else read_building(self.building_file)

    @property
    def body_files(self) -> list[str]:
        """Paths of the tables of bodies, of configurations and of isolators."""
        named = (self.specimens_file, self.configurations_file, self.isolators_file)
        return [str(path) for path in named if path]

    @property
    def is_large(self) -> bool:
        """Whether the outcomes of a configuration are counted, as they are too many for a table in memory."""
        return self.histories > MOST_ROWS * len(self.configurations)

    @property
    def ida_jobs(self) -> int:
        """Number of jobs that share the motions of the IDA curves."""
        motions = len(self.catalogue) * len(self.floors)
        return max(
            1, min(math.ceil(self.histories / HISTORIES_A_JOB), MOST_JOBS, motions)
        )

    def ida_file(self, configuration: System, job: int | None = None) -> str:
        """Path of a configuration's IDA curve under the motions of a job; without one the pattern of all jobs."""
        part = "{part}" if job is None else f"{job:03d}"
        folder = "ida" if self.ida_jobs == 1 else f"ida/{part}"
        return f"{folder}/{file_name(configuration.name)}.parquet"

    @property
    def ida_files(self) -> list[str]:
        """Paths of all IDA curves."""
        return self.ida_files_of(self.configurations)

    def ida_files_of(self, configurations: Sequence[System]) -> list[str]:
        """Paths of the IDA curves of some configurations."""
        return [
            self.ida_file(configuration, job)
            for job in range(self.ida_jobs)
            for configuration in configurations
        ]

    @property
    def own_records(self) -> list[Path]:
        """Files of the user's own records."""
        return own_records(self.catalogue, self.catalogue_file.parent)

    @property
    def motion_files(self) -> list[str]:
        """Paths of files that motions depend on: catalogue, records with what they are read with, building."""
        # second components are measured even where no direction turns towards them
        columns = ("file", "second", *("vertical",) * self.vertical)
        own = own_records(self.catalogue, self.catalogue_file.parent, columns)
        files = [self.catalogue_file, *with_files_beside(own)]
        files += [self.building_file] if self.building_file else []
        return [str(path) for path in files]

    def fetched_records(self, records: str) -> list[str]:
        """Files under ``records`` that are there as soon as the records of pinned packages are."""
        wheels = self.catalogue["source"].isin(list(WHEELS))
        names = dict.fromkeys(self.catalogue["source"][wheels])
        return [f"{records}/{name}/{PROVENANCE}" for name in names]
