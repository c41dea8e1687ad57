"""The ledger of the thesis's statements: statement, test, figure, interval, verdict."""

from rockfrag.claims.contradictions import contradictions
from rockfrag.claims.evidence import Evidence
from rockfrag.claims.experiment import experiment_claims, ledger
from rockfrag.claims.ledger import COLUMNS, ClaimResult, ledger_table
from rockfrag.claims.statements import STATEMENTS, Statement

__all__ = [
    "COLUMNS",
    "STATEMENTS",
    "ClaimResult",
    "Evidence",
    "Statement",
    "contradictions",
    "experiment_claims",
    "ledger",
    "ledger_table",
]
