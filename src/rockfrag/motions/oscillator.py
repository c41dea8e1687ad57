"""The exact step of a linear oscillator, of plain arithmetic: the same bits everywhere; kernels call it too.

In: circular frequency [rad/s], damping and step [s]. Out: what maps a state to that of a step later.
Theory: ``docs/motions.md``; Nigam & Jennings (1969, Bull. Seism. Soc. Am. 59(2), 909-922).
"""

import math

from rockfrag.base.arrays import Floats
from rockfrag.base.elementary import sin_cos
from rockfrag.base.exponentials import exp


def fill_propagator(omega: float, damping: float, step: float, matrix: Floats) -> None:
    """Fill the propagator over one step of linearly varying ground acceleration.

    The state is (u, u', a, s): relative displacement and velocity, ground acceleration and its slope; u'' + 2 ζ ω
    u' + ω² u = -a, a' = s; for any damping, at and above critical too.

    Parameters
    ----------
    omega : circular frequency [rad/s]
    damping : fraction of critical damping [-]
    step : length of the step [s]
    matrix : maps (u, u', a, s) to (u, u') one step later, shape (2, 4)
    """
    rate, square = damping * omega, omega * omega
    turn = omega * math.sqrt(abs(1.0 - damping * damping))
    if damping < 1.0:
        decay = exp(-rate * step)
        sine, cosine = sin_cos(turn * step)
        cosine, sine = decay * cosine, decay * sine / turn
    elif damping > 1.0:
        slow, fast = exp((turn - rate) * step), exp(-(turn + rate) * step)
        cosine, sine = (slow + fast) / 2, (slow - fast) / (2 * turn)
    else:
        cosine = exp(-rate * step)
        sine = step * cosine
    matrix[0, 0], matrix[0, 1] = cosine + rate * sine, sine
    matrix[1, 0], matrix[1, 1] = -square * sine, cosine - rate * sine
    # the steady answer to a and to s at the beginning of the step, and one step later
    of_a, of_slope = -1.0 / square, 2 * damping / omega / square
    for i in range(2):
        here, slope = matrix[i, 0], matrix[i, 1]
        later_a = of_a if i == 0 else 0.0
        later_slope = of_slope - step / square if i == 0 else of_a
        matrix[i, 2] = later_a - here * of_a
        matrix[i, 3] = later_slope - (here * of_slope + slope * of_a)
