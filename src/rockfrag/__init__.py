"""Rocking and overturning of free-standing objects in earthquakes.

>>> from rockfrag import Block, Stack, simulate, overturns, read_motion
"""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion
    from rockfrag.records.read import read_motion
    from rockfrag.rocking import (
        Block,
        EnsembleResult,
        Response,
        Stack,
        overturns,
        simulate,
    )

__version__ = "0.1.0"

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


def __dir__() -> list[str]:
    """Names that `help` and completion show, though they are loaded only when used."""
    return [*__all__, "__version__"]


__getattr__ = loader(
    __name__,
    {
        "Motion": "rockfrag.records.motion",
        "read_motion": "rockfrag.records.read",
        "Block": "rockfrag.system.blocks",
        "EnsembleResult": "rockfrag.rocking.ensemble",
        "Response": "rockfrag.rocking.response",
        "Stack": "rockfrag.system.blocks",
        "overturns": "rockfrag.rocking.ensemble",
        "simulate": "rockfrag.rocking.simulation",
    },
)
