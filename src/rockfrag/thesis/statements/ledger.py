"""The ledger: what was claimed, how it was tested, and what came out."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import pandas as pd

from rockfrag.thesis.statements.statements import STATEMENTS

VERDICTS = ("supported", "contradicted", "undecided")
BASES = ("simulated", "measured")
COLUMNS = (
    "number",
    "statement",
    "source",
    "test",
    "figure",
    "estimate",
    "lower",
    "upper",
    "unit",
    "verdict",
    "basis",
    "remark",
)
"""Columns of the ledger, ``claims.csv``."""


@dataclass(frozen=True)
class ClaimResult:
    """What one test says about one statement.

    Parameters
    ----------
    number
        Number of the statement, 1 to 58.
    test
        How it was tested, in words a statistician can repeat.
    figure
        The result with its interval, in words and digits.
    verdict
        ``supported``, ``contradicted`` or ``undecided``.
    basis
        ``simulated`` (models, closed forms included) or ``measured``.
    estimate, lower, upper
        The figure and its interval in ``unit``; NaN where there is no single figure.
    unit
        Unit of the three, ``-`` for ratios and probabilities.
    remark
        What else a reader must know: the power needed when undecided, the population meant.

    Raises
    ------
    ValueError
        If number, verdict or basis is not one of those above.
    """

    number: int
    test: str
    figure: str
    verdict: str
    basis: str
    estimate: float = math.nan
    lower: float = math.nan
    upper: float = math.nan
    unit: str = "-"
    remark: str = ""

    def __post_init__(self) -> None:
        if self.number not in STATEMENTS:
            raise ValueError(f"there is no statement C{self.number}")
        if self.verdict not in VERDICTS:
            raise ValueError(f"C{self.number}: verdict {self.verdict!r} is none of {VERDICTS}")
        if self.basis not in BASES:
            raise ValueError(f"C{self.number}: basis {self.basis!r} is none of {BASES}")


def ledger_table(results: Iterable[ClaimResult]) -> pd.DataFrame:
    """Put results into one table by number, then basis, with the columns of ``COLUMNS``."""
    rows = [
        {
            "number": one.number,
            "statement": STATEMENTS[one.number].text,
            "source": STATEMENTS[one.number].source,
            "test": one.test,
            "figure": one.figure,
            "estimate": one.estimate,
            "lower": one.lower,
            "upper": one.upper,
            "unit": one.unit,
            "verdict": one.verdict,
            "basis": one.basis,
            "remark": one.remark,
        }
        for one in results
    ]
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    return table.sort_values(["number", "basis"], kind="stable", ignore_index=True)
