from .laboratory_table import read_measured as read_measured
from .protocols import (
    Outcome as Outcome,
    Protocol as Protocol,
)
from .definitions import (
    always_overturning as always_overturning,
    first_overturning as first_overturning,
    step_protocol as step_protocol,
    tests_from_ida as tests_from_ida,
)
from .settings import read_shaker as read_shaker
from .shaker import (
    Shaker as Shaker,
    limits_g as limits_g,
    produced_motion as produced_motion,
    required_corner as required_corner,
    shaker_table as shaker_table,
)
