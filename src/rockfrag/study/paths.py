"""Files that a configuration names, relative to itself."""

import os
from pathlib import Path

from rockfrag.errors import InputError


def existing_file(source: Path, key: str, name: str) -> Path:
    """Path of a file that a configuration names.

    Parameters
    ----------
    source
        The configuration file.
    key
        The key that names the file, for the message.
    name
        Path relative to the configuration.

    Raises
    ------
    InputError
        If there is no such file.
    """
    path = Path(os.path.normpath(source.parent / name))
    if not path.is_file():
        raise InputError(f"{source}: key {key}: expected an existing file, found no {path}.")
    return path
