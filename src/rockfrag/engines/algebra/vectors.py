"""Vectors of three as tuples, rotations, and small linear systems, allocation-free.

In: tuples of floats, and unit quaternions (world ← body). Out: likewise, or solutions in arrays. No equation of
mechanics stands here; ``docs/space.md``, "Coordinates", says what the quaternion means.

``a``, ``b``: vectors. ``rows``: the three rows of R, world ← body: the world's axes as the body sees them.
``y``: a state, with the quaternion w + x i + y j + z k in y[3:7].
"""

import math

from rockfrag.engines.compile.jit import inlined_kernel, kernel

TINY = 1e-300  # what a length is at least where it divides: its direction is then none, or any


@kernel
def dot(a, b):
    """Scalar product a·b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a, b):
    """Vector product a × b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@kernel
def norm(x, y):
    """Length of the vector (x, y), whose components are neither huge nor tiny."""
    return math.sqrt(x * x + y * y)


@kernel
def length(a):
    """Length of a vector."""
    return math.sqrt(dot(a, a))


@kernel
def plus(a, b):
    """Sum a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@kernel
def minus(a, b):
    """Difference a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@kernel
def scaled(s, a):
    """Multiple s a."""
    return (s * a[0], s * a[1], s * a[2])


@kernel
def times(matrix, a):
    """Product of an array (3, 3) and the vector a."""
    return (
        matrix[0, 0] * a[0] + matrix[0, 1] * a[1] + matrix[0, 2] * a[2],
        matrix[1, 0] * a[0] + matrix[1, 1] * a[1] + matrix[1, 2] * a[2],
        matrix[2, 0] * a[0] + matrix[2, 1] * a[1] + matrix[2, 2] * a[2],
    )


@kernel
def rows_times(rows, a):
    """Product of a matrix, given by its rows, and the vector a."""
    return (dot(rows[0], a), dot(rows[1], a), dot(rows[2], a))


@kernel
def times_rows(a, rows):
    """Product of the vector a, as a row, and a matrix, given by its rows."""
    return (
        a[0] * rows[0][0] + a[1] * rows[1][0] + a[2] * rows[2][0],
        a[0] * rows[0][1] + a[1] * rows[1][1] + a[2] * rows[2][1],
        a[0] * rows[0][2] + a[1] * rows[1][2] + a[2] * rows[2][2],
    )


@kernel
def rotation(y):
    """Rows of R, which are the world's axes as the body sees them, from the quaternion of a state."""
    return rotation_of(y[3], y[4], y[5], y[6])


@kernel
def rotation_of(w, x, y, z):
    """Rows of R from the quaternion w + x i + y j + z k, whose length is one."""
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


@inlined_kernel
def quaternion_rate(attitude, omega):
    """Rate of a quaternion q, half of q times ω, with the angular velocity ω in the body [1/s]."""
    w, x, y, z = attitude
    a, b, c = omega
    return (
        -0.5 * (x * a + y * b + z * c),
        0.5 * (w * a + y * c - z * b),
        0.5 * (w * b + z * a - x * c),
        0.5 * (w * c + x * b - y * a),
    )


@kernel
def to_world(rows, a):
    """Components in the world of a vector of the body, R a."""
    return rows_times(rows, a)


@kernel
def to_body(rows, a):
    """Components in the body of a vector of the world, Rᵀ a."""
    return times_rows(a, rows)


@kernel
def turn(y, angle):
    """Turn the attitude of a state by a small rotation vector of the body [rad], and normalise it.

    The quaternion q becomes q ∘ (1 + angle/2), of first order in the angle.
    """
    qw, qx, qy, qz = y[3], y[4], y[5], y[6]
    a, b, c = 0.5 * angle[0], 0.5 * angle[1], 0.5 * angle[2]
    y[3] = qw - (qx * a + qy * b + qz * c)
    y[4] = qx + (qw * a + qy * c - qz * b)
    y[5] = qy + (qw * b + qz * a - qx * c)
    y[6] = qz + (qw * c + qx * b - qy * a)
    normalise(y)


@kernel
def normalise(y):
    """Give the quaternion y[3:7] of a state the length 1."""
    square = y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]
    per_length = 1.0 / math.sqrt(square)
    for i in range(3, 7):
        y[i] *= per_length


@kernel
def solve_symmetric(a, b, c, d, e, f, r):
    """Solve [[a, b, c], [b, d, e], [c, e, f]] x = r by Cramer's rule; return x, a tuple of three.

    It is r times the cofactors, which are symmetric too, over the determinant.
    """
    # cofactors of the upper triangle, row by row: p, q, s and u, v and w
    p, q, s = d * f - e * e, c * e - b * f, b * e - c * d
    inverse = 1.0 / (a * p + b * q + c * s)
    u, v, w = a * f - c * c, b * c - a * e, a * d - b * b
    return (
        inverse * (p * r[0] + q * r[1] + s * r[2]),
        inverse * (q * r[0] + u * r[1] + v * r[2]),
        inverse * (s * r[0] + v * r[1] + w * r[2]),
    )


@kernel
def factor(matrix, order, n):
    """Factor matrix[:n, :n] in place into triangles; return whether it has an inverse.

    Row k was exchanged with row ``order[k]``, that with the largest entry left in column k, before column k was
    eliminated: the lower triangle has the multipliers, the upper one what is left.
    """
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        order[k] = best
        if matrix[best, k] == 0.0:
            return False
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        for i in range(k + 1, n):
            matrix[i, k] /= matrix[k, k]
            for j in range(k + 1, n):
                matrix[i, j] -= matrix[i, k] * matrix[k, j]
    return True


@kernel
def substitute(matrix, order, n, x):
    """Solve in place, x[:n] from the right side to the solution, with the triangles of :func:`factor`."""
    for k in range(n):
        if order[k] != k:
            x[k], x[order[k]] = x[order[k]], x[k]
    for i in range(n):
        for j in range(i):
            x[i] -= matrix[i, j] * x[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            x[i] -= matrix[i, j] * x[j]
        x[i] /= matrix[i, i]
