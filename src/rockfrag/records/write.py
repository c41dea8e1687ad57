"""Any motion as a file that other programs read."""

import os
import re
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from obspy import Inventory, Stream, Trace, UTCDateTime
from obspy.core.inventory import Channel, Network, Response, Station
from obspy.core.inventory.response import InstrumentSensitivity

from rockfrag.base.errors import InputError
from rockfrag.base.files import file_name, whole_file
from rockfrag.base.keywords import named_keywords
from rockfrag.records.formats import at2, opensees, plain, seismosoft
from rockfrag.records.motion import Motion, read_motion_set
from rockfrag.records.parsing.quantities import TO_SI, asked_unit

_USUAL_UNITS = {"AT2": "g", "SEISMOSOFT": "g"}


@named_keywords
def write_motion(
    motion: Motion,
    path: str | os.PathLike[str],
    format: str | None = None,
    unit: str | None = None,
) -> Path:
    """Write a motion, be it a record, processed, of a floor or synthetic, and return the path.

    Reading it back gives the same samples to 1e-15 of the largest, and the same interval.

    Parameters
    ----------
    motion : what to write
    path : the file; its folder is made
    format
        ``AT2`` (PEER), ``CSV``, ``SEISMOSOFT``, ``OPENSEES`` (a Tcl script with a Path series) or
        ``MSEED`` (float64, in m/s², with a StationXML file beside it that states the unit). None:
        as the ending of the path says (``.AT2``, ``.csv``, ``.dat``, ``.tcl``, ``.mseed``).
    unit : unit of the numbers in the file; g for AT2 and SeismoSoft and m/s² for the others if None

    Returns
    -------
    The path of the file.
    """
    name = _format(path, format)
    stored = asked_unit(unit) if unit is not None else _USUAL_UNITS.get(name, "m/s2")
    if name == "MSEED" and stored != "m/s2":
        raise InputError(
            f"{path}: MiniSEED is written in m/s2, not {unit}; leave unit= out."
        )
    try:
        facts = motion.metadata
        described = {
            **{
                key: facts.get(key)
                for key in ("network", "location", "channel", "start_time")
            },
            "unit": stored,
            "earthquake": str(facts.get("earthquake") or motion.name),
            "component": str(facts.get("component") or ""),
            "source": str(facts.get("source") or "rockfrag"),
        }
        header = {"delta": motion.dt, "station": str(facts.get("station") or "")}
        trace = Trace(
            motion.acceleration / TO_SI[stored], {**header, "rockfrag": described}
        )
        WRITERS[name][1](Stream([trace]), path)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be written ({error.strerror or error})."
        ) from error
    return Path(path)


def write_motions(
    motions: Iterable[Motion],
    folder: str | os.PathLike[str],
    format: str,
    unit: str | None = None,
) -> list[Path]:
    """Write each motion into a folder, named as the motion, and return the paths.

    Parameters
    ----------
    motions
        With names that differ.
    folder
        Made if it is not there.
    format
        A key of :data:`WRITERS`.
    unit
        In which numbers are written, else that of the format.

    Returns
    -------
    list
        Paths of the files, in order.
    """
    name = _format(folder, format)
    ending = WRITERS[name][0]
    paths: dict[Path, str] = {}
    for motion in motions:
        path = Path(folder) / f"{file_name(motion.name)}{ending}"
        if path in paths:
            raise InputError(
                f"{path}: {motion.name!r} and {paths[path]!r} would have one file."
            )
        write_motion(motion, path, name, unit)
        paths[path] = motion.name
    return list(paths)


def motions_of_study(path: str | os.PathLike[str]) -> list[Motion]:
    """Read the motions that a study keeps in a Parquet file, such as ``motions/floors.parquet``.

    Parameters
    ----------
    path
        Of the Parquet file.

    Returns
    -------
    list
        Motions in m/s².
    """
    try:
        return read_motion_set(path)
    except (OSError, ValueError, KeyError) as error:
        words = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: no motions of a study can be read from it ({words})."
        ) from None


def _format(path: str | os.PathLike[str], format: str | None) -> str:
    """Format to write, by its name or the ending of the file."""
    endings = {ending.lower(): name for name, (ending, _) in WRITERS.items()}
    name = (
        endings.get(Path(path).suffix.lower(), "") if format is None else format.upper()
    )
    if name not in WRITERS:
        what = f"{format!r} is" if format else f"the ending {Path(path).suffix!r} names"
        raise InputError(
            f"{path}: {what} no format that is written: {', '.join(WRITERS)}."
        )
    return name


def _write_mseed(stream: Stream, path: str | os.PathLike[str]) -> None:
    """Write float64 MiniSEED and, beside it, a StationXML whose sensitivity is one per m/s²."""
    stats = stream[0].stats
    facts = stats.rockfrag
    codes = {
        "network": _code(facts.get("network"), 2, "XX"),
        "station": _code(stats.station, 5, "MOTN"),
        "location": _code(facts.get("location"), 2, ""),
        "channel": _code(facts.get("channel"), 3, "HN1"),
    }
    start = UTCDateTime(str(facts.get("start_time") or "1970-01-01"))
    data = np.ascontiguousarray(stream[0].data, dtype=np.float64)
    trace = Trace(data, {**codes, "delta": stats.delta, "starttime": start})
    sensitivity = InstrumentSensitivity(1.0, 1.0, "M/S**2", "M/S**2")
    response = Response(instrument_sensitivity=sensitivity)
    # neither place nor depth is known
    channel = Channel(
        codes["channel"],
        codes["location"],
        latitude=0,
        longitude=0,
        elevation=0,
        depth=0,
        sample_rate=1 / stats.delta,
        response=response,
    )
    station = Station(codes["station"], 0, 0, 0, channels=[channel])
    inventory = Inventory([Network(codes["network"], [station])], source="rockfrag")
    with whole_file(Path(path).with_suffix(".xml")) as part:
        inventory.write(str(part), format="STATIONXML")
    with whole_file(path) as part:
        Stream([trace]).write(str(part), format="MSEED", encoding="FLOAT64")


def _code(words: object, longest: int, default: str) -> str:
    """Return a SEED code of letters and digits, the default where the facts have none that fits."""
    plain_code = re.sub(r"[^A-Z0-9]", "", str(words or "").upper())
    return plain_code if 0 < len(plain_code) <= longest else default


WRITERS: dict[str, tuple[str, Callable[..., None]]] = {
    "AT2": (".AT2", at2.write),
    "CSV": (".csv", plain.write),
    "SEISMOSOFT": (".dat", seismosoft.write),
    "OPENSEES": (".tcl", opensees.write),
    "MSEED": (".mseed", _write_mseed),
}
"""Ending and writer of each format that a motion can be written in."""
