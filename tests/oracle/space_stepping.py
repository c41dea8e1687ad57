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
def _skew(r):
    """Matrix of r × …."""
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


@numba.njit(cache=True)
def _turned(attitude, omega, h):
    """Attitude after a step, by Rodrigues' formula."""
    angle = math.sqrt((omega * omega).sum()) * h
    if angle < 1e-300:
        return attitude
    skew = _skew(omega)
    turn = math.sin(angle) * h / angle * skew
    turn += (1 - math.cos(angle)) * (h / angle) ** 2 * (skew @ skew)
    return attitude + turn @ attitude


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
        new[i] = old[i] - (
            solved[i, 0] * u[0] + solved[i, 1] * u[1] + solved[i, 2] * u[2]
        )
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
            new[i] = (
                max(0.0, new[2] - after / w[2, 2]) if i == 2 else new[i] - after / pace
            )
        size, limit = math.hypot(new[0], new[1]), friction * new[2]
        if size > limit:
            new[0] *= limit / size
            new[1] *= limit / size


@numba.njit(cache=True)
def _relax(arms, impulses, velocity, omega, inverse, friction):
    """Gauss-Seidel over the vertices that touch, from impulses that the velocities do not know yet."""
    w, solved = np.empty((len(arms), 3, 3)), np.empty((len(arms), 3, 3))
    u, new = np.empty(3), np.empty(3)
    for k, r in enumerate(arms):
        w[k] = np.eye(3) - _skew(r) @ inverse @ _skew(r)
        solved[k] = np.linalg.inv(w[k])
        _push(r, impulses[k], velocity, omega, inverse)
    for _ in range(200):
        change = 0.0
        for k, r in enumerate(arms):
            u[0] = velocity[0] + omega[1] * r[2] - omega[2] * r[1]
            u[1] = velocity[1] + omega[2] * r[0] - omega[0] * r[2]
            u[2] = velocity[2] + omega[0] * r[1] - omega[1] * r[0]
            _alone(w[k], solved[k], u, impulses[k], friction, new)
            for i in range(3):
                step = new[i] - impulses[k, i]
                impulses[k, i], new[i] = new[i], step
                change = max(change, abs(step))
            _push(r, new, velocity, omega, inverse)
        if change < 1e-12:
            break


@numba.njit(cache=True)
def falls(points, inertia, friction, ground, dt, g, step):
    """Whether a body that stands at rest falls until two seconds after the motion.

    ``points`` are the corners of the base of a box from the centre of mass, shape (4, 3) [m], ``inertia`` its
    tensor over the mass [m²], ``ground`` accelerations, shape (n, 3) [m/s²], linear between samples.
    """
    height = -points[:, 2].min()
    attitude, place = np.eye(3), np.array([0.0, 0.0, height])
    velocity, omega = np.zeros(3), np.zeros(3)
    own, impulses = np.linalg.inv(inertia), np.zeros(points.shape)
    # less lifts no box, whatever its direction
    safe = 0.99 * g * np.abs(points[:, :2]).min() / height
    moves = False
    samples, each = ground.shape[0], round(dt / step)
    for k in range(samples + int(2 / dt)):
        for part in range(each):
            pull = np.array([0.0, 0.0, -g])
            if k < samples - 1:
                fraction = (part + 0.5) / each
                pull -= ground[k] * (1 - fraction) + ground[k + 1] * fraction
            moves = moves or math.hypot(pull[0], pull[1]) > safe
            if not moves:
                continue
            tensor = attitude @ inertia @ attitude.T
            inverse = attitude @ own @ attitude.T
            omega -= step * (inverse @ np.cross(omega, tensor @ omega))
            velocity += step * pull
            arms = points @ attitude.T
            touch = place[2] + arms[:, 2] <= 0.0
            impulses[~touch] = 0.0
            if touch.any():
                pushing = impulses[touch]
                _relax(arms[touch], pushing, velocity, omega, inverse, friction)
                impulses[touch] = pushing
            place += step * velocity
            attitude = _turned(attitude, omega, step)
        if attitude[2, 2] <= 0.2:
            return True
    return False
