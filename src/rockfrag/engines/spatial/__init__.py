"""One rigid body in space under one to three components of the ground's motion (``docs/space.md``)."""

from rockfrag.engines.spatial.engine import SpatialEngine, SpatialResponse, run_in_space

__all__ = ["SpatialEngine", "SpatialResponse", "run_in_space"]
