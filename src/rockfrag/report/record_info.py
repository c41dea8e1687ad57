"""What is in a record: a row for each of its channels, and a picture of one."""

import itertools
import os
from collections.abc import Iterable
from pathlib import Path
from textwrap import shorten
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rockfrag.base import figure_style as style
from rockfrag.base.errors import InputError
from rockfrag.base.files import file_name
from rockfrag.base.text_files import printable
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.motions.intensity import pgd, pgv, predominant_period
from rockfrag.motions.response_spectra import fourier_amplitude, response_spectrum
from rockfrag.records.catalogue import record_files
from rockfrag.records.motion import Motion, integrate
from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import Record, motion_of, read_untold

COLUMNS = (
    *("file", "format", "station", "channel", "start_time", "npts", "dt_s", "unit"),
    *("pga_g", "pgv_cm_s", "pgd_cm", "duration_s", "dominant_period_s"),
    *("quality_flags", "error", "status"),
)
"""Columns of the table; a file that cannot be read has a row with its ``error`` and ``status`` alone."""

READ, NOT_ACCELERATION, UNREADABLE = "read", "not acceleration", "unreadable"
"""What ``status`` says of a row."""

_SPECTRUM_PERIODS = np.geomspace(0.02, 10.0, 200)
_DAMPING = 0.05


def describe_files(
    paths: Iterable[str | os.PathLike[str]],
    unit: str | None = None,
    dt: float | None = None,
    force: bool = False,
) -> pd.DataFrame:
    """Describe every channel of every file, folders and archives searched through, in order of name.

    Hidden files, StationXML and papers in folders are left out. ``unit`` and ``dt`` are of files that do not
    state theirs; with ``force`` a unit is taken as given although a peak is then above 3 g.

    Columns are :data:`COLUMNS`. PGV and PGD are of the exact integral of the acceleration as recorded, from rest,
    without baseline correction; the dominant period is that of the largest 5 % damped pseudo-acceleration;
    ``quality_flags`` says what looks wrong. A file that cannot be read, or whose unit is not known, has the
    reason in ``error`` and does not stop the others.

    Parameters
    ----------
    paths : files, folders and archives
    unit, dt, force : of files that do not state theirs; dt [s]

    Returns
    -------
    pandas.DataFrame, a row a channel.
    """
    rows: list[dict[str, Any]] = []
    for path in record_files(*paths):
        try:
            record, _ = read_untold(path, dt)
        except InputError as error:
            rows.append(_error_row(str(path), error))
            continue
        rows += [_row(record, channel, unit, force) for channel in record.channels]
        rows += [_error_row(f"{path}#{name}", error) for name, error in record.left_out]
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    table["npts"] = table["npts"].astype("Int64")
    for column in ("quality_flags", "error"):
        table[column] = table[column].fillna("")
    return table


def _error_row(file: str, error: InputError) -> dict[str, Any]:
    status = NOT_ACCELERATION if isinstance(error, NotAcceleration) else UNREADABLE
    return {"file": printable(file), "error": str(error), "status": status}


def _row(
    record: Record, channel: Channel, unit: str | None, force: bool
) -> dict[str, Any]:
    """Row of the table on one channel: its length, peaks, period and quality flags.

    Parameters
    ----------
    record, channel : the file as read, and one of its channels
    unit : of the samples where the file states none
    force : whether that holds against what the file states
    """
    row: dict[str, Any] = {
        "file": printable(
            f"{record.name}#{channel.member}" if channel.member else record.name
        ),
        "format": record.format,
        "station": channel.station,
        "channel": channel.code or channel.component,
        "start_time": "" if channel.start_time is None else str(channel.start_time),
        "npts": channel.npts,
        "dt_s": channel.dt,
        "unit": channel.unit,
        "duration_s": (channel.npts - 1) * channel.dt,
        "error": "",
        "status": READ,
    }
    try:
        motion = _motion(record, channel, unit, force)
    except InputError as error:
        return row | {"error": str(error), "status": UNREADABLE}
    return row | {
        "unit": motion.metadata["unit"],
        "pga_g": motion.pga / GRAVITY,
        "pgv_cm_s": pgv(motion) * CENTIMETRES_PER_METRE,
        "pgd_cm": pgd(motion) * CENTIMETRES_PER_METRE,
        "dominant_period_s": predominant_period(motion),
        "quality_flags": "; ".join(quality_flags(motion)),
    }


def draw_files(
    paths: Iterable[str | os.PathLike[str]],
    folder: str | os.PathLike[str],
    unit: str | None = None,
    dt: float | None = None,
    force: bool = False,
) -> list[Path]:
    """Draw every channel of every file that can be read into a folder, and return the pictures.

    Parameters
    ----------
    paths, folder : files, folders and archives, and where pictures go
    unit, dt, force : of files that do not state theirs; dt [s]

    Returns
    -------
    Paths of the pictures.
    """
    drawn: list[Path] = []
    for path in record_files(*paths):
        try:
            record, _ = read_untold(path, dt)
            motions = [
                _motion(record, channel, unit, force) for channel in record.channels
            ]
        except InputError:
            continue
        for motion in motions:
            stem = file_name(motion.name)
            endings = itertools.chain(
                [""], (f"-{number}" for number in itertools.count(2))
            )
            pictures = (Path(folder) / f"{stem}{ending}.png" for ending in endings)
            picture = next(picture for picture in pictures if picture not in drawn)
            draw_record(motion, picture)
            drawn.append(picture)
    return drawn


def _motion(record: Record, channel: Channel, unit: str | None, force: bool) -> Motion:
    """Return a channel as a motion; the named unit is for files that do not state theirs."""
    return motion_of(record, channel, None if channel.unit else unit, force)


def draw_record(motion: Motion, path: str | os.PathLike[str]) -> None:
    """Draw acceleration, its exact integrals from rest, and the spectra of a motion as ``.png`` or ``.svg``.

    Parameters
    ----------
    motion, path : the record, and the file to write
    """
    if Path(path).suffix not in (".png", ".svg"):
        raise InputError(f"{path}: a picture is written as .png or .svg.")
    style.save_figure(record_figure(motion), path)


def record_figure(motion: Motion) -> Figure:
    """Return the figure of :func:`draw_record`."""
    velocity, displacement = integrate(motion.acceleration, motion.dt)
    cm = CENTIMETRES_PER_METRE
    pga, peaks = motion.pga / GRAVITY, (pgv(motion) * cm, pgd(motion) * cm)
    histories = (
        (motion.acceleration / GRAVITY, "Acceleration [g]", style.BLUE, f"{pga:.3f} g"),
        (velocity * cm, "Velocity [cm/s]", style.GREEN, f"{peaks[0]:.2f} cm/s"),
        (displacement * cm, "Displacement [cm]", style.ORANGE, f"{peaks[1]:.2f} cm"),
    )
    with style.figure_style():
        figure = style.new_figure(style.PAGE_WIDTH, 4.2)
        left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1.7, 1))[0]
        panels = left.subplots(3, 1, sharex=True)
        for panel, (values, label, colour, peak) in zip(panels, histories, strict=True):
            highest = (
                1.2 * style.draw_history(panel, motion.time, values, color=colour)
                or 1.0
            )
            panel.set(ylim=(-highest, highest), ylabel=label)
            panel.set_title(f"peak {peak}", loc="right", pad=2)
        panels[-1].set_xlabel("Time [s]")
        panels[-1].set_xlim(0, max(motion.time[-1], motion.dt))
        upper, lower = right.subplots(2, 1)
        spectrum = response_spectrum(motion, _SPECTRUM_PERIODS, _DAMPING)
        _logarithmic(
            upper, _SPECTRUM_PERIODS, spectrum.pseudo_acceleration / GRAVITY, style.BLUE
        )
        upper.set(xlabel="Period [s]", ylabel="PSA, 5 % damping [g]")
        frequency, amplitude = fourier_amplitude(motion)
        _logarithmic(lower, frequency[1:], amplitude[1:], style.PURPLE)
        lower.set(xlabel="Frequency [Hz]", ylabel="Fourier amplitude [m/s]")
        facts = {key: str(value or "") for key, value in motion.metadata.items()}
        station = f"{facts.get('station', '')} {facts.get('station_name', '')}".strip()
        found = ", ".join(
            filter(None, (station, facts.get("component"), facts.get("earthquake")))
        )
        titles = [
            shorten(line, 100, placeholder="…") for line in (motion.name, found) if line
        ]
        figure.suptitle("\n".join(titles), fontsize=9)
        return figure


def _logarithmic(
    panel: Axes, x: NDArray[np.float64], y: NDArray[np.float64], colour: str
) -> None:
    """Draw a positive curve on logarithmic axes, over five decades at most."""
    largest = float(y.max()) if y.size and y.max() > 0 else 1.0
    panel.loglog(x, np.maximum(y, 1e-9 * largest), color=colour, linewidth=0.8)
    lowest = max(float(y.min()) if y.size else 0.0, 1e-5 * largest)
    panel.set_ylim(0.7 * lowest, 2 * largest)
    style.plain_log(panel, "xy")
    panel.grid(visible=True, which="major")
