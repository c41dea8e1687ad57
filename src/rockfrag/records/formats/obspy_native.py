"""Records that ObsPy reads itself: MiniSEED with StationXML, SAC, K-NET, Kinemetrics EVT."""

import glob
from pathlib import Path
from typing import Any

import numpy as np
import obspy
from numpy.typing import NDArray
from obspy import Inventory, Trace, read_inventory

from rockfrag.errors import InputError
from rockfrag.records.formats.plain import first_odd_row
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import head_lines
from rockfrag.records.parsing.text_file import HEAD_BYTES, MAX_LINE, check_unpacked, read_head

RECORDER_FORMATS = frozenset({"MSEED", "SAC", "KNET", "KINEMETRICS_EVT"})
"""Formats of raw recordings, whose mean is the zero of the sensor, gravity and tilt included."""

_SCALED_FORMATS = frozenset({"KNET", "KINEMETRICS_EVT"})
"""Formats whose ``calib`` turns counts into m/s²."""

_SAC_QUANTITIES = {6: "displacement", 7: "velocity"}
_WATER_LEVEL = 60.0


def obspy_channels(path: Path) -> tuple[str, list[Channel]]:
    """Return the format name and the channels of a file by ObsPy's own readers.

    MiniSEED needs a StationXML file (``.xml``) in the same folder that describes its channels;
    without one the samples have no unit.

    Raises
    ------
    InputError
        If ObsPy knows no format for the file or cannot read it, or it holds no acceleration.
    """
    head = read_head(path, HEAD_BYTES)
    if len(head) > MAX_LINE and b"\x00" not in head and b"\n" not in head and b"\r" not in head:
        raise InputError(
            f"{path}, line 1: the line is longer than {MAX_LINE} characters, "
            "which no record format has."
        )
    check_unpacked(path)
    try:
        # ObsPy takes a name for a pattern; ours are names
        stream = obspy.read(glob.escape(str(path)))
    except TypeError as error:
        if "Unknown format" not in str(error):
            raise InputError(f"{path}: cannot be read ({error}).") from error
        odd = first_odd_row(head_lines(path))
        if odd is not None:
            raise InputError(
                f"{path}, line {odd + 1}: not a row of numbers like those above; the file is damaged."
            ) from None
        raise InputError(
            f"{path}: no known record format; a plain text file needs one or two columns of "
            "numbers, or a first line with the number of samples and dt."
        ) from None
    except Exception as error:  # every ObsPy reader raises its own kinds
        raise InputError(f"{path}: ObsPy cannot read it ({_one_line(error)}).") from error
    if not stream:
        raise InputError(f"{path}: the file has no samples.")
    stream.merge(method=-1)
    name = str(stream[0].stats.get("_format", ""))
    return name, [_channel(trace, name, path) for trace in stream]


def _channel(trace: Trace, format_name: str, path: Path) -> Channel:
    stats = trace.stats
    if np.ma.is_masked(trace.data) or stats.npts == 0:
        raise InputError(f"{path}: channel {trace.id} has gaps or no samples.")
    details: dict[str, Any] = {}
    samples = np.asarray(trace.data, dtype=np.float64)
    unit = ""
    if format_name in _SCALED_FORMATS:
        samples, unit = samples * float(stats.calib), "m/s2"
        details["steps"] = ({"step": "scale counts", "m_s2_per_count": float(stats.calib)},)
    elif format_name == "MSEED":
        response = _inventory_for(trace, path)
        if response is not None:
            samples, unit = _without_response(trace, response[0], path), "m/s2"
            details["steps"] = (
                {
                    "step": "remove response",
                    "inventory": response[1],
                    "output": "acceleration",
                    "water_level_db": _WATER_LEVEL,
                },
            )
    elif format_name == "SAC":
        quantity = _SAC_QUANTITIES.get(int(stats.get("sac", {}).get("idep", 5)))
        if quantity is not None:
            raise InputError(f"{path}: its header says {quantity}, not acceleration.")
    if not np.isfinite(samples).all():
        raise InputError(f"{path}: channel {trace.id} has samples that are not finite numbers.")
    details |= _event_facts(trace)
    return Channel(
        npts=samples.size,
        dt=float(stats.delta),
        samples=lambda: samples,
        unit=unit,
        start_time=stats.starttime,
        network=stats.network,
        station=stats.station,
        location=stats.location,
        code=stats.channel,
        details=details,
    )


def _event_facts(trace: Trace) -> dict[str, Any]:
    knet = trace.stats.get("knet", {})
    facts: dict[str, Any] = {}
    if "evot" in knet:
        facts["event"] = f"{knet['evot']} M {knet.get('mag', '?')}"
        facts["magnitude"] = knet.get("mag")
    return facts


def _inventory_for(trace: Trace, path: Path) -> tuple[Inventory, str] | None:
    """Return the StationXML beside a record that describes its channel, and its name."""
    for candidate in sorted(path.parent.glob("*.xml")):
        try:
            inventory = read_inventory(str(candidate), format="STATIONXML")
        except Exception:  # an .xml file of another kind, or broken: not this record's
            continue
        try:
            inventory.get_response(trace.id, trace.stats.starttime)
        except Exception:  # ObsPy raises a bare Exception for "no matching response"
            continue
        return inventory, candidate.name
    return None


def _without_response(trace: Trace, inventory: Inventory, path: Path) -> NDArray[np.float64]:
    physical = trace.copy()
    try:
        physical.remove_response(
            inventory=inventory,
            output="ACC",
            water_level=_WATER_LEVEL,
            zero_mean=True,
            taper=False,
        )
    except Exception as error:  # evalresp reports in many kinds
        raise InputError(
            f"{path}: the response of {trace.id} cannot be removed ({_one_line(error)})."
        ) from error
    return np.asarray(physical.data, dtype=np.float64)


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__
