"""Studies of somebody's tests: a campaign whose tests are simulated and compared, or a table with its measures.

In: a checked YAML file. Out: :class:`CampaignStudy` or :class:`MeasuredTable`. Docs: ``config/README.md``,
``docs/campaigns.md``.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from glob import escape, glob
from pathlib import Path
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.base.files import is_file
from rockfrag.base.tabular import read_table
from rockfrag.records.files_beside import with_files_beside
from rockfrag.study.heading import Heading, Steps, beside, checked_steps, heading_of
from rockfrag.study.holding import stated_alone

PULSE_MEASURES = ("pga_g", "pgv_over_pga_s")
"""Measures from which the motion of a commanded pulse follows."""

STEP_MEASURES = ("velocity_m_s", "distance_m")
"""Measures from which the jumps of a base that is hit and stopped follow."""

CAMPAIGN_KEY = "campaign"  # key that only a study of a campaign has


@dataclass(frozen=True)
class CampaignStudy(Heading):
    """Everything that the configuration of a campaign says, checked."""

    # Public files that are fetched if they are not there: address, SHA-256, and where each is kept
    fetch: tuple[tuple[str, str, Path], ...]
    # Table of tests, its columns, and a table of other programs' outcomes or None
    tests: Path
    columns: Mapping[str, str]
    other_codes: Path | None
    motions: str  # Where the table's motions are
    # Cycles of the cosine that the table was told to make, where ``motions`` is empty because PGA
    # and PGV/PGA of each test tell its motion; 0 for measured motions
    pulse_cycles: int
    # Whether the base was hit and stopped, as velocity and distance of each test tell
    is_stepped: bool
    # What the files of motions do not state: unit, step [s] and channel
    unstated: tuple[str | None, float | None, str | None]
    # Whether tests without a motion are left out; otherwise they are refused
    leave_out: bool
    # For each intensity measure the columns and numbers whose product it is; empty to measure the motions
    measures: Mapping[str, tuple[str | float, ...]]
    # Either ``mesh`` with its mass or density, or the planar block by hand, on those of
    # ``pedestal`` if any
    object: Mapping[str, Any]
    # Steps that each motion goes through, and other lists of steps by name that are tried beside
    conditioning: Steps
    varied_conditioning: Mapping[str, Steps]
    # Range of each thing that nobody measured
    unknowns: Mapping[str, tuple[float, float]]
    # Number of guesses, folds and divisions into folds, and the level of the intervals
    trials: int
    folds: int
    repeats: int
    confidence: float
    mesh: Path | None = field(default=None)

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        return f"the campaign {self.tests}, {self.trials} trials"

    @property
    def files(self) -> list[str]:
        """The user's files that it depends on, but for those to be fetched, whose digests it states."""
        from rockfrag.system.mesh_file import files_of_mesh

        fetched = {path for _, _, path in self.fetch}
        named = [self.tests, *self._motion_files()]
        named += [self.other_codes] if self.other_codes else []
        named += files_of_mesh(self.mesh) if self.mesh else []
        return [str(path) for path in named if path not in fetched]

    def _motion_files(self) -> list[Path]:
        """The archive of the table's motions, or the files of those that the table of tests names.

        Of a table that is still to be fetched these are all files whose names are of the pattern.
        """
        from rockfrag.campaign.laboratory import KEY, read_campaign

        if not self.motions or self.motions.endswith(".npz"):
            return [Path(self.motions)] if self.motions else []
        if self.tests in {path for _, _, path in self.fetch}:
            pattern = "*".join(map(escape, self.motions.split(KEY)))
            return with_files_beside(map(Path, sorted(glob(pattern))))
        tests = read_campaign(self.tests, self.columns, self.measures).tests
        names = dict.fromkeys(tests["motion"])
        return with_files_beside(
            Path(self.motions.replace(KEY, name)) for name in names
        )


def campaign_from(content: Mapping[str, Any], source: Path) -> CampaignStudy:
    """Make the study of a campaign from a checked configuration that was read from ``source``."""
    campaign, thing = content[CAMPAIGN_KEY], content["object"]
    fetch = tuple(
        (wanted["url"], wanted["sha256"], _kept(source, i, wanted["file"]))
        for i, wanted in enumerate(content.get("fetch", ()))
    )
    fetched = {path for _, _, path in fetch}

    def existing(key: str, name: str) -> Path:
        """Path of a file beside the study, which is there or will be fetched."""
        path = beside(source, name)
        if not is_file(path) and path not in fetched:
            raise InputError(
                f"{source}: key {key}: there is no {path}; put the file there, name yours, or give its address "
                "and digest under fetch."
            )
        return path

    _check_unknowns(content, source)
    if (alone := stated_alone(thing.get("held", {}))) is not None:
        raise InputError("{}: key object.held.{}: {}.".format(source, *alone))
    conditioning = checked_steps(
        source, "conditioning", content.get("conditioning", ())
    )
    varied = {
        name: checked_steps(source, f"varied_conditioning.{name}", steps)
        for name, steps in content.get("varied_conditioning", {}).items()
    }
    motions, pulse_cycles, is_stepped = _motions_of(campaign["motions"], source)
    if motions.endswith(".npz"):
        existing("campaign.motions", campaign["motions"])
    other, mesh = campaign.get("other_codes"), thing.get("mesh")
    return CampaignStudy(
        **heading_of(content, source),
        fetch=fetch,
        tests=existing("campaign.tests", campaign["tests"]),
        columns=dict(campaign["columns"]),
        other_codes=None if other is None else existing("campaign.other_codes", other),
        motions=motions,
        pulse_cycles=pulse_cycles,
        is_stepped=is_stepped,
        unstated=(campaign.get("unit"), campaign.get("dt_s"), campaign.get("channel")),
        leave_out=campaign.get("without_motion", "refuse") == "leave_out",
        measures={
            name: tuple(value) for name, value in campaign.get("measures", {}).items()
        },
        object=thing,
        conditioning=conditioning,
        varied_conditioning=varied,
        unknowns={
            key: (float(low), float(high))
            for key, (low, high) in content["unknowns"].items()
        },
        trials=content["trials"],
        folds=content.get("folds", 5),
        repeats=content.get("repeats", 20),
        confidence=content.get("confidence", 0.9),
        mesh=None if mesh is None else existing("object.mesh", mesh),
    )


def _check_unknowns(content: Mapping[str, Any], source: Path) -> None:
    """Refuse ranges of unknowns that end before they begin, and an unknown ``size`` that a mesh fixes."""
    for key, (low, high) in content["unknowns"].items():
        must_be_positive = key == "contact_tolerance_mm"
        above = ", above 0" if must_be_positive else ""
        if low > high or (must_be_positive and low <= 0):
            raise InputError(
                f"{source}: key unknowns.{key}: expected the lowest value first{above}, found [{low}, {high}]."
            )
    has_own_size = not {"mesh", "pedestal"}.isdisjoint(content["object"])
    if "size" in content["unknowns"] and has_own_size:
        raise InputError(
            f"{source}: key unknowns.size: is of a block by hand that stands alone; leave it out."
        )


def _motions_of(given: str | Mapping[str, Any], source: Path) -> tuple[str, int, bool]:
    """Path or pattern of the files of motions, cycles of pulses by formula, and whether the base's velocity jumps.

    The path is empty where motions are pulses or jumps, and cycles are 0 where they are not pulses.
    """
    if not isinstance(given, Mapping):
        return str(beside(source, given)), 0, False
    if "steps" in given:
        return "", 0, True
    return "", given.get("cycles", 1), False


def _kept(source: Path, number: int, name: str) -> Path:
    """Where a fetched file is kept: never outside of the folders of the configuration and of the run."""
    path = beside(source, name)
    place = Path(os.path.abspath(path))
    if not any(
        place.is_relative_to(os.path.abspath(home)) for home in (source.parent, ".")
    ):
        raise InputError(
            f"{source}: key fetch[{number}].file: {path} is outside of this folder; name a file in it."
        )
    return path


TABLE_KEY = "table"  # key that only a study of a measured table has


@dataclass(frozen=True)
class MeasuredTable(Heading):
    """Everything that the configuration of a measured table says, checked."""

    table: Path  # CSV with one row per test
    # For each intensity measure the columns and numbers whose product it is
    measures: Mapping[str, tuple[str | float, ...]]
    # Columns: ``overturned`` and, if any, ``motion``, ``earthquake`` and ``given``, a list of those
    # against which sufficiency is tested
    columns: Mapping[str, Any]
    confidence: float  # Level of the intervals
    replicates: int  # Number of bootstrap samples

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        return f"the table {self.table}"


def measured_table_from(content: Mapping[str, Any], source: Path) -> MeasuredTable:
    """Make a study of a measured table from a checked configuration that was read from ``source``."""
    table = beside(source, content[TABLE_KEY])
    if not is_file(table):
        raise InputError(
            f"{source}: key {TABLE_KEY}: there is no {table}; put a CSV file with one row per test "
            "there, or name yours."
        )
    _check_columns(source, table, content)
    return MeasuredTable(
        **heading_of(content, source),
        table=table,
        measures={
            name: tuple(factors) for name, factors in content["measures"].items()
        },
        columns=content["columns"],
        confidence=content["confidence"],
        replicates=content.get("replicates", 200),
    )


def _check_columns(source: Path, table: Path, content: Mapping[str, Any]) -> None:
    """Refuse columns that the table does not have."""
    header = read_table(table).titles
    columns = content["columns"]
    wanted = [
        *(
            (f"columns.{key}", columns.get(key))
            for key in ("overturned", "motion", "earthquake")
        ),
        *(
            (f"columns.given[{i}]", name)
            for i, name in enumerate(columns.get("given", ()))
        ),
    ]
    for measure, factors in content["measures"].items():
        wanted += [
            (f"measures.{measure}[{i}]", factor) for i, factor in enumerate(factors)
        ]
    for key, name in wanted:
        if isinstance(name, str) and name not in header:
            raise InputError(
                f"{source}: key {key}: expected a column of {table}, one of {', '.join(header)}, found {name}."
            )
