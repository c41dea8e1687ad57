"""Contact forces and energies of a computed response: was the model allowed to be used?

The forces follow from the absolute accelerations of the centres of gravity: N2 = m2 (g + y2''),
T2 = m2 x2'', and the sums over both blocks at the ground.
"""

import numpy as np
from numpy.typing import NDArray

from rockfrag.rocking.bodies import Block, Body, Vector

Array = NDArray[np.float64]


def _turned(arm: Vector, theta: Array) -> tuple[Array, Array]:
    c, s = np.cos(theta), np.sin(theta)
    return arm.x * c + arm.y * s, -arm.x * s + arm.y * c


def _acceleration(arm: Vector, theta: Array, omega: Array, alpha: Array) -> tuple[Array, Array]:
    """Acceleration of the tip of ``arm`` that turns clockwise about its foot [m/s²]."""
    x, y = _turned(arm, theta)
    return alpha * y - omega**2 * x, -alpha * x - omega**2 * y


def contact_forces(
    body: Body,
    ground: Array,
    state: NDArray[np.int64],
    theta: Array,
    omega: Array,
    alpha: Array,
    g: float,
) -> tuple[Array, Array]:
    """Normal and friction force of each interface on what stands on it.

    Parameters
    ----------
    ground
        Ground acceleration [m/s²], shape (n,).
    state, theta, omega, alpha
        As in :class:`Response`, shape (n, blocks).

    Returns
    -------
    Normal force (up) and friction force (to the right) [N], each of shape (n, blocks).
    """
    normal = np.zeros_like(theta)
    friction = np.zeros_like(theta)
    if isinstance(body, Block):
        for pole in (+1, -1):
            rows = (state[:, 0] == pole) | (state[:, 0] == 0) & (pole == 1)
            ax, ay = _acceleration(body.arm(pole), theta[rows, 0], omega[rows, 0], alpha[rows, 0])
            friction[rows, 0] = body.mass * (ground[rows] + ax)
            normal[rows, 0] = body.mass * (g + ay)
        return normal, friction
    m1, m2 = body.pedestal.mass, body.statue.mass
    for one in (+1, -1):
        for two in (+1, -1):
            rows = (state[:, 0] == one) | (state[:, 0] == 0) & (one == 1)
            rows &= (state[:, 1] == two) | (state[:, 1] == 0) & (two == 1)
            first = theta[rows, 0], omega[rows, 0], alpha[rows, 0]
            second = theta[rows, 1], omega[rows, 1], alpha[rows, 1]
            x1, y1 = _acceleration(body.pedestal.arm(one), *first)
            xd, yd = _acceleration(body.reach(one, two), *first)
            x2, y2 = _acceleration(body.statue_arm(two), *second)
            friction[rows, 1] = m2 * (ground[rows] + xd + x2)
            normal[rows, 1] = m2 * (g + yd + y2)
            friction[rows, 0] = friction[rows, 1] + m1 * (ground[rows] + x1)
            normal[rows, 0] = normal[rows, 1] + m1 * (g + y1)
    return normal, friction
