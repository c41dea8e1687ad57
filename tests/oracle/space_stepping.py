"""A plain oracle for bodies in space: time stepping with complementarity (Moreau 1988, Jean 1999).

It knows no modes and no contact events: in each step of constant length the vertices that have reached the ground
get impulses that keep them from sinking and obey Coulomb's law, found by Gauss-Seidel iteration.  The attitude is
a matrix, angular velocities are in world coordinates, and the tensor of inertia is turned in each step: nothing is
shared with the engine.  Of first order in the step.
"""

import math

import numba
import numpy as np


@numba.njit
def _solve3(a, b):
    x = np.empty(3)
    det = (
        a[0, 0] * (a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1])
        - a[0, 1] * (a[1, 0] * a[2, 2] - a[1, 2] * a[2, 0])
        + a[0, 2] * (a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0])
    )
    for k in range(3):
        m = a.copy()
        m[0, k], m[1, k], m[2, k] = b[0], b[1], b[2]
        x[k] = (
            m[0, 0] * (m[1, 1] * m[2, 2] - m[1, 2] * m[2, 1])
            - m[0, 1] * (m[1, 0] * m[2, 2] - m[1, 2] * m[2, 0])
            + m[0, 2] * (m[1, 0] * m[2, 1] - m[1, 1] * m[2, 0])
        ) / det
    return x


@numba.njit
def _cross(a, b):
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@numba.njit
def _turned(attitude, omega, h):
    """Rodrigues' formula."""
    angle = math.sqrt(omega[0] ** 2 + omega[1] ** 2 + omega[2] ** 2) * h
    if angle < 1e-300:
        return attitude
    n = omega * (h / angle)
    skew = np.array([[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]])
    turn = np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * (skew @ skew)
    return turn @ attitude


@numba.njit
def _compliance(r, inverse):
    """What an impulse at arm r does to the velocity there."""
    skew = np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])
    return np.eye(3) - skew @ inverse @ skew


@numba.njit
def _alone(w, u, old, friction):
    """Impulse of one vertex, the others as they are: it stops, or slides on its cone."""
    new = old - _solve3(w, u)
    if new[2] > 0.0 and math.hypot(new[0], new[1]) <= friction * new[2]:
        return new
    new = old.copy()
    pace = w[0, 0] + w[1, 1]
    for _ in range(15):
        after = u + w @ (new - old)
        new[2] = max(0.0, new[2] - after[2] / w[2, 2])
        after = u + w @ (new - old)
        new[0] -= after[0] / pace
        new[1] -= after[1] / pace
        size, limit = math.hypot(new[0], new[1]), friction * new[2]
        if size > limit:
            new[0] *= limit / size
            new[1] *= limit / size
    return new


@numba.njit
def _relax(arms, active, impulses, velocity, omega, inverse, friction, ida_curves):
    """Gauss-Seidel over the vertices that touch."""
    for _ in range(ida_curves):
        change = 0.0
        for k in range(active.size):
            r = arms[active[k]]
            u = velocity + _cross(omega, r)
            new = _alone(_compliance(r, inverse), u, impulses[k], friction)
            step = new - impulses[k]
            impulses[k] = new
            velocity += step
            omega += inverse @ _cross(r, step)
            change = max(change, np.abs(step).max())
        if change < 1e-12:
            break


@numba.njit
def stepping(points, inertia, friction, ground, dt, g, step, turned):
    """Integrate a body that stands at rest until it lies, or two seconds after the motion.

    Parameters
    ----------
    points
        Vertices of the base from the centre of mass, shape (n, 3) [m].
    inertia
        Tensor over the mass, shape (3, 3) [m²].
    friction
        Coefficient of friction.
    ground
        Acceleration of the ground, shape (n, 3) [m/s²], linear between samples.
    dt, step
        Sampling interval and step [s].
    g
        Gravity [m/s²].
    turned
        Turn about the vertical in which it stands [rad].

    Returns
    -------
    Whether it fell, and tilt [rad] at each sample.
    """
    height = -points[:, 2].min()
    c, s = math.cos(turned), math.sin(turned)
    attitude = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    place = np.array([0.0, 0.0, height])
    velocity, omega = np.zeros(3), np.zeros(3)
    samples = ground.shape[0]
    tilts = np.zeros(samples)
    each = round(dt / step)
    moving = False
    reach = np.hypot(points[:, 0], points[:, 1]).max()
    safe = 0.2 * g * 0.5 * reach / height if points.shape[0] > 4 else 0.0
    for k in range(samples + int(2 / dt)):
        for part in range(each):
            pull = np.array([0.0, 0.0, -g])
            if k < samples - 1:
                fraction = (part + 0.5) / each
                pull -= ground[k] * (1 - fraction) + ground[k + 1] * fraction
            if not moving:
                if math.hypot(pull[0], pull[1]) <= safe:
                    continue
                moving = True
            tensor = attitude @ inertia @ attitude.T
            inverse = np.zeros((3, 3))
            for j in range(3):
                unit = np.zeros(3)
                unit[j] = 1.0
                inverse[:, j] = _solve3(tensor, unit)
            spin = _cross(omega, tensor @ omega)
            velocity = velocity + step * pull
            omega = omega - step * (inverse @ spin)
            arms = (attitude @ points.T).T.copy()
            active = np.nonzero(place[2] + arms[:, 2] <= 0.0)[0]
            if active.size:
                impulses = np.zeros((active.size, 3))
                _relax(arms, active, impulses, velocity, omega, inverse, friction, 200)
            place = place + step * velocity
            attitude = _turned(attitude, omega, step)
        if k < samples:
            tilts[k] = math.acos(max(-1.0, min(1.0, attitude[2, 2])))
        if attitude[2, 2] <= 0.2:
            return True, tilts
    return False, tilts
