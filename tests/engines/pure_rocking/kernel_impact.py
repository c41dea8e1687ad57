"""The kernels' impact, and their record of contacts and motion, as tests ask for them."""

import numpy as np

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.pure_rocking.kernels.equations import STATE
from rockfrag.engines.pure_rocking.kernels.impact import impact


# kernels can be called by kernels only
@entry_kernel
def kernel_impact(body, at, closes1, closes2):
    return impact(body, at, closes1, closes2)


def state_record(c, theta, omega, pull=(0.0, 9.81)) -> np.void:
    """Contacts and motion; ``pull``: acceleration of the ground, and gravity."""
    made = np.zeros(1, STATE)
    made[0] = (*c, theta[0], omega[0], theta[1], omega[1], *pull)
    return made[0]
