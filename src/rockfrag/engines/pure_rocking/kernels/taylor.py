"""Taylor series of a rocking motion over one step (Moore 1966; Jorba and Zou 2005), see ``docs/kernels.md``.

``fill_series`` is for both rotations of any body in any contact state, linearised or not; ``rates_of_one`` and
``rates_of_two`` are the same written out, so that the compiler can work on several cases at once.

In: a body, its state and the ground over a step. Out: coefficients of its angles by time in steps.
"""

from typing import NamedTuple

import numpy as np

from rockfrag.base.arrays import fields
from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import fma, inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels import equations

ORDER = 7  # order of the series: with p h ≤ 0.1 the remainder is below 1e-13 rad

ROTATION = np.dtype(fields("angle sine cosine", ORDER + 1))
"""Coefficients of an angle θ(τ) = Σ θ_k τ^k, and of its sine and cosine; τ runs from 0 to 1 over a step."""

SERIES = np.dtype([*fields("one two between", of=ROTATION), *fields("gap", ORDER + 1)])
"""Series of a step: of pedestal, statue, θ2 - θ1, and the opening of the contact that is looked at."""


class Step(NamedTuple):
    """A step of an integration."""

    length: float  # its length [s]
    ground: float  # acceleration of the ground at its beginning [m/s²]
    rise: float  # what that grows by until its end [m/s²]
    # gravity, lift: gravity and the ground's upward acceleration likewise [m/s²]
    gravity: float
    lift: float


# --------------------------------------------------------------------------- one history


@kernel
def _extend(rotation, k, linear):
    """Append coefficient ``k`` of sine and cosine, or of θ and 1 in the linearised equations."""
    if linear:
        rotation.sine[k] = rotation.angle[k]
        rotation.cosine[k] = 1.0 if k == 0 else 0.0
    elif k == 0:
        rotation.sine[0], rotation.cosine[0] = sin_cos(rotation.angle[0])
    else:
        _extend_circular(rotation, k)


@kernel
def _extend_circular(rotation, k):
    """Append coefficient k ≥ 1: k s_k = Σ c_j (k - j) θ_{k-j} and k c_k = -Σ s_j (k - j) θ_{k-j}."""
    ds = 0.0
    dc = 0.0
    for j in range(k):
        rate = (k - j) * rotation.angle[k - j]
        ds += rotation.cosine[j] * rate
        dc += rotation.sine[j] * rate
    rotation.sine[k] = ds / k
    rotation.cosine[k] = -dc / k


@kernel
def _fill_one(body, moment, inertia, step, rotation):
    """Series of one rotation: J θ'' = g V_x - a V_y; the first two coefficients are there."""
    vx, vy = moment
    scale = step.length * step.length / inertia
    g = step.gravity
    # coefficients of cos θ and sin θ, constant and linear in τ
    pc0 = scale * (g * vx - step.ground * vy)
    pc1 = -scale * step.rise * vy + scale * step.lift * vx
    ps0 = scale * g * vy
    ps1 = scale * step.lift * vy
    if body.linear == 0:
        ps0 += scale * step.ground * vx
        ps1 += scale * step.rise * vx
    sine, cosine = rotation.sine, rotation.cosine
    for k in range(ORDER - 1):
        _extend(rotation, k, body.linear > 0)
        total = pc0 * cosine[k] + ps0 * sine[k]
        if k > 0:
            total += pc1 * cosine[k - 1] + ps1 * sine[k - 1]
        rotation.angle[k + 2] = total / ((k + 1) * (k + 2))


@kernel
def _weight(body, moment, step, rotation, k):
    """Coefficient ``k`` of a V_y - g V_x, V the first moment of a rotation."""
    vx, vy = moment
    g = step.gravity
    f = (step.ground * vy - g * vx) * rotation.cosine[k] - g * vy * rotation.sine[k]
    if k > 0:
        f += step.rise * vy * rotation.cosine[k - 1]
        f -= step.lift * (vx * rotation.cosine[k - 1] + vy * rotation.sine[k - 1])
    if body.linear == 0:
        f -= step.ground * vx * rotation.sine[k]
        if k > 0:
            f -= step.rise * vx * rotation.sine[k - 1]
    return f


@kernel
def _fill_two(body, c1, c2, step, series):
    """Series of both rotations of patterns 1 and 2; the first two coefficients of both angles are there."""
    hh = step.length * step.length
    s1, s2 = equations.pivot(c1), equations.pivot(c2)
    m11 = equations.inertia1(body, s1, s2)
    m22 = equations.inertia2(body, s2)
    e, f = equations.coupling(body, s1, s2)
    moment1, moment2 = (
        equations.first_moment1(body, s1, s2),
        equations.first_moment2(body, s2),
    )
    linear = body.linear > 0
    first, two, between = series.one, series.two, series.between
    for k in range(ORDER - 1):
        between.angle[k] = two.angle[k] - first.angle[k]
        _extend(first, k, linear)
        _extend(two, k, linear)
        if linear:
            between.sine[k] = 0.0
            between.cosine[k] = 1.0 if k == 0 else 0.0
        elif k == 0:
            # sine and cosine of the difference from those already there
            between.sine[0] = (
                two.sine[0] * first.cosine[0] - two.cosine[0] * first.sine[0]
            )
            between.cosine[0] = (
                two.cosine[0] * first.cosine[0] + two.sine[0] * first.sine[0]
            )
        else:
            _extend_circular(between, k)
        right1 = -hh * _weight(body, moment1, step, first, k)
        right2 = -hh * _weight(body, moment2, step, two, k)
        if not linear:
            for j in range(k + 1):
                # coefficient j of D times coefficient k - j of the squared rates
                d = f * between.cosine[j] - e * between.sine[j]
                square1 = 0.0
                square2 = 0.0
                for i in range(k - j + 1):
                    weight = (i + 1) * (k - j - i + 1)
                    square1 += weight * first.angle[i + 1] * first.angle[k - j - i + 1]
                    square2 += weight * two.angle[i + 1] * two.angle[k - j - i + 1]
                right1 -= d * square2
                right2 += d * square1
            for j in range(1, k + 1):
                m12 = e * between.cosine[j] + f * between.sine[j]
                i = k - j
                factor = (i + 1) * (i + 2)
                right1 -= m12 * factor * two.angle[i + 2]
                right2 -= m12 * factor * first.angle[i + 2]
        m12 = e * between.cosine[0] + f * between.sine[0]
        fraction = 1.0 / ((m11 * m22 - m12 * m12) * (k + 1) * (k + 2))
        first.angle[k + 2] = (m22 * right1 - m12 * right2) * fraction
        two.angle[k + 2] = (m11 * right2 - m12 * right1) * fraction


@kernel
def fill_series(body, state, step, series):
    """Fill the series of both angles over a step from a state."""
    first, two = series.one, series.two
    for k in range(ORDER + 1):
        first.angle[k] = 0.0
        two.angle[k] = 0.0
    c1, c2 = state.c1, state.c2
    first.angle[0] = state.theta1
    two.angle[0] = state.theta2
    if c1 == 0 and c2 == 0:
        return
    first.angle[1] = state.omega1 * step.length
    two.angle[1] = state.omega2 * step.length
    if c1 != 0 and c2 != 0:
        _fill_two(body, c1, c2, step, series)
        return
    vx, vy, inertia = equations.turning(body, c1, c2)
    if c1 == 0:
        _fill_one(body, (vx, vy), inertia, step, two)
    else:
        _fill_one(body, (vx, vy), inertia, step, first)
        for k in range(ORDER + 1):
            two.angle[k] = first.angle[k]


# --------------------------------------------------------------------------- several cases at once


@inlined_kernel
def quick_sine_cosine(x):
    """Sine and cosine without a branch, for |x| ≤ π/2 to 1e-10, and to rounding for |x| ≤ 0.6."""
    y = x * x
    s = fma(y, -1.0 / 1307674368000.0, 1.0 / 6227020800.0)
    s = fma(s, y, -1.0 / 39916800.0)
    s = fma(s, y, 1.0 / 362880.0)
    s = fma(s, y, -1.0 / 5040.0)
    s = fma(s, y, 1.0 / 120.0)
    s = fma(s, y, -1.0 / 6.0)
    c = fma(y, 1.0 / 20922789888000.0, -1.0 / 87178291200.0)
    c = fma(c, y, 1.0 / 479001600.0)
    c = fma(c, y, -1.0 / 3628800.0)
    c = fma(c, y, 1.0 / 40320.0)
    c = fma(c, y, -1.0 / 720.0)
    c = fma(c, y, 1.0 / 24.0)
    c = fma(c, y, -0.5)
    return fma(x * y, s, x), fma(y, c, 1.0)


@inlined_kernel
def pulled(gravity, now, before):
    """Coefficient of gravity (now, growth, whether it varies) × a series, of which two coefficients are given."""
    g, lift, varies = gravity
    return fma(lift, before, g * now) if varies else g * now


@inlined_kernel
def _torque(ground, weight, sine, cosine):
    """Coefficient of W sin ψ + A cos ψ; of sine and cosine, that of this order and the one before."""
    (a, rise), (u, lift, varies) = ground, weight
    (s, s_before), (c, c_before) = sine, cosine
    if varies:
        # what depends on the latest rate comes last
        return fma(u, s, fma(a, c, fma(lift, s_before, rise * c_before)))
    return fma(a, c, fma(rise, c_before, u * s))


@inlined_kernel
def rates_of_one(turn, w, kappa, ground, weight):
    """Taylor coefficients 0 to 6 of ψ' over a step that begins at sin ψ = s0, cos ψ = c0.

    ψ'' = κ (W sin ψ + A cos ψ) with A = a + rise τ, W = u + lift τ and time in steps (Housner, 1963): a lone
    block with ψ = θc - |θ|, κ = p² h², A the ground acceleration over g, positive where it pushes the block back
    down, and W gravity over g, 1 unless the ground moves vertically; ``weight`` as in ``pulled``.
    """
    s0, c0 = turn
    w1 = kappa * fma(ground[0], c0, weight[0] * s0)
    s1 = c0 * w
    c1 = -(s0 * w)
    w2 = 0.5 * kappa * _torque(ground, weight, (s1, s0), (c1, c0))
    s2 = 0.5 * fma(c1, w, c0 * w1)
    c2 = -0.5 * fma(s1, w, s0 * w1)
    w3 = (1 / 3) * kappa * _torque(ground, weight, (s2, s1), (c2, c1))
    s3 = (1 / 3) * fma(c2, w, fma(c0, w2, c1 * w1))
    c3 = -(1 / 3) * fma(s2, w, fma(s0, w2, s1 * w1))
    w4 = 0.25 * kappa * _torque(ground, weight, (s3, s2), (c3, c2))
    s4 = 0.25 * fma(c3, w, fma(c0, w3, fma(c2, w1, c1 * w2)))
    c4 = -0.25 * fma(s3, w, fma(s0, w3, fma(s2, w1, s1 * w2)))
    w5 = 0.2 * kappa * _torque(ground, weight, (s4, s3), (c4, c3))
    s5 = 0.2 * fma(c4, w, fma(c0, w4, fma(c3, w1, fma(c1, w3, c2 * w2))))
    c5 = -0.2 * fma(s4, w, fma(s0, w4, fma(s3, w1, fma(s1, w3, s2 * w2))))
    w6 = (1 / 6) * kappa * _torque(ground, weight, (s5, s4), (c5, c4))
    return w, w1, w2, w3, w4, w5, w6


@inlined_kernel
def keep_rates(rows, i, rates):
    """Store coefficients 1 to 6 in column i of (ORDER - 1, lanes)."""
    rows[0, i], rows[1, i], rows[2, i] = rates[1], rates[2], rates[3]
    rows[3, i], rows[4, i], rows[5, i] = rates[4], rates[5], rates[6]


@inlined_kernel
def travel(rates, t):
    """ψ(t) - ψ(0)."""
    p = fma(t, 1 / 7 * rates[6], 1 / 6 * rates[5])
    p = fma(t, p, 0.2 * rates[4])
    p = fma(t, p, 0.25 * rates[3])
    p = fma(t, p, 1 / 3 * rates[2])
    p = fma(t, p, 0.5 * rates[1])
    return t * fma(t, p, rates[0])


@inlined_kernel
def rate_at(rates, t):
    """ψ'(t)."""
    v = fma(t, rates[6], rates[5])
    v = fma(t, fma(t, fma(t, fma(t, v, rates[4]), rates[3]), rates[2]), rates[1])
    return fma(t, v, rates[0])


@inlined_kernel
def rates_of_two(mass, weight1, weight2, rates, ground, gravity):
    """Taylor coefficients 0 to 6 of θ1' and θ2' over a step of both rotations.

    M11 θ1'' + M12 θ2'' + D θ2'² + f1 = 0 and M12 θ1'' + M22 θ2'' - D θ1'² + f2 = 0 with M12 = E cos Δ + F sin Δ,
    D = dM12/dΔ, Δ = θ2 - θ1 and fi = a Xi - g Yi, where Xi = Vy cos θi - Vx sin θi and Yi = Vx cos θi + Vy sin θi
    (``equations``).  All satisfy recurrences: M' = D Δ', D' = -M Δ', X' = -Y θ', Y' = X θ'.  Time is counted
    in steps: rates and V carry the step's length.

    At the start of the step ``mass`` has M11, M22, M12 and D, a ``weight`` X and Y, ``rates`` θ1' and θ2', and
    ``ground`` its acceleration and what that grows by until the end; ``gravity`` is as in ``pulled``.
    """
    m11, m22, m0, d0 = mass
    (x10, y10), (x20, y20) = weight1, weight2
    p0, q0 = rates
    a, b = ground
    g = gravity[0]
    fraction = 1.0 / fma(m11, m22, -m0 * m0)
    i11, i12, i22 = m22 * fraction, m0 * fraction, m11 * fraction
    # order 0; u and v are the squared rates
    u0, v0 = p0 * p0, q0 * q0
    r1 = fma(-d0, v0, fma(-a, x10, g * y10))
    r2 = fma(d0, u0, fma(-a, x20, g * y20))
    p1, q1 = fma(i11, r1, -i12 * r2), fma(i22, r2, -i12 * r1)
    # what depends on the latest rates comes last in every sum
    dp, dq = 2.0 * d0 * p0, 2.0 * d0 * q0
    # order 1
    e0 = q0 - p0
    m1 = d0 * e0
    d1 = -(m0 * e0)
    x11 = -(y10 * p0)
    y11 = x10 * p0
    x21 = -(y20 * q0)
    y21 = x20 * q0
    r1 = fma(-a, x11, fma(-b, x10, pulled(gravity, y11, y10)))
    r1 = fma(-d1, v0, r1)
    r2 = fma(-a, x21, fma(-b, x20, pulled(gravity, y21, y20)))
    r2 = fma(d1, u0, r2)
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
    r1 = fma(-a, x12, fma(-b, x11, pulled(gravity, y12, y11)))
    r1 = fma(-d0, v2, fma(-d1, v1, r1))
    r1 = fma(-d2, v0, fma(-m2, q1, r1))
    r2 = fma(-a, x22, fma(-b, x21, pulled(gravity, y22, y21)))
    r2 = fma(d0, u2, fma(d1, u1, r2))
    r2 = fma(d2, u0, fma(-m2, p1, r2))
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
    r1 = fma(-a, x13, fma(-b, x12, pulled(gravity, y13, y12)))
    r1 = fma(-d1, v2, fma(-m2, 2.0 * q2, r1))
    r1 = fma(-d0, v3, fma(-d2, v1, r1))
    r1 = fma(-d3, v0, fma(-m3, q1, r1))
    r2 = fma(-a, x23, fma(-b, x22, pulled(gravity, y23, y22)))
    r2 = fma(d1, u2, fma(-m2, 2.0 * p2, r2))
    r2 = fma(d0, u3, fma(d2, u1, r2))
    r2 = fma(d3, u0, fma(-m3, p1, r2))
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
    r1 = fma(-a, x14, fma(-b, x13, pulled(gravity, y14, y13)))
    r1 = fma(-m2, 3.0 * q3, fma(-d2, v2, r1))
    r1 = fma(-d1, v3, fma(-m3, 2.0 * q2, r1))
    r1 = fma(-d0, v4, fma(-d3, v1, r1))
    r1 = fma(-d4, v0, fma(-m4, q1, r1))
    r2 = fma(-a, x24, fma(-b, x23, pulled(gravity, y24, y23)))
    r2 = fma(-m2, 3.0 * p3, fma(d2, u2, r2))
    r2 = fma(d1, u3, fma(-m3, 2.0 * p2, r2))
    r2 = fma(d0, u4, fma(d3, u1, r2))
    r2 = fma(d4, u0, fma(-m4, p1, r2))
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
    r1 = fma(-a, x15, fma(-b, x14, pulled(gravity, y15, y14)))
    r1 = fma(-d2, v3, fma(-m3, 3.0 * q3, r1))
    r1 = fma(-m2, 4.0 * q4, fma(-d3, v2, r1))
    r1 = fma(-d1, v4, fma(-m4, 2.0 * q2, r1))
    r1 = fma(-d0, v5, fma(-d4, v1, r1))
    r1 = fma(-d5, v0, fma(-m5, q1, r1))
    r2 = fma(-a, x25, fma(-b, x24, pulled(gravity, y25, y24)))
    r2 = fma(d2, u3, fma(-m3, 3.0 * p3, r2))
    r2 = fma(-m2, 4.0 * p4, fma(d3, u2, r2))
    r2 = fma(d1, u4, fma(-m4, 2.0 * p2, r2))
    r2 = fma(d0, u5, fma(d4, u1, r2))
    r2 = fma(d5, u0, fma(-m5, p1, r2))
    r1, r2 = fma(-(dq + 5.0 * m1), q5, r1), fma(dp - 5.0 * m1, p5, r2)
    p6, q6 = (1 / 6) * fma(i11, r1, -i12 * r2), (1 / 6) * fma(i22, r2, -i12 * r1)
    return (p0, p1, p2, p3, p4, p5, p6), (q0, q1, q2, q3, q4, q5, q6)
