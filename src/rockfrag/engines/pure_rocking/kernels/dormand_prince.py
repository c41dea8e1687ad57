"""Stages of Dormand and Prince's pair of order 5 (1980), and what each takes of the rates of those before it.

In: rates. Out: tables of numbers, and the estimate of the error.
Used in ``docs/contact.md``, "Modes, accelerations and forces".
"""

import numpy as np

from rockfrag.engines.compile.jit import inlined_kernel

INSTANTS = np.array([0.0, 0.2, 0.3, 0.8, 8 / 9, 1.0, 1.0])
WEIGHTS = np.array(
    [
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.2, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.075, 0.225, 0.0, 0.0, 0.0, 0.0),
        (44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0),
        (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0),
        (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0),
        (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
    ]
)
ERRORS = np.array(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]
)
"""Weights of the stages in :func:`error_rate`."""


@inlined_kernel
def error_rate(k, i):
    """Return by how much the solutions of order 5 and 4 part in a unit of time, of component i (table 2).

    ``k`` has the rates at the stages, shape (7, components).
    """
    return (
        71 / 57600 * k[0, i] - 71 / 16695 * k[2, i] + 71 / 1920 * k[3, i]
        - 17253 / 339200 * k[4, i] + 22 / 525 * k[5, i] - 1 / 40 * k[6, i]
    )  # fmt: skip
