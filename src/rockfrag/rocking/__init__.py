"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from importlib import import_module
from typing import Any

import lazy_loader

_find, _, _own = lazy_loader.attach_stub(__name__, __file__)
_OTHERS = {
    **dict.fromkeys(("Block", "Body", "Column", "Shape", "Stack", "read_shape"), "system"),
    "Outcomes": "outcomes",
    "Response": "engines.response",
}
"""What is shaken and what comes out, which those who shake it need too, and their homes."""

__all__ = [*_own, *_OTHERS]


def __dir__() -> list[str]:
    """Names that `help` and completion show, though they are loaded only when used."""
    return sorted(__all__)


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used."""
    if name in _OTHERS:
        return getattr(import_module(f"rockfrag.{_OTHERS[name]}"), name)
    return _find(name)
