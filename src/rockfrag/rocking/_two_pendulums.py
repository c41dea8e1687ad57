"""Straight-line arithmetic of both rotations of a stack over one step, written for many cases side by side.

The equations are M11 θ1'' + M12 θ2'' + D θ2'² + f1 = 0 and M12 θ1'' + M22 θ2'' - D θ1'² + f2 = 0 with
M12 = E cos Δ + F sin Δ, D = dM12/dΔ, Δ = θ2 - θ1 and fi = a Xi - g Yi, where Xi = Vy cos θi - Vx sin θi
and Yi = Vx cos θi + Vy sin θi (``_mechanics.equations``).  All of these satisfy recurrences: M' = D Δ',
D' = -M Δ', X' = -Y θ', Y' = X θ', so each Taylor coefficient follows exactly from those before it.

Time is counted in steps: rates, accelerations and V carry the step's length.
"""

import numba


@numba.njit(inline="always", error_model="numpy")
def accelerations_of_two(m11, m22, m12, share, right1, right2):
    """Solve the two equations, ``share`` being 1 over the determinant and the order."""
    return (m22 * right1 - m12 * right2) * share, (m11 * right2 - m12 * right1) * share


@numba.njit(inline="always", error_model="numpy")
def rates_of_two(m11, m22, m0, d0, x10, y10, x20, y20, g, p0, q0, a, b):
    """Taylor coefficients 1 to 6 of θ1' (p) and θ2' (q).

    ``x10`` ... ``y20``: X and Y of both rotations at the start of the step; ``p0`` and ``q0`` the rates;
    a + b τ the ground acceleration.
    """
    share = 1.0 / (m11 * m22 - m0 * m0)
    # order 0
    u0 = p0 * p0
    v0 = q0 * q0
    r1 = -d0 * v0 - (a * x10 - g * y10)
    r2 = d0 * u0 - (a * x20 - g * y20)
    p1, q1 = accelerations_of_two(m11, m22, m0, share, r1, r2)
    # order 1
    e0 = q0 - p0
    m1 = d0 * e0
    d1 = -m0 * e0
    x11 = -y10 * p0
    y11 = x10 * p0
    x21 = -y20 * q0
    y21 = x20 * q0
    u1 = 2.0 * p0 * p1
    v1 = 2.0 * q0 * q1
    r1 = -(d0 * v1 + d1 * v0) - m1 * q1 - (a * x11 + b * x10 - g * y11)
    r2 = d0 * u1 + d1 * u0 - m1 * p1 - (a * x21 + b * x20 - g * y21)
    p2, q2 = accelerations_of_two(m11, m22, m0, 0.5 * share, r1, r2)
    # order 2
    e1 = q1 - p1
    m2 = 0.5 * (d0 * e1 + d1 * e0)
    d2 = -0.5 * (m0 * e1 + m1 * e0)
    x12 = -0.5 * (y10 * p1 + y11 * p0)
    y12 = 0.5 * (x10 * p1 + x11 * p0)
    x22 = -0.5 * (y20 * q1 + y21 * q0)
    y22 = 0.5 * (x20 * q1 + x21 * q0)
    u2 = 2.0 * p0 * p2 + p1 * p1
    v2 = 2.0 * q0 * q2 + q1 * q1
    r1 = -(d0 * v2 + d1 * v1 + d2 * v0) - (m1 * 2.0 * q2 + m2 * q1)
    r1 -= a * x12 + b * x11 - g * y12
    r2 = d0 * u2 + d1 * u1 + d2 * u0 - (m1 * 2.0 * p2 + m2 * p1)
    r2 -= a * x22 + b * x21 - g * y22
    p3, q3 = accelerations_of_two(m11, m22, m0, 1 / 3 * share, r1, r2)
    # order 3
    e2 = q2 - p2
    m3 = 1 / 3 * (d0 * e2 + d1 * e1 + d2 * e0)
    d3 = -1 / 3 * (m0 * e2 + m1 * e1 + m2 * e0)
    x13 = -1 / 3 * (y10 * p2 + y11 * p1 + y12 * p0)
    y13 = 1 / 3 * (x10 * p2 + x11 * p1 + x12 * p0)
    x23 = -1 / 3 * (y20 * q2 + y21 * q1 + y22 * q0)
    y23 = 1 / 3 * (x20 * q2 + x21 * q1 + x22 * q0)
    u3 = 2.0 * (p0 * p3 + p1 * p2)
    v3 = 2.0 * (q0 * q3 + q1 * q2)
    r1 = -(d0 * v3 + d1 * v2 + d2 * v1 + d3 * v0) - (m1 * 3.0 * q3 + m2 * 2.0 * q2 + m3 * q1)
    r1 -= a * x13 + b * x12 - g * y13
    r2 = d0 * u3 + d1 * u2 + d2 * u1 + d3 * u0 - (m1 * 3.0 * p3 + m2 * 2.0 * p2 + m3 * p1)
    r2 -= a * x23 + b * x22 - g * y23
    p4, q4 = accelerations_of_two(m11, m22, m0, 0.25 * share, r1, r2)
    # order 4
    e3 = q3 - p3
    m4 = 0.25 * (d0 * e3 + d1 * e2 + d2 * e1 + d3 * e0)
    d4 = -0.25 * (m0 * e3 + m1 * e2 + m2 * e1 + m3 * e0)
    x14 = -0.25 * (y10 * p3 + y11 * p2 + y12 * p1 + y13 * p0)
    y14 = 0.25 * (x10 * p3 + x11 * p2 + x12 * p1 + x13 * p0)
    x24 = -0.25 * (y20 * q3 + y21 * q2 + y22 * q1 + y23 * q0)
    y24 = 0.25 * (x20 * q3 + x21 * q2 + x22 * q1 + x23 * q0)
    u4 = 2.0 * (p0 * p4 + p1 * p3) + p2 * p2
    v4 = 2.0 * (q0 * q4 + q1 * q3) + q2 * q2
    r1 = -(d0 * v4 + d1 * v3 + d2 * v2 + d3 * v1 + d4 * v0)
    r1 -= m1 * 4.0 * q4 + m2 * 3.0 * q3 + m3 * 2.0 * q2 + m4 * q1
    r1 -= a * x14 + b * x13 - g * y14
    r2 = d0 * u4 + d1 * u3 + d2 * u2 + d3 * u1 + d4 * u0
    r2 -= m1 * 4.0 * p4 + m2 * 3.0 * p3 + m3 * 2.0 * p2 + m4 * p1
    r2 -= a * x24 + b * x23 - g * y24
    p5, q5 = accelerations_of_two(m11, m22, m0, 0.2 * share, r1, r2)
    # order 5
    e4 = q4 - p4
    m5 = 0.2 * (d0 * e4 + d1 * e3 + d2 * e2 + d3 * e1 + d4 * e0)
    d5 = -0.2 * (m0 * e4 + m1 * e3 + m2 * e2 + m3 * e1 + m4 * e0)
    x15 = -0.2 * (y10 * p4 + y11 * p3 + y12 * p2 + y13 * p1 + y14 * p0)
    y15 = 0.2 * (x10 * p4 + x11 * p3 + x12 * p2 + x13 * p1 + x14 * p0)
    x25 = -0.2 * (y20 * q4 + y21 * q3 + y22 * q2 + y23 * q1 + y24 * q0)
    y25 = 0.2 * (x20 * q4 + x21 * q3 + x22 * q2 + x23 * q1 + x24 * q0)
    u5 = 2.0 * (p0 * p5 + p1 * p4 + p2 * p3)
    v5 = 2.0 * (q0 * q5 + q1 * q4 + q2 * q3)
    r1 = -(d0 * v5 + d1 * v4 + d2 * v3 + d3 * v2 + d4 * v1 + d5 * v0)
    r1 -= m1 * 5.0 * q5 + m2 * 4.0 * q4 + m3 * 3.0 * q3 + m4 * 2.0 * q2 + m5 * q1
    r1 -= a * x15 + b * x14 - g * y15
    r2 = d0 * u5 + d1 * u4 + d2 * u3 + d3 * u2 + d4 * u1 + d5 * u0
    r2 -= m1 * 5.0 * p5 + m2 * 4.0 * p4 + m3 * 3.0 * p3 + m4 * 2.0 * p2 + m5 * p1
    r2 -= a * x25 + b * x24 - g * y25
    p6, q6 = accelerations_of_two(m11, m22, m0, 1 / 6 * share, r1, r2)
    return p1, p2, p3, p4, p5, p6, q1, q2, q3, q4, q5, q6
