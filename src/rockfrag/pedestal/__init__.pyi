from .paired_tests import (
    Pairs as Pairs,
    check_tests as check_tests,
    pair_tests as pair_tests,
)
from .study import (
    PedestalStudy as PedestalStudy,
    effects_table as effects_table,
    study_pedestal as study_pedestal,
)
