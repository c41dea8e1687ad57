"""Three readings of one amplitude sweep, as tables of tests.

The step protocol of the laboratory, the first overturning and the amplitude above which the
specimen always overturns are three different figures; between the last two lie survival windows.
"""

import math
from collections.abc import Hashable, Iterable, Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.shaketable.protocols import Outcome, Protocol, measured
from rockfrag.shaketable.swept import ABOUT, Swept, swept_of
from rockfrag.shaketable.tests_table import as_tests_table

Floats = NDArray[np.float64]
Verdicts = NDArray[np.bool_]

READINGS = ("step_protocol", "first_overturning", "always_overturning")

READING = "step_protocol"
"""The reading that resembles a laboratory's: statistics rest on it, the others stand beside."""

_NEEDED = (
    "configuration",
    "object",
    "pedestal",
    "motion",
    "event",
    "floor",
    "amplitude_g",
    "overturned",
    "overturned_body",
)


def first_overturning(amplitudes: Floats, overturned: Verdicts) -> Outcome:
    """Bounds of the least amplitude that overturns.

    Parameters
    ----------
    amplitudes
        Amplitudes [g], rising, shape (n,).
    overturned
        Whether each overturned, shape (n,).

    Returns
    -------
    The :class:`Outcome`: bounds of the amplitude.
    """
    _check_sweep(amplitudes, overturned, "sweep")
    return _climbed(amplitudes, overturned)


def _climbed(amplitudes: Floats, overturned: Verdicts) -> Outcome:
    """Bounds of the first overturning, as :func:`rockfrag.shaketable.protocols.climb` finds them."""
    first = int(overturned.argmax()) if overturned.any() else overturned.size
    survived = float(amplitudes[first - 1]) if first else 0.0
    if first == overturned.size:
        return Outcome(survived, math.nan, "limit reached" if first else "no step fits")
    remark = "" if first else "overturned at the first step"
    return Outcome(survived, float(amplitudes[first]), remark)


def always_overturning(amplitudes: Floats, overturned: Verdicts) -> Outcome:
    """Bounds of the amplitude above which every amplitude of the sweep overturns.

    Censored if the largest amplitude was survived.

    Parameters
    ----------
    amplitudes
        Amplitudes [g], rising, shape (n,).
    overturned
        Whether each overturned, shape (n,).

    Returns
    -------
    The :class:`Outcome`: bounds of the amplitude.
    """
    _check_sweep(amplitudes, overturned, "sweep")
    return _always(amplitudes, overturned)


def _always(amplitudes: Floats, overturned: Verdicts) -> Outcome:
    survived = np.flatnonzero(~overturned)
    if survived.size == 0:
        return Outcome(0.0, float(amplitudes[0]), "overturned at the first step")
    last = int(survived[-1])
    if last == amplitudes.size - 1:
        return Outcome(float(amplitudes[-1]), math.nan, "limit reached")
    return Outcome(float(amplitudes[last]), float(amplitudes[last + 1]))


def step_protocol(
    amplitudes: Floats,
    overturned: Verdicts,
    protocol: Protocol,
    limit_g: float | None = None,
    repetition: int = 1,
) -> Outcome:
    """Climb the protocol's ladder on a sweep, each rung at the nearest amplitude of the sweep.

    Parameters
    ----------
    amplitudes, overturned
        As of :func:`first_overturning`.
    protocol
        Protocol; rungs beyond the end of the sweep are not climbed.
    limit_g
        Limit of the shaker for this motion [g], if it has one; no rung is above it.
    repetition
        Number of the repetition, from 1.

    Returns
    -------
    The :class:`Outcome`: bounds of the amplitude.
    """
    _check_sweep(amplitudes, overturned, "sweep")
    climbed = _rungs(amplitudes, protocol, limit_g, repetition)
    return _climbed(amplitudes[climbed], overturned[climbed])


def _rungs(
    amplitudes: Floats, protocol: Protocol, limit_g: float | None, repetition: int
) -> NDArray[np.intp]:
    """Which amplitudes of a sweep the protocol's ladder takes."""
    rungs = protocol.amplitudes(limit_g, repetition)
    spacing = float(np.diff(amplitudes[-2:])[0]) if amplitudes.size > 1 else 0.0
    rungs = rungs[rungs <= amplitudes[-1] + spacing / 2]
    above = np.searchsorted(amplitudes, rungs).clip(1, amplitudes.size - 1)
    if amplitudes.size == 1:
        above = np.zeros(rungs.size, dtype=np.intp)
    else:
        above -= rungs - amplitudes[above - 1] < amplitudes[above] - rungs
    nearest = np.unique(above)
    limit = protocol.limit_g if limit_g is None else min(limit_g, protocol.limit_g)
    return np.asarray(nearest[amplitudes[nearest] <= limit * (1 + 1e-9)])


def tests_from_sweep(
    sweep: pd.DataFrame,
    protocol: Protocol,
    *,
    readings: Sequence[str] = READINGS,
    limits_g: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Read every sweep of a table as tests.

    Parameters
    ----------
    sweep
        Columns ``configuration``, ``object``, ``pedestal``, ``motion``, ``event``, ``floor``,
        ``amplitude_g``, ``overturned``, ``overturned_body``; in any order of rows.
    protocol
        Protocol of the laboratory; its repetitions concern the step protocol, its reading and its
        measurement concern all readings.
    readings
        Which of ``step_protocol``, ``first_overturning`` and ``always_overturning`` to take.
    limits_g
        Limit of the shaker [g] for each motion that has one. The step protocol stops there; the
        other two readings are of the specimen and not of the laboratory, and use the whole sweep.

    Returns
    -------
    Table of tests, see :mod:`rockfrag.shaketable.tests_table`; in the order in which
    the sweeps first appear, then by reading and repetition.

    Raises
    ------
    InputError
        If a column is missing, a reading is unknown, or an amplitude occurs twice.
    """
    for column in _NEEDED:
        if column not in sweep.columns:
            raise InputError(f"sweep: column {column!r} is missing; it needs {', '.join(_NEEDED)}.")
    for reading in readings:
        if reading not in READINGS:
            raise InputError(f"protocol: reading {reading!r} is not one of {', '.join(READINGS)}.")
    return tests_from_swept(
        swept_of(sweep, ["configuration", "motion"], list(ABOUT)),
        protocol,
        readings=readings,
        limits_g=limits_g,
    )


def tests_from_swept(
    parts: Iterable[Swept],
    protocol: Protocol,
    *,
    readings: Sequence[str] = READINGS,
    limits_g: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Read sweeps as tests, part after part, as :func:`tests_from_sweep` does those of a table.

    Parameters
    ----------
    parts
        Sweeps, see :func:`rockfrag.shaketable.swept.read_swept`.
    protocol, readings, limits_g
        As of :func:`tests_from_sweep`.
    """
    rows: list[dict[str, object]] = []
    for part in parts:
        ladders: dict[tuple[float | None, int], NDArray[np.intp]] = {}
        for place, about in enumerate(part.about.to_dict("records")):
            limit = None if limits_g is None else limits_g.get(about["motion"])
            _check_sweep(
                part.amplitude_g,
                part.overturned[place],
                f"{about['configuration']} {about['motion']}",
            )
            for repetition in range(1, protocol.repetitions + 1):
                if (limit, repetition) not in ladders:
                    ladder = _rungs(part.amplitude_g, protocol, limit, repetition)
                    ladders[limit, repetition] = ladder
            climbed = [ladders[limit, number + 1] for number in range(protocol.repetitions)]
            for reading in readings:
                rows.extend(_rows(part, place, about, protocol, reading, climbed))
    return as_tests_table(rows)


def _rows(
    part: Swept,
    place: int,
    about: Mapping[Hashable, object],
    protocol: Protocol,
    reading: str,
    ladders: Sequence[NDArray[np.intp]],
) -> list[dict[str, object]]:
    amplitudes, overturned = part.amplitude_g, part.overturned[place]
    if reading == "step_protocol":
        outcomes = [_climbed(amplitudes[rungs], overturned[rungs]) for rungs in ladders]
    elif reading == "first_overturning":
        outcomes = [_climbed(amplitudes, overturned)]
    else:
        outcomes = [_always(amplitudes, overturned)]
    rows = []
    for repetition, true in enumerate(outcomes, start=1):
        shown = measured(true, protocol.measurement, str(about["configuration"]))
        body = ""
        if not true.censored:
            body = part.bodies[part.fallen[place, int(np.searchsorted(amplitudes, true.upper_g))]]
        rows.append(
            {
                "test": f"{about['configuration']} {about['motion']}",
                **{key: about[key] for key in ABOUT},
                "lower_g": shown.lower_g,
                "upper_g": shown.upper_g,
                "amplitude_g": protocol.report(shown),
                "censored": "right" if shown.censored else "none",
                "overturned_body": body,
                "repetition": repetition,
                "remark": shown.remark,
                "reading": reading,
            }
        )
    return rows


def _check_sweep(amplitudes: Floats, overturned: Verdicts, name: str) -> None:
    if amplitudes.size == 0 or amplitudes.shape != overturned.shape:
        raise InputError(f"{name}: a sweep needs amplitudes and as many verdicts.")
    if not (
        np.isfinite(amplitudes).all() and amplitudes[0] > 0 and (np.diff(amplitudes) > 0).all()
    ):
        raise InputError(
            f"{name}: amplitudes must be positive, rise, and occur once; check the sweep's rows."
        )
