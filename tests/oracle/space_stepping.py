"""A plain oracle for bodies in space: time stepping with complementarity (Moreau 1988, Jean 1999).

It knows no modes and no contact events: in each step of constant length the vertices that have reached the ground
get impulses that keep them from sinking and obey Coulomb's law, found by Gauss-Seidel iteration from those of the
step before.  The attitude is a matrix, angular velocities are in world coordinates, and the tensor of inertia is
turned in each step: nothing is shared with the engine.  Of first order in the step.
"""

import math

import numba
import numpy as np


@numba.njit(cache=True)
def _invert(a, x):
    """Write the inverse of a 3 × 3 matrix into x."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for n in range(3):
            p, q = (n + 1) % 3, (n + 2) % 3
            x[n, i] = a[j, p] * a[k, q] - a[j, q] * a[k, p]
    det = a[0, 0] * x[0, 0] + a[0, 1] * x[1, 0] + a[0, 2] * x[2, 0]
    for i in range(3):
        for j in range(3):
            x[i, j] /= det


@numba.njit(cache=True)
def _product(a, b, x):
    """Write the product of two 3 × 3 matrices into x."""
    for i in range(3):
        for j in range(3):
            x[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


@numba.njit(cache=True)
def _skew(r, x):
    """Write the matrix of r × … into x."""
    x[:] = 0.0
    x[0, 1], x[0, 2], x[1, 2] = -r[2], r[1], -r[0]
    x[1, 0], x[2, 0], x[2, 1] = r[2], -r[1], r[0]


@numba.njit(cache=True)
def _turn(attitude, omega, h, work):
    """Turn the attitude for a step by Rodrigues' formula."""
    angle = math.sqrt(omega[0] ** 2 + omega[1] ** 2 + omega[2] ** 2) * h
    if angle < 1e-300:
        return
    skew, square, turn, old = work[0], work[1], work[2], work[3]
    _skew(omega, skew)
    _product(skew, skew, square)
    a, b = math.sin(angle) * h / angle, (1 - math.cos(angle)) * (h / angle) ** 2
    for i in range(3):
        for j in range(3):
            turn[i, j] = (i == j) + a * skew[i, j] + b * square[i, j]
            old[i, j] = attitude[i, j]
    _product(turn, old, attitude)


@numba.njit(cache=True)
def _push(r, impulse, velocity, omega, inverse):
    """Change the velocities by an impulse at arm r."""
    a = r[1] * impulse[2] - r[2] * impulse[1]
    b = r[2] * impulse[0] - r[0] * impulse[2]
    c = r[0] * impulse[1] - r[1] * impulse[0]
    for i in range(3):
        velocity[i] += impulse[i]
        omega[i] += inverse[i, 0] * a + inverse[i, 1] * b + inverse[i, 2] * c


@numba.njit(cache=True)
def _alone(w, solved, u, old, friction, new):
    """Impulse of one vertex, the others as they are: it stops, or slides on its cone."""
    for i in range(3):
        new[i] = old[i] - (solved[i, 0] * u[0] + solved[i, 1] * u[1] + solved[i, 2] * u[2])
    if new[2] > 0.0 and math.hypot(new[0], new[1]) <= friction * new[2]:
        return
    for i in range(3):
        new[i] = old[i]
    pace = w[0, 0] + w[1, 1]
    for _ in range(15):
        for i in (2, 0, 1):
            after = u[i]
            for j in range(3):
                after += w[i, j] * (new[j] - old[j])
            new[i] = max(0.0, new[2] - after / w[2, 2]) if i == 2 else new[i] - after / pace
        size, limit = math.hypot(new[0], new[1]), friction * new[2]
        if size > limit:
            new[0] *= limit / size
            new[1] *= limit / size


@numba.njit(cache=True)
def _relax(arms, active, impulses, velocity, omega, inverse, friction, work):
    """Gauss-Seidel over the vertices that touch."""
    n = active.size
    w, solved = np.empty((n, 3, 3)), np.empty((n, 3, 3))
    u, new = np.empty(3), np.empty(3)
    for k in range(n):
        r = arms[active[k]]
        _skew(r, work[0])
        _product(inverse, work[0], work[1])
        _product(work[0], work[1], work[2])
        for i in range(3):
            for j in range(3):
                w[k, i, j] = (i == j) - work[2, i, j]
        _invert(w[k], solved[k])
        _push(r, impulses[active[k]], velocity, omega, inverse)
    for _ in range(200):
        change = 0.0
        for k in range(n):
            r, old = arms[active[k]], impulses[active[k]]
            u[0] = velocity[0] + omega[1] * r[2] - omega[2] * r[1]
            u[1] = velocity[1] + omega[2] * r[0] - omega[0] * r[2]
            u[2] = velocity[2] + omega[0] * r[1] - omega[1] * r[0]
            _alone(w[k], solved[k], u, old, friction, new)
            for i in range(3):
                step = new[i] - old[i]
                old[i] = new[i]
                new[i] = step
                change = max(change, abs(step))
            _push(r, new, velocity, omega, inverse)
        if change < 1e-12:
            break


@numba.njit(cache=True)
def _fly(tensor, inverse, pull, step, velocity, omega):
    """Change the velocities by what acts without contacts."""
    p, q, r = omega
    a = tensor[0, 0] * p + tensor[0, 1] * q + tensor[0, 2] * r
    b = tensor[1, 0] * p + tensor[1, 1] * q + tensor[1, 2] * r
    c = tensor[2, 0] * p + tensor[2, 1] * q + tensor[2, 2] * r
    moment = (q * c - r * b, r * a - p * c, p * b - q * a)
    for i in range(3):
        turned = inverse[i, 0] * moment[0] + inverse[i, 1] * moment[1] + inverse[i, 2] * moment[2]
        omega[i] -= step * turned
        velocity[i] += step * pull[i]


@numba.njit(cache=True)
def falls(points, inertia, friction, ground, dt, g, step):
    """Whether a body that stands at rest falls until two seconds after the motion.

    ``points`` are the corners of the base of a box from the centre of mass, shape (4, 3) [m], ``inertia`` its
    tensor over the mass [m²], ``ground`` accelerations, shape (n, 3) [m/s²], linear between samples.
    """
    height = -points[:, 2].min()
    attitude, place = np.eye(3), np.array([0.0, 0.0, height])
    velocity, omega, pull = np.zeros(3), np.zeros(3), np.zeros(3)
    work, tensor, inverse = np.zeros((4, 3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    arms, impulses = np.zeros(points.shape), np.zeros(points.shape)
    active = np.zeros(points.shape[0], np.int64)
    # less lifts no box, whatever its direction
    safe = 0.99 * g * np.abs(points[:, :2]).min() / height
    moves = False
    samples, each = ground.shape[0], round(dt / step)
    for k in range(samples + int(2 / dt)):
        for part in range(each):
            pull[0], pull[1], pull[2] = 0.0, 0.0, -g
            if k < samples - 1:
                fraction = (part + 0.5) / each
                for i in range(3):
                    pull[i] -= ground[k, i] * (1 - fraction) + ground[k + 1, i] * fraction
            moves = moves or math.hypot(pull[0], pull[1]) > safe
            if not moves:
                continue
            _product(attitude, inertia, work[0])
            _product(work[0], attitude.T, tensor)
            _invert(tensor, inverse)
            _fly(tensor, inverse, pull, step, velocity, omega)
            n = 0
            for i in range(points.shape[0]):
                for j in range(3):
                    arms[i, j] = 0.0
                    for m in range(3):
                        arms[i, j] += attitude[j, m] * points[i, m]
                if place[2] + arms[i, 2] <= 0.0:
                    active[n] = i
                    n += 1
                else:
                    impulses[i] = 0.0
            if n > 0:
                _relax(arms, active[:n], impulses, velocity, omega, inverse, friction, work)
            for i in range(3):
                place[i] += step * velocity[i]
            _turn(attitude, omega, step, work)
        if attitude[2, 2] <= 0.2:
            return True
    return False
