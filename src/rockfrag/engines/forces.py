"""Contact forces and energies of a computed response: was the model allowed to be used?

The forces follow from the absolute accelerations of the centres of gravity: N2 = m2 (g + y2''),
T2 = m2 x2'', and the sums over both blocks at the ground.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rockfrag.elementary import hypot
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.kernels.record import fill_sines
from rockfrag.system import geometry
from rockfrag.system.system import System

Array = NDArray[np.float64]
Pair = tuple[float, float]


Way = tuple[NDArray[np.bool_], Pair, Pair, Pair]


def _ways(system: System, state: NDArray[np.int64]) -> Iterator[Way]:
    """Yield the rows of each way to rock, and the arms of the lower body, of the upper one's foot, and of that."""
    signs = np.where(state == 0, 1, state)
    for side in (+1, -1):
        arm = geometry.arm(system.shapes[0], side)
        if system.count == 1:
            yield signs[:, 0] == side, arm, (0.0, 0.0), (0.0, 0.0)
            continue
        for two in (+1, -1):
            rows = (signs[:, 0] == side) & (signs[:, 1] == two)
            foot = geometry.reach(system.pile, side, two)
            yield rows, arm, foot, geometry.upper_arm(system.pile, two)


def centres(system: System, state: NDArray[np.int64], theta: Array) -> Array:
    """Centres of gravity of bodies that rock without sliding, relative to the ground [m], shape (n, blocks, 2)."""
    found = np.zeros((*theta.shape, 2))
    sine, cosine = _sines(theta)

    def turned(arm: Pair, rows: NDArray[np.bool_], block: int) -> Array:
        s, c = sine[rows, block], cosine[rows, block]
        return np.column_stack([arm[0] * c + arm[1] * s, -arm[0] * s + arm[1] * c])

    for rows, arm, foot, above in _ways(system, state):
        found[rows, 0] = turned(arm, rows, 0)
        if system.count == 2:
            found[rows, 1] = turned(foot, rows, 0)
            found[rows, 1] += turned(above, rows, 1)
        found[rows, :, 0] += system.shapes[0].x - arm[0]
    return found


def _sines(theta: Array) -> tuple[Array, Array]:
    """Sine and cosine of rotations, the same on every processor."""
    sine, cosine = np.empty_like(theta), np.empty_like(theta)
    with compiling_alone(fill_sines):
        fill_sines(theta, sine, cosine)
    return sine, cosine


def contact_forces(
    system: System,
    ground: Array,
    state: NDArray[np.int64],
    theta: Array,
    omega: Array,
    alpha: Array,
    gravity: Array,
) -> tuple[Array, Array]:
    """Normal and friction force of each interface, across and along the face that carries [N], (n, blocks)."""
    normal = np.zeros_like(theta)
    friction = np.zeros_like(theta)
    sine, cosine = _sines(theta)

    def acceleration(arm: Pair, rows: NDArray[np.bool_], block: int) -> tuple[Array, Array]:
        """Acceleration of the tip of ``arm`` that turns clockwise about its foot [m/s²]."""
        s, c, w, q = (values[rows, block] for values in (sine, cosine, omega, alpha))
        x, y = arm[0] * c + arm[1] * s, -arm[0] * s + arm[1] * c
        return q * y - w * w * x, -q * x - w * w * y

    mass = system.shapes[0].mass
    for rows, arm, foot, above in _ways(system, state):
        x1, y1 = acceleration(arm, rows, 0)
        friction[rows, 0], normal[rows, 0] = mass * (ground[rows] + x1), mass * (gravity[rows] + y1)
        if system.count == 2:
            upper = system.pile.upper.mass
            xd, yd = acceleration(foot, rows, 0)
            x2, y2 = acceleration(above, rows, 1)
            friction[rows, 1] = upper * (ground[rows] + xd + x2)
            normal[rows, 1] = upper * (gravity[rows] + yd + y2)
            friction[rows, 0] += friction[rows, 1]
            normal[rows, 0] += normal[rows, 1]
    if system.count == 1:
        return normal, friction
    pile = system.pile
    # of the interface so far upright and level: the pedestal's top turns with it
    x, y = pile.right[0] - pile.left[0], pile.right[1] - pile.left[1]
    length = hypot(x, y)
    tx = (x * cosine[:, 0] + y * sine[:, 0]) / length
    ty = (y * cosine[:, 0] - x * sine[:, 0]) / length
    across = tx * normal[:, 1] - ty * friction[:, 1]
    friction[:, 1] = tx * friction[:, 1] + ty * normal[:, 1]
    normal[:, 1] = across
    return normal, friction
