"""What a column of a table of outcomes is: declared once, beside the array that holds it."""

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

Table = Literal["cases", "bodies", "contacts"]
"""The three tables of outcomes: a row per case, per body of a case, per contact of a case."""

SUFFIXES = {"": "", "s": "_s", "rad": "_rad", "rad/s": "_rad_s", "m": "_m", "N": "_n"}
"""What a unit adds to the name of a column."""


@dataclass(frozen=True)
class Column:
    """One column of a table of outcomes: an attribute of :class:`rockfrag.outcomes.Outcomes`.

    ``unit`` is empty for a number without one, a count or a statement; ``meaning`` says in one sentence what it
    is, and what NaN means where it can be NaN; ``empty``, of the column's type, stands where no engine has
    answered.
    """

    name: str
    table: Table
    unit: str
    meaning: str
    empty: Any

    @property
    def title(self) -> str:
        """Name in a table, with the unit."""
        return self.name + SUFFIXES[self.unit]

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of its values; words are objects, as numpy cuts longer ones off otherwise."""
        return np.dtype(object) if isinstance(self.empty, str) else np.asarray(self.empty).dtype


def column(table: Table, unit: str, meaning: str, empty: Any) -> Any:
    """Declare a column as a field of :class:`rockfrag.outcomes.Outcomes`."""
    return field(metadata={"table": table, "unit": unit, "meaning": meaning, "empty": empty})
