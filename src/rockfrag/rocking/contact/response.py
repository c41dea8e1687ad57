"""What a simulation with friction and flight returns."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.rocking.bodies import Body

Array = NDArray[np.float64]

MODES = {
    (0, 0): "flies",
    (1, 0): "rocks left",
    (2, 0): "rocks right",
    (3, 0): "stands",
    (1, 1): "rocks left, slides right",
    (1, -1): "rocks left, slides left",
    (2, 1): "rocks right, slides right",
    (2, -1): "rocks right, slides left",
    (3, 1): "slides right",
    (3, -1): "slides left",
}
"""Names of the modes of an interface: its closed ends (bits: left, right) and the sign of slip."""


def mode_names(number: int, interfaces: int) -> tuple[str, ...]:
    """Name of each interface's mode in the number that the kernels keep."""
    digits = [(number >> (4 * k)) & 15 for k in range(interfaces)]
    return tuple(MODES[digit & 3, (digit >> 2) - 1] for digit in digits)


@dataclass(frozen=True)
class ContactResponse:
    """Response of one body that may slide, rock and fly.

    Columns are (block,) for a lone block and (pedestal, statue) for a stack, or the interfaces below them.

    Attributes
    ----------
    body
        The body that was simulated.
    time
        Times of the samples [s], shape (n,); the motion and the free motion after it.
    position
        x and y of the centres of gravity relative to the moving ground [m], shape (n, blocks, 2).
    theta, omega
        Rotations [rad] and angular velocities [rad/s], shape (n, blocks).
    slip
        Displacement along each interface of the corner that carries, from where it stood at first [m], shape
        (n, blocks); positive to the right.
    mode
        What each interface does at the samples ("stands", "rocks right, slides left", …), shape (n, blocks).
    events
        One row per change: ``time`` [s], ``kind`` ("change", "impact", "paradox" or "fall"), ``from``, ``to``
        (modes of the interfaces), ``slip`` [m] (of the interfaces), ``loss`` of kinetic energy [J].
    overturned
        Whether a block fell, over a corner or over the edge.
    overturned_body
        ``"block"``, ``"pedestal"``, ``"statue"``, or ``""``.
    overturning_time
        When it lay down or left the edge [s], NaN if it did not.
    energy
        Table over time [J]: ``kinetic``, ``potential``, ``input`` (work of the ground so far), ``lost_friction``,
        ``lost_impacts``, and ``residual``, which is zero but for rounding.
    normal_force, friction_force
        Forces of each interface on the block above it, across and along the face that carries [N],
        shape (n, blocks).
    impacts
        Number of impacts.
    paradoxes
        Times that no mode was consistent and contacts received an impulse as in the limit of stiff contact.
    forced
        Events of samples with so many that accumulating ones were ended more coarsely.
    """

    body: Body
    time: Array
    position: Array
    theta: Array
    omega: Array
    slip: Array
    mode: NDArray[np.str_]
    events: pd.DataFrame
    overturned: bool
    overturned_body: str
    overturning_time: float
    energy: pd.DataFrame
    normal_force: Array
    friction_force: Array
    impacts: int
    paradoxes: int
    forced: int
