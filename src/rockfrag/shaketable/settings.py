"""Shakers from YAML or mappings, refused with one sentence where they make no sense."""

import os
from typing import Any

from rockfrag.errors import InputError
from rockfrag.schema import checked
from rockfrag.shaketable.shaker import Shaker
from rockfrag.yaml_file import read_yaml

_FIELDS = {
    "stroke_m": "stroke",
    "force_n": "force",
    "lowest_hz": "lowest_hz",
    "highest_hz": "highest_hz",
    "start": "start",
    "armature_mass_kg": "armature_mass",
    "table_mass_kg": "table_mass",
    "velocity_m_s": "velocity",
}


def read_shaker(path: str | os.PathLike[str]) -> Shaker:
    """Read a shaker from a YAML file such as ``config/experiment/shaker.yaml``.

    Parameters
    ----------
    path
        Path of the YAML file.

    Returns
    -------
    The :class:`Shaker`.

    Raises
    ------
    InputError
        If the file is absent, is not YAML, or does not describe a shaker.
    """
    return make_shaker(read_yaml(path), str(path))


def make_shaker(settings: Any, source: str = "shaker") -> Shaker:
    """Make a shaker from a mapping with units in its keys, as the schema ``shaker`` has them."""
    values = checked(settings, "shaker", source)
    try:
        return Shaker(**{_FIELDS[key]: value for key, value in values.items()})
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
