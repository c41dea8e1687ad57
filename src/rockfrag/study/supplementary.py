"""What a study may ask for beyond its tests: a shaker, measured tests."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockfrag.shaketable.settings import read_shaker
from rockfrag.shaketable.shaker import Shaker
from rockfrag.study.paths import existing_file


@dataclass(frozen=True)
class Supplementary:
    """Optional parts of a study; each is None where the configuration does not ask for it."""

    # A shaking table whose limits are read beside the unlimited protocol, and its YAML file
    shaker_file: Path | None = None
    shaker: Shaker | None = None
    # CSV file of a laboratory's tests, which go through the same statistics
    measured_tests: Path | None = None


def supplementary_from(content: Mapping[str, Any], source: Path) -> Supplementary:
    """Take the optional parts out of a study's configuration, which has passed its schema."""
    shaker_file = _file(source, "shaker", content.get("shaker"))
    return Supplementary(
        shaker_file=shaker_file,
        shaker=None if shaker_file is None else read_shaker(shaker_file),
        measured_tests=_file(source, "measured_tests", content.get("measured_tests")),
    )


def _file(source: Path, key: str, name: str | None) -> Path | None:
    return None if name is None else existing_file(source, key, name)
