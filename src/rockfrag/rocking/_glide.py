"""Pattern 4 between events: the statue rocks, the pedestal stands."""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import (
    FIXED,
    GRAVITY,
    coupling,
    first_moment1,
    first_moment2,
    inertia2,
)
from rockfrag.rocking._pendulum import rate, rates, sine_cosine, travel


@kernel
def _hold_terms(p, s1, c2, angle, h):
    """Coefficients of s1 τ1(s1) h² in terms of ψ: (P, Q, Y, X).

    M12 = P cos ψ + Q sin ψ, so with θ2'' = -c2 ψ'' the moment of the ground is
    -c2 ((P cos ψ + Q sin ψ) ψ'' + (Q cos ψ - P sin ψ) ψ'²) + a Y + X.
    """
    e, f = coupling(p, s1, c2)
    vx, vy = first_moment1(p, s1, c2)
    cosine, sine = math.cos(angle), c2 * math.sin(angle)
    moment = -s1 * c2
    return (
        moment * (e * cosine + f * sine),
        moment * c2 * (e * sine - f * cosine),
        s1 * vy * h * h,
        -s1 * p[GRAVITY] * vx * h * h,
    )


@kernel
def glide(p, c2, theta, omega, k, last, substeps, dt, acceleration, scale, extremes):
    """March pattern 4 from sample ``k`` through whole samples without an event, to ``last`` at most.

    Returns the sample reached, θ2 and θ2' there; what happens in the interval after it is for the
    caller to find out.  ``extremes`` receives the largest rotation over the critical angle, the
    largest speed and the least distance from balance squared.
    """
    h = dt / substeps
    vx, vy = first_moment2(p, c2)
    angle = math.atan2(-c2 * vx, vy)
    swing = p[GRAVITY] * math.hypot(vx, vy) / inertia2(p, c2) * h * h
    factor = c2 * scale / p[GRAVITY]
    fixed = p[FIXED] > 0.0
    pr, qr, yr, xr = _hold_terms(p, 1, c2, angle, h)
    pl, ql, yl, xl = _hold_terms(p, -1, c2, angle, h)
    per_a = p[GRAVITY] * c2
    psi = angle - c2 * theta
    w = -c2 * omega * h
    before_psi, before_w = psi, w
    low = psi
    fast = abs(w)
    near = math.inf
    per_speed = 1.0 / swing
    start = k
    while k < last:
        left = factor * acceleration[k]
        rise = (factor * acceleration[k + 1] - left) / substeps
        p_sample, w_sample = psi, w
        stop = False
        for sub in range(substeps):
            a = left + sub * rise
            s, c = sine_cosine(psi)
            w1, w2, w3, w4, w5, w6 = rates(s, c, w, swing, a, rise)
            if not fixed:
                square = w * w
                push = a * per_a
                right = (pr * c + qr * s) * w1 + (qr * c - pr * s) * square + yr * push + xr
                other = (pl * c + ql * s) * w1 + (ql * c - pl * s) * square + yl * push + xl
                if right < 0.0 or other < 0.0:
                    stop = True
                    if k > start and sub == 0:
                        # the pedestal let go in the interval before
                        k -= 1
                        p_sample, w_sample = before_psi, before_w
                    break
            end = psi + travel(w, w1, w2, w3, w4, w5, w6, 1.0)
            v = rate(w, w1, w2, w3, w4, w5, w6, 1.0)
            if end >= angle or (w > 0.0 and v < 0.0) or end <= angle - 0.5 * math.pi:
                stop = True
                break
            if w < 0.0 and v > 0.0:
                low = min(low, psi + 0.5 * w * w / (w - v))
            psi = end
            w = v
        if stop:
            psi, w = p_sample, w_sample
            break
        before_psi, before_w = p_sample, w_sample
        low = min(low, psi)
        fast = max(fast, abs(w))
        near = min(near, psi * psi + w * w * per_speed)
        k += 1
    extremes[0] = 1.0 - low / angle
    extremes[1] = fast / h
    extremes[2] = near / (angle * angle)
    return k, c2 * (angle - psi), -c2 * w / h
