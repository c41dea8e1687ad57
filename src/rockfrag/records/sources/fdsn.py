"""Motions from an FDSN service through ObsPy's client."""

import re

import numpy as np
from obspy import UTCDateTime

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

_REQUEST = re.compile(
    r"^(?P<client>\S+)\s+(?P<network>\w+)\.(?P<station>\w+)\.(?P<location>\w*)\.(?P<channel>\w+)"
    r"\s+(?P<start>\S+)\s+(?P<end>\S+)$"
)


def read_fdsn(request: str) -> Motion:
    """Fetch one channel and remove its response to acceleration.

    Parameters
    ----------
    request
        ``CLIENT NET.STA.LOC.CHA START END`` with a client name that ObsPy knows and times in UTC,
        for instance ``NCEDC BK.CMB.00.HNE 2014-08-24T10:20:14 2014-08-24T10:22:44``.

    Raises
    ------
    InputError
        If the request is not of that form, the service does not answer, or the data have gaps.
    """
    match = _REQUEST.match(request.strip())
    if match is None:
        raise InputError(
            f"FDSN request {request!r} is not of the form 'CLIENT NET.STA.LOC.CHA START END'."
        )
    try:
        start, end = UTCDateTime(match["start"]), UTCDateTime(match["end"])
    except Exception as error:  # UTCDateTime raises several kinds
        raise InputError(f"FDSN request {request!r}: a time is not readable.") from error
    # imported here: the client is slow to import and only this source needs it
    from obspy.clients.fdsn import Client

    try:
        stream = Client(match["client"]).get_waveforms(
            match["network"],
            match["station"],
            match["location"] or "--",
            match["channel"],
            start,
            end,
            attach_response=True,
        )
        stream.merge(method=-1)
        stream.remove_response(output="ACC", water_level=60.0, zero_mean=True, taper=False)
    except Exception as error:  # network, service and evalresp each raise their own kinds
        raise InputError(
            f"FDSN request {request!r}: no data came ({' '.join(str(error).split())}); without "
            "network use a file and its StationXML."
        ) from error
    if len(stream) != 1:
        raise InputError(
            f"FDSN request {request!r}: {len(stream)} pieces came; the data have gaps."
        )
    trace = stream[0]
    return Motion(
        acceleration=np.asarray(trace.data, dtype=np.float64),
        dt=float(trace.stats.delta),
        name=trace.id,
        metadata={
            "network": trace.stats.network,
            "station": trace.stats.station,
            "location": trace.stats.location,
            "channel": trace.stats.channel,
            "start_time": str(trace.stats.starttime),
            "format": "FDSN",
            "unit": "m/s2",
        },
        provenance=(
            {"step": "read", "request": request, "format": "FDSN", "unit": "m/s2"},
            {"step": "remove response", "output": "acceleration", "water_level_db": 60.0},
        ),
    )
