"""Files that a configuration names, relative to itself."""

import os
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.files import is_file


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
    check_file(path, f"{source}: key {key}")
    return path


def check_file(path: Path, where: str) -> None:
    """Check that a file exists and has a name that the workflow can use.

    Raises
    ------
    InputError
        Behind ``where``, what is wrong.
    """
    if not is_file(path):
        raise InputError(f"{where}: expected an existing file, found no {path}.")
    if set("{}") & set(str(path)):
        raise InputError(
            f"{where}: {path} has curly brackets in its name, which the workflow takes for wildcards; rename it."
        )
