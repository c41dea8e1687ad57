"""What studies of every kind say: their heading, files that lie beside them, lists of processing steps.

In: a checked configuration. Out: paths that exist, steps that are known. Docs: ``config/README.md``.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.files import is_file

Steps = tuple[Mapping[str, Any], ...]


@dataclass(frozen=True)
class Heading:
    """Folder under ``results/``, heading of the report, seed of all random numbers, configuration file."""

    name: str
    title: str
    seed: int
    source: Path


def heading_of(content: Mapping[str, Any], source: Path) -> dict[str, Any]:
    """Return the fields of :class:`Heading` of a configuration that was read from ``source``."""
    named = {
        "name": content["study"],
        "title": content["title"],
        "seed": content["seed"],
    }
    return {**named, "source": source}


def beside(source: Path, name: str) -> Path:
    """Path of a file that a configuration names relative to itself."""
    return Path(os.path.normpath(source.parent / name))


def existing_file(source: Path, key: str, name: str) -> Path:
    """Path of a file that exists, which a configuration names under ``key`` relative to itself."""
    path = beside(source, name)
    check_file(path, f"{source}: key {key}")
    return path


def check_file(path: Path, where: str) -> None:
    """Check that a file exists; messages begin with ``where``."""
    if not is_file(path):
        raise InputError(f"{where}: expected an existing file, found no {path}.")


def checked_steps(source: Path, key: str, steps: Sequence[Mapping[str, Any]]) -> Steps:
    """Return the steps that a configuration lists under ``key``; each step and parameter must be known."""
    if steps:
        # the steps need SciPy and ObsPy, which a study without any need not wait for
        from rockfrag.motions.processing import check_steps

        with errors_of(f"{source}: key {key}"):
            check_steps(steps)
    return tuple(steps)
