from .laboratory_table import read_measured as read_measured
from .protocols import (
    Outcome as Outcome,
    Protocol as Protocol,
)
from .definitions import tests_from_ida as tests_from_ida
from .shaker import (
    Shaker as Shaker,
    produced_motion as produced_motion,
    read_shaker as read_shaker,
    required_corner as required_corner,
    shaker_table as shaker_table,
)
