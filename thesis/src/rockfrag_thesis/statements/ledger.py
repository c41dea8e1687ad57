"""The ledger: every statement with its kind, its rule, what came out, and the word for it."""

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from rockfrag.pedestal.cluster_means import TooFewUnitsError
from rockfrag.pedestal.multiplicity import holm
from rockfrag.records.motion import Motion
from rockfrag.rocking.ensemble import LightBodies
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.statements import (  # noqa: F401  (each enters its statements when it is loaded)
    blocks,
    earthquakes,
    floors,
    pedestal,
    protocol,
    slenderness,
    spectra,
    stacks,
)
from rockfrag_thesis.statements.evidence import Evidence
from rockfrag_thesis.statements.setting import FreeRocking, Setting, make_setting
from rockfrag_thesis.statements.statement import (
    STATEMENTS,
    Finding,
    Kind,
    Result,
    Statement,
    Undecidable,
    verdict,
)

THEORY = range(1, 25)
"""Numbers of the statements about theory; the others are about tests."""

COLUMNS = (
    "number",
    "statement",
    "source",
    "kind",
    "evidence",
    "rule",
    "error_rate",
    "finding",
    "verdict",
    "figure",
    "estimate",
    "lower",
    "upper",
    "unit",
    "p",
    "p_of",
    "p_holm",
    "basis",
    "remark",
)
"""Columns of the ledger, ``claims.csv``."""


@dataclass(frozen=True)
class Row:
    """A statement and what came out."""

    statement: Statement
    result: Result
    basis: str


def theory_ledger(
    specimens: Mapping[str, Block],
    motions: Sequence[Motion],
    *,
    seed: int,
    free_rocking: FreeRocking | None = None,
    threads: int | None = None,
    assemblies: Mapping[str, Stack] | None = None,
) -> pd.DataFrame:
    """Compute C1 to C24 for specimens and ground motions.

    A statement about which they cannot speak (no stack, no motion) is open, with the reason.

    Parameters
    ----------
    specimens
        Blocks by name.  A block named "P" is the pedestal: without ``assemblies`` each other block is put on it.
    motions
        Ground motions at their recorded amplitude.
    seed
        Of the perturbations and random geometries.
    free_rocking
        Measured free rocking by specimen: times [s] and rotations [rad] of a history (C5).
    threads
        Threads to use; the results do not depend on it.
    assemblies
        Stacks by name.

    Returns
    -------
    pandas.DataFrame
        Columns of ``COLUMNS``.

    Raises
    ------
    InputError
        If a measured history cannot be used.
    """
    setting = make_setting(specimens, motions, seed, free_rocking, threads, assemblies)
    return _table(_row(one, setting, "simulated") for one in _statements(theory=True))


def ledger(tests: Evidence) -> pd.DataFrame:
    """Test C25 to C58 on one table of tests.

    A statement about which the table cannot speak (a floor that was not tested, a column that is
    absent, a single object) is open, with the reason.

    Returns
    -------
    pandas.DataFrame
        Columns of ``COLUMNS``.

    Raises
    ------
    InputError
        If the table of tests itself cannot be used.
    """
    _ = tests.clean  # a table that cannot be used is the user's error, and no statement's
    return _table(_row(one, tests, tests.basis) for one in _statements(theory=False))


def _statements(theory: bool) -> list[Statement]:
    return [STATEMENTS[n] for n in sorted(STATEMENTS) if (n in THEORY) == theory]


def _row(one: Statement, evidence: Setting | Evidence, basis: str) -> Row:
    try:
        with warnings.catch_warnings():
            # the statements are about pure rocking, whose limits the chapter on validity counts
            warnings.simplefilter("ignore", LightBodies)
            result = one.test(evidence)
    except (Undecidable, TooFewUnitsError) as reason:
        result = Result(Finding.OPEN, "no figure", remark=f"these data cannot decide it: {reason}")
    if one.kind is Kind.IDENTITY:
        basis = "computed"
    return Row(one, result, result.basis or basis)


def _table(rows: Iterable[Row]) -> pd.DataFrame:
    table = pd.DataFrame(
        [
            {
                "number": row.statement.number,
                "statement": row.statement.text,
                "source": row.statement.source,
                "kind": str(row.statement.kind),
                "evidence": row.statement.evidence,
                "rule": row.statement.rule,
                "error_rate": row.statement.error_rate,
                "finding": str(row.result.finding),
                "verdict": verdict(row.statement.kind, row.basis, row.result.finding),
                "figure": row.result.figure,
                "estimate": row.result.estimate,
                "lower": row.result.lower,
                "upper": row.result.upper,
                "unit": row.result.unit,
                "p": row.result.p,
                "p_of": row.result.p_of,
                "p_holm": math.nan,
                "basis": row.basis,
                "remark": row.result.remark,
            }
            for row in rows
        ],
        columns=list(COLUMNS),
    )
    # many statements are tested on one table: what still stands when all of them are counted
    table["p_holm"] = holm(table["p"])
    return table
