"""Arrays by what they hold, and the fields of records."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

Fields = list[tuple[str, Any, tuple[int, ...]]]


def fields(names: str, *shape: int, of: Any = np.float64) -> Fields:
    """Return fields of a record for ``np.dtype``, numbers or arrays of a shape, of one type each."""
    return [(name, of, shape) for name in names.split()]


def whole(names: str, *shape: int) -> Fields:
    """Return fields of a record likewise, of whole numbers."""
    return fields(names, *shape, of=np.int64)
