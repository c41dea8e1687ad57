"""Series of impacts that accumulate, ended at once where that is proved to change nothing.

The proofs, at rest and on a body that rocks on, with D, e, w and T: ``docs/kernels.md``, "Accumulating impacts".

In: a body that has just had an impact, and the ground ahead of it. Out: whether the impacts that follow may be
ended at once, and the velocities then.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import fields
from rockfrag.base.elementary import hypot
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.contact_states import at_rest
from rockfrag.engines.pure_rocking.kernels.equations import accelerations, turning
from rockfrag.engines.pure_rocking.kernels.impact import mass_matrix


class ChatterTolerance(NamedTuple):
    """How long chatter is followed before it is closed."""

    # a contact that comes off slower than this stays closed [rad/s]
    closing_speed: float
    # flights higher than this are followed even if they are sure to end at rest [rad]
    drop: float


HISTORY = ChatterTolerance(closing_speed=1e-6, drop=1e-9)  # where the history is kept
# where only the outcome matters
OUTCOME = ChatterTolerance(closing_speed=1e-4, drop=1e-2)
CHATTER_ERROR = 1e-7
"""Largest w² T [rad²/s] of a chatter that is closed at once on a body that rocks on."""
FASTEST_CHATTER = 0.1  # speed [rad/s] above which it is not
# time [s] over which the ground is looked at, at most, before it is
CHATTER_TIME = 0.08
# fraction of the speed left by impacts above which no end is foreseen
LONGEST_FRACTION = 0.999
MOST_AHEAD = 32  # samples of the ground that are looked at, at most
HIGHEST_FLIGHTS = 0.2
"""Largest speed over D/p of a chatter that is closed: flights are at most w²/2D = D/50 p² high, over which D
varies by 2 %."""
SAFETY_OF_BLOCKS = 1.03  # factor on T of a lone block, for that variation ...
SAFETY_OF_STACKS = (
    1.5  # ... and of a stack, whose thrown pedestal lengthens the flights of the statue
)
LEAVES = ((0, 1), (0, -1), (1, 0), (-1, 0))
"""Contact states (c1, c2) by which a body leaves rest: of the statue on its right and left pivot, then of both."""


class Ahead(NamedTuple):
    """The ground from an instant on."""

    samples: NDArray[np.float64]  # acceleration [m/s²], zero after ``last``
    # likewise upwards over gravity, or none where the ground does not move so
    vertical: NDArray[np.float64]
    factor: float  # on both; of lone blocks it makes of accelerations parts of gravity
    last: int  # number of the last sample
    # the instant: a sample, and the part of the interval after it [-]
    k: int
    tau: float
    dt: float  # sampling interval [s]; 1 for lone blocks, whose time is counted in samples


# --------------------------------------------------------------------------- at rest: stacks, and single histories

RESTORING = np.dtype(
    [
        # angular accelerations that bring the body back to rest from each of LEAVES: with a still ground
        # [rad/s²], and per unit of the ground's acceleration [rad/m]
        *fields("still per_ground", 4),
        # p² of the statue [1/s²], and HIGHEST_FLIGHTS D/p [rad/s] with the D of a still ground: above it no
        # chatter is closed
        *fields("frequency2 fastest"),
    ]
)
"""What closes the chatter of a body at θ1 = θ2 = 0."""


@kernel
def fill_restoring(body, restoring, scratch):
    """Fill the record RESTORING of a body for the four ways to leave rest; ``scratch`` is a STATE."""
    for i, (c1, c2) in enumerate(LEAVES):
        if c1 != 0 and body.fixed:
            restoring.still[i], restoring.per_ground[i] = math.inf, 0.0
        else:
            still = _restoring(body, c1, c2, 0.0, scratch)
            restoring.still[i] = still
            restoring.per_ground[i] = _restoring(body, c1, c2, 1.0, scratch) - still
    # of the statue on its right pivot
    vx, vy, inertia = turning(body, 0, 1)
    # p² of a ground that does not move vertically
    frequency2 = body.gravity * hypot(vx, vy) / inertia
    restoring.frequency2 = frequency2
    restoring.fastest = (
        HIGHEST_FLIGHTS * _least_restoring(restoring, 0.0, 1.0) / math.sqrt(frequency2)
    )


@kernel
def _restoring(body, c1, c2, ground, scratch):
    """Angular acceleration [rad/s²] that closes the one contact (c1 or c2) on which a body has begun to rock.

    The body is still where it rests, under an acceleration of the ground [m/s²]; ``scratch`` is a STATE.
    """
    at_rest(scratch, ground, body.gravity)
    alpha1, alpha2 = accelerations(body, c1, c2, scratch)
    return -c2 * alpha2 if c1 == 0 else -c1 * alpha1


@kernel
def _least_restoring(restoring, a, weight):
    """Least of the four restoring accelerations [rad/s²] under an acceleration of the ground ``a`` [m/s²].

    ``weight``: gravity over that of a ground that does not move vertically [-].
    """
    still, per = restoring.still, restoring.per_ground
    return min(
        min(weight * still[0] + per[0] * a, weight * still[1] + per[1] * a),
        min(weight * still[2] + per[2] * a, weight * still[3] + per[3] * a),
    )


@inlined_kernel
def weight_at(ahead, k):
    """Gravity at sample k over that of a ground that does not move vertically [-]."""
    if k < ahead.vertical.size and k <= ahead.last:
        return 1.0 + ahead.factor * ahead.vertical[k]
    return 1.0


@kernel
def dies_out(speed, fraction, safety, restoring, drop, ahead):
    """Whether the impacts that follow one at θ1 = θ2 = 0 end at rest before anything else can happen.

    They last at most T = 2 w / (D (1 - e)), with the least restoring acceleration D over that time
    (``docs/kernels.md``, "Accumulating impacts"). The ground is looked at sample by sample until T is over.

    Parameters
    ----------
    speed : w, larger one of both rates after the impact [rad/s]
    fraction : e, part of the speed that an impact leaves [-]
    safety : factor by which T is taken longer [-]
    restoring : record ``RESTORING`` of the body
    drop : height of flights that are followed whatever comes of them [rad]
    ahead : an :class:`Ahead`
    """
    if fraction > LONGEST_FRACTION:
        return False
    least = math.inf
    for n in range(MOST_AHEAD + 1):
        i = ahead.k + n
        a = ahead.samples[i] * ahead.factor if i <= ahead.last else 0.0
        least = min(least, _least_restoring(restoring, a, weight_at(ahead, i)))
        # p w > HIGHEST_FLIGHTS D, squared
        if least <= 0.0 or speed * speed * restoring.frequency2 > 0.04 * least * least:
            return False
        if speed * speed > 2.0 * drop * least:
            return False
        time = safety * 2.0 * speed / (least * (1.0 - fraction))
        if n > 0 and time <= (n - ahead.tau) * ahead.dt:
            return True
        if time > MOST_AHEAD * ahead.dt:
            return False
    return False


# --------------------------------------------------------------------------- at rest: lone blocks


@inlined_kernel
def block_dies_out(w, side, here, there, ahead):
    """Whether the impacts after one of a lone block end at rest before anything else can happen.

    T = 2 w (1/D + e/D') / (1 - e e') as in :func:`dies_out`, with D = κ (W sin θc + A cos θc) of either pivot and
    3 % more of it for the height of flights (``docs/kernels.md``, "Accumulating impacts").

    Parameters
    ----------
    w : speed after the impact [rad per sample]
    side : pivot that it rocks on then, +1 or -1
    here, there : constants (``block.PIVOT``) of that pivot and of the other
    ahead : an :class:`Ahead`, over g, time counted in samples
    """
    # gravity only ever grows D; the least of it, so far, is enough
    weight = weight_at(ahead, ahead.k)
    weight = min(weight, weight + ahead.tau * (weight_at(ahead, ahead.k + 1) - weight))
    factor, samples = ahead.factor, ahead.samples
    kappa = here.swing
    a = factor * samples[ahead.k]
    a += ahead.tau * (factor * samples[ahead.k + 1] - a)
    s, c = here.sine, side * here.cosine
    s_there, c_there = there.sine, side * there.cosine
    d = weight * s + a * c
    d_there = weight * s_there - a * c_there
    loss = 1.0 - here.restitution * there.restitution
    if loss <= 0.0:
        return False
    # 2 w and 3 % more
    flight = 2.06 * w / (kappa * loss)
    back = here.restitution * kappa / there.swing
    most = a
    least = a
    for n in range(1, MOST_AHEAD + 1):
        # flight × (1/D + e κ/κ' 1/D') with the least D and D' so far
        d = weight * s + (least if c > 0.0 else most) * c
        d_there = weight * s_there - (most if c > 0.0 else least) * c_there
        # w² > (HIGHEST_FLIGHTS D / p)², with D = κ d and p² = κ
        if d <= 0.0 or d_there <= 0.0 or w * w > 0.04 * kappa * d * d:
            return False
        time = flight * (d_there + back * d)
        if n > 1 and time <= (n - 1 - ahead.tau) * d * d_there:
            return True
        if time > (MOST_AHEAD - ahead.tau) * d * d_there:
            return False
        a = factor * samples[ahead.k + n] if ahead.k + n <= ahead.last else 0.0
        weight = min(weight, weight_at(ahead, ahead.k + n))
        most = max(most, a)
        least = min(least, a)
    return False


# --------------------------------------------------------------------------- on a body that rocks on


class Hop(NamedTuple):
    """A contact that has come down and off again while the other is open, with rates [rad per sample]."""

    ground: bool  # whether it is the ground's contact, not the interface's
    side: int  # sign of its opening now
    old: float  # its relative velocity before the impact
    # cosine, sine: of the statue's rotation
    cosine: float
    sine: float
    # omega1, omega2: velocities after the impact
    omega1: float
    omega2: float


@inlined_kernel
def _turn_of(hop):
    """Cosine and sine of θ1, and of θ2 - θ1: either θ1 is zero, or both are the same."""
    if hop.ground:
        return 1.0, 0.0, hop.cosine, hop.sine
    return hop.cosine, hop.sine, 1.0, 0.0


@kernel
def _opening(two, hop, side, g):
    """Acceleration that opens the hopping contact, in parts, in the contact state of the constants ``two`` (TWO).

    ``side``: sign of its opening in that state; ``g``: gravity [m/s²].

    Returns
    -------
    still : acceleration on a still ground [rad per sample²]
    per_ground : what each m/s² of the ground's acceleration adds
    per_weight : what each unit of weight, gravity over g, adds
    inertia : moment of inertia of the opening [kg m²]
    """
    k1, s1, cosine, sine = _turn_of(hop)
    k2, s2 = hop.cosine, hop.sine
    m11, m12, m22, d = mass_matrix(two, cosine, sine)
    g1, g2 = -g * (two.v1x * k1 + two.v1y * s1), -g * (two.v2x * k2 + two.v2y * s2)
    # right-hand sides of both bodies on a still ground, and what each m/s² of it adds
    f1 = d * hop.omega2 * hop.omega2 + g1
    f2 = -d * hop.omega1 * hop.omega1 + g2
    a1 = two.v1y * k1 - two.v1x * s1
    a2 = two.v2y * k2 - two.v2x * s2
    determinant = m11 * m22 - m12 * m12
    # the contact opens by -θ1'' if the ground's, by θ1'' - θ2'' if the interface's, at a side of +1: times the
    # determinant that is by1 times the right-hand side of body 1 and by2 times that of body 2
    if hop.ground:
        by1, by2, inertia = -m22, m12, determinant / m22
    else:
        by1, by2 = m12 + m22, -(m11 + m12)
        inertia = determinant / (m11 + 2.0 * m12 + m22)
    scale = side / determinant
    still, per_ground = scale * (by1 * f1 + by2 * f2), scale * (by1 * a1 + by2 * a2)
    return still, per_ground, scale * (by1 * g1 + by2 * g2), inertia


@inlined_kernel
def may_close(hop, before, after, longest, g, ahead):
    """Whether a contact that hops may stay closed from now on, while the other contact is open.

    Hops on both sides get slower by a part ``left`` of two impacts, so that all of them together last at most
    hops (1 / least + back / other), where ``least`` and ``other`` are the least accelerations that close the
    contact on either side. These are looked for over twice the time that those of now would give; if what they
    give is within that time, and short enough, the contact may stay closed (``docs/kernels.md``, "On a body that
    rocks on").

    Parameters
    ----------
    hop : a :class:`Hop`
    before, after : constants (``stack_constants.TWO``) of the contact states before and after its impact
    longest : time that the hops may last at most [samples]
    g : gravity [m/s²]
    ahead : an :class:`Ahead` [m/s²]
    """
    h, k, tau, last, factor = ahead.dt, ahead.k, ahead.tau, ahead.last, ahead.factor
    samples = ahead.samples
    # relative speed of the contact after its impact
    speed = abs(hop.omega1) if hop.ground else abs(hop.omega2 - hop.omega1)
    if speed > FASTEST_CHATTER * h:
        return False
    here, per_here, weight_here, inertia = _opening(after, hop, hop.side, g)
    there, per_there, weight_there, of_old = _opening(before, hop, -hop.side, g)
    e = speed / abs(hop.old)
    left = e * e * inertia / of_old
    if left > 0.98:
        return False
    longest = min(longest, CHATTER_ERROR * h / (speed * speed))
    hops = 3.0 * speed / (1.0 - left)
    back = left / e
    # the ground's acceleration over twice the time that its present value gives, sample by sample
    a_left = factor * samples[k] if k <= last else 0.0
    a_right = factor * samples[k + 1] if k < last else 0.0
    a = a_left + tau * (a_right - a_left)
    up_left, up_right = weight_at(ahead, k) - 1.0, weight_at(ahead, k + 1) - 1.0
    up = up_left + tau * (up_right - up_left)
    least = -(here + per_here * a + weight_here * up)
    other = -(there + per_there * a + weight_there * up)
    if least <= 0.0 or other <= 0.0:
        return False
    span = 2.0 * hops * (1.0 / least + back / other)
    if span > 2.0 * longest or span > CHATTER_TIME / h:
        return False
    n = 1
    while True:
        x = min(n - tau, span)
        a = a_right + (x - (n - tau)) * (a_right - a_left)
        up = up_right + (x - (n - tau)) * (up_right - up_left)
        least = min(least, -(here + per_here * a + weight_here * up))
        other = min(other, -(there + per_there * a + weight_there * up))
        if least <= 0.0 or other <= 0.0:
            return False
        if x == span:
            break
        n += 1
        a_left = a_right
        a_right = factor * samples[k + n] if k + n <= last else 0.0
        up_left, up_right = up_right, weight_at(ahead, k + n) - 1.0
    return hops * (1.0 / least + back / other) <= min(longest, span)


@inlined_kernel
def closed(hop, two):
    """Rates ω1 and ω2 [rad per sample] once the hopping contact stays closed: the momentum of what rocks on stays.

    ``two``: constants (``stack_constants.TWO``) of the contact state after its impact.
    """
    _, _, cosine, sine = _turn_of(hop)
    m11, m12, m22, _ = mass_matrix(two, cosine, sine)
    if hop.ground:
        return 0.0, hop.omega2 + m12 * hop.omega1 / m22
    both = ((m11 + m12) * hop.omega1 + (m12 + m22) * hop.omega2) / (
        m11 + 2.0 * m12 + m22
    )
    return both, both
