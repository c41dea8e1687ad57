"""Lists of processing steps in a configuration."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError

Steps = tuple[Mapping[str, Any], ...]


def checked_steps(source: Path, key: str, steps: Sequence[Mapping[str, Any]]) -> Steps:
    """Return the steps that a configuration lists under ``key``; each step and parameter must be known."""
    if steps:
        # the steps need SciPy and ObsPy, which a study without any need not wait for
        from rockfrag.motions.processing import check_steps

        try:
            check_steps(steps)
        except InputError as error:
            raise InputError(f"{source}: key {key}: {error}") from error
    return tuple(steps)
