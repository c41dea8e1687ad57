"""Straight-line arithmetic of one rotation: ψ'' = κ (sin ψ + A cos ψ), A linear in time.

ψ = θc - |θ| is the angle left until the block balances, A the ground acceleration over g, positive where it
pushes the block back down, κ = p² h² and time is counted in steps of h (thesis eq. 2.4).  Written without
branches or calls, so that the compiler can work on several cases at once.
"""

import numba


@numba.njit(inline="always", error_model="numpy")
def sine_cosine(x):
    """Sine and cosine for |x| ≤ π/2 to 1e-10, and to rounding for |x| ≤ 0.6."""
    y = x * x
    s = -1.0 / 1307674368000.0
    s = s * y + 1.0 / 6227020800.0
    s = s * y - 1.0 / 39916800.0
    s = s * y + 1.0 / 362880.0
    s = s * y - 1.0 / 5040.0
    s = s * y + 1.0 / 120.0
    s = s * y - 1.0 / 6.0
    c = 1.0 / 20922789888000.0
    c = c * y - 1.0 / 87178291200.0
    c = c * y + 1.0 / 479001600.0
    c = c * y - 1.0 / 3628800.0
    c = c * y + 1.0 / 40320.0
    c = c * y - 1.0 / 720.0
    c = c * y + 1.0 / 24.0
    c = c * y - 0.5
    return x + x * y * s, 1.0 + y * c


@numba.njit(inline="always", error_model="numpy")
def rates(s0, c0, w, kappa, a, ramp):
    """Taylor coefficients 1 to 6 of ψ' over a step that begins at sin ψ = s0, cos ψ = c0."""
    w1 = kappa * (s0 + a * c0)
    s1 = c0 * w
    c1 = -s0 * w
    w2 = 0.5 * kappa * (s1 + a * c1 + ramp * c0)
    s2 = 0.5 * (c0 * w1 + c1 * w)
    c2 = -0.5 * (s0 * w1 + s1 * w)
    w3 = (1.0 / 3.0) * kappa * (s2 + a * c2 + ramp * c1)
    s3 = (1.0 / 3.0) * (c0 * w2 + c1 * w1 + c2 * w)
    c3 = -(1.0 / 3.0) * (s0 * w2 + s1 * w1 + s2 * w)
    w4 = 0.25 * kappa * (s3 + a * c3 + ramp * c2)
    s4 = 0.25 * (c0 * w3 + c1 * w2 + c2 * w1 + c3 * w)
    c4 = -0.25 * (s0 * w3 + s1 * w2 + s2 * w1 + s3 * w)
    w5 = 0.2 * kappa * (s4 + a * c4 + ramp * c3)
    s5 = 0.2 * (c0 * w4 + c1 * w3 + c2 * w2 + c3 * w1 + c4 * w)
    c5 = -0.2 * (s0 * w4 + s1 * w3 + s2 * w2 + s3 * w1 + s4 * w)
    w6 = (1.0 / 6.0) * kappa * (s5 + a * c5 + ramp * c4)
    return w1, w2, w3, w4, w5, w6


@numba.njit(inline="always", error_model="numpy")
def travel(w, w1, w2, w3, w4, w5, w6, t):
    """ψ(t) - ψ(0)."""
    return t * (
        w
        + t
        * (
            0.5 * w1
            + t
            * (1 / 3 * w2 + t * (0.25 * w3 + t * (0.2 * w4 + t * (1 / 6 * w5 + t * (1 / 7 * w6)))))
        )
    )


@numba.njit(inline="always", error_model="numpy")
def rate(w, w1, w2, w3, w4, w5, w6, t):
    """ψ'(t)."""
    return w + t * (w1 + t * (w2 + t * (w3 + t * (w4 + t * (w5 + t * w6)))))


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
