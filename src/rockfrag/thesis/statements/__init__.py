"""The ledger of the thesis's statements: statement, test, figure, interval, verdict."""

from rockfrag.thesis.statements.contradictions import contradictions
from rockfrag.thesis.statements.evidence import Evidence
from rockfrag.thesis.statements.experiment import experiment_claims, ledger
from rockfrag.thesis.statements.ledger import COLUMNS, ClaimResult, ledger_table
from rockfrag.thesis.statements.statements import STATEMENTS, Statement

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
