"""Series of both rotations over one step in a given contact state."""

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import (
    coupling,
    first_moment1,
    first_moment2,
    inertia1,
    inertia2,
    pole,
)
from rockfrag.rocking._series import ORDER, extend_circular, extend_rotation

# Places of the series in the scratch array that a march allocates once.
TH1, TH2, SIN1, COS1, SIN2, COS2, SIND, COSD, DELTA, GAP = (row * (ORDER + 1) for row in range(10))
# Critical angles and squared frequencies of the ways to balance: see _tally.
CRITICAL, FREQUENCY2 = 10 * (ORDER + 1), 11 * (ORDER + 1)
# What chatter at rest is closed with: see _events.restoring_table.
RESTORING, RESTORED = 12 * (ORDER + 1), 10
SCRATCH = RESTORING + RESTORED


@kernel
def _one(p, vx, vy, inertia, h, a0, slope, q, theta, sine, cosine):
    """Series of one rotation: J θ'' = g V_x - a V_y; the first two coefficients are there."""
    scale = h * h / inertia
    g = p.gravity
    # coefficients of cos θ and sin θ, constant and linear in τ
    pc0 = scale * (g * vx - a0 * vy)
    pc1 = -scale * slope * vy
    ps0 = scale * g * vy
    ps1 = 0.0
    if p.linear == 0:
        ps0 += scale * a0 * vx
        ps1 = scale * slope * vx
    linear = p.linear > 0
    for k in range(ORDER - 1):
        extend_rotation(q, k, linear, theta, sine, cosine)
        total = pc0 * q[cosine + k] + ps0 * q[sine + k]
        if k > 0:
            total += pc1 * q[cosine + k - 1] + ps1 * q[sine + k - 1]
        q[theta + k + 2] = total / ((k + 1) * (k + 2))


@kernel
def _two(p, c1, c2, h, a0, slope, q):
    """Series of both rotations of patterns 1 and 2; TH1 and TH2 hold the initial state."""
    g = p.gravity
    hh = h * h
    s1, s2 = pole(c1), pole(c2)
    m11 = inertia1(p, s1, s2)
    m22 = inertia2(p, s2)
    e, f = coupling(p, s1, s2)
    v1x, v1y = first_moment1(p, s1, s2)
    v2x, v2y = first_moment2(p, s2)
    linear = p.linear > 0
    for k in range(ORDER - 1):
        q[DELTA + k] = q[TH2 + k] - q[TH1 + k]
        extend_rotation(q, k, linear, TH1, SIN1, COS1)
        extend_rotation(q, k, linear, TH2, SIN2, COS2)
        if linear:
            q[SIND + k] = 0.0
            q[COSD + k] = 1.0 if k == 0 else 0.0
        else:
            if k == 0:
                # sin and cos of the difference from those already there
                q[SIND] = q[SIN2] * q[COS1] - q[COS2] * q[SIN1]
                q[COSD] = q[COS2] * q[COS1] + q[SIN2] * q[SIN1]
            else:
                extend_circular(q, k, DELTA, SIND, COSD)
        # weight and ground: f/h² without the centrifugal terms
        f1 = (a0 * v1y - g * v1x) * q[COS1 + k] - g * v1y * q[SIN1 + k]
        f2 = (a0 * v2y - g * v2x) * q[COS2 + k] - g * v2y * q[SIN2 + k]
        if k > 0:
            f1 += slope * v1y * q[COS1 + k - 1]
            f2 += slope * v2y * q[COS2 + k - 1]
        if not linear:
            f1 -= a0 * v1x * q[SIN1 + k]
            f2 -= a0 * v2x * q[SIN2 + k]
            if k > 0:
                f1 -= slope * v1x * q[SIN1 + k - 1]
                f2 -= slope * v2x * q[SIN2 + k - 1]
        right1 = -hh * f1
        right2 = -hh * f2
        if not linear:
            for j in range(k + 1):
                # coefficient j of D times coefficient k - j of the squared rates
                d = f * q[COSD + j] - e * q[SIND + j]
                square1 = 0.0
                square2 = 0.0
                for i in range(k - j + 1):
                    weight = (i + 1) * (k - j - i + 1)
                    square1 += weight * q[TH1 + i + 1] * q[TH1 + k - j - i + 1]
                    square2 += weight * q[TH2 + i + 1] * q[TH2 + k - j - i + 1]
                right1 -= d * square2
                right2 += d * square1
            for j in range(1, k + 1):
                m12 = e * q[COSD + j] + f * q[SIND + j]
                i = k - j
                factor = (i + 1) * (i + 2)
                right1 -= m12 * factor * q[TH2 + i + 2]
                right2 -= m12 * factor * q[TH1 + i + 2]
        m12 = e * q[COSD] + f * q[SIND]
        share = 1.0 / ((m11 * m22 - m12 * m12) * (k + 1) * (k + 2))
        q[TH1 + k + 2] = (m22 * right1 - m12 * right2) * share
        q[TH2 + k + 2] = (m11 * right2 - m12 * right1) * share


@kernel
def series(p, c1, c2, theta1, omega1, theta2, omega2, h, a0, slope, q):
    """Fill TH1 and TH2 of ``q`` with θ1(τ), θ2(τ) for a ground acceleration a0 + slope τ."""
    for k in range(ORDER + 1):
        q[TH1 + k] = 0.0
        q[TH2 + k] = 0.0
    q[TH1] = theta1
    q[TH2] = theta2
    if c1 == 0 and c2 == 0:
        return
    q[TH1 + 1] = omega1 * h
    q[TH2 + 1] = omega2 * h
    s1, s2 = pole(c1), pole(c2)
    if c1 == 0:
        vx, vy = first_moment2(p, s2)
        _one(p, vx, vy, inertia2(p, s2), h, a0, slope, q, TH2, SIN2, COS2)
    elif c2 == 0:
        v1x, v1y = first_moment1(p, s1, s2)
        v2x, v2y = first_moment2(p, s2)
        e, _ = coupling(p, s1, s2)
        whole = inertia1(p, s1, s2) + 2.0 * e + inertia2(p, s2)
        _one(p, v1x + v2x, v1y + v2y, whole, h, a0, slope, q, TH1, SIN1, COS1)
        for k in range(ORDER + 1):
            q[TH2 + k] = q[TH1 + k]
    else:
        _two(p, c1, c2, h, a0, slope, q)
