"""A study of somebody's own table of tests: overturned yes or no, with intensity measures."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError
from rockfrag.files import is_file
from rockfrag.study.heading import Heading, beside, heading_of
from rockfrag.tabular import read_table

TABLE_KEY = "table"  # key that only a study of a measured table has


@dataclass(frozen=True)
class MeasuredTable(Heading):
    """Everything that the configuration of a measured table says, checked."""

    table: Path  # CSV with one row per test
    # For each intensity measure the columns and numbers whose product it is
    measures: Mapping[str, tuple[str | float, ...]]
    # Columns: outcome, input motion, earthquake, and those against which sufficiency is tested
    overturned: str
    motion: str | None
    earthquake: str | None
    given: tuple[str, ...]
    confidence: float  # Level of the intervals
    replicates: int  # Number of bootstrap samples

    @property
    def summary(self) -> str:
        """What it computes, in a line."""
        return f"the table {self.table}"


def measured_table_from(content: Mapping[str, Any], source: Path) -> MeasuredTable:
    """Make a study of a measured table from a checked configuration that was read from ``source``."""
    table = beside(source, content[TABLE_KEY])
    if not is_file(table):
        raise InputError(
            f"{source}: key {TABLE_KEY}: there is no {table}; put a CSV file with one row per test "
            "there, or name yours."
        )
    columns = content["columns"]
    _check_columns(source, table, content)
    return MeasuredTable(
        **heading_of(content, source),
        table=table,
        measures={name: tuple(factors) for name, factors in content["measures"].items()},
        overturned=columns["overturned"],
        motion=columns.get("motion"),
        earthquake=columns.get("earthquake"),
        given=tuple(columns.get("given", ())),
        confidence=content["confidence"],
        replicates=content.get("replicates", 200),
    )


def _check_columns(source: Path, table: Path, content: Mapping[str, Any]) -> None:
    """Refuse columns that the table does not have."""
    header = read_table(table).titles
    columns = content["columns"]
    wanted = [
        *((f"columns.{key}", columns.get(key)) for key in ("overturned", "motion", "earthquake")),
        *((f"columns.given[{i}]", name) for i, name in enumerate(columns.get("given", ()))),
    ]
    for measure, factors in content["measures"].items():
        wanted += [(f"measures.{measure}[{i}]", factor) for i, factor in enumerate(factors)]
    for key, name in wanted:
        if isinstance(name, str) and name not in header:
            raise InputError(
                f"{source}: key {key}: expected a column of {table}, one of {', '.join(header)}, found {name}."
            )
