"""Stages of Dormand and Prince's pair of order 5 (1980), and what each takes of the rates of those before it.

In: nothing. Out: tables of numbers. Used in ``docs/contact.md``, "Modes, accelerations and forces".
"""

import numpy as np

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
