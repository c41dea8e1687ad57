"""Outcomes of systems × motions × scales, as arrays, and as four tidy tables (``docs/definitions.md``).

In: arrays that engines fill. Out: tables and a figure. Systems, motions and scales are the three axes everywhere.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Whole = NDArray[np.int64]
Small = NDArray[np.int8]
Words = NDArray[np.object_]

Table = Literal["cases", "bodies", "contacts", "constraints"]
"""The four tables of outcomes: a row per case, and per body, contact and constraint of a case."""

ROW_OF = {"bodies": "body", "contacts": "contact", "constraints": "constraint"}
"""What a row is of, in the tables that have several of a case."""

SUFFIXES = {
    **{"": "", "s": "_s", "rad": "_rad", "rad/s": "_rad_s", "m": "_m", "N": "_n"},
    "N s": "_n_s",
}
"""What a unit adds to the name of a column."""


@dataclass(frozen=True)
class Column:
    """One column of a table of outcomes: an attribute of :class:`rockfrag.outcomes.Outcomes`.

    ``unit`` is empty for a number without one, a count or a statement; ``empty`` stands where no engine answered.
    """

    name: str
    table: Table
    unit: str
    empty: Any

    @property
    def title(self) -> str:
        """Name in a table, with the unit."""
        return self.name + SUFFIXES[self.unit]

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of its values; words are objects, as numpy cuts longer ones off otherwise."""
        return (
            np.dtype(object)
            if isinstance(self.empty, str)
            else np.asarray(self.empty).dtype
        )


def column(
    empty: Any = math.nan,
    unit: str = "",
    table: Table = "cases",
    *,
    shown: bool = True,
) -> Any:
    """Declare a column as a field of :class:`rockfrag.outcomes.Outcomes`.

    Parameters
    ----------
    empty : value where an engine does not tell
    unit : of its values
    table : in which it appears: of cases, bodies, contacts or constraints
    shown : whether the result shows it at the prompt
    """
    about = {"table": table, "unit": unit, "empty": empty}
    # at the prompt, a result fits a screen
    return field(metadata=about, repr=shown and table != "constraints")


@dataclass(frozen=True)
class Outcomes:
    """What became of systems × motions × scales.

    Arrays of cases have shape (systems, motions, scales), those of bodies and contacts one axis more, from below:
    body 0 is the lowest, contact 0 the ground's; what a system has fewer of is filled with what is not told.
    ``docs/definitions.md`` defines each word.

    Attributes
    ----------
    names : of the bodies of each system, from below
    holding : names of what holds the bodies of each system: its constraints, bonds and support
    scales : factors on the motions, shape (motions, scales)
    engines : names of those that answered
    engine : which of them answered each case
    without_sliding
        Whether each case falls if nothing can slide or fly, shape (systems, motions, scales); None unless a
        planar engine with friction has asked that of pure rocking for all systems
    systems, motions : names of systems and motions, empty where one has none; no names at all if not known
    peaks : peak accelerations of the unscaled motions along x [m/s²], shape (motions,), NaN where not known
    """

    names: tuple[tuple[str, ...], ...]
    holding: tuple[tuple[str, ...], ...]
    scales: Floats
    engines: tuple[str, ...]
    engine: Small
    overturned: Flags = column(False)  # whether a body fell
    # number from below of the body that fell first, from 1; 0 without a fall
    overturned_body: Small = column(np.int8(0))
    # instant of the fall; NaN without a fall, or where the engine stops before it
    overturning_time: Floats = column(unit="s")
    # instant from which the fall was certain whatever followed; NaN without one or not told
    certain_time: Floats = column(unit="s")
    impacts: Whole = column(np.int64(0))  # until the outcome was known
    # times that a body left what it stood on with all of its base
    flights: Whole = column(np.int64(0))
    # impacts in which the law of a restitution gave way, lest energy grow
    given_way: Whole = column(np.int64(0))
    # number from below, from 1, of the contact open furthest under what fell; 0: no fall, or not told
    parted_contact: Small = column(np.int8(0))
    # whether a body that has not fallen rests beyond its balance, against a wall or
    # in a tie
    leaning: Flags = column(False, shown=False)
    # times that more than one mode of contact was found consistent
    several_modes: Whole = column(np.int64(0))
    # times that no mode of contact was consistent
    paradoxes: Whole = column(np.int64(0))
    # least distance to an unstable equilibrium; infinite if it never rocked, NaN not told
    unstable_distance: Floats = column(math.inf)
    # least effective gravity over gravity while the ground moves
    minimum_gravity_ratio: Floats = column(1.0)
    # instant at which pure rocking first needed a contact to pull; NaN if none or not told
    lost_contact: Floats = column(unit="s")
    # largest rotation on what it stands on, over the critical angle of its side; infinite if it fell
    peak_rotation: Floats = column(table="bodies")
    # largest angular velocity until the outcome was known
    peak_velocity: Floats = column(unit="rad/s", table="bodies")
    # rotation about the vertical at the end; NaN of a planar body
    turn: Floats = column(unit="rad", table="bodies")
    # horizontal displacement of the centre of gravity at the end; NaN not told
    walk: Floats = column(unit="m", table="bodies")
    # direction of the fall from x towards y; NaN without a fall or not told
    fall_direction: Floats = column(unit="rad", table="bodies")
    # edge or vertex (from 1) over which it fell, rim, or flight; empty without a fall or not told
    fell_over: Words = column("", table="bodies")
    # displacement along the contact at the end, positive to the right
    slip: Floats = column(unit="m", table="contacts")
    # largest displacement along the contact
    peak_slip: Floats = column(unit="m", table="contacts")
    # largest friction over normal force until the fall was due; NaN not told
    friction_demand: Floats = column(table="contacts")
    # least normal force until the fall was due; NaN not told
    least_normal_force: Floats = column(unit="N", table="contacts")
    # times that a body hit a wall, a tie became taut, an isolator met its stop
    hits: Whole = column(np.int64(0), table="constraints")
    # largest impulse, of a hit
    largest_impulse: Floats = column(unit="N s", table="constraints")
    # largest force; of a bond what its most loaded side had to bear against being pulled off
    largest_force: Floats = column(unit="N", table="constraints")
    # instant of breaking; NaN if it held, or cannot break
    breaking_time: Floats = column(unit="s", table="constraints")
    # largest displacement of the plate of an isolator; NaN of all else
    stroke: Floats = column(unit="m", table="constraints")
    without_sliding: Flags | None = field(default=None, repr=False)
    systems: tuple[str, ...] = field(default=(), repr=False)
    motions: tuple[str, ...] = field(default=(), repr=False)
    peaks: tuple[float, ...] = field(default=(), repr=False)

    __repr__ = short_repr

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of systems, motions and scales."""
        systems, motions, scales = self.overturned.shape
        return systems, motions, scales

    @property
    def counts(self) -> tuple[int, ...]:
        """Number of bodies of each system."""
        return tuple(len(names) for names in self.names)

    def rows_of(self, table: Table) -> tuple[tuple[str, ...], ...]:
        """Return the names of the rows that each system has in a table of bodies, contacts or constraints."""
        return self.holding if table == "constraints" else self.names

    def of_top(self, name: str) -> NDArray[Any]:
        """Return a column of bodies or contacts of the uppermost one, shape (systems, motions, scales)."""
        values = getattr(self, name)
        return np.stack(
            [values[i, ..., count - 1] for i, count in enumerate(self.counts)]
        )

    def of_any(self, name: str) -> NDArray[Any]:
        """Column of bodies or contacts where it is largest, or least of least ones, (systems, motions, scales)."""
        pick = np.fmin if name.startswith("least") else np.fmax
        return np.asarray(pick.reduce(getattr(self, name), axis=-1))

    def wide(self, system: int, columns_of: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Return columns of one system with a number per case, the scale running fastest.

        Those of bodies or contacts become a column for each, numbered from below, such as
        ``peak_slip_contact_1_m``.
        """
        found = {}
        for known in (each for each in columns() if each.name in columns_of):
            values = getattr(self, known.name)[system]
            if known.table == "cases":
                found[known.title] = values.ravel()
                continue
            part = ROW_OF[known.table]
            for k in range(len(self.rows_of(known.table)[system])):
                name = f"{known.name}_{part}_{k + 1}{SUFFIXES[known.unit]}"
                found[name] = values[..., k].ravel()
        return found

    def plot(self, title: str = "") -> "Figure":
        """Draw the incremental dynamic analysis: peak rotations over the peak of the motion, and who falls.

        Parameters
        ----------
        title : heading of the figure

        Returns
        -------
        matplotlib.figure.Figure
            A panel a system: of each motion the peak rotation of the uppermost body over its critical angle [-]
            and a cross where it overturns, over the peak of the scaled motion [g]; below the fraction of the
            motions that overturn it.
        """
        # matplotlib is loaded only by those who draw
        from rockfrag.outcomes.outcomes_figure import outcomes_figure

        return outcomes_figure(self, title)

    def table(
        self, which: Table = "cases", columns_of: Sequence[str] | None = None
    ) -> pd.DataFrame:
        """Return one of the four tables, the scale running fastest, then bodies or contacts from below.

        Parameters
        ----------
        which : ``"cases"``, ``"bodies"``, ``"contacts"`` or ``"constraints"``
        columns_of : attributes that become columns; all of the table if None

        Returns
        -------
        A row per case, or per body or contact of a case: ``system``, ``motion`` (positions in the lists given),
        ``system_name``, ``motion_name`` (empty where they have none), ``scale``, in tables of bodies and contacts
        ``body`` or ``contact`` (from below, from 1; contact k lies under body k) and ``name`` of that body, in
        that of constraints ``constraint`` (from 1) and its ``name`` (``"wall 1"``, ``"bond 2"``, ``"support"``),
        and the columns of :func:`columns`, with their units in the names; of cases ``engine`` too.
        """
        if which not in get_args(Table):
            raise InputError(
                f"table: expected one of {', '.join(get_args(Table))}, got {which!r}."
            )
        chosen = [
            known
            for known in columns(which)
            if columns_of is None or known.name in columns_of
        ]
        whole = which == "cases"
        systems, motions, _ = self.shape
        names = self.rows_of(which)
        counts = [1 if whole else len(each) for each in names]
        most = max(counts, default=0)
        # each column is spread over systems, motions, scales and rows of a case; those that are there are taken
        full = (*self.shape, most)
        made: dict[str, Any] = {
            "system": np.arange(systems)[:, np.newaxis, np.newaxis, np.newaxis],
            "motion": np.arange(motions)[:, np.newaxis, np.newaxis],
            "system_name": _names(self.systems, systems)[
                :, np.newaxis, np.newaxis, np.newaxis
            ],
            "motion_name": _names(self.motions, motions)[:, np.newaxis, np.newaxis],
            "scale": self.scales[..., np.newaxis],
        }
        if not whole:
            made[ROW_OF[which]] = np.arange(1, most + 1)
            padded = np.full((systems, 1, 1, most), "", dtype=object)
            for i, each in enumerate(names):
                padded[i, 0, 0, : len(each)] = each
            made["name"] = padded
        made |= {
            known.title: getattr(self, known.name).reshape(full) for known in chosen
        }
        if whole:
            engines = np.array(self.engines, dtype=object)
            made["engine"] = engines[self.engine][..., np.newaxis]
        there = (
            np.arange(most)
            < np.array(counts, dtype=np.int64)[:, np.newaxis, np.newaxis, np.newaxis]
        )
        rows = np.broadcast_to(there, full).ravel()
        return pd.DataFrame(
            {name: np.broadcast_to(a, full).ravel()[rows] for name, a in made.items()}
        )


def _names(names: Sequence[str], count: int) -> Words:
    """Names as an array, shape (count,), empty ones where none are known."""
    return np.array(list(names) or [""] * count, dtype=object)


@cache
def columns(table: Table | None = None) -> tuple[Column, ...]:
    """Columns of a table of outcomes, or of all four, in their order.

    Parameters
    ----------
    table : which table; None for all

    Returns
    -------
    The columns.
    """
    return tuple(
        Column(each.name, **each.metadata)
        for each in fields(Outcomes)
        if each.metadata and table in (None, each.metadata["table"])
    )


def empty_outcomes(
    names: Sequence[Sequence[str]],
    scales: Floats,
    engines: Sequence[str] = (),
    *,
    holding: Sequence[Sequence[str]] = (),
) -> Outcomes:
    """Outcomes for an engine to write into.

    Parameters
    ----------
    names, scales : names of the bodies of each system, and factors, shape (motions, scales)
    engines : names of the engines
    holding : names of what holds the bodies of each system; empty: nothing holds any

    Returns
    -------
    The :class:`Outcomes`, of shape (systems, motions, scales).
    """
    shape = (len(names), *scales.shape)
    holding = holding or ((),) * len(names)
    most = max((len(each) for each in names), default=0)
    rows = {
        **{"cases": (), "bodies": (most,), "contacts": (most,)},
        "constraints": (max((len(each) for each in holding), default=0),),
    }
    arrays: dict[str, Any] = {
        known.name: np.full((*shape, *rows[known.table]), known.empty, known.dtype)
        for known in columns()
    }
    return Outcomes(
        names=tuple(tuple(each) for each in names),
        holding=tuple(tuple(each) for each in holding),
        scales=scales,
        engines=tuple(engines),
        engine=np.zeros(shape, np.int8),
        **arrays,
    )


def merge_outcomes(into: Outcomes, rows: Sequence[int], found: Outcomes) -> None:
    """Write the outcomes of some systems, answered by one engine, into the rows of those of all.

    Parameters
    ----------
    into, rows : outcomes of all systems, and places of some of them
    found : outcomes of these
    """
    place = np.asarray(rows, dtype=np.intp)
    numbers = np.array(
        [into.engines.index(name) for name in found.engines], dtype=np.int8
    )
    into.engine[place] = numbers[found.engine]
    for known in columns():
        values = getattr(found, known.name)
        if known.table == "cases":
            getattr(into, known.name)[place] = values
        else:
            getattr(into, known.name)[place, ..., : values.shape[-1]] = values
