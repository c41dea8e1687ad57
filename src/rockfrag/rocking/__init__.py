"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from importlib import import_module
from typing import Any

import lazy_loader

_find, _, _own = lazy_loader.attach_stub(__name__, __file__)
_SYSTEM = ("Block", "Body", "Column", "Shape", "Stack", "read_shape")
"""What is shaken, which those who shake it need too."""

__all__ = [*_own, *_SYSTEM]


def __dir__() -> list[str]:
    """Names that `help` and completion show, though they are loaded only when used."""
    return sorted(__all__)


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    return getattr(import_module("rockfrag.system"), name) if name in _SYSTEM else _find(name)
