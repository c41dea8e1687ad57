"""A study of a campaign on a shake table: every test simulated with its own motion, and compared."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError
from rockfrag.files import is_file
from rockfrag.study.heading import Heading, Steps, beside, checked_steps, heading_of

PULSE_MEASURES = ("pga_g", "pgv_over_pga_s")
"""Measures from which the motion of a commanded pulse follows."""

CAMPAIGN_KEY = "campaign"  # key that only a study of a campaign has


@dataclass(frozen=True)
class PublicFile:
    """A file that anybody can fetch: address, SHA-256, and where it is kept."""

    url: str
    sha256: str
    path: Path


@dataclass(frozen=True)
class CampaignStudy(Heading):
    """Everything that the configuration of a campaign says, checked."""

    fetch: tuple[PublicFile, ...]  # Public files that are fetched if they are not there
    # Table of tests, its columns, and a table of other programs' outcomes or None
    tests: Path
    columns: Mapping[str, str]
    other_codes: Path | None
    # Where the table's motions are, and what their files do not state
    motions: str
    # Cycles of the cosine that the table was told to make, where ``motions`` is empty because PGA
    # and PGV/PGA of each test tell its motion; 0 for measured motions
    pulse_cycles: int
    unit: str | None
    dt_s: float | None
    channel: str | None
    leave_out: bool  # Whether tests without a motion are left out; otherwise they are refused
    # For each intensity measure the columns and numbers whose product it is; empty to measure the motions
    measures: Mapping[str, tuple[str | float, ...]]
    # Either ``mesh`` with its mass or density, or the planar block by hand, on those of
    # ``pedestal`` if any
    object: Mapping[str, Any]
    # Steps that each motion goes through, and other lists of steps by name that are tried beside
    conditioning: Steps
    varied_conditioning: Mapping[str, Steps]
    unknowns: Mapping[str, tuple[float, float]]  # Range of each thing that nobody measured
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
        """Files that must be there before anything runs; those to be fetched are not among them."""
        named = (self.tests, self.other_codes, self.mesh)
        paths = [path for path in named if path is not None]
        paths += [Path(self.motions)] if self.motions.endswith(".npz") else []
        fetched = {source.path for source in self.fetch}
        return [str(path) for path in paths if path not in fetched]


def campaign_from(content: Mapping[str, Any], source: Path) -> CampaignStudy:
    """Make the study of a campaign from a checked configuration that was read from ``source``."""
    campaign, thing = content[CAMPAIGN_KEY], content["object"]
    fetch = tuple(
        PublicFile(wanted["url"], wanted["sha256"], _kept(source, i, wanted["file"]))
        for i, wanted in enumerate(content.get("fetch", ()))
    )
    fetched = {source.path for source in fetch}

    def existing(key: str, name: str) -> Path:
        path = beside(source, name)
        if not is_file(path) and path not in fetched:
            raise InputError(
                f"{source}: key {key}: there is no {path}; put the file there, name yours, or give its address "
                "and digest under fetch."
            )
        return path

    _check_object(source, thing, content["unknowns"])
    _check_columns(source, campaign["columns"], isinstance(campaign["motions"], Mapping))
    conditioning = checked_steps(source, "conditioning", content.get("conditioning", ()))
    varied = {
        name: checked_steps(source, f"varied_conditioning.{name}", steps)
        for name, steps in content.get("varied_conditioning", {}).items()
    }
    for key, (low, high) in content["unknowns"].items():
        if low > high or (key == "contact_tolerance_mm" and low <= 0):
            raise InputError(
                f"{source}: key unknowns.{key}: expected the lowest value first"
                f"{', above 0' if key == 'contact_tolerance_mm' else ''}, found [{low}, {high}]."
            )
    motions, pulse_cycles = "", 0
    if isinstance(campaign["motions"], Mapping):
        pulse_cycles = campaign["motions"].get("cycles", 1)
        _check_pulses(source, campaign)
    else:
        motions = str(beside(source, campaign["motions"]))
    if motions.endswith(".npz"):
        existing("campaign.motions", campaign["motions"])
    tests, other, mesh = campaign["tests"], campaign.get("other_codes"), thing.get("mesh")
    return CampaignStudy(
        **heading_of(content, source),
        fetch=fetch,
        tests=existing("campaign.tests", tests),
        columns=dict(campaign["columns"]),
        other_codes=None if other is None else existing("campaign.other_codes", other),
        motions=motions,
        pulse_cycles=pulse_cycles,
        **{key: campaign.get(key) for key in ("unit", "dt_s", "channel")},
        leave_out=campaign.get("without_motion", "refuse") == "leave_out",
        measures={name: tuple(value) for name, value in campaign.get("measures", {}).items()},
        object=thing,
        conditioning=conditioning,
        varied_conditioning=varied,
        unknowns={
            key: (float(low), float(high)) for key, (low, high) in content["unknowns"].items()
        },
        trials=content["trials"],
        folds=content.get("folds", 5),
        repeats=content.get("repeats", 20),
        confidence=content.get("confidence", 0.9),
        mesh=None if mesh is None else existing("object.mesh", mesh),
    )


def _kept(source: Path, number: int, name: str) -> Path:
    """Where a fetched file is kept: never outside of the folders of the configuration and of the run."""
    path = beside(source, name)
    place = Path(os.path.abspath(path))
    if not any(place.is_relative_to(os.path.abspath(home)) for home in (source.parent, ".")):
        raise InputError(
            f"{source}: key fetch[{number}].file: {path} is outside of this folder; name a file in it."
        )
    return path


_BY_HAND = ("left_m", "right_m", "cg_height_m", "height_m", "mass_kg", "inertia_kg_m2")
_OF_A_MESH = ("direction_deg", "contact_tolerance_mm")


def _check_object(source: Path, thing: Mapping[str, Any], unknowns: Mapping[str, Any]) -> None:
    where = f"{source}: key object"
    slides, bounces, piled = "friction" in unknowns, "restitution" in unknowns, "pedestal" in thing
    in_space = slides and "mesh" in thing
    if not (in_space or (slides != bounces and slides == piled)):
        raise InputError(
            f"{source}: key unknowns: expected the range of restitution, of a planar body, that of friction, of a "
            "mesh in space or an object on a pedestal, or both, of a mesh in space beside the planar body."
        )
    if "mesh" in thing:
        strange = [key for key in (*_BY_HAND, "pedestal") if key in thing and key != "mass_kg"]
        if strange:
            raise InputError(
                f"{where}: {strange[0]} is of an object by hand; leave it out beside a mesh."
            )
        if ("mass_kg" in thing) == ("density_kg_m3" in thing):
            raise InputError(f"{where}: give either mass_kg or density_kg_m3.")
        missing = [key for key in _OF_A_MESH if key not in unknowns]
        if missing:
            raise InputError(
                f"{source}: key unknowns: {missing[0]} is needed for a mesh; give its range."
            )
        return
    missing = [key for key in _BY_HAND if key not in thing]
    if missing:
        raise InputError(
            f"{where}: {missing[0]} is missing; without a mesh all of {', '.join(_BY_HAND)} are needed."
        )
    strange = [key for key in _OF_A_MESH if key in unknowns]
    if strange:
        raise InputError(
            f"{source}: key unknowns: {strange[0]} has a meaning for a mesh only; leave it out."
        )


def _check_pulses(source: Path, campaign: Mapping[str, Any]) -> None:
    """A commanded pulse follows from PGA and PGV/PGA of its test."""
    missing = [name for name in PULSE_MEASURES if name not in campaign.get("measures", {})]
    if missing:
        raise InputError(
            f"{source}: key campaign.measures: {missing[0]} is missing; a pulse follows from "
            f"{PULSE_MEASURES[0]} and {PULSE_MEASURES[1]} of each test."
        )
    needless = [key for key in ("unit", "dt_s", "channel", "without_motion") if key in campaign]
    if needless:
        raise InputError(
            f"{source}: key campaign.{needless[0]}: is of measured motions, and the motions here are pulses; "
            "leave it out."
        )


def _check_columns(source: Path, columns: Mapping[str, str], pulses: bool) -> None:
    if not pulses and "motion" not in columns:
        raise InputError(
            f"{source}: key campaign.columns.motion is missing; expected the column with the key or file name "
            "of the table's motion."
        )
    brackets = ("lower_g" in columns, "upper_g" in columns)
    if any(brackets) and not all(brackets):
        raise InputError(
            f"{source}: key campaign.columns: lower_g and upper_g belong together; give both."
        )
    if ("overturned" in columns) == all(brackets):
        raise InputError(
            f"{source}: key campaign.columns: give either overturned, an outcome per test, or lower_g and "
            "upper_g, between which the object overturned."
        )
