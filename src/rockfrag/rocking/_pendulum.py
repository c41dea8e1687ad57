"""Straight-line arithmetic of one rotation: ψ'' = κ (sin ψ + A cos ψ), A linear in time.

ψ = θc - |θ| is the angle left until the block balances, A the ground acceleration over g, positive where it
pushes the block back down, κ = p² h² and time is counted in steps of h (thesis eq. 2.4).  Written without
branches or calls, so that the compiler can work on several cases at once.
"""

import math

import numba

from rockfrag.rocking._intrinsics import fma

HALF_TURN = 0.5 * math.pi
"""A block that has turned so far lies down [rad]."""


@numba.njit(inline="always", error_model="numpy")
def sine_cosine(x):
    """Sine and cosine for |x| ≤ π/2 to 1e-10, and to rounding for |x| ≤ 0.6."""
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


@numba.njit(inline="always", error_model="numpy")
def rates(s0, c0, w, kappa, a, ramp):
    """Taylor coefficients 1 to 6 of ψ' over a step that begins at sin ψ = s0, cos ψ = c0."""
    w1 = kappa * fma(a, c0, s0)
    s1 = c0 * w
    c1 = -(s0 * w)
    w2 = 0.5 * kappa * fma(a, c1, fma(ramp, c0, s1))
    s2 = 0.5 * fma(c1, w, c0 * w1)
    c2 = -0.5 * fma(s1, w, s0 * w1)
    w3 = (1 / 3) * kappa * fma(a, c2, fma(ramp, c1, s2))
    s3 = (1 / 3) * fma(c2, w, fma(c0, w2, c1 * w1))
    c3 = -(1 / 3) * fma(s2, w, fma(s0, w2, s1 * w1))
    w4 = 0.25 * kappa * fma(a, c3, fma(ramp, c2, s3))
    s4 = 0.25 * fma(c3, w, fma(c0, w3, fma(c2, w1, c1 * w2)))
    c4 = -0.25 * fma(s3, w, fma(s0, w3, fma(s2, w1, s1 * w2)))
    w5 = 0.2 * kappa * fma(a, c4, fma(ramp, c3, s4))
    s5 = 0.2 * fma(c4, w, fma(c0, w4, fma(c3, w1, fma(c1, w3, c2 * w2))))
    c5 = -0.2 * fma(s4, w, fma(s0, w4, fma(s3, w1, fma(s1, w3, s2 * w2))))
    w6 = (1 / 6) * kappa * fma(a, c5, fma(ramp, c4, s5))
    return w1, w2, w3, w4, w5, w6


@numba.njit(inline="always", error_model="numpy")
def travel(w, w1, w2, w3, w4, w5, w6, t):
    """ψ(t) - ψ(0)."""
    p = fma(t, 1 / 7 * w6, 1 / 6 * w5)
    p = fma(t, p, 0.2 * w4)
    p = fma(t, p, 0.25 * w3)
    p = fma(t, p, 1 / 3 * w2)
    p = fma(t, p, 0.5 * w1)
    return t * fma(t, p, w)


@numba.njit(inline="always", error_model="numpy")
def rate(w, w1, w2, w3, w4, w5, w6, t):
    """ψ'(t)."""
    v = fma(t, fma(t, fma(t, fma(t, fma(t, w6, w5), w4), w3), w2), w1)
    return fma(t, v, w)


@numba.njit(inline="always", error_model="numpy")
def dips(gap, out, out_at_end):
    """Whether a contact that closes at the start and opens at the end may have closed in between."""
    return (out < 0.0) & (out_at_end > 0.0) & (gap * (out_at_end - out) < out * out)


@numba.njit(inline="always", error_model="numpy")
def hops(gap, out, out_at_end, bend):
    """Whether a contact that opens, and still opens at the end, may have closed in between.

    The cubic through rate and acceleration at the start and rate at the end, over time, is
    out + bend τ / 2 + c τ² / 3; it must have a minimum within the step that is negative, either by half.
    """
    c = out_at_end - out - bend
    return (
        (out >= 0.0)
        & (out_at_end > 0.0)
        & (gap + 0.5 * bend < 0.0)
        & (-0.5 * bend < c)
        & (bend * bend > 3.5 * out * c)
    )
