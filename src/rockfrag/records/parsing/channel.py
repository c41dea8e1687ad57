"""What a reader of one format hands over: the channels of a file, samples read on demand."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Trace, UTCDateTime
from obspy.core import AttribDict

from rockfrag.errors import InputError
from rockfrag.plain_text import printable
from rockfrag.plausibility import LONGEST_STEP, SHORTEST_STEP

_FIRST, _LAST = UTCDateTime(1900, 1, 1), UTCDateTime(2100, 1, 1)


def cut_short_step(promised: int, found: int) -> dict[str, Any]:
    """Return the step of the provenance of a file with fewer samples than its header promises."""
    return {
        "step": "read a file that is cut short",
        "samples_promised": promised,
        "samples_read": found,
    }


@dataclass(frozen=True)
class Channel:
    """One acceleration history as a file stores it."""

    npts: int  # number of samples
    dt: float  # sampling interval [s]
    # gives the samples in the unit of the file, shape (npts,)
    samples: Callable[[], NDArray[np.float64]]
    unit: str = ""  # canonical unit (``g``, ``cm/s2``, …); empty if the file does not state it
    # time of the first sample, or None if the file does not state it; a time before 1900 or after
    # 2100 is a mistake of the header and counts as not stated
    start_time: UTCDateTime | None = None
    # network, station, location, code: the SEED names as far as the file has them; a station without
    # a code has its name here
    network: str = ""
    station: str = ""
    location: str = ""
    code: str = ""
    component: str = ""  # orientation as the file words it (``090``, ``N10E``, ``UP``)
    member: str = ""  # name of the file within an archive of several records, else empty
    # whether this is a raw recording, whose mean is the zero of the sensor and not motion
    raw: bool = False
    # more facts for the metadata: ``station_name``, ``earthquake``, ``title``, …
    details: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        # what a file says goes to terminals and tables, and may hold anything
        for name in ("network", "station", "location", "code", "component", "member"):
            object.__setattr__(self, name, printable(getattr(self, name)))
        shown = {k: printable(v) if isinstance(v, str) else v for k, v in self.details.items()}
        object.__setattr__(self, "details", shown)
        if self.start_time is not None and not _FIRST < self.start_time < _LAST:
            object.__setattr__(self, "start_time", None)

    def check(self, name: str) -> None:
        """Check that number of samples and interval can be those of a record; ``name`` is its file's."""
        if self.npts < 1:
            raise InputError(f"{name}: the header promises {self.npts} samples.")
        if not SHORTEST_STEP <= self.dt <= LONGEST_STEP:
            raise InputError(
                f"{name}: a sampling interval of {self.dt:g} s is none of a strong-motion record (from "
                f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s); mend the header, or give the true one with dt=."
            )

    @property
    def label(self) -> str:
        """Name to choose the channel by: its code, else its orientation, with its member if any."""
        return f"{self.member} {self.code or self.component}".strip()

    def trace(self, headonly: bool) -> Trace:
        """Return the channel as an ObsPy trace, what SEED names have no room for in ``stats.rockfrag``."""
        facts = {
            "unit": self.unit,
            "quantity": "acceleration",
            "component": self.component,
            "start_time_stated": self.start_time is not None,
            **{key: value for key, value in self.details.items() if value not in ("", None)},
        }
        header = {
            "network": self.network,
            "station": self.station,
            "location": self.location,
            "channel": self.label,
            "delta": self.dt,
            "npts": self.npts,
            "rockfrag": AttribDict(facts),
        }
        if self.start_time is not None:
            header["starttime"] = self.start_time
        if headonly:
            return Trace(header=header)
        return Trace(data=self.samples(), header=header)
