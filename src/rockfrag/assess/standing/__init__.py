"""Kinds of standing, a file each: which one settings are of, and the object that they make."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rockfrag.assess.standing.box import Box
from rockfrag.assess.standing.contract import Standing
from rockfrag.assess.standing.dimensions import foundation_of
from rockfrag.assess.standing.planar import Planar
from rockfrag.assess.standing.rolling import Round
from rockfrag.assess.standing.scanned import Scanned

__all__ = ["KINDS", "Standing", "make_standing"]

KINDS: list[type[Standing]] = [Scanned, Round, Box, Planar]
"""Kinds of standing: the first that takes the settings makes the object."""


def make_standing(settings: Mapping[str, Any], folder: Path) -> Standing:
    """Make an object and what it stands on of checked keys of ``statue.yaml``.

    Parameters
    ----------
    settings : checked keys
    folder : from which paths in them are read

    Returns
    -------
    The object as it stands.
    """
    kind = next(kind for kind in KINDS if kind.takes(settings))
    found = kind.of(settings, folder, foundation_of(settings))
    found.check()
    return found
