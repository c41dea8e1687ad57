"""Incremental dynamic analyses as matrices, motion by amplitude, and three definitions of one as tables of tests.

A file of an IDA curve has a row per motion and amplitude, motion after motion, each raised through the same
amplitudes. The step protocol of the laboratory, the first overturning and the amplitude above which the specimen
always overturns are three different figures; between the last two lie structural resurrections.

In: files or tables of IDA curves. Out: tables of tests, amplitudes [g]. Theory: ``docs/definitions.md``.
"""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.errors import InputError
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named
from rockfrag.shaketable.protocols import Outcome, Protocol
from rockfrag.shaketable.tests_table import as_tests_table
from rockfrag.system.system import System

# columns that are the same for all amplitudes of a motion
ABOUT = ("configuration", "object", "pedestal", "earthquake", "floor", "motion")


@dataclass(frozen=True)
class Swept:
    """Outcomes of some motions, each at the same amplitudes."""

    about: pd.DataFrame  # one row a motion: the columns ``ABOUT``
    amplitude_g: NDArray[np.float64]  # amplitudes [g], rising, shape (n,)
    # whether the limit state that was asked for was reached, shape (motions, n)
    overturned: NDArray[np.bool_]
    # place in ``bodies`` of what overturned, shape (motions, n)
    fallen: NDArray[np.intp]
    bodies: Sequence[str]  # names of what overturned in any of them, empty for nothing

    def rows(self, columns: Sequence[str], step: int = 1) -> pd.DataFrame:
        """Return a row for each motion and every so many-th amplitude.

        Columns: those asked for of ``about``, ``amplitude_g`` and ``overturned``.
        """
        amplitude = self.amplitude_g[::step]
        overturned = self.overturned[:, ::step].ravel()
        motions = np.repeat(np.arange(len(self.about)), amplitude.size)
        rows = self.about[list(columns)].iloc[motions].reset_index(drop=True)
        return rows.assign(
            amplitude_g=np.tile(amplitude, len(self.about)), overturned=overturned
        )


def labels_of(system: System) -> dict[str, str]:
    """Labels of a system in tables: its configuration, its object, with or without a pedestal.

    Parameters
    ----------
    system : the system

    Returns
    -------
    The labels by column.
    """
    side = "P" if system.count > 1 else "NP"
    return {"configuration": system.name, "object": system.names[-1], "pedestal": side}


def fallen_names(system: System) -> tuple[str, ...]:
    """Names in tables of the body that fell, by its number in outcomes.

    Parameters
    ----------
    system : of n bodies

    Returns
    -------
    The names, n + 1 of them.
    """
    return (
        "",
        *(
            system.names
            if system.count > 2
            else ("pedestal", "statue")[-system.count :]
        ),
    )


def read_swept(paths: Iterable[Path], *, state: str = OVERTURNS) -> Iterator[Swept]:
    """Yield the outcomes of IDA curves in a limit state, some motions at a time, so that memory holds one part.

    Parameters
    ----------
    paths, state : Parquet files of IDA curves, and the limit state

    Returns
    -------
    Parts of the IDA curves.
    """
    reached = limit_state_named(state).column
    columns = [*ABOUT, "amplitude_g", reached, "overturned_body"]
    for path in paths:
        with pq.ParquetFile(path, read_dictionary=[*ABOUT, "overturned_body"]) as file:
            for group in range(file.num_row_groups):
                yield _swept(file.read_row_group(group, columns=columns), reached, path)


def _swept(part: pa.Table, reached: str, path: Path) -> Swept:
    """Turn rows of a motion and an amplitude each into tables of motions by amplitudes.

    ``reached``: column of the limit state; ``path``: for messages.
    """
    amplitude = part["amplitude_g"].to_numpy()
    motion = part["motion"].combine_chunks()
    code = motion.indices.to_numpy()
    ends = np.flatnonzero(np.diff(code)) + 1
    each = int(ends[0]) if ends.size else code.size
    if code.size % each or not np.array_equal(ends, np.arange(each, code.size, each)):
        raise InputError(
            f"{path}: its motions have not equally many amplitudes; make it anew."
        )
    grid = amplitude.reshape(-1, each)
    if not (grid == grid[0]).all() or (np.diff(grid[0]) <= 0).any():
        raise InputError(
            f"{path}: its motions have not the same rising amplitudes; make it anew."
        )
    first = part.select(list(ABOUT)).take(pa.array(np.arange(0, code.size, each)))
    about = pd.DataFrame({name: first[name].to_pylist() for name in ABOUT}, dtype="str")
    body = part["overturned_body"].combine_chunks()
    fallen = body.indices.to_numpy().reshape(-1, each)
    found = part[reached].to_numpy().reshape(-1, each)
    return Swept(about, grid[0].copy(), found, fallen, body.dictionary.to_pylist())


def swept_of(ida: pd.DataFrame) -> Iterator[Swept]:
    """Yield the IDA curve of each configuration and motion, in the order in which they first appear."""
    number, bodies = pd.factorize(ida["overturned_body"])
    overturned = ida["overturned"].to_numpy(dtype=bool)
    amplitude = ida["amplitude_g"].to_numpy(dtype=np.float64)
    for rows in ida.groupby(["configuration", "motion"], sort=False).indices.values():
        ordered = rows[np.argsort(amplitude[rows], kind="stable")]
        head = ida[list(ABOUT)].iloc[rows[:1]].reset_index(drop=True)
        yield Swept(
            head,
            amplitude[ordered],
            overturned[None, ordered],
            number[None, ordered],
            list(bodies),
        )


DEFINITIONS = ("step_protocol", "first_overturning", "always_overturning")
# as in a laboratory: statistics rest on it, the others stand beside
DEFINITION = "step_protocol"
_LABELS = ("configuration", "object", "pedestal", "floor")


def first_overturning(amplitudes: Floats, overturned: Flags) -> Outcome:
    """Bounds of the least amplitude that overturns, of rising ones [g], shape (n,).

    Parameters
    ----------
    amplitudes, overturned : rising peaks [g] and their outcomes, shape (n,)

    Returns
    -------
    The :class:`Outcome`.
    """
    return _between(
        amplitudes, int(overturned.argmax()) if overturned.any() else overturned.size
    )


def always_overturning(amplitudes: Floats, overturned: Flags) -> Outcome:
    """Bounds of the amplitude above which all overturn; censored if the largest was survived.

    Parameters
    ----------
    amplitudes, overturned : rising peaks [g] and their outcomes, shape (n,)

    Returns
    -------
    The :class:`Outcome`.
    """
    return _between(amplitudes, int(np.flatnonzero(~overturned).max(initial=-1)) + 1)


def _between(amplitudes: Floats, place: int) -> Outcome:
    """Bounds where the amplitude of a place overturned and the one below it did not."""
    survived = float(amplitudes[place - 1]) if place else 0.0
    if place == amplitudes.size:
        return Outcome(survived, math.nan, "limit reached" if place else "no step fits")
    remark = "" if place else "overturned at the first step"
    return Outcome(survived, float(amplitudes[place]), remark)


def step_protocol(amplitudes: Floats, overturned: Flags, protocol: Protocol) -> Outcome:
    """Bounds where the protocol's series of levels is climbed, each level at the nearest amplitude.

    Parameters
    ----------
    amplitudes, overturned : rising peaks [g] and their outcomes, shape (n,)
    protocol : of the laboratory

    Returns
    -------
    The :class:`Outcome`.
    """
    climbed = _levels(amplitudes, protocol, None, 1)
    return first_overturning(amplitudes[climbed], overturned[climbed])


def _levels(
    amplitudes: Floats, protocol: Protocol, limit_g: float | None, repetition: int
) -> NDArray[np.intp]:
    """Numbers of the amplitudes of an IDA curve that the series of levels takes.

    Levels beyond the end of the curve are not climbed.

    Parameters
    ----------
    amplitudes : of the curve, rising [g], shape (n,)
    protocol : that climbs
    limit_g : of the table for this motion [g]; None for that of the protocol
    repetition : number of the series
    """
    levels = protocol.amplitudes(limit_g, repetition)
    middles = (amplitudes[1:] + amplitudes[:-1]) / 2
    spacing = float(np.diff(amplitudes[-2:])[0]) if amplitudes.size > 1 else 0.0
    levels = levels[levels <= amplitudes[-1] + spacing / 2]
    nearest = np.unique(np.searchsorted(middles, levels, side="right"))
    limit = protocol.limit_g if limit_g is None else min(limit_g, protocol.limit_g)
    return np.asarray(nearest[amplitudes[nearest] <= limit * (1 + 1e-9)])


def tests_from_ida(
    ida: pd.DataFrame,
    protocol: Protocol,
    *,
    definitions: Sequence[str] = DEFINITIONS,
    limits_g: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Read every IDA curve of a table as tests.

    Parameters
    ----------
    ida : rows in any order
        Columns ``configuration``, ``object``, ``pedestal``, ``motion``, ``earthquake``, ``floor``,
        ``amplitude_g``, ``overturned``, ``overturned_body``.
    protocol : of the laboratory
        Its repetitions concern the step protocol, its definition and its measurement all definitions.
    definitions : which of ``step_protocol``, ``first_overturning`` and ``always_overturning`` to take
    limits_g : limit of the shaker [g], at which the step protocol stops, for each motion that has one

    Returns
    -------
    Table of tests (:mod:`rockfrag.shaketable.tests_table`) by IDA curve, definition and repetition.
    """
    needed = (*ABOUT, "amplitude_g", "overturned", "overturned_body")
    for column in needed:
        if column not in ida.columns:
            raise InputError(
                f"IDA curve: column {column!r} is missing; it needs {', '.join(needed)}."
            )
    for definition in definitions:
        if definition not in DEFINITIONS:
            raise InputError(
                f"protocol: definition {definition!r} is not one of {', '.join(DEFINITIONS)}."
            )
    return tests_from_swept(
        swept_of(ida), protocol, definitions=definitions, limits_g=limits_g
    )


def tests_from_swept(
    parts: Iterable[Swept],
    protocol: Protocol,
    *,
    definitions: Sequence[str] = DEFINITIONS,
    limits_g: Mapping[str, float] | None = None,
) -> pd.DataFrame:
    """Read IDA curves as tests, part after part, as :func:`tests_from_ida` does those of a table.

    Parameters
    ----------
    parts : of IDA curves
    protocol, definitions, limits_g : as of :func:`tests_from_ida`

    Returns
    -------
    Table of tests.
    """
    rows: list[dict[str, object]] = []
    for part in parts:
        amplitudes_g, first = part.amplitude_g, part.about.iloc[0]
        rising = (
            np.isfinite(amplitudes_g).all()
            and (np.diff(amplitudes_g, prepend=0.0) > 0).all()
        )
        if not (amplitudes_g.size and rising):
            raise InputError(
                f"{first['configuration']} {first['motion']}: amplitudes must be positive, rise, and occur once; "
                "check the IDA curve's rows."
            )
        levels = cache(partial(_levels, amplitudes_g, protocol))
        every = np.arange(amplitudes_g.size)
        for place, motion in enumerate(part.about["motion"]):
            limit = None if limits_g is None else limits_g.get(motion)
            climbed = [
                levels(limit, number) for number in range(1, protocol.repetitions + 1)
            ]
            for definition in definitions:
                series = climbed if definition == DEFINITION else [every]
                rows += [
                    {"repetition": repetition, "definition": definition}
                    | _row(
                        part,
                        place,
                        protocol,
                        definition=definition,
                        climbed=amplitudes,
                    )
                    for repetition, amplitudes in enumerate(series, start=1)
                ]
    return as_tests_table(rows)


def _row(
    part: Swept,
    place: int,
    protocol: Protocol,
    *,
    definition: str,
    climbed: NDArray[np.intp],
) -> dict[str, object]:
    """Outcome of the motion in a row of a part, at the amplitudes that were climbed.

    Parameters
    ----------
    part, place : swept motions, and the number of the row
    protocol, definition : how amplitudes are climbed, and which overturning is meant
    climbed : numbers of the amplitudes
    """
    about = part.about.iloc[place]
    bounds = first_overturning
    if definition == "always_overturning":
        bounds = always_overturning
    true = bounds(part.amplitude_g[climbed], part.overturned[place][climbed])
    shown = true
    if protocol.measurement is not None:
        shown = protocol.measurement.show(true, str(about["configuration"]))
    upper = int(np.searchsorted(part.amplitude_g, true.upper_g))
    return {
        "test": f"{about['configuration']} {about['motion']}",
        **{key: about[key] for key in ABOUT},
        "lower_g": shown.lower_g,
        "upper_g": shown.upper_g,
        "amplitude_g": protocol.report(shown),
        "censored": "right" if shown.censored else "none",
        "overturned_body": ""
        if true.censored
        else part.bodies[part.fallen[place, upper]],
        "remark": shown.remark,
    }


def mean_amplitudes(tests: pd.DataFrame) -> pd.DataFrame:
    """Geometric means of amplitudes over the motions that overturned all that is compared, a row a mean.

    ``tests`` are of one definition; ``amplitude_g`` [g] is missing where the test has none. ``by`` is what is
    compared: all configurations over the same motions (``configuration``), the floors by side over the same
    records and objects (``floor``), or the same for each object (``object_floor``). ``configuration``, ``object``,
    ``pedestal`` and ``floor`` are empty where all are taken together; ``mean_g`` [g] is missing where no motion
    overturned all; of ``of`` motions ``motions`` did. Repetitions are averaged in the logarithm, and count only if
    each of them overturned.

    Parameters
    ----------
    tests : of one definition, a row a test

    Returns
    -------
    pandas.DataFrame.
    """
    # the same record on another floor has another name: that of the record and the floor's
    names = tests[["motion", "floor"]].to_numpy().tolist()
    record = [motion.removesuffix(f"_{floor}") for motion, floor in names]
    known = tests.assign(ln_a=np.log(tests["amplitude_g"]), record=record)
    rows = _means("configuration", known, ["configuration"], ["record", "floor"])
    rows += _means("floor", known, ["pedestal", "floor"], ["record", "object"])
    for _, group in known.groupby("object", sort=False):
        rows += _means("object_floor", group, ["pedestal", "floor"], ["record"])
    return pd.DataFrame(rows, columns=["by", *_LABELS, "mean_g", "motions", "of"])


def _means(
    by: str, tests: pd.DataFrame, compared: list[str], units: list[str]
) -> list[dict[str, object]]:
    """Means of each of ``compared`` over the ``units`` in which all of them are known."""
    parts = [part for _, part in tests.groupby(compared, sort=False)]
    ln_a = [
        part.groupby(units)["ln_a"].agg(lambda values: values.mean(skipna=False))
        for part in parts
    ]
    table = pd.concat(ln_a, axis=1)
    complete = table.dropna()
    rows: list[dict[str, object]] = []
    for column, part in enumerate(parts):
        alike = (name for name in _LABELS if len(set(part[name])) == 1)
        labels = dict.fromkeys(_LABELS, "") | {
            name: str(part[name].iloc[0]) for name in alike
        }
        mean_g = float(np.exp(complete.iloc[:, column].mean()))
        about = {"mean_g": mean_g, "motions": len(complete), "of": len(table)}
        rows.append({"by": by, **labels, **about})
    return rows
