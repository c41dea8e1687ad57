"""Records that ObsPy reads itself: MiniSEED with StationXML, SAC, K-NET, EVT, SLIST, TSPAIR, SeismicHandler."""

import glob
import gzip
import math
import os
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import obspy
from numpy.typing import NDArray
from obspy import Inventory, Stream, Trace, read_inventory
from obspy.core.inventory import Response
from obspy.core.util.base import ENTRY_POINTS, buffered_load_entry_point

from rockfrag.base.errors import InputError
from rockfrag.records.parsing import text_file
from rockfrag.records.parsing.format import Channel, cut_short_step, head_lines
from rockfrag.records.parsing.number_fields import first_odd_row
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import MAX_BYTES, MAX_LINE, NotAcceleration
from rockfrag.records.parsing.time_column import GAP
from rockfrag.records.quality_flags import foreign_kind

_READ_BY_OBSPY = (
    "MSEED",
    "SAC",
    "KNET",
    "KINEMETRICS_EVT",
    "SLIST",
    "TSPAIR",
    "SH_ASC",
)
"""Formats left to ObsPy. Of its others PICKLE would run what a file says, GSE ends the process on a
damaged file, and the rest are of other fields."""

# whose ``calib`` turns counts into m/s²
_SCALED_FORMATS = frozenset({"KNET", "KINEMETRICS_EVT"})
_SAC_QUANTITIES = {6: "displacement", 7: "velocity"}
_WATER_LEVEL = 60.0

MOST_SAMPLES = 20_000_000  # of all channels of a file: a day at 200 Hz has 17 million
_SHOWN = 60


def obspy_channels(path: Path, cut_short: bool = False) -> tuple[str, list[Channel]]:
    """Return the format name and the channels of a file, ``.gz`` unpacked, by ObsPy's own readers.

    MiniSEED needs a StationXML file (``.xml``) in the same folder that describes its channels;
    without one the samples have no unit.
    """
    head = text_file.read_head(path)
    kind = foreign_kind(head)
    if kind:
        problem = NotAcceleration if "spectra" in kind else InputError
        raise problem(f"{path}: this is {kind}.")
    if (
        len(head) > MAX_LINE
        and b"\x00" not in head
        and b"\n" not in head
        and b"\r" not in head
    ):
        raise InputError(
            f"{path}, line 1: the line is longer than {MAX_LINE} characters, which no record format has."
        )
    with _unpacked(path) as plain:
        name = _format_of(plain)
        if not name:
            raise InputError(f"{path}{_unknown(path)}")
        stream = _stream(plain, name, path)
        if name == "MSEED":
            _check_whole_records(plain, path, cut_short)
    parts: dict[str, list[Trace]] = {}
    for trace in stream:
        parts.setdefault(trace.id, []).append(trace)
    return name, [
        _channel_of(several, name, path, cut_short) for several in parts.values()
    ]


def _channel_of(parts: list[Trace], name: str, path: Path, cut_short: bool) -> Channel:
    """Return the channel of the traces of one name; several are parts with a gap or an overlap between them."""
    if len(parts) == 1:
        return _channel(parts[0], name, path, cut_short)
    parts = sorted(parts, key=lambda trace: trace.stats.starttime)
    stats = parts[0].stats
    samples = np.asarray(parts[0].data, dtype=np.float64)
    return Channel(
        samples.size,
        float(stats.delta),
        samples,
        **{key: stats[key] for key in ("network", "station", "location")},
        start_time=stats.starttime,
        code=stats.channel,
        fault=_fault_between(parts),
    )


def _fault_between(parts: list[Trace]) -> str:
    """Return in words what keeps parts of a channel from being one series: the first gap or overlap."""
    rates = {float(trace.stats.sampling_rate) for trace in parts}
    name = f"channel {parts[0].id}"
    if len(rates) > 1:
        listed = ", ".join(f"{rate:g}" for rate in sorted(rates))
        return f"{name} has parts of {listed} samples a second; keep one of them"
    end, start = parts[0].stats.endtime, parts[1].stats.starttime
    apart = float(start - end)
    dt = float(parts[0].stats.delta)
    more = f", the first of {len(parts) - 1}" if len(parts) > 2 else ""
    if apart < GAP * dt:
        return f"{name} has parts that overlap and differ from {start} on{more}; keep one of them"
    return (
        f"{name} has a gap{more}: no samples for {apart:g} s from {end} on, where {round(apart / dt) - 1} are "
        "missing; fill it, or cut the file to one side of it"
    )


@contextmanager
def _unpacked(path: Path) -> Iterator[Path]:
    """Give the file itself, or what a ``.gz`` file holds, if that is no more than a record can have."""
    if path.suffix.lower() != ".gz":
        yield path
        return
    with tempfile.TemporaryDirectory(prefix="rockfrag.") as scratch:
        plain = Path(scratch) / path.stem
        try:
            problem = f"{path}: unpacks to more than {MAX_BYTES // 2**20} MiB."
            with gzip.open(path, "rb") as packed:
                text_file.copy_within(packed, plain, MAX_BYTES, problem)
        except (OSError, EOFError, zlib.error) as error:
            raise InputError(f"{path}: cannot be unpacked ({error}).") from None
        yield plain


def _format_of(path: Path) -> str:
    """Return the name of ObsPy's format that claims a file, or an empty string."""
    for name in _READ_BY_OBSPY:
        entry = ENTRY_POINTS["waveform"][name]
        group = f"obspy.plugin.waveform.{entry.name}"
        with suppress(Exception):  # a detector that fails has not detected its format
            if buffered_load_entry_point(entry.dist.name, group, "isFormat")(str(path)):
                return name
    return ""


def _unknown(path: Path) -> str:
    """Return what is wrong with a file that no format recognises."""
    lines = head_lines(path)
    odd = first_odd_row(lines)
    if odd is not None:
        return f", line {odd + 1}: not a row of numbers like those above; the file is damaged."
    first = next(filter(None, map(str.strip, lines)), "")
    seen = f"it begins with {first[:_SHOWN]!r}" if first else "it is no text"
    return (
        f": no known record format: {seen}, and no rows of numbers go on below to its end; plain text "
        "needs columns or rows of numbers, and words above them alone."
    )


def _stream(plain: Path, name: str, path: Path) -> Stream:
    """All traces of a file by ObsPy's reader of a format."""
    _check_size(plain, name, path)
    try:
        # ObsPy takes a name for a pattern; ours are names
        stream = obspy.read(glob.escape(str(plain)), format=name)
        stream.merge(method=-1)
    except Exception as error:  # every ObsPy reader raises its own kinds
        raise InputError(
            f"{path}: ObsPy cannot read it as {name} ({_one_line(error)}); it is cut short or damaged."
        ) from error
    if not stream or any(trace.stats.npts == 0 for trace in stream):
        raise InputError(f"{path}: the file has no samples; it is cut short.")
    return stream


def _check_size(plain: Path, name: str, path: Path) -> None:
    """Refuse more samples than memory should hold: packed, a few megabytes may be hundreds of millions."""
    count = 0
    with suppress(Exception):  # what is wrong is told where the samples are read
        heads = obspy.read(glob.escape(str(plain)), format=name, headonly=True)
        count = sum(int(trace.stats.npts) for trace in heads)
    if count > MOST_SAMPLES:
        raise InputError(
            f"{path}: {count:,} samples are more than the {MOST_SAMPLES:,} of a record; cut it to the earthquake."
        )


def _check_whole_records(plain: Path, path: Path, cut_short: bool) -> None:
    """Check that a MiniSEED file ends where a record of it does: ObsPy leaves a cut one out."""
    from obspy.io.mseed.util import get_record_information

    size, length = os.path.getsize(plain), 0
    # an unusual first record; ObsPy has read the file all the same
    with suppress(Exception):
        length = int(get_record_information(str(plain))["record_length"])
    if length and size % length and not cut_short:
        raise InputError(
            f"{path}: {size} bytes are no whole number of MiniSEED records of {length}; the file is cut short."
        )


def _scaled(
    trace: Trace, format_name: str, path: Path
) -> tuple[NDArray[np.float64], str, list[dict[str, Any]]]:
    """Samples of a trace, their unit, and the steps that gave it.

    Parameters
    ----------
    trace, format_name : of ObsPy
    path : of the file, beside which StationXML may lie

    Returns
    -------
    Samples, and ``m/s2`` with the step; counts without a unit or a step where nothing says it.
    """
    counts = np.asarray(trace.data, dtype=np.float64)
    if format_name in _SCALED_FORMATS:
        factor = float(trace.stats.calib)
        step = {"step": "scale counts", "m_s2_per_count": factor}
        return counts * factor, "m/s2", [step]
    if format_name == "MSEED":
        found = _inventory_for(trace, path)
        if found is not None:
            samples, step = _physical(trace, found[0], path)
            return samples, "m/s2", [{**step, "inventory": found[1]}]
    elif format_name == "SAC":
        quantity = _SAC_QUANTITIES.get(int(trace.stats.get("sac", {}).get("idep", 5)))
        if quantity is not None:
            raise NotAcceleration(
                f"{path}: its header says {quantity}, not acceleration."
            )
    return counts, "", []


def _channel(trace: Trace, format_name: str, path: Path, cut_short: bool) -> Channel:
    """A channel of a trace, its samples in the unit that the file states.

    Parameters
    ----------
    trace, format_name : as ObsPy has read it, and what it calls the format
    path : of the file
    cut_short : whether a file that ends early is wanted
    """
    stats = trace.stats
    if np.ma.is_masked(trace.data):
        raise InputError(f"{path}: channel {trace.id} has gaps or no samples.")
    steps: list[dict[str, Any]] = _shortness(trace, format_name, path, cut_short)
    samples, unit, scaling = _scaled(trace, format_name, path)
    steps += scaling
    if not np.isfinite(samples).all():
        raise InputError(
            f"{path}: channel {trace.id} has samples that are not finite numbers."
        )
    knet, earthquake = stats.get("knet", {}), {}
    if "evot" in knet:
        said = f"{knet['evot']} M {knet.get('mag', '?')}"
        earthquake = {"earthquake": said, "magnitude": knet.get("mag")}
    channel = Channel(
        npts=samples.size,
        dt=float(stats.delta),
        samples=samples,
        unit=unit,
        start_time=stats.starttime,
        **{key: stats[key] for key in ("network", "station", "location")},
        code=stats.channel,
        # MiniSEED of floating point has been computed: its mean is meant
        raw=not (format_name == "MSEED" and trace.data.dtype.kind == "f"),
        counts=not unit and trace.data.dtype.kind in "iu",
        details=earthquake,
        steps=tuple(steps),
    )
    channel.check(str(path))
    peak = StatedPeak(str(knet.get("accmax", "")), "gal")
    return with_checked_peak(channel, peak, str(path), cut_short)


def _shortness(
    trace: Trace, format_name: str, path: Path, cut_short: bool
) -> list[dict[str, Any]]:
    """Check K-NET's duration against its samples; return the note of a shorter file that is wanted.

    Parameters are those of :func:`_channel`; the note, a step of the provenance, is alone in the list, which is
    empty where nothing is missing.
    """
    duration = (
        trace.stats.get("knet", {}).get("duration") if format_name == "KNET" else None
    )
    if duration is None:
        return []
    product = float(duration) * float(trace.stats.sampling_rate)
    if not math.isfinite(product):
        raise InputError(
            f"{path}: its duration of {duration} s is no length; the file is damaged."
        )
    promised, found = round(product), int(trace.stats.npts)
    if found == promised or (cut_short and found < promised):
        return [] if found == promised else [cut_short_step(promised, found)]
    raise InputError(
        f"{path}: the header promises {promised} samples ({float(duration):g} s) but {found} follow; "
        "the file is cut short, or its header is wrong."
    )


@lru_cache(maxsize=256)
def _inventory(path: str, changed: int, size: int) -> Inventory:
    """Return a StationXML file; ``changed`` and ``size`` tell its versions apart."""
    return read_inventory(path, format="STATIONXML")


def _inventory_for(trace: Trace, path: Path) -> tuple[Response, str] | None:
    """Return the response in the StationXML beside a record that has its channel, and the name of that file."""
    for candidate in sorted(path.parent.glob("*.xml")):
        state = candidate.stat()
        # another kind of file, a broken one, or ObsPy's bare Exception for "no matching response"
        with suppress(Exception):
            inventory = _inventory(str(candidate), state.st_mtime_ns, state.st_size)
            response = inventory.get_response(trace.id, trace.stats.starttime)
            return response, candidate.name
    return None


def _physical(
    trace: Trace, response: Response, path: Path
) -> tuple[NDArray[np.float64], dict[str, Any]]:
    """Return acceleration [m/s²] of a trace of counts, and the step that made it.

    The response is taken off by its stages; without stages counts are divided by its sensitivity.
    """
    if response.response_stages:
        physical = trace.copy()
        physical.stats.response = response
        settings = {"water_level": _WATER_LEVEL, "zero_mean": True, "taper": False}
        try:
            physical.remove_response(output="ACC", **settings)
        except Exception as error:  # evalresp reports in many kinds
            raise InputError(
                f"{path}: the response of {trace.id} cannot be removed ({_one_line(error)})."
            ) from error
        step = {
            "step": "remove response",
            "output": "acceleration",
            "water_level_db": _WATER_LEVEL,
        }
        return np.asarray(physical.data, dtype=np.float64), step
    sensitivity = response.instrument_sensitivity
    if sensitivity is None or not sensitivity.value:
        raise InputError(
            f"{path}: its StationXML has neither stages nor a sensitivity."
        )
    if canonical_unit(str(sensitivity.input_units or "")) != "m/s2":
        raise InputError(
            f"{path}: its StationXML has no stages and a sensitivity in {sensitivity.input_units}, "
            "not M/S**2; get it with the level of the response."
        )
    value = float(sensitivity.value)
    step = {"step": "divide by sensitivity", "counts_per_m_s2": value}
    return np.asarray(trace.data, dtype=np.float64) / value, step


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__
