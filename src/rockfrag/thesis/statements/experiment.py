"""C25 to C58 on one table of tests."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

import pandas as pd

from rockfrag.pedestal.cluster_means import TooFewUnitsError
from rockfrag.rocking.bodies import Block
from rockfrag.thesis.statements import events, floors, protocol, slenderness
from rockfrag.thesis.statements.evidence import Evidence, Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult, ledger_table
from rockfrag.thesis.statements.results import not_decidable

Test = Callable[[Evidence], ClaimResult]

TESTS: Mapping[int, Test] = {
    25: slenderness.c25,
    26: slenderness.c26,
    27: slenderness.c27,
    28: slenderness.c28,
    29: slenderness.c29,
    30: slenderness.c30,
    31: slenderness.c31,
    32: slenderness.c32,
    33: slenderness.c33,
    34: floors.c34,
    35: floors.c35,
    36: floors.c36,
    37: floors.c37,
    38: floors.c38,
    39: floors.c39,
    40: floors.c40,
    41: floors.c41,
    42: floors.c42,
    43: floors.c43,
    44: floors.c44,
    45: events.c45,
    46: events.c46,
    47: events.c47,
    48: events.c48,
    49: events.c49,
    50: floors.c50,
    51: floors.c51,
    52: events.c52,
    53: slenderness.c53,
    54: slenderness.c54,
    55: protocol.c55,
    56: protocol.c56,
    57: protocol.c57,
    58: protocol.c58,
}
"""Test of each statement about the experiment."""

EXPLORATORY = range(32, 49)
"""Statements about parts of the data, found by looking at it."""


def experiment_claims(evidence: Evidence) -> list[ClaimResult]:
    """Test C25 to C58 on one table.

    A statement about which the table cannot speak (a floor that was not tested, a column that is
    absent) is undecided, with the reason.

    Raises
    ------
    InputError
        If the table of tests itself cannot be used.
    """
    results = []
    for number, test in TESTS.items():
        try:
            result = test(evidence)
        except (Undecidable, TooFewUnitsError) as reason:
            result = not_decidable(number, test, evidence.basis, reason)
        if number in EXPLORATORY:
            result = replace(result, remark="; ".join(filter(None, ["exploratory", result.remark])))
        results.append(result)
    return results


def ledger(
    tests: pd.DataFrame,
    *,
    basis: str,
    seed: int,
    measures: pd.DataFrame | None = None,
    bodies: Mapping[str, Block] | None = None,
    sliding: pd.DataFrame | None = None,
    others: Iterable[ClaimResult] = (),
) -> pd.DataFrame:
    """The ledger of one table of tests, together with results from elsewhere (C1 to C24).

    Parameters
    ----------
    tests, basis, seed, measures, bodies, sliding
        See `Evidence`.
    others
        Results for other statements or another basis, such as those of a measured table.

    Returns
    -------
    pandas.DataFrame
        Columns of `rockfrag.thesis.statements.ledger.COLUMNS`.
    """
    evidence = Evidence(tests, basis, seed, measures, bodies, sliding)
    return ledger_table([*others, *experiment_claims(evidence)])
