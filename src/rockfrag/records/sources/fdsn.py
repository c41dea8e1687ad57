"""Records from an FDSN service through ObsPy's client, kept as MiniSEED and StationXML."""

import hashlib
import itertools
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from obspy import UTCDateTime

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of, whole_file, write_text

if TYPE_CHECKING:
    from obspy.clients.fdsn import Client

_REQUEST = re.compile(
    r"^(?P<client>\S+)\s+(?P<network>[\w*?]+)\.(?P<station>[\w*?]+)\.(?P<location>[\w*?-]*)\."
    r"(?P<channel>[\w*?]+)\s+(?P<rest>\S.*)$"
)
_WINDOW = re.compile(
    r"^(?P<earthquake>\S+)\s+(?P<before>[+-]\d+(?:\.\d+)?)\s+(?P<after>[+-]\d+(?:\.\d+)?)$"
)
RECORDS, STATIONS, FACTS = "records.mseed", "stations.xml", "request.json"
"""Names of the three files that a request leaves; the last is written when the others are whole."""


@dataclass(frozen=True)
class FdsnRequest:
    """What is asked of a service; codes may have the wildcards ``*`` and ``?``.

    The window is either from one time to another or, with ``earthquake``, from second to second about its origin.
    """

    client: str
    codes: Mapping[str, str]  # ``network``, ``station``, ``location`` and ``channel``
    begin: UTCDateTime | float
    end: UTCDateTime | float
    earthquake: str = ""


def parse_request(words: str) -> FdsnRequest:
    """Read ``CLIENT NET.STA.LOC.CHA START END`` or ``CLIENT NET.STA.LOC.CHA EVENT -30 +120``.

    For instance ``NCEDC BK.CMB.00.HNE 2014-08-24T10:20:14 2014-08-24T10:22:44`` or ``NCEDC
    BK.CMB.*.HN? nc72282711 -10 +120``; times are UTC, an earthquake is the service's identifier.
    """
    match = _REQUEST.match(words.strip())
    if match is None:
        raise InputError(
            f"FDSN request {words!r} is not of the form 'CLIENT NET.STA.LOC.CHA START END' or "
            "'CLIENT NET.STA.LOC.CHA EVENT -30 +120'."
        )
    window, times = _WINDOW.match(match["rest"]), match["rest"].split()
    if window is None and len(times) != 2:
        raise InputError(
            f"FDSN request {words!r}: expected START and END, or EVENT -30 +120."
        )
    try:
        limits = (
            map(float, window.group("before", "after"))
            if window
            else map(UTCDateTime, times)
        )
        begin, end = limits
    except Exception as error:  # UTCDateTime raises several kinds
        raise InputError(f"FDSN request {words!r}: a time is not readable.") from error
    if end <= begin:
        raise InputError(f"FDSN request {words!r}: the window ends before it begins.")
    codes = {
        name: match[name] for name in ("network", "station", "location", "channel")
    }
    earthquake = window["earthquake"] if window else ""
    return FdsnRequest(match["client"], codes, begin, end, earthquake)


def fetch_fdsn(words: str, records: Path) -> Path:
    """Put what a request gives into ``records/fdsn/…``, if it is not there, and return the MiniSEED file.

    Parameters
    ----------
    words
        Data centre, channels and times, as a catalogue names them.
    records
        Folder of fetched records.

    Returns
    -------
    Path
        Of the MiniSEED file; its StationXML lies beside it.
    """
    request = parse_request(words)
    digest = hashlib.sha256(" ".join(words.split()).encode()).hexdigest()[:12]
    place = f"{request.codes['network']}.{request.codes['station']}-{digest}"
    folder = Path(records) / "fdsn" / re.sub("[*?]", "_", place)
    found, stations = folder / RECORDS, folder / STATIONS
    by_hand = found.is_file() and stations.is_file() and not (folder / FACTS).exists()
    if by_hand or _answered(folder):
        return found
    try:
        # imported here: the client is slow to import and only this source needs it
        from obspy.clients.fdsn import Client

        client = Client(request.client)
        start, end, facts = _window(request, client)
        asked = {**request.codes, "starttime": start, "endtime": end}
        asked["location"] = asked["location"] or "--"
        stream = client.get_waveforms(**asked)
        if not stream:
            raise InputError(
                f"FDSN request {words!r}: the service has no records of it."
            )
        inventory = client.get_stations(**asked, level="response")
        with whole_file(stations) as part:
            inventory.write(str(part), format="STATIONXML")
        with whole_file(found) as part:
            stream.write(str(part), format="MSEED")
        digests = {RECORDS: sha256_of(found), STATIONS: sha256_of(stations)}
        text = (
            json.dumps({"request": words, **facts, "files": digests}, indent=2) + "\n"
        )
        write_text(text, folder / FACTS)
    except InputError:
        raise
    except Exception as error:  # network, service and disk each raise their own kinds
        raise InputError(
            f"FDSN request {words!r}: no data came ({' '.join(str(error).split())}); without network "
            f"put {RECORDS} and {STATIONS} into {folder}."
        ) from error
    return found


def _answered(folder: Path) -> bool:
    """Tell whether a folder has the whole answer to its request, with the bytes it came with."""
    try:
        listed = json.loads((folder / FACTS).read_text(encoding="utf-8"))["files"]
        return all(
            sha256_of(folder / name) == digest for name, digest in listed.items()
        )
    except (OSError, ValueError, KeyError, AttributeError, TypeError):
        return False


def _window(
    request: FdsnRequest, client: "Client"
) -> tuple[UTCDateTime, UTCDateTime, dict[str, str]]:
    """Begin and end of the window that is asked for, and what is known of its earthquake.

    Without an earthquake both are instants; with one they count from its origin time.
    """
    if not request.earthquake:
        return request.begin, request.end, {}
    earthquake = client.get_events(eventid=request.earthquake)[0]
    origin = earthquake.preferred_origin() or earthquake.origins[0]
    facts = {"earthquake": request.earthquake, "origin_time": str(origin.time)}
    magnitudes = filter(
        None, [earthquake.preferred_magnitude(), *earthquake.magnitudes]
    )
    for magnitude in itertools.islice(magnitudes, 1):
        facts["magnitude"] = str(magnitude.mag)
    return origin.time + request.begin, origin.time + request.end, facts
