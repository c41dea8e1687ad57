"""The effect of a pedestal on overturning: d = ln a_P - ln a_NP, tested as a referee would."""

from rockfrag.pedestal.explanation import explain
from rockfrag.pedestal.paired_tests import Pairs, check_tests, pair_tests
from rockfrag.pedestal.study import PedestalStudy, effects_table, study_pedestal

__all__ = [
    "Pairs",
    "PedestalStudy",
    "check_tests",
    "effects_table",
    "explain",
    "pair_tests",
    "study_pedestal",
]
