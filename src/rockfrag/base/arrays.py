"""Arrays by what they hold, and the fields of records."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

Fields = list[tuple[str, Any, tuple[int, ...]]]


def fields(names: str, *shape: int, of: Any = np.float64) -> Fields:
    """Return fields of a record for ``np.dtype``, numbers or arrays of a shape, of one type each.

    Parameters
    ----------
    names : of the fields, between blanks
    shape : of each field; a number without one
    of : type of each, as ``np.dtype`` takes it

    Returns
    -------
    A list of (name, type, shape), to be put among others into ``np.dtype``.
    """
    return [(name, of, shape) for name in names.split()]


def whole(names: str, *shape: int) -> Fields:
    """Return fields of a record likewise, of whole numbers.

    Parameters
    ----------
    names : of the fields, between blanks
    shape : of each field; a number without one

    Returns
    -------
    A list of (name, type, shape) as :func:`fields` returns it, of type int64.
    """
    return fields(names, *shape, of=np.int64)


def with_attributes(record: np.void) -> Any:
    """Return a record whose fields are attributes, as those of records are in kernels; it shares its memory.

    Parameters
    ----------
    record : of any type

    Returns
    -------
    The same record.
    """
    return np.asarray(record).reshape(1).view(np.recarray)[0]
