"""Writing a record as text: one trace of a stream, checked, in the words of a format.

In goes a stream of ObsPy, whose ``stats.rockfrag`` has unit and facts; a format gives the function that makes the
text of what is :class:`Written`.
"""

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from obspy import Stream

from rockfrag.base.errors import InputError
from rockfrag.base.files import write_text
from rockfrag.records.parsing.quantities import TO_SI


@dataclass(frozen=True)
class Written:
    """One trace as a format writes it."""

    facts: Mapping[str, Any]  # of ObsPy's stats and stats.rockfrag
    samples: list[float]  # in the unit
    unit: str
    dt: float  # [s]

    def said(self, *keys: str, otherwise: str = "") -> str:
        """Return the first of some facts that is known, on one line."""
        known = (self.facts[key] for key in keys if self.facts.get(key))
        return " ".join(str(next(known, otherwise)).split())

    def rows(self, each: int) -> Iterator[list[float]]:
        """Yield samples, ``each`` of them a row."""
        for start in range(0, len(self.samples), each):
            yield self.samples[start : start + each]

    def timed(self) -> Iterator[tuple[str, float]]:
        """Yield the time of each sample [s], as it is written, and the sample."""
        for number, value in enumerate(self.samples):
            yield f"{number * self.dt:.12g}", value


def text_writer(
    text: Callable[[Written], str], with_unit: bool = True
) -> Callable[..., None]:
    """Return the function that writes one trace of a stream to a file, as ObsPy wants it.

    Parameters
    ----------
    text
        Gives the text of a trace.
    with_unit
        Whether the trace must state a unit of acceleration.

    Returns
    -------
    callable
        Takes a stream and the name of a file.
    """

    def write(stream: Stream, filename: str | os.PathLike[str], **_: Any) -> None:
        """Write one trace of a stream, whose unit must be known, as ObsPy's plugins do."""
        if len(stream) != 1:
            raise InputError(
                f"{filename}: a file holds one trace, not {len(stream)}; choose one."
            )
        stats, samples = stream[0].stats, np.asarray(stream[0].data, dtype=np.float64)
        if samples.size == 0 or not np.isfinite(samples).all():
            raise InputError(
                f"{filename}: a record needs at least one sample, and all of them finite."
            )
        facts = {
            **stats.get("rockfrag", {}),
            "station": stats.station,
            "channel": stats.channel,
        }
        unit = str(facts.get("unit") or "")
        if with_unit and unit not in TO_SI:
            raise InputError(
                f"{filename}: the trace does not state a unit of acceleration; set stats.rockfrag = "
                "{'unit': 'g'} (or 'cm/s2', 'm/s2', …) once it is known."
            )
        dt = float(f"{stats.delta:.12g}")
        write_text(text(Written(facts, samples.tolist(), unit, dt)), filename)

    return write
