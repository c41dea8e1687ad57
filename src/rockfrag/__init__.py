"""Rocking and overturning of free-standing objects in earthquakes.

>>> from rockfrag import Block, Stack, simulate, overturns, read_motion
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion
    from rockfrag.records.reading import read_motion
    from rockfrag.rocking.bodies import Block, Stack
    from rockfrag.rocking.ensemble import EnsembleResult, overturns
    from rockfrag.rocking.response import Response
    from rockfrag.rocking.simulation import simulate

__all__ = [
    "Block",
    "EnsembleResult",
    "Motion",
    "Response",
    "Stack",
    "overturns",
    "read_motion",
    "simulate",
]

_HOMES = {
    "Block": "rockfrag.rocking.bodies",
    "EnsembleResult": "rockfrag.rocking.ensemble",
    "Motion": "rockfrag.records.motion",
    "Response": "rockfrag.rocking.response",
    "Stack": "rockfrag.rocking.bodies",
    "overturns": "rockfrag.rocking.ensemble",
    "read_motion": "rockfrag.records.reading",
    "simulate": "rockfrag.rocking.simulation",
}


def __getattr__(name: str) -> Any:
    # loaded when first used: reading needs ObsPy and simulating needs numba, a second each
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'rockfrag' has no attribute {name!r}")
