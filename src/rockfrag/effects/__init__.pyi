from .paired_tests import Pairs as Pairs
from .study import (
    PedestalStudy as PedestalStudy,
    study_pedestal as study_pedestal,
)
