"""What every study says of itself, of whatever kind it is."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Heading:
    """Folder under ``results/``, heading of the report, seed of all random numbers, configuration file."""

    name: str
    title: str
    seed: int
    source: Path


def heading_of(content: Mapping[str, Any], path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the fields of :class:`Heading` of a configuration that was read from ``path``."""
    named = {"name": content["study"], "title": content["title"], "seed": content["seed"]}
    return {**named, "source": Path(path)}
