"""An object that rocks in one plane, on edges: width and height are known, and no depth.

In: settings of a request. Out: an object (:mod:`rockfrag.assess.standing.contract`), sizes in m and kg. Docs:
``docs/assess.md``, "What is computed".
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from rockfrag.assess.assumed import assume
from rockfrag.assess.standing.contract import Foundation, Standing
from rockfrag.assess.standing.dimensions import (
    conserves_momentum,
    on_foundation,
    sizes_of,
)


class Planar(Standing):
    """An object that rocks in one plane, on edges."""

    @classmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Take what has a width."""
        return "width_m" in settings

    @classmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Make the object of its sizes."""
        sizes = sizes_of(settings)
        first = (assume("planar_base"), *conserves_momentum(settings), *sizes.assumed)
        under = on_foundation(under, sizes.block, first, sizes.quality_flags)
        return cls(sizes.block, sizes.plane, under)
