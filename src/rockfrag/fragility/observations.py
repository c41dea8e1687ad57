"""Observations that every fragility estimator starts from, checked once at the door, and their pooling.

In: tables of tests, a row a test, or of counts. Out: :class:`Observations`, arrays of shape (n,) with the
measure in its unit; messages about bad rows name table, row and column. Theory: ``docs/fragility.md``, "When the
data do not allow a curve".
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.motions.intensity import measure_of, split_column

Floats = NDArray[np.float64]  # an array of floating-point numbers
Over = Literal["motion", "earthquake"]
"""What tests are grouped by: those of a group are not independent."""


class Grouped:
    """Tests that are labelled with their motion and earthquake."""

    motion: NDArray[np.object_]
    earthquake: NDArray[np.object_]

    @property
    def n_motions(self) -> int:
        """Number of different motions."""
        return len(pd.unique(pd.Series(self.motion)))

    @property
    def n_earthquakes(self) -> int:
        """Number of different earthquakes."""
        return len(pd.unique(pd.Series(self.earthquake)))

    def groups(self, over: Over) -> NDArray[np.object_]:
        """Label of each test's motion or earthquake, shape (n,)."""
        return self.motion if over == "motion" else self.earthquake


@dataclass(frozen=True)
class Observations(Grouped):
    """Overturned or not, at known values of one intensity measure.

    Attributes
    ----------
    im : intensity measure of each row, > 0, shape (n,)
    overturned, trials : number of tests of the row that overturned, and of all, shape (n,); 1 for single tests
    motion, earthquake : labels, shape (n,); rows of one are not independent; the motion's for no earthquake
    name, unit : the intensity measure as the field writes it, for example ``PGA`` and ``g``
    """

    im: Floats
    overturned: Floats
    trials: Floats
    motion: NDArray[np.object_]
    earthquake: NDArray[np.object_]
    name: str = "IM"
    unit: str = ""
    # whether rows are labelled with motions; else they are tests, or counts of tests
    of_motions: bool = True

    __repr__ = short_repr

    @property
    def log_im(self) -> Floats:
        """Natural logarithm of the intensity measure, shape (n,)."""
        return np.asarray(np.log(self.im))

    @property
    def n(self) -> int:
        """Number of tests."""
        return int(self.trials.sum())

    @property
    def n_overturned(self) -> int:
        """Number of tests that overturned."""
        return int(self.overturned.sum())

    @property
    def n_repeated(self) -> int:
        """Number of rows that repeat the motion, the value and the outcome of an earlier row."""
        rows = pd.DataFrame(
            {"m": self.motion, "x": self.im, "y": self.overturned / self.trials}
        )
        return int(rows.duplicated().sum())

    @property
    def is_swept(self) -> bool:
        """Whether motions have more than one row."""
        return self.n_motions < self.im.size

    def log_arrangements(self) -> Floats:
        """Logarithm of the binomial coefficient of each row, trials over overturned, shape (n,)."""
        stood = self.trials - self.overturned
        logs = special.gammaln(self.trials + 1) - special.gammaln(self.overturned + 1)
        return np.asarray(logs - special.gammaln(stood + 1))

    def pooled(self, cell: NDArray[np.intp], im: Floats) -> "Observations":
        """Tests of each cell as one row at a value of the measure, and one motion of its own."""
        fell = np.bincount(cell, self.overturned).astype(np.float64)
        trials = np.bincount(cell, self.trials).astype(np.float64)
        labels = np.arange(im.size).astype(object)
        return Observations(im, fell, trials, labels, labels, self.name, self.unit)

    def by_value(self) -> "Observations":
        """The same tests in no more rows than a kernel estimate needs."""
        return self

    def group_weights(self, weights: Floats) -> Floats:
        """Weights of the groups of rows: those of the motions or earthquakes, as each group is one."""
        return weights

    def independent(self, inside: NDArray[np.bool_]) -> tuple[int, float]:
        """How many motions have tests in some rows, and tests of which a motion's several rows count once."""
        largest = pd.Series(self.trials[inside]).groupby(self.motion[inside]).max()
        return int(pd.Series(self.motion[inside]).nunique()), float(largest.sum())

    def drawn(self, capacity: Floats, cell: NDArray[np.intp]) -> Floats:
        """Outcomes by cell where each motion has one capacity [ln IM], shape (replicates, cells).

        The capacities, shape (replicates, motions), are in the order in which the motions first appear.
        """
        codes, log_im = pd.factorize(pd.Series(self.motion))[0], self.log_im
        fallen = ((log_im > thresholds[codes]) * self.trials for thresholds in capacity)
        return np.array([np.bincount(cell, each) for each in fallen])


def name_and_unit(column: str) -> tuple[str, str]:
    """Split a column name: ``pga_g`` gives ``("PGA", "g")``, ``sa_0_3s_g`` ``("SA(0.3s)", "g")``.

    Parameters
    ----------
    column : name of a column of a table

    Returns
    -------
    Name and unit of the measure; a name without a known unit is whole, with an empty unit.
    """
    found = measure_of(column)
    if found is not None:
        return found.label, found.unit
    name, unit = split_column(column)
    return name.replace("_", " "), unit


def numbers(
    table: pd.DataFrame, column: str, source: str = "table", first: int = 1
) -> Floats:
    """Column of a table as finite numbers.

    Parameters
    ----------
    table, column : n rows, and the name of the column
    source, first : name of the table in messages, and the number of its first row there

    Returns
    -------
    The numbers in the unit of the column, shape (n,).
    """
    if column not in table:
        known = ", ".join(map(str, table.columns))
        raise InputError(
            f"{source}: there is no column {column!r}; name one of the columns {known}."
        )
    values = pd.to_numeric(table[column], errors="coerce").to_numpy(dtype=np.float64)
    wrong = ~np.isfinite(values)
    if wrong.any():
        row = int(wrong.argmax())
        found = table[column].iloc[row]
        raise InputError(
            f"{source}, row {row + first}, column {column!r}: {'nothing' if pd.isna(found) else repr(found)} "
            "is not a finite number; correct it or leave the row out."
        )
    return values


def positive(
    table: pd.DataFrame, column: str, source: str = "table", first: int = 1
) -> Floats:
    """Column of a table as numbers above zero, because they enter by their logarithm.

    Parameters
    ----------
    table, column, source, first : as of :func:`numbers`

    Returns
    -------
    The numbers in the unit of the column, shape (n,).
    """
    values = numbers(table, column, source, first)
    wrong = values <= 0
    if wrong.any():
        row = int(wrong.argmax())
        raise InputError(
            f"{source}, row {row + first}, column {column!r}: an intensity measure must be above "
            f"zero to have a logarithm, got {values[row]:g}; correct it or leave the row out."
        )
    return values


def read_observations(
    table: pd.DataFrame, column: str, source: str = "table"
) -> Floats:
    """Column of outcomes, 0 or 1.

    Parameters
    ----------
    table, column, source : as of :func:`numbers`

    Returns
    -------
    The outcomes, shape (n,).
    """
    values = numbers(table, column, source)
    wrong = (values != 0) & (values != 1)
    if wrong.any():
        row = int(wrong.argmax())
        raise InputError(
            f"{source}, row {row + 1}, column {column!r}: overturned must be 0 or 1, got "
            f"{values[row]:g}; give counts of several tests with a column of trials."
        )
    return values


def labels(
    table: pd.DataFrame, column: str | None, source: str = "table", first: int = 1
) -> NDArray[np.object_]:
    """Column of labels.

    Parameters
    ----------
    table, column, source, first : as of :func:`numbers`; a label per row where ``column`` is None

    Returns
    -------
    The labels, shape (n,).
    """
    if column is None:
        return np.array(
            [f"row {row + first}" for row in range(len(table))], dtype=object
        )
    if column not in table:
        raise InputError(
            f"{source}: there is no column {column!r}; correct the name of the column."
        )
    missing = table[column].isna().to_numpy()
    if missing.any():
        row = int(missing.argmax())
        raise InputError(
            f"{source}, row {row + first}, column {column!r}: the label is missing; fill it in."
        )
    return table[column].to_numpy(dtype=object)


def observations_from_table(
    table: pd.DataFrame,
    im: str,
    *,
    overturned: str = "overturned",
    trials: str | None = None,
    motion: str | None = "motion",
    earthquake: str | None = None,
    source: str = "table",
) -> Observations:
    """Read outcomes and one intensity measure out of a table.

    Parameters
    ----------
    table, im
        One row per test, or per group of equal tests when ``trials`` names a column of counts; and the column of
        the intensity measure, whose unit is read from the name (``pga_g``, ``pgv_cm_s``).
    overturned, trials
        Column of outcomes (0/1, false/true), or of counts when the column with the number of tests is given.
    motion, earthquake, source
        Columns with labels, None where every row is a motion (earthquake) of its own; what messages call it.

    Returns
    -------
    The :class:`Observations`, of n rows.
    """
    if len(table) == 0:
        raise InputError(f"{source}: there is no row; give at least one test.")
    values = positive(table, im, source)
    if trials is None:
        counts = np.ones(len(table))
        failed = read_observations(table, overturned, source)
    else:
        counts = numbers(table, trials, source)
        failed = numbers(table, overturned, source)
        wrong = (failed < 0) | (failed > counts) | (counts <= 0)
        if wrong.any():
            row = int(wrong.argmax())
            raise InputError(
                f"{source}, row {row + 1}, column {overturned!r}: {failed[row]:g} overturned of "
                f"{counts[row]:g} tests is not a fraction between 0 and 1; correct the counts."
            )
    motions = labels(table, motion, source)
    earthquakes = motions if earthquake is None else labels(table, earthquake, source)
    named = motion is not None
    return Observations(
        values, failed, counts, motions, earthquakes, *name_and_unit(im), named
    )


MOST_VALUES = 1000
"""Different values of a measure that are kept apart; more fall into as many cells of equal counts."""


def cells(
    measure: Floats, most: int = MOST_VALUES, tests: Floats | None = None
) -> tuple[NDArray[np.intp], Floats]:
    """Put each row into a cell of equal or neighbouring values.

    Up to ``most`` different values have a cell each; of more, cells have about equally many rows, or tests.

    Parameters
    ----------
    measure : values, shape (n,)
    most : number of cells at most
    tests : number of tests in each row, shape (n,); None for one

    Returns
    -------
    Number of the cell of each row, shape (n,), and mean of each cell, rising, shape (cells,).
    """
    values, cell = np.unique(measure, return_inverse=True)
    if values.size <= most:
        return cell, values
    count = np.bincount(cell, tests)
    middle = np.cumsum(count) - 0.5 * count
    coarse = np.unique(
        (middle / count.sum() * most).astype(np.intp), return_inverse=True
    )[1]
    cell = coarse[cell]
    return cell, np.bincount(cell, measure) / np.bincount(cell)


def counts(group: NDArray[np.intp], cell: NDArray[np.intp], weight: Floats) -> Floats:
    """Sum weights by group and cell.

    Parameters
    ----------
    group, cell, weight : of each row, shape (n,)

    Returns
    -------
    The sums, shape (groups, cells).
    """
    groups, columns = int(group.max()) + 1, int(cell.max()) + 1
    flat = np.bincount(group * columns + cell, weight, minlength=groups * columns)
    return np.asarray(flat.reshape(groups, columns))
