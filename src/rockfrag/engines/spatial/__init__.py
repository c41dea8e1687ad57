"""One rigid body in space under one to three components of the ground's motion (``docs/space.md``)."""

from rockfrag.engines.spatial.engine import (
    SpatialEngine,
    SpatialResponse,
    run_in_space,
    simulate_in_space,
)
from rockfrag.engines.spatial.robustness import flip_rate, spread_vertices

__all__ = [
    "SpatialEngine",
    "SpatialResponse",
    "flip_rate",
    "run_in_space",
    "simulate_in_space",
    "spread_vertices",
]
