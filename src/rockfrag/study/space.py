"""A study of bodies in space beside planar ones."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rockfrag.rocking.space_sweep import Sweep
from rockfrag.schema import checked
from rockfrag.study.heading import Heading, heading_of

SPACE_KEY = "space"
"""Key that only a study of bodies in space has."""


@dataclass(frozen=True)
class SpaceStudy(Heading):
    """Everything that the configuration of a study in space says, checked."""

    # Records of FEMA P-695 that shake the bodies: every one for 1, every second one for 2
    every: int
    # Bases by name, heights over the narrow side, and heights [m]
    bases: tuple[str, ...]
    slenderness: tuple[float, ...]
    heights_m: tuple[float, ...]
    sweep: Sweep  # Levels and directions

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        count = len(self.bases) * len(self.slenderness) * len(self.heights_m)
        return f"{count} bodies in space and in the plane"

    @property
    def files(self) -> list[str]:
        """Files that must be there before anything runs: none."""
        return []


def space_study_from(content: Mapping[str, Any], path: str | os.PathLike[str]) -> SpaceStudy:
    """Make a study of bodies in space from a configuration that was read from ``path``."""
    content = checked(content, "space", str(path))
    space = content[SPACE_KEY]
    return SpaceStudy(
        **heading_of(content, path),
        every=space["every"],
        bases=tuple(space["bases"]),
        slenderness=tuple(float(value) for value in space["slenderness"]),
        heights_m=tuple(float(value) for value in space["heights_m"]),
        sweep=Sweep(
            lowest=float(space["lowest"]),
            highest=float(space["highest"]),
            levels=space["levels"],
            directions=space["directions"],
            resamples=space["resamples"],
            spread=float(space.get("base_spread", 0.0)),
        ),
    )
