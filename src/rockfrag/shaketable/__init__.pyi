from .tests_table import read_measured as read_measured
from .protocols import Protocol as Protocol
from .definitions import tests_from_ida as tests_from_ida
from .shaker import (
    produced_motion as produced_motion,
    read_shaker as read_shaker,
    required_corner as required_corner,
)
