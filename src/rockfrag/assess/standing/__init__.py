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
from rockfrag.base.errors import InputError

__all__ = ["KINDS", "Standing", "make_standing", "options"]

KINDS: list[type[Standing]] = [Scanned, Round, Box, Planar]
"""Kinds of standing: the first that takes the settings makes the object."""


def options() -> dict[str, type[Standing]]:
    """Return the kinds that are asked for by a word, by that word."""
    return {kind.option: kind for kind in KINDS if kind.option}


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
    asked, known = settings.get("stands"), options()
    if asked is not None and asked not in known:
        words = (
            f"one of {', '.join(known)}"
            if known
            else "no such key, as no kind has a word"
        )
        raise InputError(f"key stands: expected {words}, found {asked[:40]!r}.")
    kind = next(kind for kind in KINDS if kind.takes(settings))
    found = kind.of(settings, folder, foundation_of(settings))
    found.check()
    return found
