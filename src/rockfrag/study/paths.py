"""Files that a configuration names, relative to itself."""

import os
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.files import is_file


def existing_file(source: Path, key: str, name: str) -> Path:
    """Path of a file that exists, which a configuration names under ``key`` relative to itself."""
    path = Path(os.path.normpath(source.parent / name))
    check_file(path, f"{source}: key {key}")
    return path


def check_file(path: Path, where: str) -> None:
    """Check that a file exists and has a name that the workflow can use; messages begin with ``where``."""
    if not is_file(path):
        raise InputError(f"{where}: expected an existing file, found no {path}.")
    if set("{}") & set(str(path)):
        raise InputError(
            f"{where}: {path} has curly brackets in its name, which the workflow takes for wildcards; rename it."
        )
