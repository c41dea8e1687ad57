"""The two-block model in one formulation for all nine contact states (``docs/derivation.md``).

Block 1 is the pedestal, block 2 the statue, or a lone block on a block 1 that cannot move (``fixed``).  c1
(ground) and c2 (interface) are +1 or -1 for rocking on the right or left pivot, σ = ±1 along the interface, and 0
for full contact.  M θ'' + f = τ, with τ zero at a rocking pivot (Spanos, Roussis and Politis, 2001).

In: a record BODY, pivots and a STATE. Out: masses, forces, accelerations [rad/s²], moments [N m] and energies [J].
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.base.elementary import atan2, hypot, sin, sin_cos
from rockfrag.engines.compile.jit import inlined_kernel, kernel

IMPACT_LAW = np.dtype([*whole("law"), *fields("value")])
"""How a contact comes off an impact: by momentum (0) or by a law with its number, which is a factor on the rate
that momentum gives (COUPLE), the place of the impulse from the middle (0) to the new pivot (1) of the base
(POSITION), or the ratio of the rates after and before (RATIO)."""

BODY = np.dtype(
    [
        # pedestal: mass, inertia, half width of its base, centre of gravity from the middle of its base
        *fields("m1 i1 b1 c1x c1y"),
        # middle of the statue's footing, from the same point, and unit vector along it
        *fields("tx ty ex ey"),
        # statue: likewise, centre from the middle of its footing
        *fields("m2 i2 b2 c2x c2y"),
        # how ground and interface come off impacts that end rocking on the right and on the left pivot
        *fields("after1r after1l after2r after2l", of=IMPACT_LAW),
        *fields("gravity"),  # of a ground that does not move vertically
        *whole("linear"),  # 0 exact; 1 eq. 2.60-2.65; 2 eq. 2.9 (lone block)
        # whether block 1 cannot move, and whether some impact follows another law than momentum's
        *fields("fixed measured", of=np.bool_),
    ],
    align=True,
)
"""What the kernels know of a body: lengths [m], masses [kg], moments of inertia [kg m²], gravity [m/s²]."""

STATE = np.dtype(
    [
        *whole("c1 c2"),  # contact states of ground and interface
        # rotation [rad] and rate [rad/s] of pedestal, statue
        *fields("theta1 omega1 theta2 omega2"),
        *fields("ground"),  # acceleration of the ground [m/s²]
        *fields("gravity"),  # gravity and the ground's upward acceleration [m/s²]
    ],
    align=True,
)
"""Where a body is at an instant, and how the ground moves then."""


# --------------------------------------------------------------------------- geometry


@kernel
def pivot(c):
    """Position σ of the pivot of contact state c; full contact (0) counts as rocking on +1, at rest."""
    return -1.0 if c < 0 else 1.0


@inlined_kernel
def number_of(c1, c2):
    """Place of the contact state (c1, c2) among the nine, 0 to 8; 4 is rest."""
    return 3 * c1 + c2 + 4


@kernel
def arm1(body, sigma):
    """Return the vector from σ on the ground to the pedestal's centre, at θ1 = 0."""
    return body.c1x - sigma * body.b1, body.c1y


@kernel
def arm2(body, sigma):
    """Return the vector from σ on the interface to the statue's centre, at θ2 = 0."""
    x = body.c2x - sigma * body.b2 * body.ex
    y = body.c2y - sigma * body.b2 * body.ey
    if body.linear == 2:
        # eq. 2.9: sin θc → θc, cos θc → 1
        radius = hypot(x, y)
        return -sigma * radius * atan2(-sigma * x, y), radius
    return x, y


@kernel
def reach(body, sigma1, sigma2):
    """Return the vector d from σ1 on the ground to σ2 on the interface, at θ1 = 0."""
    return (
        body.tx + sigma2 * body.b2 * body.ex - sigma1 * body.b1,
        body.ty + sigma2 * body.b2 * body.ey,
    )


@kernel
def inertia1(body, sigma1, sigma2):
    """M11 = I1 + m1 |r1|² + m2 |d|² [kg m²], of rocking on ``sigma1`` with the statue on ``sigma2``."""
    rx, ry = arm1(body, sigma1)
    dx, dy = reach(body, sigma1, sigma2)
    return body.i1 + body.m1 * (rx * rx + ry * ry) + body.m2 * (dx * dx + dy * dy)


@kernel
def inertia2(body, sigma2):
    """M22 = I2 + m2 |r2|² [kg m²], of the statue about its pivot ``sigma2``."""
    x = body.c2x - sigma2 * body.b2 * body.ex
    y = body.c2y - sigma2 * body.b2 * body.ey
    return body.i2 + body.m2 * (x * x + y * y)


@kernel
def coupling(body, sigma1, sigma2):
    """E and F [kg m²] of M12 = m2 d·r2 = E cos(θ2 - θ1) + F sin(θ2 - θ1), as a pair."""
    dx, dy = reach(body, sigma1, sigma2)
    rx, ry = arm2(body, sigma2)
    return body.m2 * (dx * rx + dy * ry), body.m2 * (dx * ry - dy * rx)


@kernel
def first_moment1(body, sigma1, sigma2):
    """First moment m1 r1 + m2 d [kg m] at θ1 = 0, that gravity and the ground act on in the first equation."""
    rx, ry = arm1(body, sigma1)
    dx, dy = reach(body, sigma1, sigma2)
    return body.m1 * rx + body.m2 * dx, body.m1 * ry + body.m2 * dy


@kernel
def first_moment2(body, sigma2):
    """First moment m2 r2 [kg m] at θ2 = 0, of the second equation."""
    rx, ry = arm2(body, sigma2)
    return body.m2 * rx, body.m2 * ry


# --------------------------------------------------------------------------- motion and contact forces


@kernel
def weight_moment(body, vx, vy, theta, state):
    """-g V_x + a V_y [N m] with V = R(θ)(vx, vy): what gravity and the ground add to f1 or f2.

    ``vx``, ``vy``: first moment at θ = 0 [kg m]; ``theta``: θ1 or θ2 [rad]; ``state`` has g and a.
    """
    g, ground = state.gravity, state.ground
    if body.linear > 0:
        return ground * vy - g * (vx + vy * theta)
    s, c = sin_cos(theta)
    return ground * (vy * c - vx * s) - g * (vx * c + vy * s)


@kernel
def equations(body, sigma1, sigma2, state):
    """M11, M12, M22 [kg m²], f1 and f2 [N m] of M θ'' + f = τ about the points σ1 and σ2, in a STATE.

    f1 = D θ2'² + weight and f2 = -D θ1'² + weight (:func:`weight_moment`), with D = dM12/d(θ2 - θ1).
    """
    e, f = coupling(body, sigma1, sigma2)
    theta1, theta2 = state.theta1, state.theta2
    if body.linear > 0:
        m12 = e
        d = 0.0
    else:
        s, c = sin_cos(theta2 - theta1)
        m12 = e * c + f * s
        d = f * c - e * s
    v1x, v1y = first_moment1(body, sigma1, sigma2)
    v2x, v2y = first_moment2(body, sigma2)
    omega1, omega2 = state.omega1, state.omega2
    f1 = d * omega2 * omega2 + weight_moment(body, v1x, v1y, theta1, state)
    f2 = -d * omega1 * omega1 + weight_moment(body, v2x, v2y, theta2, state)
    return inertia1(body, sigma1, sigma2), m12, inertia2(body, sigma2), f1, f2


@kernel
def accelerations(body, c1, c2, state):
    """θ1'' and θ2'' [rad/s²] if the contacts were (c1, c2)."""
    if c1 == 0 and c2 == 0:
        return 0.0, 0.0
    m11, m12, m22, f1, f2 = equations(body, pivot(c1), pivot(c2), state)
    if c1 == 0:
        return 0.0, -f2 / m22
    if c2 == 0:
        both = -(f1 + f2) / (m11 + 2.0 * m12 + m22)
        return both, both
    determinant = m11 * m22 - m12 * m12
    return (m12 * f2 - m22 * f1) / determinant, (m12 * f1 - m11 * f2) / determinant


GROUND, INTERFACE = 1, 2  # the two contacts


@kernel
def hold(body, contact, contacts, state, alpha):
    """Least contact moment over both corners of a closed contact: it has to be pressed at each, s τ(s) ≥ 0.

    The pedestal rests where the ground is closed, and the statue is stuck to it where the interface is
    (``docs/derivation.md``).

    Parameters
    ----------
    body, state : records ``BODY`` and ``STATE``
    contact : GROUND or INTERFACE
    contacts : contact states (c1, c2) under which the body moves
    alpha : θ1'' and θ2'' then [rad/s²]

    Returns
    -------
    The least s τ(s) [N m], negative where the contact would have to be pulled, and the corner s = ±1 it is at.
    """
    if contact == GROUND and body.fixed:
        return 1.0, 1
    c1, c2 = contacts
    least = math.inf
    corner = 1
    for c in (1, -1):
        s1, s2 = (c, c2) if contact == GROUND else (c1, c)
        _, m12, m22, f1, f2 = equations(body, pivot(s1), pivot(s2), state)
        if contact == INTERFACE:
            tau = (m12 + m22) * alpha[0] + f2
        else:
            tau = m12 * alpha[1] + f1
            if c2 == 0:
                tau += m22 * alpha[1] + f2
        if c * tau < least:
            least = c * tau
            corner = c
    return least, corner


# --------------------------------------------------------------------------- energy and balance


@kernel
def turn_between(body, state):
    """Cosine and sine of θ2 - θ1; 1 and 0 in the linearised equations."""
    if body.linear > 0 or state.theta1 == state.theta2:
        return 1.0, 0.0
    sine, cosine = sin_cos(state.theta2 - state.theta1)
    return cosine, sine


@kernel
def metric(body, first, other, turn):
    """Return the kinetic products of two pairs of velocity fields, mass times velocity times velocity [kg m²].

    A field is the unit rotation of block 1 (carrying block 2) or of block 2 about a point σ of its base. Kij is
    that of field i about the points ``first`` with field j about the points ``other``. With both the same, K is
    the mass matrix; momentum about new pivots from old velocities takes them different (``docs/derivation.md``).

    Parameters
    ----------
    body : record ``BODY``
    first, other : points (σ1, σ2) on the ground and on the interface
    turn : cosine and sine of θ2 - θ1 (:func:`turn_between`)

    Returns
    -------
    K11, K12, K21, K22.
    """
    c, s = turn
    ax, ay = arm1(body, first[0])
    bx, by = arm1(body, other[0])
    dax, day = reach(body, first[0], first[1])
    dbx, dby = reach(body, other[0], other[1])
    rax, ray = arm2(body, first[1])
    rbx, rby = arm2(body, other[1])
    m1 = body.m1
    m2 = body.m2
    k11 = body.i1 + m1 * (ax * bx + ay * by) + m2 * (dax * dbx + day * dby)
    # d·R(Δ)r
    k12 = m2 * (dax * (rbx * c + rby * s) + day * (rby * c - rbx * s))
    k21 = m2 * (dbx * (rax * c + ray * s) + dby * (ray * c - rax * s))
    if body.linear == 2:
        k22 = inertia2(body, first[1])
        if first[1] != other[1]:
            x, y = body.c2x, body.c2y
            b = body.b2
            k22 = body.i2 + m2 * ((x - first[1] * b) * (x - other[1] * b) + y * y)
    else:
        k22 = body.i2 + m2 * (rax * rbx + ray * rby)
    return k11, k12, k21, k22


@kernel
def kinetic_energy(body, state):
    """Kinetic energy relative to the ground [J]."""
    return energy_with(body, state, (state.c1, state.c2), (state.omega1, state.omega2))


@kernel
def energy_with(body, state, contacts, omega):
    """Kinetic energy [J] of a state with other ``contacts`` (c1, c2) and velocities ``omega`` (ω1, ω2) [rad/s]."""
    pivots = pivot(contacts[0]), pivot(contacts[1])
    k11, k12, _, k22 = metric(body, pivots, pivots, turn_between(body, state))
    w1, w2 = omega
    return 0.5 * (k11 * w1 * w1 + 2.0 * k12 * w1 * w2 + k22 * w2 * w2)


@kernel
def potential_energy(body, state):
    """Potential energy above rest [J]: g Σ m y, quadratic in θ in the linearised equations.

    Σ m y changes with the upward component of the first moments, of which (v1x, v1y) turns by θ1 and (v2x, v2y) by
    θ2.
    """
    s1, s2 = pivot(state.c1), pivot(state.c2)
    theta1, theta2 = state.theta1, state.theta2
    v1x, v1y = first_moment1(body, s1, s2)
    v2x, v2y = first_moment2(body, s2)
    g = body.gravity
    if body.linear > 0:
        return -g * (
            theta1 * (v1x + 0.5 * v1y * theta1) + theta2 * (v2x + 0.5 * v2y * theta2)
        )
    # V_y(θ) - V_y(0), with 1 - cos θ = 2 sin²(θ/2) so that nothing cancels
    h1 = sin(0.5 * theta1)
    h2 = sin(0.5 * theta2)
    return -g * (
        v1x * sin(theta1)
        + 2.0 * v1y * h1 * h1
        + v2x * sin(theta2)
        + 2.0 * v2y * h2 * h2
    )


@kernel
def turning(body, c1, c2):
    """What turns about an open pivot: the statue where c1 is 0, else all on the pedestal's pivot.

    Returned are its first moment x and y at θ = 0 [kg m] and its moment of inertia [kg m²], both about the pivot.
    """
    s1, s2 = pivot(c1), pivot(c2)
    x2, y2 = first_moment2(body, s2)
    if c1 == 0:
        return x2, y2, inertia2(body, s2)
    x1, y1 = first_moment1(body, s1, s2)
    if c2 != 0:
        return x1, y1, inertia1(body, s1, s2)
    e, _ = coupling(body, s1, s2)
    return x1 + x2, y1 + y2, inertia1(body, s1, s2) + 2.0 * e + inertia2(body, s2)


@kernel
def balance(body, c1, c2):
    """Critical angle [rad] of what turns about an open pivot, and the three numbers of :func:`turning`."""
    vx, vy, inertia = turning(body, c1, c2)
    return atan2(-(c1 or c2) * vx, vy), vx, vy, inertia


@kernel
def barrier(body):
    """Least energy [J] that could overturn the body at rest without help from the ground."""
    least = math.inf
    for c1 in (0, 1, -1):
        for c2 in (0, 1, -1):
            if (c1 != 0 or c2 != 0) and not (c1 != 0 and body.fixed):
                vx, vy, _ = turning(body, c1, c2)
                least = min(least, hypot(vx, vy) - vy)
    return least * body.gravity
