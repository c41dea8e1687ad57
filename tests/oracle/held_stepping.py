"""An oracle: time stepping of one block between walls, on cords and brackets, in wax, on a plate, plain and slow.

It shares nothing with the engines: corners of a rectangle, planes, springs and impulses in steps of constant
length, with Coulomb's law and Newton's ratio, solved by Gauss-Seidel iteration (Moreau 1988; Jean 1999).
"""

import math
from typing import NamedTuple

import numba
import numpy as np

TAIL = 6.0  # free motion that is followed after the shaking [s]


class Held(NamedTuple):
    """A rectangle and what holds it: rows of walls, cords and a bond, in numbers."""

    width: float
    height: float
    mass: float
    mu: float  # of its base
    # (x of the face, side, height, friction, ratio)
    walls: np.ndarray
    # (x, z on the body from the middle of its base; x, z of the end; stiffness, damping, length beyond which it is
    # in tension, strength, length below which it pushes: 0 for a cord)
    cords: np.ndarray
    # (half distance of the pads, capacity of each, capacity in shear), empty: none
    bond: np.ndarray
    # (mass of the plate, radius of its dish, friction in it, stroke, ratio at its stops), empty: none
    plate: np.ndarray = np.zeros(0)


@numba.njit(cache=True)
def _place(q, b, h, x, z):
    """Where a point of the body is, from the middle of its base."""
    c, s = math.cos(q[2]), math.sin(q[2])
    dx, dz = x, z - h
    return q[0] + dx * c + dz * s, q[1] - dx * s + dz * c


@numba.njit(cache=True)
def _rows(q, b, h, mu, walls, points, normals, gaps, mus, ratios):
    """Points that may touch, normals towards the body, gaps, frictions and ratios; their number."""
    n = 0
    for x in (-b, b):
        points[n] = _place(q, b, h, x, 0.0)
        normals[n] = (0.0, 1.0)
        gaps[n], mus[n], ratios[n] = points[n, 1], mu, 0.0
        n += 1
    for w in range(walls.shape[0]):
        at, side, top = walls[w, 0], walls[w, 1], walls[w, 2]
        low = _place(q, b, h, side * b, 0.0)
        high = _place(q, b, h, side * b, 2.0 * h)
        for corner in (low, high):
            gap = side * (at - corner[0])
            if corner[1] <= top and gap > -0.5 * b:
                points[n] = corner
                normals[n] = (-side, 0.0)
                gaps[n], mus[n], ratios[n] = gap, walls[w, 3], walls[w, 4]
                n += 1
        if low[1] < top < high[1]:
            # the wall's edge and the side of the body
            c, s = math.cos(q[2]), math.sin(q[2])
            across = (at - q[0]) * c - (top - q[1]) * s
            points[n] = (at, top)
            normals[n] = (-side * c, side * s)
            gaps[n] = side * across - b
            mus[n], ratios[n] = walls[w, 3], walls[w, 4]
            n += 1
    return n


@numba.njit(cache=True)
def _relax(w, free, mus, glued, p, plate):
    """Impulses along normals (even rows) and tangents by iteration; what is glued has no bounds.

    ``plate``: the impulse of its own weight, above 0 if the last pair of rows is that of its stop and its dish.
    """
    u = free + w @ p
    for _ in range(3000):
        change, largest = 0.0, 1e-300
        for i in range(p.size):
            new = p[i] - u[i] / w[i, i]
            if not glued[i // 2]:
                if i % 2 == 0:
                    new = max(0.0, new)
                else:
                    limit = mus[i // 2] * p[i - 1]
                    if plate > 0.0 and i == p.size - 1:
                        limit = mus[i // 2] * max(0.0, p[0] + p[2] + plate)
                    new = min(max(new, -limit), limit)
            largest = max(largest, abs(new))
            u += w[i] * (new - p[i])
            change = max(change, abs(new - p[i]))
            p[i] = new
        if change <= 1e-7 * largest:
            break


@numba.njit(cache=True)
def _pull(q, v, b, h, cords, whole, force):
    """Add the forces of cords, and break those that are overloaded."""
    for i in range(cords.shape[0]):
        if not whole[i]:
            continue
        x, z = _place(q, b, h, cords[i, 0], cords[i, 1])
        dx, dz = cords[i, 2] - x, cords[i, 3] - z
        length = math.hypot(dx, dz)
        dx, dz = dx / length, dz / length
        rx, rz = x - q[0], z - q[1]
        rate = -dx * (v[0] + v[2] * rz) - dz * (v[1] - v[2] * rx)
        longer, shorter = length - cords[i, 6], length - cords[i, 8]
        if longer > 0.0:
            pulls = max(0.0, cords[i, 4] * longer + cords[i, 5] * rate)
        elif shorter < 0.0:
            pulls = min(0.0, cords[i, 4] * shorter + cords[i, 5] * rate)
        else:
            continue
        if abs(pulls) > cords[i, 7]:
            whole[i] = False
            continue
        force[0] += pulls * dx
        force[1] += pulls * dz
        force[2] += pulls * (dx * rz - dz * rx)


@numba.njit(cache=True)
def _march(sizes, walls, cords, bond, plate, acceleration, dt, step, steps, g):
    """March; whether it fell, whether it rests turned, and the last state: x, z, turn and place of the plate."""
    b, h, mass, mu = sizes
    inertia = mass * (b * b + h * h) / 3.0
    slides = plate.size > 0
    inverse = np.array([1 / mass, 1 / mass, 1 / inertia, 0.0])
    own = 0.0
    if slides:
        inverse[3], own = 1 / plate[0], plate[0] * g
    q, v = np.array([0.0, h, 0.0, 0.0]), np.zeros(4)
    most = 3 + 3 * walls.shape[0]
    points, normals = np.zeros((most, 2)), np.zeros((most, 2))
    gaps, mus, ratios = np.zeros(most), np.zeros(most), np.zeros(most)
    whole = np.ones(cords.shape[0], np.bool_)
    bonded = bond.size > 0
    pressed = mass * g
    p = np.zeros(0)
    last = acceleration.size - 1
    substeps = max(1, math.ceil(dt / step - 1e-9))
    step = dt / substeps
    for i in range(last + steps):
        for j in range(substeps):
            part = (j + 0.5) / substeps
            a = 0.0
            if i < last:
                a = acceleration[i] + part * (acceleration[i + 1] - acceleration[i])
            n = _rows(q, b, h, mu, walls, points, normals, gaps, mus, ratios)
            force = np.array([-mass * a, -mass * g, 0.0, 0.0])
            _pull(q, v, b, h, cords, whole, force)
            if slides:
                force[3] = -plate[0] * a - (pressed + own) * q[3] / plate[1]
                side = 1.0 if q[3] >= 0.0 else -1.0
                gaps[n], mus[n], ratios[n] = plate[3] - side * q[3], plate[2], plate[4]
                n += 1
            jacobian = np.zeros((2 * n, 4))
            for c in range(n):
                if slides and c == n - 1:
                    jacobian[2 * c, 3], jacobian[2 * c + 1, 3] = -side, 1.0
                    continue
                nx, nz = normals[c]
                rx, rz = points[c, 0] - q[0], points[c, 1] - q[1]
                jacobian[2 * c, :3] = (nx, nz, nx * rz - nz * rx)
                jacobian[2 * c + 1, :3] = (nz, -nx, nz * rz + nx * rx)
                if c < 2:
                    # the base slides on the plate
                    jacobian[2 * c + 1, 3] = -1.0
            before = jacobian @ v
            v += step * inverse * force
            free = jacobian @ v
            for c in range(n):
                free[2 * c] += max(gaps[c], 0.0) / step
                if gaps[c] < 0.0:
                    free[2 * c] += 0.2 * gaps[c] / step
                if gaps[c] <= 1e-9 and before[2 * c] < -1e-2:
                    free[2 * c] += ratios[c] * before[2 * c]
            w = (jacobian * inverse) @ jacobian.T
            w += 1e-9 * np.diag(np.diag(w))
            glued = np.zeros(n, np.bool_)
            if bonded:
                glued[:2] = True
            if p.size != 2 * n:
                p = np.zeros(2 * n)
            _relax(w, free, mus[:n], glued, p, own * step)
            pressed = (p[0] + p[2]) / step
            if bonded:
                shear = (p[1] + p[3]) / step
                moment = (p[2] - p[0]) / step * b
                least = 0.5 * (pressed - abs(moment) / bond[0])
                bonded = least > -bond[1] and abs(shear) < bond[2] + mu * pressed
            v += inverse * (jacobian.T @ p)
            q += step * v
            if abs(q[2]) >= math.pi / 2:
                return True, False, q, v
        if i >= last and np.abs(v).max() < 1e-4:
            break
    leans = abs(q[2]) > 1e-3 and np.abs(v).max() < 1e-2
    return False, leans, q, v


def outcome(held: Held, acceleration, dt, *, step=5e-5, g=9.81) -> tuple[bool, bool]:
    """Whether a held block falls, and whether it rests turned."""
    sizes = np.array([held.width / 2, held.height / 2, held.mass, held.mu])
    values = np.ascontiguousarray(acceleration, dtype=float)
    steps = round(TAIL / dt)
    rows = held.walls, held.cords, held.bond, held.plate
    fell, leans, _, _ = _march(sizes, *rows, values, dt, step, steps, g)
    return bool(fell), bool(leans)
