"""Straight-line arithmetic of both rotations of a stack over one step, written for many cases side by side.

The equations are M11 θ1'' + M12 θ2'' + D θ2'² + f1 = 0 and M12 θ1'' + M22 θ2'' - D θ1'² + f2 = 0 with
M12 = E cos Δ + F sin Δ, D = dM12/dΔ, Δ = θ2 - θ1 and fi = a Xi - g Yi, where Xi = Vy cos θi - Vx sin θi
and Yi = Vx cos θi + Vy sin θi (``_mechanics.equations``).  All of these satisfy recurrences: M' = D Δ',
D' = -M Δ', X' = -Y θ', Y' = X θ', so each Taylor coefficient follows exactly from those before it.

Time is counted in steps: rates, accelerations and V carry the step's length.
"""

import numba

from rockfrag.rocking._intrinsics import fma


@numba.njit(inline="always", error_model="numpy")
def rates_of_two(m11, m22, m0, d0, x10, y10, x20, y20, g, p0, q0, a, b):
    """Taylor coefficients 1 to 6 of θ1' (p) and θ2' (q).

    ``x10`` ... ``y20``: X and Y of both rotations at the start of the step; ``p0`` and ``q0`` the rates;
    a + b τ the ground acceleration.  What is known last comes last in every sum: the processor works on
    several orders at once.
    """
    share = 1.0 / fma(m11, m22, -m0 * m0)
    i11, i12, i22 = m22 * share, m0 * share, m11 * share
    # order 0
    u0, v0 = p0 * p0, q0 * q0
    r1 = fma(-d0, v0, fma(-a, x10, g * y10))
    r2 = fma(d0, u0, fma(-a, x20, g * y20))
    p1, q1 = fma(i11, r1, -i12 * r2), fma(i22, r2, -i12 * r1)
    # twice d0 and the rates
    dp, dq = 2.0 * d0 * p0, 2.0 * d0 * q0
    # order 1
    e0 = q0 - p0
    m1 = d0 * e0
    d1 = -(m0 * e0)
    x11 = -(y10 * p0)
    y11 = x10 * p0
    x21 = -(y20 * q0)
    y21 = x20 * q0
    r1 = fma(-d1, v0, fma(-a, x11, fma(-b, x10, g * y11)))
    r2 = fma(d1, u0, fma(-a, x21, fma(-b, x20, g * y21)))
    r1, r2 = fma(-(dq + m1), q1, r1), fma(dp - m1, p1, r2)
    u1 = 2.0 * p0 * p1
    v1 = 2.0 * q0 * q1
    p2, q2 = 0.5 * fma(i11, r1, -i12 * r2), 0.5 * fma(i22, r2, -i12 * r1)
    # order 2
    e1 = q1 - p1
    m2 = 0.5 * fma(d1, e0, d0 * e1)
    d2 = -0.5 * fma(m1, e0, m0 * e1)
    x12 = -0.5 * fma(y11, p0, y10 * p1)
    y12 = 0.5 * fma(x11, p0, x10 * p1)
    x22 = -0.5 * fma(y21, q0, y20 * q1)
    y22 = 0.5 * fma(x21, q0, x20 * q1)
    u2 = p1 * p1
    v2 = q1 * q1
    r1 = fma(-d2, v0, fma(-m2, q1, fma(-d0, v2, fma(-d1, v1, fma(-a, x12, fma(-b, x11, g * y12))))))
    r2 = fma(d2, u0, fma(-m2, p1, fma(d0, u2, fma(d1, u1, fma(-a, x22, fma(-b, x21, g * y22))))))
    r1, r2 = fma(-(dq + 2.0 * m1), q2, r1), fma(dp - 2.0 * m1, p2, r2)
    u2 = fma(2.0 * p0, p2, u2)
    v2 = fma(2.0 * q0, q2, v2)
    p3, q3 = (1 / 3) * fma(i11, r1, -i12 * r2), (1 / 3) * fma(i22, r2, -i12 * r1)
    # order 3
    e2 = q2 - p2
    m3 = (1 / 3) * fma(d2, e0, fma(d0, e2, d1 * e1))
    d3 = -(1 / 3) * fma(m2, e0, fma(m0, e2, m1 * e1))
    x13 = -(1 / 3) * fma(y12, p0, fma(y10, p2, y11 * p1))
    y13 = (1 / 3) * fma(x12, p0, fma(x10, p2, x11 * p1))
    x23 = -(1 / 3) * fma(y22, q0, fma(y20, q2, y21 * q1))
    y23 = (1 / 3) * fma(x22, q0, fma(x20, q2, x21 * q1))
    u3 = 2.0 * (p1 * p2)
    v3 = 2.0 * (q1 * q2)
    r1 = fma(
        -d3,
        v0,
        fma(
            -m3,
            q1,
            fma(
                -d0,
                v3,
                fma(-d2, v1, fma(-d1, v2, fma(-m2, 2.0 * q2, fma(-a, x13, fma(-b, x12, g * y13))))),
            ),
        ),
    )
    r2 = fma(
        d3,
        u0,
        fma(
            -m3,
            p1,
            fma(
                d0,
                u3,
                fma(d2, u1, fma(d1, u2, fma(-m2, 2.0 * p2, fma(-a, x23, fma(-b, x22, g * y23))))),
            ),
        ),
    )
    r1, r2 = fma(-(dq + 3.0 * m1), q3, r1), fma(dp - 3.0 * m1, p3, r2)
    u3 = fma(2.0 * p0, p3, u3)
    v3 = fma(2.0 * q0, q3, v3)
    p4, q4 = 0.25 * fma(i11, r1, -i12 * r2), 0.25 * fma(i22, r2, -i12 * r1)
    # order 4
    e3 = q3 - p3
    m4 = 0.25 * fma(d3, e0, fma(d0, e3, fma(d2, e1, d1 * e2)))
    d4 = -0.25 * fma(m3, e0, fma(m0, e3, fma(m2, e1, m1 * e2)))
    x14 = -0.25 * fma(y13, p0, fma(y10, p3, fma(y12, p1, y11 * p2)))
    y14 = 0.25 * fma(x13, p0, fma(x10, p3, fma(x12, p1, x11 * p2)))
    x24 = -0.25 * fma(y23, q0, fma(y20, q3, fma(y22, q1, y21 * q2)))
    y24 = 0.25 * fma(x23, q0, fma(x20, q3, fma(x22, q1, x21 * q2)))
    u4 = fma(2.0, p1 * p3, p2 * p2)
    v4 = fma(2.0, q1 * q3, q2 * q2)
    r1 = fma(
        -d4,
        v0,
        fma(
            -m4,
            q1,
            fma(
                -d0,
                v4,
                fma(
                    -d3,
                    v1,
                    fma(
                        -d1,
                        v3,
                        fma(
                            -m3,
                            2.0 * q2,
                            fma(-m2, 3.0 * q3, fma(-d2, v2, fma(-a, x14, fma(-b, x13, g * y14)))),
                        ),
                    ),
                ),
            ),
        ),
    )
    r2 = fma(
        d4,
        u0,
        fma(
            -m4,
            p1,
            fma(
                d0,
                u4,
                fma(
                    d3,
                    u1,
                    fma(
                        d1,
                        u3,
                        fma(
                            -m3,
                            2.0 * p2,
                            fma(-m2, 3.0 * p3, fma(d2, u2, fma(-a, x24, fma(-b, x23, g * y24)))),
                        ),
                    ),
                ),
            ),
        ),
    )
    r1, r2 = fma(-(dq + 4.0 * m1), q4, r1), fma(dp - 4.0 * m1, p4, r2)
    u4 = fma(2.0 * p0, p4, u4)
    v4 = fma(2.0 * q0, q4, v4)
    p5, q5 = 0.2 * fma(i11, r1, -i12 * r2), 0.2 * fma(i22, r2, -i12 * r1)
    # order 5
    e4 = q4 - p4
    m5 = 0.2 * fma(d4, e0, fma(d0, e4, fma(d3, e1, fma(d1, e3, d2 * e2))))
    d5 = -0.2 * fma(m4, e0, fma(m0, e4, fma(m3, e1, fma(m1, e3, m2 * e2))))
    x15 = -0.2 * fma(y14, p0, fma(y10, p4, fma(y13, p1, fma(y11, p3, y12 * p2))))
    y15 = 0.2 * fma(x14, p0, fma(x10, p4, fma(x13, p1, fma(x11, p3, x12 * p2))))
    x25 = -0.2 * fma(y24, q0, fma(y20, q4, fma(y23, q1, fma(y21, q3, y22 * q2))))
    y25 = 0.2 * fma(x24, q0, fma(x20, q4, fma(x23, q1, fma(x21, q3, x22 * q2))))
    u5 = 2.0 * fma(p1, p4, p2 * p3)
    v5 = 2.0 * fma(q1, q4, q2 * q3)
    r1 = fma(
        -d5,
        v0,
        fma(
            -m5,
            q1,
            fma(
                -d0,
                v5,
                fma(
                    -d4,
                    v1,
                    fma(
                        -d1,
                        v4,
                        fma(
                            -m4,
                            2.0 * q2,
                            fma(
                                -m2,
                                4.0 * q4,
                                fma(
                                    -d3,
                                    v2,
                                    fma(
                                        -d2,
                                        v3,
                                        fma(-m3, 3.0 * q3, fma(-a, x15, fma(-b, x14, g * y15))),
                                    ),
                                ),
                            ),
                        ),
                    ),
                ),
            ),
        ),
    )
    r2 = fma(
        d5,
        u0,
        fma(
            -m5,
            p1,
            fma(
                d0,
                u5,
                fma(
                    d4,
                    u1,
                    fma(
                        d1,
                        u4,
                        fma(
                            -m4,
                            2.0 * p2,
                            fma(
                                -m2,
                                4.0 * p4,
                                fma(
                                    d3,
                                    u2,
                                    fma(
                                        d2,
                                        u3,
                                        fma(-m3, 3.0 * p3, fma(-a, x25, fma(-b, x24, g * y25))),
                                    ),
                                ),
                            ),
                        ),
                    ),
                ),
            ),
        ),
    )
    r1, r2 = fma(-(dq + 5.0 * m1), q5, r1), fma(dp - 5.0 * m1, p5, r2)
    p6, q6 = (1 / 6) * fma(i11, r1, -i12 * r2), (1 / 6) * fma(i22, r2, -i12 * r1)
    return p1, p2, p3, p4, p5, p6, q1, q2, q3, q4, q5, q6
