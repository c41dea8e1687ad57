"""Any record as a :class:`Motion` in m/s²: unit, channel and zero level settled, not guessed."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of
from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.base.text_files import printable
from rockfrag.base.units import GRAVITY
from rockfrag.records.formats import HEADED, plain
from rockfrag.records.formats.obspy_native import obspy_channels
from rockfrag.records.motion import Motion
from rockfrag.records.parsing import directions, quantities
from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.peak_in_words import with_checked_peaks
from rockfrag.records.parsing.stated_peak import StatedPeak
from rockfrag.records.parsing.text_file import NotAcceleration, check_file
from rockfrag.records.quality_flags import STRONGEST_G
from rockfrag.records.sources.archive import is_archive, is_no_record, unpacked

FORMATS = (*HEADED, plain.FORMAT)  # those read here; ObsPy reads some others
# a mean within this fraction of g is the weight of the sensor's mass
_GRAVITY_FRACTION = 0.05

# fraction of an interval by which the user's may differ from the stated one
_SAME_STEP = 1e-9


@dataclass(frozen=True)
class Record:
    """The acceleration channels of one file, or of one member or all of an archive."""

    # path of the file, with ``#member`` where one member of an archive was asked for
    name: str
    format: str  # of those of an archive's members, joined by ``+``
    sha256: str  # of the file; of the archive for its members
    channels: tuple[Channel, ...]
    # members without acceleration, and why
    left_out: tuple[tuple[str, InputError], ...] = ()

    __repr__ = short_repr


def read_record(
    path: str | os.PathLike[str], dt: float | None = None, cut_short: bool = False
) -> Record:
    """Return what is in a file, before units are settled."""
    name, (file, mark, member) = str(path), str(path).partition("#")
    # a file whose own name has a # is that file
    if not (
        mark and not os.path.lexists(name) and os.path.isfile(file) and is_archive(file)
    ):
        file, member = name, ""
    check_file(file)
    if is_archive(file):
        return _archived(file, member, dt, cut_short)
    form, channels = _channels(Path(file), dt, cut_short)
    return Record(name, form, sha256_of(Path(file)), tuple(channels))


def read_untold(path: Path, dt: float | None) -> tuple[Record, float | None]:
    """Return what is in a file, and ``dt`` [s] if it was needed, as the file does not state its own.

    Parameters
    ----------
    path
        Of the file.
    dt
        Sampling interval that the user names for such files [s].

    Returns
    -------
    record : Record
        Its channels, before units are settled.
    dt : float or None
        The interval where the file needed it.
    """
    try:
        return read_record(path), None
    except InputError as error:
        if dt is None or isinstance(error, NotAcceleration):
            raise
    return read_record(path, dt), dt


def _channels(
    path: Path, dt: float | None, cut_short: bool
) -> tuple[str, list[Channel]]:
    """Format and channels of a file, by this package's readers or ObsPy's."""
    found = next((known for known in FORMATS if known.is_format(path)), None)
    if found is None:
        name, channels = obspy_channels(path, cut_short)
    else:
        name, channels = found.name, found.channels(path, dt, cut_short)
    if dt is not None and any(
        abs(channel.dt - dt) > _SAME_STEP * dt for channel in channels
    ):
        raise InputError(
            f"{path}: the file states dt = {channels[0].dt:g} s, not {dt:g} s; leave dt= out."
        )
    return name, channels


def _archived(file: str, wanted: str, dt: float | None, cut_short: bool) -> Record:
    """Read one member of an archive, or all that hold acceleration.

    Parameters
    ----------
    file : the archive
    wanted : path or name of the one member; empty for all
    dt : sampling interval of members that state none [s]
    cut_short : whether a member that ends early is wanted
    """
    channels: list[Channel] = []
    forms: set[str] = set()
    left_out: list[tuple[str, InputError]] = []
    with unpacked(file) as members:
        chosen = [m for m in members if wanted in (m.name, Path(m.name).name)]
        if wanted and len(chosen) != 1:
            raise InputError(
                f"{file}: {'no member is' if not chosen else 'several members are'} called "
                f"{wanted!r}; there are {', '.join(m.name for m in members)}."
            )
        for member in chosen or (m for m in members if not is_no_record(m.name)):
            try:
                form, found = _channels(member.path, dt, cut_short)
                found = [replace(channel, member=member.name) for channel in found]
            except InputError as error:
                # the user knows the archive's names, not where they lie unpacked
                renamed = type(error)(
                    str(error).replace(str(member.path), f"{file}#{member.name}")
                )
                if wanted:
                    raise renamed from None
                left_out.append((member.name, renamed))
                continue
            channels += found
            forms.add(form)
    if not channels:
        why = f": {left_out[0][1]}" if left_out else "."
        kinds = {type(error) for _, error in left_out}
        problem = NotAcceleration if kinds == {NotAcceleration} else InputError
        raise problem(f"{file}: no member of the archive holds acceleration{why}")
    if len({channel.member for channel in channels}) == 1:
        channels = [replace(channel, member="") for channel in channels]
    name = f"{file}#{wanted}" if wanted else file
    digest = sha256_of(Path(file))
    return Record(
        name, "+".join(sorted(forms)), digest, tuple(channels), tuple(left_out)
    )


@named_keywords
def read_motion(
    path: str | os.PathLike[str],
    unit: str | None = None,
    channel: str | int | None = None,
    dt: float | None = None,
    *,
    cut_short: bool = False,
    force: bool = False,
) -> Motion:
    """Read one component of acceleration from a record of any known format.

    Parameters
    ----------
    path : the file; ``archive.zip#member`` for one of several records in an archive
    unit
        Unit of the samples (``g``, ``m/s2``, ``cm/s2``, ``gal``, ``mm/s2``); wanted where the file
        does not state its own, and checked against it where it does.
    channel : which channel, by name, orientation or number from 1; wanted where there are several
    dt : sampling interval [s]; wanted where plain text does not state it
    cut_short : whether to read what there is of a file with fewer samples than its header promises
    force : whether to take ``unit`` as given although the peak is then above 3 g

    Returns
    -------
    Motion
        Acceleration in m/s² (1 g = 9.81 m/s²). The metadata has ``station``, ``start_time`` (ISO
        8601, UTC, or None), ``earthquake``, ``component``, ``format`` and ``unit`` (as stored); the
        provenance has the file, its SHA-256 and every change made to its numbers.
    """
    record = read_record(path, dt, cut_short)
    return motion_of(record, choose_channel(record, channel), unit, force)


def choose_channel(record: Record, wanted: str | int | None) -> Channel:
    """Return the channel of a record with a name, orientation or number from 1."""
    channels = record.channels
    if isinstance(wanted, int) and not isinstance(wanted, bool):
        if not 1 <= wanted <= len(channels):
            raise InputError(
                f"{record.name}: there is no channel {wanted}; there are {_listed(record)}."
            )
        return channels[wanted - 1]
    wanted = None if wanted is None else str(wanted)
    if wanted is None:
        if len(channels) == 1:
            return channels[0]
        raise InputError(
            f"{record.name}: the file has several channels, {_listed(record)}; choose one with channel=."
        )
    found = _answering(channels, wanted)
    if len(found) == 1:
        return found[0]
    if wanted.isdigit() and not found and 1 <= int(wanted) <= len(channels):
        return channels[int(wanted) - 1]
    problem = "several channels answer" if found else "no channel answers"
    raise InputError(
        f"{record.name}: {problem} to {wanted!r}; there are {_listed(record)}."
    )


def _answering(channels: Sequence[Channel], wanted: str) -> list[Channel]:
    """Channels of a name; if there are none, those in the direction that it names; else by the letter of codes."""
    name = directions.plain_name(wanted)
    named = [each for each in channels if name in _names_of(each)]
    if named:
        return named
    azimuth = directions.azimuth_of(wanted)
    # a SEED code names its sensor, not always its direction
    turned = [
        each
        for each in channels
        if azimuth is not None
        and each.component != each.code
        and directions.azimuth_of(each.component) == azimuth
    ]
    if turned:
        return turned
    if len(wanted) == 1 and wanted.isalpha():
        return [each for each in channels if each.code.upper().endswith(wanted.upper())]
    return []


def motion_of(
    record: Record, channel: Channel, unit: str | None = None, force: bool = False
) -> Motion:
    """Return one channel of a record as a motion in m/s²; ``unit`` and ``force`` as of :func:`read_motion`.

    Parameters
    ----------
    record
        Of :func:`read_record`.
    channel
        One of its channels.
    unit
        Of the samples, where the file does not state it.
    force
        Whether a peak above 3 g is taken in that unit.

    Returns
    -------
    Motion
        Acceleration in m/s² with its provenance.
    """
    if channel.fault:
        raise InputError(f"{record.name}: {channel.fault}.")
    samples = channel.samples
    number = next((n for n, c in enumerate(record.channels, 1) if c is channel), 1)
    where = f", channel {channel.label or number}" if len(record.channels) > 1 else ""
    named = replace(record, name=f"{record.name}{where}")
    stored = _settled_unit(named, channel, samples, unit)
    if channel.peaks:
        peaks = [StatedPeak(number, unit) for number, unit in channel.peaks]
        found = with_checked_peaks([replace(channel, unit=stored)], peaks, named.name)
        channel = replace(channel, steps=found[0].steps)
    factor = quantities.to_si(stored)
    acceleration = _in_si(named, samples, factor)
    read: dict[str, Any] = {
        "step": "read",
        "file": printable(Path(record.name).name),
        "sha256": record.sha256,
        "format": record.format,
        "channel": channel.label,
        "unit": stored,
        "unit_stated": bool(channel.unit),
        "factor_to_m_s2": factor,
    }
    if channel.member:
        read["member"] = channel.member
    if record.left_out:
        read["left_out"] = [name for name, _ in record.left_out]
    steps: list[Mapping[str, Any]] = [read, *channel.steps]
    mean = float(acceleration.mean())
    # the sensor's zero, or the weight of its mass, which is not motion
    if mean and (channel.raw or abs(abs(mean) - GRAVITY) < _GRAVITY_FRACTION * GRAVITY):
        acceleration = acceleration - mean
        steps.append({"step": "remove zero level", "offset_m_s2": mean})
    if not channel.unit and not force:
        _check_peak(named, acceleration, stored)
    name, metadata = _name_of(record, channel), _metadata(record, channel, stored)
    return Motion(acceleration, channel.dt, name, metadata, tuple(steps))


def _name_of(record: Record, channel: Channel) -> str:
    """Name of a motion: that of its file or member without its ending, and of its channel if there are several."""
    own = channel.member or record.name.rpartition("#")[2]
    name = printable(Path(own).name.removesuffix(".gz").rsplit(".", 1)[0])
    if len(record.channels) == 1:
        return name
    return f"{name} {channel.code or channel.component}".strip()


def _in_si(
    record: Record, samples: NDArray[np.float64], factor: float
) -> NDArray[np.float64]:
    """Return samples in m/s², all of them finite numbers."""
    with np.errstate(over="ignore"):
        acceleration = samples * factor
    wrong = np.flatnonzero(~np.isfinite(acceleration))
    if wrong.size:
        first = int(wrong[0])
        raise InputError(
            f"{record.name}: sample {first + 1} of {samples.size} is {samples[first]:g}, which is no "
            "acceleration; mend the file."
        )
    return acceleration


def _check_peak(record: Record, acceleration: NDArray[np.float64], unit: str) -> None:
    """Refuse a peak that hardly any record has where the unit is what the user says it is."""
    peak = float(np.abs(acceleration).max())
    if peak > STRONGEST_G * GRAVITY:
        raise InputError(
            f"{record.name}: in {unit} its peak would be {peak / GRAVITY:.3g} g, above {STRONGEST_G:g} g; give "
            f"the unit of the numbers, or, if it is {unit}, say so with force=True or in the file."
        )


def _metadata(record: Record, channel: Channel, unit: str) -> dict[str, Any]:
    """What is known of a channel, for the motion that it becomes."""
    start = channel.start_time
    facts = {
        **{key: getattr(channel, key) for key in ("network", "station", "location")},
        "channel": channel.code or channel.component,
        "component": channel.component or channel.code,
        "earthquake": channel.details.get("earthquake", ""),
        "start_time": None if start is None else str(start),
        "format": record.format,
        "unit": unit,
    }
    return {**channel.details, **facts}


def _settled_unit(
    record: Record, channel: Channel, samples: NDArray[np.float64], unit: str | None
) -> str:
    """Unit of the samples, as stated in the file or given; an error where both differ or none is known.

    ``samples``: shape (n,), whose peaks the message shows in every unit; ``unit``: given by the user.
    """
    asked = None if unit is None else quantities.asked_unit(unit)
    velocity = directions.is_seismometer(channel.code)
    if channel.counts and (velocity or asked is None):
        of_what = (
            f"counts of a seismometer ({channel.code}), which records velocity"
            if velocity
            else "counts of a recorder"
        )
        raise InputError(
            f"{record.name}: the file does not state its unit: whole numbers without StationXML are {of_what}; "
            "put the StationXML of the station beside the file, which turns them into acceleration."
        )
    if channel.unit:
        if quantities.quantity_of(channel.unit) != "acceleration":
            raise InputError(
                f"{record.name}: samples in {channel.unit!r} are no acceleration known here."
            )
        if asked is not None and asked != channel.unit:
            raise InputError(
                f"{record.name}: the file states its unit as {channel.unit}, not {unit}; leave unit= out."
            )
        return channel.unit
    if asked is not None:
        return asked
    peak = float(np.abs(samples - samples.mean()).max())
    candidates = ", ".join(
        f"{peak * quantities.to_si(name) / GRAVITY:.3g} g if {name}"
        for name in quantities.ASKED_UNITS
    )
    remark = (
        f" ({channel.code} is a channel of a seismometer: velocity, unless it has been differentiated)"
        if velocity
        else ""
    )
    raise InputError(
        f"{record.name}: the file does not state its unit{remark}; give unit= "
        f"({', '.join(quantities.ASKED_UNITS)}): the peak about the mean would be {candidates}."
    )


def _listed(record: Record) -> str:
    """The channels of a record by number and name, for messages."""
    named = ((c.member, c.code, c.component) for c in record.channels)
    words = (" ".join(dict.fromkeys(filter(None, names))) for names in named)
    return "; ".join(
        f"{k}: {both}" if both else str(k) for k, both in enumerate(words, start=1)
    )


def _names_of(channel: Channel) -> set[str]:
    """Return all names of a channel, plain ones."""
    bare = (channel.code, channel.component, f"{channel.code} {channel.component}")
    names = {name.strip() for name in bare if name.strip()}
    names.add(str(channel.details.get("title", "")))
    if channel.member:
        files = {channel.member, Path(channel.member).name}
        names |= files | {f"{file} {name}" for file in files for name in names}
        names |= {f"{file}#{name}" for file in files for name in names}
    return {directions.plain_name(name) for name in names if name}
