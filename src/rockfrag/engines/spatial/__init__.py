"""One rigid body in space under one to three components of the ground's motion (``docs/space.md``)."""

from rockfrag.engines.built_in import SpatialEngine
from rockfrag.engines.spatial.engine import SpatialResponse

__all__ = ["SpatialEngine", "SpatialResponse"]
