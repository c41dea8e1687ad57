"""Rigid blocks rocking: bodies, contact states, impacts, histories and ensembles."""

from typing import TYPE_CHECKING

from rockfrag._lazy import loader

if TYPE_CHECKING:
    from rockfrag.rocking.bodies import Block, Body, Stack
    from rockfrag.rocking.ensemble import EnsembleResult, overturns
    from rockfrag.rocking.parquet import stream_histories, stream_overturns
    from rockfrag.rocking.response import Response
    from rockfrag.rocking.simulation import simulate

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
        "stream_histories": "rockfrag.rocking.parquet",
        "stream_overturns": "rockfrag.rocking.parquet",
    },
)
