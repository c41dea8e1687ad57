from .motion import (
    Motion as Motion,
)
from .read import (
    read_motion as read_motion,
)
from .velocity_steps import (
    VelocitySteps as VelocitySteps,
    bump_and_stop as bump_and_stop,
    landing as landing,
)
from .write import (
    write_motion as write_motion,
)
