"""What a laboratory hands over: the table of tests, and the motion of the table in each, checked against it.

In: a CSV file of tests and the files of the table's motions. Out: tests with motions in m/s², and what disagrees.
Docs: ``docs/campaigns.md``.
"""

import os
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.files import is_file
from rockfrag.base.short_repr import short_repr
from rockfrag.base.units import GRAVITY
from rockfrag.fragility.tests_file import product_of, read_columns, read_titles
from rockfrag.motions.intensity import pgv
from rockfrag.motions.processing import highpass
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.quantities import TO_SI, asked_unit
from rockfrag.records.read import read_motion

MEASURED = "overturned"  # column of what the laboratory saw

NOTED = ("rocked", "slid")  # columns of what a laboratory may have noted besides


@dataclass(frozen=True)
class Campaign:
    """Tests of one object on a shake table."""

    # one row a test: ``test`` (its name), ``motion`` (key or file of the table's motion), ``group`` (tests of one
    # input motion share it), ``overturned`` (bool), ``amplitude_g`` (peak to which the motion is scaled, NaN for
    # as recorded) and a column per intensity measure
    tests: pd.DataFrame
    measures: tuple[str, ...]  # names of the columns with intensity measures
    # outcomes of other programs, a bool column each, a row per row of ``tests``
    codes: pd.DataFrame

    __repr__ = short_repr


def read_campaign(
    path: str | os.PathLike[str],
    columns: Mapping[str, str],
    measures: Mapping[str, Sequence[str | float]],
    other_codes: str | os.PathLike[str] | None = None,
) -> Campaign:
    """Read a table of tests, one row a test, and, if there is one, a table of other programs' outcomes by test.

    Meanings are ``test`` and ``motion`` (without it the measures of a test name its motion); either
    ``overturned`` (yes or no) or ``lower_g`` and ``upper_g``, the largest peak survived and the one that
    overturned, which make two tests; ``group`` where tests of one input motion share a name, else the motion;
    ``amplitude_g`` where motions are scaled to a peak; ``rocked``, ``slid`` (yes or no) and ``which_way`` (text)
    where the laboratory noted them.

    Parameters
    ----------
    path : CSV file
    columns : titles of its columns by their meaning
    measures : of each intensity measure the columns and numbers whose product it is
    other_codes : CSV file of other programs’ outcomes

    Returns
    -------
    The :class:`Campaign`.
    """
    source = Path(path).name
    raw = read_columns(path, _kinds_of_columns(columns, measures))
    motion = raw[columns["motion"]] if "motion" in columns else ""
    tests = pd.DataFrame({"test": raw[columns["test"]], "motion": motion, "group": ""})
    doubled = tests["test"][tests["test"].duplicated()]
    if len(doubled):
        raise InputError(
            f"{source}: test {doubled.iloc[0]} stands twice; keep one row a test."
        )
    for name, recipe in measures.items():
        tests[name] = product_of(raw, recipe)
    if "motion" not in columns:
        tests["motion"] = _settings_in_words(tests[list(measures)])
    tests["group"] = raw[columns["group"]] if "group" in columns else tests["motion"]
    for key in NOTED:
        if key in columns:
            tests[key] = raw[columns[key]].astype(bool)
    if "which_way" in columns:
        tests["which_way"] = raw[columns["which_way"]]
    tests = _with_outcomes(tests, raw, columns, source)
    return Campaign(
        tests, tuple(measures), _codes(other_codes, columns["test"], tests["test"])
    )


def _kinds_of_columns(
    columns: Mapping[str, str], measures: Mapping[str, Sequence[str | float]]
) -> dict[str, str]:
    """What each column of a table of tests holds, by its title, as :func:`read_columns` takes it.

    ``columns``: titles by their meaning; ``measures``: columns and numbers whose product each measure is.
    """
    kinds = {
        part: "positive"
        for recipe in measures.values()
        for part in recipe
        if isinstance(part, str)
    }
    meanings = {
        "label": ("test", "motion", "group", "which_way"),
        "positive": ("amplitude_g", "lower_g", "upper_g"),
        "outcome": (MEASURED, *NOTED),
    }
    for kind, keys in meanings.items():
        kinds |= {columns[key]: kind for key in keys if key in columns}
    return kinds


def _settings_in_words(measures: pd.DataFrame) -> list[str]:
    """Name of each test's setting, its measures in words: tests that repeat a setting share it."""
    return [
        ", ".join(f"{name} {value:g}" for name, value in row.items())
        for row in measures.to_dict("records")
    ]


def _with_outcomes(
    tests: pd.DataFrame, raw: pd.DataFrame, columns: Mapping[str, str], source: str
) -> pd.DataFrame:
    """Add outcome and amplitude to the tests; an amplitude of overturning makes one test survived and one not.

    ``raw``: the table as read; ``columns``: its titles by their meaning; ``source``: its name in messages.
    """
    if "overturned" in columns:
        amplitude = raw[columns["amplitude_g"]] if "amplitude_g" in columns else np.nan
        seen = raw[columns["overturned"]].astype(bool)
        return tests.assign(**{MEASURED: seen, "amplitude_g": amplitude})
    parts = []
    for key, fell in (("lower_g", False), ("upper_g", True)):
        amplitude = raw[columns[key]]
        names = [
            f"{test} at {peak:g} g"
            for test, peak in zip(tests["test"], amplitude, strict=True)
        ]
        parts.append(
            tests.assign(test=names, amplitude_g=amplitude, **{MEASURED: fell})
        )
    wrong = np.flatnonzero(parts[0]["amplitude_g"] >= parts[1]["amplitude_g"])
    if wrong.size:
        raise InputError(
            f"{source}, row {wrong[0] + 2}: lower_g is not below upper_g; the object overturned between them."
        )
    return pd.concat(parts, ignore_index=True)


def _codes(
    path: str | os.PathLike[str] | None, column: str, tests: "pd.Series[str]"
) -> pd.DataFrame:
    """Outcomes by other programs in the order of the tests: 1, 0, or NaN where none is given.

    ``column``: title of the names of tests in the file; without a file there are no columns.
    """
    if path is None:
        return pd.DataFrame(index=range(len(tests)))
    source = Path(path).name
    names = [name for name in read_titles(path) if name != column]
    table = read_columns(
        path, {column: "label"} | dict.fromkeys(names, "outcome")
    ).set_index(column)
    if not set(tests) & set(table.index):
        raise InputError(
            f"{source}: has none of the {len(tests)} tests; check that the column {column!r} has their names."
        )
    return table.astype(float).reindex(list(tests)).reset_index(drop=True)


LARGEST_PEAK = 10 * GRAVITY
"""Largest acceleration that a shake table is believed to make [m/s²]; volts and counts look larger."""

KEY = "{motion}"  # stands for the test's motion in a pattern of file names

# high-pass before a measured motion is integrated: its noise would drift
DRIFT_CORNER_HZ = 0.1

LARGEST_FACTOR = 1.5
"""Factor between the middle listed and measured peak beyond which they are not of one motion: of ours.  On a table
that followed its commands it is 1.00 in PGA and 1.12 in PGV (490 tests)."""

_CAUSES = {
    "pga_g": "check the unit of the motions (unit) and of the column",
    "pgv_cm_s": "check the time step of the motions (dt_s) and the unit of the column",
}


def table_motions(
    source: str,
    names: Sequence[str],
    unit: str | None,
    dt: float | None,
    channel: str | None,
) -> list[Motion]:
    """Read the measured motion of the table in each test, in the order of the tests [m/s²].

    ``source`` is an ``.npz`` archive with one array per motion, or a pattern of file names such as
    ``motions/Test{motion}.txt``; ``names`` are keys of the archive, or what to put for ``{motion}``. ``unit``,
    ``dt`` [s] and ``channel`` are for files that do not state them.

    Parameters
    ----------
    source, names : archive or pattern of files, and names of motions
    unit, dt, channel : of files that do not state theirs; dt [s]

    Returns
    -------
    One motion a test [m/s²].
    """
    absent = missing_motions(source, names)
    if absent:
        raise InputError(
            f"{source}: has no motion for {len(absent)} of {len(names)} tests, {', '.join(absent[:3])} first; "
            "add them, or set without_motion: leave_out."
        )
    if source.endswith(".npz"):
        found = _of_archive(source, names, unit, dt)
    else:
        read = (read_motion(_path(source, name), unit, channel, dt) for name in names)
        found = [
            replace(motion, name=name) for motion, name in zip(read, names, strict=True)
        ]
    for motion in found:
        if motion.pga > LARGEST_PEAK:
            raise InputError(
                f"{source}: motion {motion.name} peaks at {motion.pga / GRAVITY:.3g} g, which no shake "
                "table reaches; it may be in volts or counts, or another column: check unit and channel."
            )
    return found


def missing_motions(source: str, names: Sequence[str]) -> list[str]:
    """Names of which there is no motion.

    Parameters
    ----------
    source, names : archive or pattern of files, and names of motions

    Returns
    -------
    The names.
    """
    if not source.endswith(".npz"):
        return [name for name in names if not is_file(Path(_path(source, name)))]
    with _archive(source) as content:
        return [name for name in names if name not in content.files]


def _path(pattern: str, name: str) -> str:
    """The file of a test's motion, of a pattern that holds its key."""
    if KEY not in pattern:
        raise InputError(
            f"{pattern}: expected an .npz archive, or file names with {KEY} where the test's motion is named."
        )
    return pattern.replace(KEY, name)


def _archive(source: str) -> Any:
    """An open .npz archive of arrays."""
    if not is_file(Path(source)):
        raise InputError(f"{source}: there is no such file; correct the path.")
    try:
        # looked at first: numpy leaves a file open that turns out to be no archive
        zipfile.ZipFile(source).close()
        # arrays only: an archive with Python objects could run code
        return np.load(source, allow_pickle=False)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(
            f"{source}: cannot be read as an .npz archive ({error})."
        ) from error


def _of_archive(
    source: str, names: Sequence[str], unit: str | None, dt: float | None
) -> list[Motion]:
    """The motions of an .npz archive by name, in m/s²; ``unit`` and ``dt`` [s] are those of its arrays."""
    if unit is None or dt is None:
        raise InputError(
            f"{source}: an .npz archive states neither unit nor interval; give unit and dt."
        )
    factor, found = TO_SI[asked_unit(unit)], []
    about = ({"step": "read", "file": Path(source).name, "unit": unit},)
    with _archive(source) as content:
        for name in names:
            try:
                values = np.asarray(content[name], dtype=np.float64)
            except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
                raise InputError(
                    f"{source}: motion {name} cannot be read ({error})."
                ) from error
            found.append(Motion(values * factor, dt, name, provenance=about))
    return found


def measured_peaks(motions: Sequence[Motion]) -> pd.DataFrame:
    """Peak acceleration and velocity of motions, ``pga_g`` and ``pgv_cm_s``.

    Parameters
    ----------
    motions : of the table, n of them

    Returns
    -------
    pandas.DataFrame, n rows: ``pga_g`` [g], ``pgv_cm_s`` [cm/s].
    """
    velocities = [100 * pgv(highpass(motion, DRIFT_CORNER_HZ)) for motion in motions]
    return pd.DataFrame(
        {"pga_g": [m.pga / GRAVITY for m in motions], "pgv_cm_s": velocities}
    )


def check_peaks(tests: pd.DataFrame, motions: Sequence[Motion], source: str) -> None:
    """Refuse motions whose peaks differ from those in the table of tests; the message has the factor between.

    Parameters
    ----------
    tests, motions, source : a row a test, the motion of each, and the name of the motions in messages
    """
    listed = tests.filter(items=list(_CAUSES))
    if "pgv_cm_s" not in listed and {"pga_g", "pgv_over_pga_s"} <= set(tests):
        listed = listed.assign(
            pgv_cm_s=100 * GRAVITY * tests["pga_g"] * tests["pgv_over_pga_s"]
        )
    if listed.empty:
        return
    found = measured_peaks(motions)
    for name in map(str, listed):
        factor = float(np.median(found[name].to_numpy() / listed[name].to_numpy()))
        if not 1 / LARGEST_FACTOR <= factor <= LARGEST_FACTOR:
            raise InputError(
                f"{source}: the peaks of its motions are {factor:.3g} times the {name} that the tests list "
                f"(median of {len(tests)} tests); {_CAUSES[name]}."
            )
