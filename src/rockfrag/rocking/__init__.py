"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.rocking.bodies import Block, Body, Stack
    from rockfrag.rocking.ensemble import EnsembleResult, overturns
    from rockfrag.rocking.history_streaming import stream_histories
    from rockfrag.rocking.response import Response
    from rockfrag.rocking.simulation import simulate
    from rockfrag.rocking.streaming import stream_overturns

__all__ = [
    "Block",
    "Body",
    "EnsembleResult",
    "Response",
    "Stack",
    "overturns",
    "simulate",
    "stream_histories",
    "stream_overturns",
]

__getattr__ = loader(
    __name__,
    {
        "Block": "rockfrag.rocking.bodies",
        "Body": "rockfrag.rocking.bodies",
        "Stack": "rockfrag.rocking.bodies",
        "EnsembleResult": "rockfrag.rocking.ensemble",
        "overturns": "rockfrag.rocking.ensemble",
        "Response": "rockfrag.rocking.response",
        "simulate": "rockfrag.rocking.simulation",
        "stream_histories": "rockfrag.rocking.history_streaming",
        "stream_overturns": "rockfrag.rocking.streaming",
    },
)
