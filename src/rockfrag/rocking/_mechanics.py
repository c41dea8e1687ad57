"""The two-block model in one formulation for all nine contact states (``docs/derivation.md``).

Block 1 is the pedestal, block 2 the statue.  c1 (ground) and c2 (interface) are the contact states:
+1 or -1 for rocking on the right or left pole, 0 for full contact.  Rest is (0, 0), pattern 4 (0, ±1),
pattern 3 (±1, 0), pattern 1 (s, s), pattern 2 (s, -s).

Positions along an interface are given as σ in [-1, 1]: the poles are σ = ±1.  With
r1 = R(θ1) arm1, d = R(θ1) reach, r2 = R(θ2) arm2 the equations are M θ'' + f = τ with τ the moments of
the contact forces, zero at a rocking pole (thesis eq. 2.43, 2.51, 2.55, 2.58).

A lone block is block 2 on a block 1 that cannot move (``fixed``).
"""

import math

import numpy as np

from rockfrag.rocking._compile import kernel

BODY = np.dtype(
    [
        # pedestal: mass, inertia, half width, centre of gravity
        ("m1", np.float64), ("i1", np.float64), ("b1", np.float64), ("c1x", np.float64), ("c1y", np.float64),
        # middle and direction of the statue's footing
        ("tx", np.float64), ("ty", np.float64), ("ex", np.float64), ("ey", np.float64),
        # statue: likewise, centre from the middle of its footing
        ("m2", np.float64), ("i2", np.float64), ("b2", np.float64), ("c2x", np.float64), ("c2y", np.float64),
        # where the impulse of a closing contact acts, σ towards the new pole +1 and -1; 1 is the pole itself
        ("eta1r", np.float64), ("eta1l", np.float64), ("eta2r", np.float64), ("eta2l", np.float64),
        ("gravity", np.float64),
        ("linear", np.int64),  # 0 exact; 1 eq. 2.60-2.65; 2 eq. 2.9 (lone block)
        ("fixed", np.bool_),  # block 1 cannot move
        ("measured", np.bool_),  # an impulse acts elsewhere than at its pole
    ],
    align=True,
)  # fmt: skip
"""What the kernels know of a body: lengths [m], masses [kg], moments of inertia [kg m²], gravity [m/s²]."""


@kernel
def pole(c):
    """Position σ of the pole of contact state c; full contact (0) counts as rocking on +1, at rest."""
    return -1.0 if c < 0 else 1.0


@kernel
def arm1(p, sigma):
    """Return the vector from σ on the ground to the pedestal's centre, at θ1 = 0."""
    return p.c1x - sigma * p.b1, p.c1y


@kernel
def arm2(p, sigma):
    """Return the vector from σ on the interface to the statue's centre, at θ2 = 0."""
    x = p.c2x - sigma * p.b2 * p.ex
    y = p.c2y - sigma * p.b2 * p.ey
    if p.linear == 2:
        # eq. 2.9: sin θc → θc, cos θc → 1
        radius = math.hypot(x, y)
        return -sigma * radius * math.atan2(-sigma * x, y), radius
    return x, y


@kernel
def reach(p, sigma1, sigma2):
    """Return the vector d from σ1 on the ground to σ2 on the interface, at θ1 = 0."""
    return (
        p.tx + sigma2 * p.b2 * p.ex - sigma1 * p.b1,
        p.ty + sigma2 * p.b2 * p.ey,
    )


@kernel
def inertia1(p, sigma1, sigma2):
    """M11 = I1 + m1 |r1|² + m2 |d|²."""
    rx, ry = arm1(p, sigma1)
    dx, dy = reach(p, sigma1, sigma2)
    return p.i1 + p.m1 * (rx * rx + ry * ry) + p.m2 * (dx * dx + dy * dy)


@kernel
def inertia2(p, sigma2):
    """M22 = I2 + m2 |r2|²."""
    x = p.c2x - sigma2 * p.b2 * p.ex
    y = p.c2y - sigma2 * p.b2 * p.ey
    return p.i2 + p.m2 * (x * x + y * y)


@kernel
def coupling(p, sigma1, sigma2):
    """E and F of M12 = m2 d·r2 = E cos(θ2 - θ1) + F sin(θ2 - θ1)."""
    dx, dy = reach(p, sigma1, sigma2)
    rx, ry = arm2(p, sigma2)
    return p.m2 * (dx * rx + dy * ry), p.m2 * (dx * ry - dy * rx)


@kernel
def first_moment1(p, sigma1, sigma2):
    """m1 r1 + m2 d at θ1 = 0, what gravity and ground acceleration act on in the first equation."""
    rx, ry = arm1(p, sigma1)
    dx, dy = reach(p, sigma1, sigma2)
    return p.m1 * rx + p.m2 * dx, p.m1 * ry + p.m2 * dy


@kernel
def first_moment2(p, sigma2):
    """m2 r2 at θ2 = 0."""
    rx, ry = arm2(p, sigma2)
    return p.m2 * rx, p.m2 * ry


@kernel
def weight_moment(p, vx, vy, theta, a):
    """-g V_x + a V_y with V = R(θ)(vx, vy): gravity's and the ground's share of f1 or f2."""
    g = p.gravity
    if p.linear > 0:
        return a * vy - g * (vx + vy * theta)
    c = math.cos(theta)
    s = math.sin(theta)
    return a * (vy * c - vx * s) - g * (vx * c + vy * s)


@kernel
def equations(p, sigma1, sigma2, theta1, omega1, theta2, omega2, a):
    """M11, M12, M22, f1, f2 of M θ'' + f = τ."""
    e, f = coupling(p, sigma1, sigma2)
    if p.linear > 0:
        m12 = e
        d = 0.0
    else:
        c = math.cos(theta2 - theta1)
        s = math.sin(theta2 - theta1)
        m12 = e * c + f * s
        d = f * c - e * s
    v1x, v1y = first_moment1(p, sigma1, sigma2)
    v2x, v2y = first_moment2(p, sigma2)
    f1 = d * omega2 * omega2 + weight_moment(p, v1x, v1y, theta1, a)
    f2 = -d * omega1 * omega1 + weight_moment(p, v2x, v2y, theta2, a)
    return inertia1(p, sigma1, sigma2), m12, inertia2(p, sigma2), f1, f2


@kernel
def accelerations(p, c1, c2, theta1, omega1, theta2, omega2, a):
    """θ1'' and θ2'' [rad/s²] in contact state (c1, c2)."""
    s1, s2 = pole(c1), pole(c2)
    if c1 == 0 and c2 == 0:
        return 0.0, 0.0
    m11, m12, m22, f1, f2 = equations(p, s1, s2, theta1, omega1, theta2, omega2, a)
    if c1 == 0:
        return 0.0, -f2 / m22
    if c2 == 0:
        both = -(f1 + f2) / (m11 + 2.0 * m12 + m22)
        return both, both
    determinant = m11 * m22 - m12 * m12
    return (m12 * f2 - m22 * f1) / determinant, (m12 * f1 - m11 * f2) / determinant


@kernel
def ground_hold(p, c2, theta1, theta2, omega2, a, alpha2):
    """Least s1 τ1(s1) over both corners of a pedestal at rest [N m], and the corner it is least at.

    The full contact persists while it is not negative: the ground pushes and never pulls.
    """
    if p.fixed:
        return 1.0, 1
    s2 = pole(c2)
    least = math.inf
    corner = 1
    for c1 in (1, -1):
        _, m12, m22, f1, f2 = equations(p, pole(c1), s2, theta1, 0.0, theta2, omega2, a)
        tau = m12 * alpha2 + f1
        if c2 == 0:
            tau += m22 * alpha2 + f2
        if c1 * tau < least:
            least = c1 * tau
            corner = c1
    return least, corner


@kernel
def interface_hold(p, c1, theta1, omega1, theta2, omega2, a, alpha1):
    """Least s2 τ2(s2) over both corners of a statue stuck to its pedestal [N m], and the corner."""
    s1 = pole(c1)
    least = math.inf
    corner = 1
    for c2 in (1, -1):
        _, m12, m22, _, f2 = equations(p, s1, pole(c2), theta1, omega1, theta2, omega2, a)
        tau = (m12 + m22) * alpha1 + f2
        if c2 * tau < least:
            least = c2 * tau
            corner = c2
    return least, corner


@kernel
def settle(p, c1, c2, theta1, omega1, theta2, omega2, a):
    """Contact state into which forces take the closed contacts of (c1, c2).

    Every state that the closed contacts allow is tried, from all closed to all open; the first
    consistent one is taken: an opening contact accelerates away from its corner, a closed one pushes
    at both corners.
    """
    if c1 != 0 and c2 != 0:
        return c1, c2
    fallback1 = c1
    fallback2 = c2
    for opened in range(3):
        for n1 in (0, 1, -1):
            if c1 != 0 and n1 != 0:
                continue
            if p.fixed and n1 != 0:
                continue
            for n2 in (0, 1, -1):
                if c2 != 0 and n2 != 0:
                    continue
                if abs(n1) + abs(n2) != opened:
                    continue
                t1 = c1 if c1 != 0 else n1
                t2 = c2 if c2 != 0 else n2
                alpha1, alpha2 = accelerations(p, t1, t2, theta1, omega1, theta2, omega2, a)
                good = True
                if c1 == 0:
                    if n1 != 0:
                        good = n1 * alpha1 > 0.0
                    else:
                        hold, corner = ground_hold(p, t2, theta1, theta2, omega2, a, alpha2)
                        good = hold >= 0.0
                        if opened == 0 and not good:
                            fallback1 = corner
                if c2 == 0:
                    if n2 != 0:
                        good = good and n2 * (alpha2 - alpha1) > 0.0
                    else:
                        hold, corner = interface_hold(
                            p, t1, theta1, omega1, theta2, omega2, a, alpha1
                        )
                        good = good and hold >= 0.0
                        if opened == 0 and hold < 0.0:
                            fallback2 = corner
                if good:
                    return t1, t2
    # within rounding of a threshold: open what its own criterion opens
    if p.fixed:
        fallback1 = 0
    return fallback1, fallback2


@kernel
def _between(p, theta1, theta2):
    """Cosine and sine of θ2 - θ1; 1 and 0 in the linearised equations."""
    if p.linear > 0 or theta1 == theta2:
        return 1.0, 0.0
    return math.cos(theta2 - theta1), math.sin(theta2 - theta1)


@kernel
def _metric(p, ta1, ta2, tb1, tb2, c, s):
    """Kinetic-metric products of the velocity fields about (ta1, ta2) with those about (tb1, tb2).

    c and s are the cosine and sine of θ2 - θ1.
    """
    ax, ay = arm1(p, ta1)
    bx, by = arm1(p, tb1)
    dax, day = reach(p, ta1, ta2)
    dbx, dby = reach(p, tb1, tb2)
    rax, ray = arm2(p, ta2)
    rbx, rby = arm2(p, tb2)
    m1 = p.m1
    m2 = p.m2
    k11 = p.i1 + m1 * (ax * bx + ay * by) + m2 * (dax * dbx + day * dby)
    # d·R(Δ)r
    k12 = m2 * (dax * (rbx * c + rby * s) + day * (rby * c - rbx * s))
    k21 = m2 * (dbx * (rax * c + ray * s) + dby * (ray * c - rax * s))
    if p.linear == 2:
        k22 = inertia2(p, ta2)
        if ta2 != tb2:
            x, y = p.c2x, p.c2y
            b = p.b2
            k22 = p.i2 + m2 * ((x - ta2 * b) * (x - tb2 * b) + y * y)
    else:
        k22 = p.i2 + m2 * (rax * rbx + ray * rby)
    return k11, k12, k21, k22


@kernel
def kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2):
    """Kinetic energy relative to the ground [J]."""
    s1, s2 = pole(c1), pole(c2)
    c, s = _between(p, theta1, theta2)
    k11, k12, _, k22 = _metric(p, s1, s2, s1, s2, c, s)
    return 0.5 * (k11 * omega1 * omega1 + 2.0 * k12 * omega1 * omega2 + k22 * omega2 * omega2)


@kernel
def potential_energy(p, c1, c2, theta1, theta2):
    """Potential energy above rest [J]: g Σ m y, quadratic in θ in the linearised equations."""
    s1, s2 = pole(c1), pole(c2)
    v1x, v1y = first_moment1(p, s1, s2)
    v2x, v2y = first_moment2(p, s2)
    g = p.gravity
    if p.linear > 0:
        return -g * (theta1 * (v1x + 0.5 * v1y * theta1) + theta2 * (v2x + 0.5 * v2y * theta2))
    # V_y(θ) - V_y(0), with 1 - cos θ = 2 sin²(θ/2) so that nothing cancels
    h1 = math.sin(0.5 * theta1)
    h2 = math.sin(0.5 * theta2)
    return -g * (
        v1x * math.sin(theta1) + 2.0 * v1y * h1 * h1 + v2x * math.sin(theta2) + 2.0 * v2y * h2 * h2
    )


@kernel
def _row1(p, t1, t2, n1, n2, c1, c2, c, s, w1n, w2n, w1o, w2o, glued):
    """Impulse moment on the field that turns block 1 (both if ``glued``) about (t1, t2)."""
    k11, k12, k21, k22 = _metric(p, t1, t2, n1, n2, c, s)
    b11, b12, b21, b22 = _metric(p, t1, t2, c1, c2, c, s)
    total = k11 * w1n + k12 * w2n - b11 * w1o - b12 * w2o
    if glued:
        total += k21 * w1n + k22 * w2n - b21 * w1o - b22 * w2o
    return total


@kernel
def _row2(p, t1, t2, n1, n2, c1, c2, c, s, w1n, w2n, w1o, w2o):
    """Impulse moment on the field that turns block 2 about t2."""
    _, _, k21, k22 = _metric(p, t1, t2, n1, n2, c, s)
    _, _, b21, b22 = _metric(p, t1, t2, c1, c2, c, s)
    return k21 * w1n + k22 * w2n - b21 * w1o - b22 * w2o


@kernel
def _after(p, c1, c2, n1, n2, t1, t2, c, s, omega1, omega2):
    """Velocities after an impact that takes the poles from (c1, c2) to (n1, n2), 0 being stuck."""
    o1, o2 = pole(c1), pole(c2)
    if n1 == 0 and n2 == 0:
        return 0.0, 0.0
    p1, p2 = pole(n1), pole(n2)
    k11, k12, k21, k22 = _metric(p, t1, t2, p1, p2, c, s)
    b11, b12, b21, b22 = _metric(p, t1, t2, o1, o2, c, s)
    q1 = b11 * omega1 + b12 * omega2
    q2 = b21 * omega1 + b22 * omega2
    if n1 == 0:
        return 0.0, q2 / k22
    if n2 == 0:
        both = (q1 + q2) / (k11 + k12 + k21 + k22)
        return both, both
    determinant = k11 * k22 - k12 * k21
    return (k22 * q1 - k12 * q2) / determinant, (k11 * q2 - k21 * q1) / determinant


@kernel
def _strike(p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2, measured):
    """Try the states an impact may lead to, open before stuck; the first admissible one."""
    o1, o2 = pole(c1), pole(c2)
    c, s = _between(p, theta1, theta2)
    # velocities that rounding alone leaves count as none
    tiny = 1e-13 * (abs(omega1) + abs(omega2))
    free1 = closes1 or c1 == 0
    free2 = closes2 or c2 == 0
    for choice1 in range(3):
        if choice1 == 0:
            n1 = -c1 if closes1 else (1 if c1 == 0 else c1)
        elif choice1 == 1:
            if closes1 or c1 != 0:
                continue
            n1 = -1
        else:
            if not free1:
                continue
            n1 = 0
        if p.fixed and n1 != 0:
            continue
        for choice2 in range(3):
            if choice2 == 0:
                n2 = -c2 if closes2 else (1 if c2 == 0 else c2)
            elif choice2 == 1:
                if closes2 or c2 != 0:
                    continue
                n2 = -1
            else:
                if not free2:
                    continue
                n2 = 0
            p1, p2 = pole(n1), pole(n2)
            t1, t2 = p1, p2
            if measured:
                if closes1 and n1 != 0:
                    t1 = n1 * (p.eta1r if n1 > 0 else p.eta1l)
                if closes2 and n2 != 0:
                    t2 = n2 * (p.eta2r if n2 > 0 else p.eta2l)
            w1, w2 = _after(p, c1, c2, n1, n2, t1, t2, c, s, omega1, omega2)
            if free1 and n1 != 0 and n1 * w1 <= tiny:
                continue
            if free2 and n2 != 0 and n2 * (w2 - w1) <= tiny:
                continue
            good = True
            if n1 == 0 and not p.fixed:
                slack = 1e-12 * p.i1 * (abs(omega1) + abs(omega2))
                for corner in (1.0, -1.0):
                    moment = _row1(
                        p, corner, t2, p1, p2, o1, o2, c, s,
                        w1, w2, omega1, omega2, n2 == 0,
                    )  # fmt: skip
                    if corner * moment < -slack:
                        good = False
            if good and n2 == 0:
                slack = 1e-12 * p.i2 * (abs(omega1) + abs(omega2))
                for corner in (1.0, -1.0):
                    moment = _row2(p, t1, corner, p1, p2, o1, o2, c, s, w1, w2, omega1, omega2)
                    if corner * moment < -slack:
                        good = False
            if good:
                return n1, n2, w1, w2
    # no admissible solution: what met stays together (thesis, after eq. 2.78)
    n1 = 0 if free1 else c1
    n2 = 0 if free2 else c2
    w1, w2 = _after(p, c1, c2, n1, n2, pole(n1), pole(n2), c, s, omega1, omega2)
    return n1, n2, w1, w2


@kernel
def impact(p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2):
    """State and velocities after contacts of (c1, c2) close: (n1, n2, ω1⁺, ω2⁺).

    Momentum before is projected on the velocity fields after, M(test, new) ω⁺ = B(test, old) ω⁻; the
    test fields turn about the points where the impulses act: the new poles, or the point that a
    measured restitution asks for.  Energy never grows: where a measured value would make it grow in
    this configuration, the impulse acts at the pole.
    """
    for measured in (True, False):
        n1, n2, w1, w2 = _strike(
            p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2, measured
        )
        if not p.measured:
            break
        before = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
        after = kinetic_energy(p, n1, n2, theta1, w1, theta2, w2)
        if after <= before * (1.0 + 1e-9):
            break
    return n1, n2, w1, w2


@kernel
def stick(p, c1, c2, n1, n2, theta1, omega1, theta2, omega2):
    """Velocities after an impact that is made to end in the state (n1, n2)."""
    c, s = _between(p, theta1, theta2)
    return _after(p, c1, c2, n1, n2, pole(n1), pole(n2), c, s, omega1, omega2)
