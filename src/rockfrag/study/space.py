"""A study of bodies in space beside planar ones.

In: a checked configuration. Out: bodies with base and height [m], records of two components, amplitudes. Theory:
``docs/space.md``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.records.catalogue import own_records, read_catalogue
from rockfrag.records.files_beside import with_files_beside
from rockfrag.study.heading import Heading, existing_file, heading_of

SPACE_KEY = "space"  # key that only a study of bodies in space has


@dataclass(frozen=True)
class SpaceStudy(Heading):
    """Everything that the configuration of a study in space says, checked."""

    # Records of FEMA P-695 that shake the bodies: every one for 1, every second one for 2; None with a catalogue
    every: int | None
    catalogue_file: Path | None
    catalogue: pd.DataFrame | None  # a row for each pair of components
    # Bases by name, heights over the narrow side, and heights [m]
    bases: tuple[str, ...]
    slenderness: tuple[float, ...]
    heights_m: tuple[float, ...]
    sweep: Mapping[str, Any]  # Levels and directions, as the configuration gives them

    @property
    def bodies(self) -> list[tuple[str, float, float]]:
        """Base, height over the narrow side, and height [m] of every body."""
        return list(product(self.bases, self.slenderness, self.heights_m))

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        return f"{len(self.bodies)} bodies in space and in the plane"

    @property
    def files(self) -> list[str]:
        """Files that must be there before anything runs."""
        if self.catalogue_file is None or self.catalogue is None:
            return []
        own = own_records(
            self.catalogue, self.catalogue_file.parent, ("file", "second")
        )
        return [str(self.catalogue_file), *map(str, with_files_beside(own))]


def space_study_from(content: Mapping[str, Any], source: Path) -> SpaceStudy:
    """Make a study of bodies in space from a checked configuration that was read from ``source``."""
    space = content[SPACE_KEY]
    catalogue_file = None
    if "catalogue" in space:
        catalogue_file = existing_file(source, "space.catalogue", space["catalogue"])
    return SpaceStudy(
        **heading_of(content, source),
        every=space.get("every"),
        catalogue_file=catalogue_file,
        catalogue=None if catalogue_file is None else _pairs(catalogue_file),
        bases=tuple(space["bases"]),
        slenderness=tuple(map(float, space["slenderness"])),
        heights_m=tuple(map(float, space["heights_m"])),
        sweep={"base_spread": 0.0} | space,
    )


def _pairs(path: Path) -> pd.DataFrame:
    """Rows of a catalogue, one for each pair of components."""
    rows = read_catalogue(path)
    alone = rows["name"][rows["second"] == ""]
    if not alone.empty:
        raise InputError(
            f"{path}: motion {alone.iloc[0]} has no second component; name its file in the column second, "
            "or leave the motion out."
        )
    pairs = pd.Series(
        list(map(frozenset, zip(rows["file"], rows["second"], strict=True)))
    )
    return rows.loc[~pairs.duplicated()]
