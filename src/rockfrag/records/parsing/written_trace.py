"""What every writer of a text format checks before it writes a trace."""

import os

import numpy as np
from numpy.typing import NDArray
from obspy import Stream, Trace

from rockfrag.errors import InputError
from rockfrag.records.parsing.quantities import TO_SI


def one_trace(
    stream: Stream, filename: str | os.PathLike[str]
) -> tuple[Trace, NDArray[np.float64]]:
    """Return the only trace of a stream and its samples, shape (n,)."""
    if len(stream) != 1:
        raise InputError(f"{filename}: a file holds one trace, not {len(stream)}; choose one.")
    samples = np.asarray(stream[0].data, dtype=np.float64)
    if samples.size == 0 or not np.isfinite(samples).all():
        raise InputError(f"{filename}: a record needs at least one sample, and all of them finite.")
    return stream[0], samples


def stated_unit(trace: Trace, filename: str | os.PathLike[str]) -> str:
    """Return the unit of acceleration that ``stats.rockfrag.unit`` states."""
    unit = str(trace.stats.get("rockfrag", {}).get("unit") or "")
    if unit not in TO_SI:
        raise InputError(
            f"{filename}: the trace does not state a unit of acceleration; set stats.rockfrag = "
            "{'unit': 'g'} (or 'cm/s2', 'm/s2', …) once it is known."
        )
    return unit
