"""Taylor series of a rocking motion over one step (Moore 1966; Jorba and Zou 2005), see ``docs/kernels.md``.

``fill_series`` is for both rotations of any body in any contact state, linearised or not; ``lanes/series`` does
the same written out, so that the compiler can work on several cases at once.

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
    """Append coefficient ``k`` of sine and cosine to a ROTATION; ``linear``: those of θ and 1 in their place."""
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
    """Fill the series of one ROTATION: J θ'' = g V_x - a V_y; its first two coefficients are there.

    ``moment``: first moment (vx, vy) about the pivot at θ = 0 [kg m]; ``inertia``: J about it [kg m²].
    """
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
    """Coefficient ``k`` of a V_y - g V_x [N m], V the first moment [kg m] that turns with a rotation.

    ``moment``: V at θ = 0.
    """
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
    """Fill the series of both rotations where both blocks rock; both angles have their first two coefficients.

    Coefficient k of M11 θ1'' + M12 θ2'' + D θ2'² + f1 = 0 and of its counterpart gives that of both angles two
    orders above (``lanes/series.rates_of_two``).
    """
    hh = step.length * step.length
    s1, s2 = equations.pivot(c1), equations.pivot(c2)
    m11 = equations.inertia1(body, s1, s2)
    m22 = equations.inertia2(body, s2)
    e, f = equations.coupling(body, s1, s2)
    moment1 = equations.first_moment1(body, s1, s2)
    moment2 = equations.first_moment2(body, s2)
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
            right1, right2 = _coupled(series, k, (e, f), (right1, right2))
        m12 = e * between.cosine[0] + f * between.sine[0]
        fraction = 1.0 / ((m11 * m22 - m12 * m12) * (k + 1) * (k + 2))
        first.angle[k + 2] = (m22 * right1 - m12 * right2) * fraction
        two.angle[k + 2] = (m11 * right2 - m12 * right1) * fraction


@kernel
def _coupled(series, k, coupling, right):
    """Return both right-hand sides less what lower orders of the other rotation add to coefficient k.

    What they add is D θ2'² + (M12 - m₀) θ2'' for the first, and (M12 - m₀) θ1'' - D θ1'² for the second, with
    Δ = θ2 - θ1, M12 = E cos Δ + F sin Δ and D = F cos Δ - E sin Δ. m₀, coefficient 0 of M12, stands on the left
    side, in the mass matrix, so that the sum with M12 begins at its coefficient 1. ``coupling`` is E and F,
    ``right`` both right-hand sides; ``two`` is the second rotation.
    """
    (e, f), (right1, right2) = coupling, right
    first, two, between = series.one.angle, series.two.angle, series.between
    for j in range(k + 1):
        # coefficient j of D times coefficient k - j of the squared rates
        d = f * between.cosine[j] - e * between.sine[j]
        square1 = 0.0
        square2 = 0.0
        for i in range(k - j + 1):
            weight = (i + 1) * (k - j - i + 1)
            square1 += weight * first[i + 1] * first[k - j - i + 1]
            square2 += weight * two[i + 1] * two[k - j - i + 1]
        right1 -= d * square2
        right2 += d * square1
    for j in range(1, k + 1):
        # coefficient j of M12 times coefficient k - j of the accelerations
        m12 = e * between.cosine[j] + f * between.sine[j]
        i = k - j
        factor = (i + 1) * (i + 2)
        right1 -= m12 * factor * two[i + 2]
        right2 -= m12 * factor * first[i + 2]
    return right1, right2


@kernel
def fill_series(body, state, step, series):
    """Fill the series (SERIES) of both angles over a :class:`Step` from a STATE, in any contact state."""
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
def keep_rates(rows, i, rates):
    """Store coefficients 1 to 6 in column i of (ORDER - 1, lanes)."""
    rows[0, i], rows[1, i], rows[2, i] = rates[1], rates[2], rates[3]
    rows[3, i], rows[4, i], rows[5, i] = rates[4], rates[5], rates[6]


@inlined_kernel
def travel(rates, t):
    """ψ(t) - ψ(0) [rad], of Taylor coefficients 0 to 6 of ψ' per step; ``t``: time in the step [-]."""
    p = fma(t, 1 / 7 * rates[6], 1 / 6 * rates[5])
    p = fma(t, p, 0.2 * rates[4])
    p = fma(t, p, 0.25 * rates[3])
    p = fma(t, p, 1 / 3 * rates[2])
    p = fma(t, p, 0.5 * rates[1])
    return t * fma(t, p, rates[0])


@inlined_kernel
def rate_at(rates, t):
    """ψ'(t) [rad per step], of Taylor coefficients 0 to 6 of ψ'; ``t``: time in the step [-]."""
    v = fma(t, rates[6], rates[5])
    v = fma(t, fma(t, fma(t, fma(t, v, rates[4]), rates[3]), rates[2]), rates[1])
    return fma(t, v, rates[0])
