"""What a reader of one format hands over: the channels of a file, samples read on demand."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Trace, UTCDateTime
from obspy.core import AttribDict


@dataclass(frozen=True)
class Channel:
    """One acceleration history as a file stores it.

    Attributes
    ----------
    npts
        Number of samples.
    dt
        Sampling interval [s].
    samples
        Gives the samples in the unit of the file, shape (npts,).
    unit
        Canonical unit (``g``, ``cm/s2``, …); empty if the file does not state it.
    start_time
        Time of the first sample, or None if the file does not state it.
    network, station, location, code
        The SEED names as far as the file has them; a station without a code has its name here.
    component
        Orientation as the file words it (``090``, ``N10E``, ``UP``).
    details
        More facts for the metadata: ``station_name``, ``event``, ``title``, …
    """

    npts: int
    dt: float
    samples: Callable[[], NDArray[np.float64]]
    unit: str = ""
    start_time: UTCDateTime | None = None
    network: str = ""
    station: str = ""
    location: str = ""
    code: str = ""
    component: str = ""
    details: Mapping[str, Any] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """Name to choose the channel by: its code, else its orientation."""
        return self.code or self.component

    def facts(self) -> dict[str, Any]:
        """Return the stated facts that SEED names have no room for."""
        facts: dict[str, Any] = {
            "unit": self.unit,
            "quantity": "acceleration",
            "component": self.component,
            "start_time_stated": self.start_time is not None,
        }
        facts.update({key: value for key, value in self.details.items() if value not in ("", None)})
        return facts

    def trace(self, headonly: bool) -> Trace:
        """Return the channel as an ObsPy trace, its other facts in ``stats.rockfrag``."""
        header = {
            "network": self.network,
            "station": self.station,
            "location": self.location,
            "channel": self.label,
            "delta": self.dt,
            "npts": self.npts,
            "rockfrag": AttribDict(self.facts()),
        }
        if self.start_time is not None:
            header["starttime"] = self.start_time
        if headonly:
            return Trace(header=header)
        return Trace(data=self.samples(), header=header)
