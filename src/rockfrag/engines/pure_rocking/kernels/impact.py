"""Impacts: what the velocities are after contacts have closed (``docs/derivation.md``, ``docs/restitution.md``).

Momentum decides first, M(new) ω⁺ = B(new, old) ω⁻ (Housner, 1963; Spanos, Roussis and Politis, 2001); a measured
restitution then says at which rate the closing contact comes off, as far as energy does not grow.

In: a record BODY, a STATE before the impact, and the contacts that close. Out: contact state and velocities after.
"""

from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.contact_states import side_of
from rockfrag.engines.pure_rocking.kernels.equations import (
    energy_with,
    kinetic_energy,
    metric,
    pivot,
    turn_between,
)
from rockfrag.engines.pure_rocking.kernels.laws import moves_impulse, rate

# relative growth of the kinetic energy in an impact that counts as rounding
GAIN = 1e-12
NO_CHOICE = 2  # in the place of a contact state, where there is none to try


@kernel
def impact(body, state, closes1, closes2):
    """Return what an impact leads to: momentum first, then a measured restitution as far as energy does not grow.

    Parameters
    ----------
    body : record ``BODY``
    state : record ``STATE`` just before
    closes1, closes2 : whether the ground's contact and the interface's close

    Returns
    -------
    Contact states c1 and c2, rates ω1⁺ and ω2⁺ [rad/s], and 1 if a restitution had to give way, otherwise 0.
    """
    n1, n2, w1, w2, _ = _admissible(body, state, closes1, closes2, False)
    if not body.measured:
        return n1, n2, w1, w2, 0
    return _measured(body, state, (closes1, closes2), (n1, n2, w1, w2))


@kernel
def stuck(body, state, n1, n2):
    """Rates ω1⁺ and ω2⁺ [rad/s] after an impact that is made to end with the contact states (n1, n2)."""
    return _projected(body, state, n1, n2, (pivot(n1), pivot(n2)))


@kernel
def _projected(body, state, n1, n2, test):
    """Rates ω1⁺ and ω2⁺ [rad/s] after an impact that ends with the contact states (n1, n2).

    The moments of momentum about the points ``test`` (σ1, σ2), at which the impulses act, stay as they are:
    K ω⁺ = B ω⁻ with the kinetic products (``equations.metric``) of new and of old pivots.
    """
    if n1 == 0 and n2 == 0:
        return 0.0, 0.0
    turn = turn_between(body, state)
    k11, k12, k21, k22 = metric(body, test, (pivot(n1), pivot(n2)), turn)
    b11, b12, b21, b22 = metric(body, test, (pivot(state.c1), pivot(state.c2)), turn)
    l1 = b11 * state.omega1 + b12 * state.omega2
    l2 = b21 * state.omega1 + b22 * state.omega2
    if n1 == 0:
        return 0.0, l2 / k22
    if n2 == 0:
        both = (l1 + l2) / (k11 + k12 + k21 + k22)
        return both, both
    determinant = k11 * k22 - k12 * k21
    return (k22 * l1 - k12 * l2) / determinant, (k11 * l2 - k21 * l1) / determinant


# --------------------------------------------------------------------------- impulses that push


@kernel
def _impulse_moments(body, state, new, after, test):
    """Impulse moments [N m s] about the points ``test`` (σ1, σ2): on both blocks, and on block 2 alone.

    They are by how much the moments of momentum grow. ``new``: pivots (σ1, σ2) after the impact; ``after``: rates
    ω1⁺ and ω2⁺ [rad/s].
    """
    turn = turn_between(body, state)
    k11, k12, k21, k22 = metric(body, test, new, turn)
    b11, b12, b21, b22 = metric(body, test, (pivot(state.c1), pivot(state.c2)), turn)
    w1, w2 = after
    first = k11 * w1 + k12 * w2 - b11 * state.omega1 - b12 * state.omega2
    two = k21 * w1 + k22 * w2 - b21 * state.omega1 - b22 * state.omega2
    return first, two


@kernel
def _pushed(body, state, contacts, after, test):
    """Whether the contacts that an impact leaves closed get impulses that push, at both their corners.

    ``contacts``: their states (c1, c2) after it; ``after``: rates ω1⁺ and ω2⁺ [rad/s]; ``test``: points (σ1, σ2)
    at which impulses act where contacts are open.
    """
    n1, n2 = contacts
    new = pivot(n1), pivot(n2)
    speed = abs(state.omega1) + abs(state.omega2)
    if n1 == 0 and not body.fixed:
        for corner in (1.0, -1.0):
            first, two = _impulse_moments(body, state, new, after, (corner, test[1]))
            moment = first + two if n2 == 0 else first
            if corner * moment < -1e-12 * body.i1 * speed:
                return False
    if n2 == 0:
        for corner in (1.0, -1.0):
            _, moment = _impulse_moments(body, state, new, after, (test[0], corner))
            if corner * moment < -1e-12 * body.i2 * speed:
                return False
    return True


@inlined_kernel
def _choices(c, closes):
    """Three states that a contact ``c`` may have after an impact, in the order of trial, filled up by NO_CHOICE.

    One that ``closes`` comes off on its other pivot or stays closed; a full one opens to either side or stays; one
    that is open elsewhere stays open.
    """
    if closes:
        return -c, 0, NO_CHOICE
    return (1, -1, 0) if c == 0 else (c, NO_CHOICE, NO_CHOICE)


@kernel
def _admissible(body, state, closes1, closes2, moved):
    """Try the contact states that an impact may lead to, open before stuck, and return the first admissible one.

    In it open contacts separate, and closed ones are pushed together at both corners. Impulses act at the pivots,
    or, if ``moved``, where the law of position has them.

    Returns
    -------
    Contact states c1 and c2, rates ω1⁺ and ω2⁺ [rad/s], and whether there is an admissible one; if not, what met
    stays together.
    """
    at1, at2 = 1.0, 1.0
    if moved:
        law1, value1, has1 = _law(body, state, 1, closes1)
        law2, value2, has2 = _law(body, state, 2, closes2)
        at1 = value1 if has1 and moves_impulse(law1) else 1.0
        at2 = value2 if has2 and moves_impulse(law2) else 1.0
    c1, c2 = state.c1, state.c2
    # velocities that rounding alone leaves count as none
    tiny = 1e-13 * (abs(state.omega1) + abs(state.omega2))
    free1 = closes1 or c1 == 0
    free2 = closes2 or c2 == 0
    for n1 in _choices(c1, closes1):
        if n1 == NO_CHOICE or (body.fixed and n1 != 0):
            continue
        for n2 in _choices(c2, closes2):
            if n2 == NO_CHOICE:
                continue
            # points about which momentum is taken: the new pivots, or where the law of position has the impulses
            test = (
                pivot(n1) * (at1 if n1 != 0 else 1.0),
                pivot(n2) * (at2 if n2 != 0 else 1.0),
            )
            w1, w2 = _projected(body, state, n1, n2, test)
            if free1 and n1 != 0 and n1 * w1 <= tiny:
                continue
            if free2 and n2 != 0 and n2 * (w2 - w1) <= tiny:
                continue
            if _pushed(body, state, (n1, n2), (w1, w2), test):
                return n1, n2, w1, w2, True
    # no admissible solution: what met stays together
    n1 = 0 if free1 else c1
    n2 = 0 if free2 else c2
    w1, w2 = stuck(body, state, n1, n2)
    return n1, n2, w1, w2, False


# --------------------------------------------------------------------------- what a measured restitution says


@kernel
def _law(body, state, contact, closes):
    """Law by which ``contact`` 1 (ground) or 2 (interface) comes off its impact.

    Returned are its number and its value (``IMPACT_LAW``), and whether the contact closes and the law is not
    momentum.
    """
    if contact == 1:
        after = body.after1l if state.c1 > 0 else body.after1r
    else:
        after = body.after2l if state.c2 > 0 else body.after2r
    return after.law, after.value, closes and after.law != 0


@kernel
def _measured(body, state, closes, momentum):
    """Return the outcome of an impact (as :func:`impact`) by the laws of its closing contacts.

    The laws say at which rates closing contacts come off, from those by ``momentum`` (c1, c2, ω1⁺, ω2⁺). Where
    energy would grow by these, rates are taken between those of momentum and those of the laws, as far as it does
    not.
    """
    n1, n2, w1, w2 = momentum
    law1, value1, has1 = _law(body, state, 1, closes[0])
    law2, value2, has2 = _law(body, state, 2, closes[1])
    if not (has1 or has2):
        return n1, n2, w1, w2, 0
    # rates by momentum, before the impact, and with impulses that have moved
    rate1, rate2 = w1, w2 - w1
    before1, before2 = state.omega1, state.omega2 - state.omega1
    moved1, moved2, exists = rate1, rate2, True
    if (has1 and moves_impulse(law1)) or (has2 and moves_impulse(law2)):
        _, _, v1, v2, exists = _admissible(body, state, closes[0], closes[1], True)
        if exists:
            moved1, moved2 = v1, v2 - v1
    want1 = rate(law1, value1, rate1, before1, moved1)
    want2 = rate(law2, value2, rate2, before2, moved2)
    open1 = -state.c1 if has1 else n1
    open2 = -state.c2 if has2 else n2
    # a contact that closes does not rebound on its old pivot
    want1 = open1 * max(0.0, open1 * want1) if has1 else want1
    want2 = open2 * max(0.0, open2 * want2) if has2 else want2
    others = n1, n2
    n1, n2, w1, w2 = _with_rates(
        body, state, closes, others, (has1, want1), (has2, want2)
    )
    energy = kinetic_energy(body, state)
    if energy_with(body, state, (n1, n2), (w1, w2)) <= energy * (1.0 + GAIN):
        return n1, n2, w1, w2, 0 if exists else 1
    # as far from what momentum says as energy allows, by halving
    low, high = 0.0, 1.0
    for i in range(61):
        # the last time at a fraction where energy is known not to grow
        fraction = 0.5 * (low + high) if i < 60 else low
        first = has1, rate1 + fraction * (want1 - rate1)
        two = has2, rate2 + fraction * (want2 - rate2)
        n1, n2, w1, w2 = _with_rates(body, state, closes, others, first, two)
        if energy_with(body, state, (n1, n2), (w1, w2)) <= energy:
            low = fraction
        else:
            high = fraction
    return n1, n2, w1, w2, 1


@kernel
def _with_rates(body, state, closes, others, ground, interface):
    """Contact states c1 and c2 and rates ω1⁺ and ω2⁺ after an impact in which contacts come off at given rates.

    A couple in the closing contact does it, which leaves one momentum as it is: that of the whole about the pivot
    of the ground if the interface closes, that of the statue about its pivot if the ground does.  The other
    contact separates if that momentum asks for it, and is pressed otherwise.

    ``others``: contacts after the impact by momentum, which the contact without a given rate tries first;
    ``ground``, ``interface``: whether the rate of the contact is given, and the rate [rad/s].
    """
    given1, rate1 = ground
    given2, rate2 = interface
    m1 = side_of(rate1) if given1 else 0
    m2 = side_of(rate2) if given2 else 0
    if given1 and given2:
        return m1, m2, rate1, rate1 + rate2
    turn = turn_between(body, state)
    old = pivot(state.c1), pivot(state.c2)
    tiny = 1e-13 * (abs(state.omega1) + abs(state.omega2))
    # of the contact without a given rate: its state before, whether it closes too, and its state by momentum
    c, shuts, n = (
        (state.c2, closes[1], others[1]) if given1 else (state.c1, closes[0], others[0])
    )
    stays = c != 0 and not shuts
    if n == 0:
        n = -c if shuts else 1
    for attempt in range(2):
        if body.fixed and given2:
            break
        if attempt == 1:
            # only what was full may open to either side
            if c != 0:
                break
            n = -n
        # one momentum about the new pivots, l1 and l2 by the velocities before, gives the rate that is left
        pivots = (pivot(m1), pivot(n)) if given1 else (pivot(n), pivot(m2))
        k11, k12, k21, k22 = metric(body, pivots, pivots, turn)
        b11, b12, b21, b22 = metric(body, pivots, old, turn)
        l1 = b11 * state.omega1 + b12 * state.omega2
        l2 = b21 * state.omega1 + b22 * state.omega2
        if given1:
            w2 = (l2 - k21 * rate1) / k22
            if stays or n * (w2 - rate1) > tiny:
                return m1, n, rate1, w2
        else:
            w1 = (l1 + l2 - (k12 + k22) * rate2) / (k11 + k12 + k21 + k22)
            if stays or n * w1 > tiny:
                return n, m2, w1, w1 + rate2
    # on neither side does it come off: it stays closed
    if given1:
        return m1, 0, rate1, rate1
    return 0, m2, 0.0, rate2


# --------------------------------------------------------------------------- by the table of a stack


@inlined_kernel
def mass_matrix(two, cosine, sine):
    """M11, M12, M22 and D [kg m²] of a contact state in which both blocks rotate, Δ = θ2 - θ1.

    ``two``: its constants (``stack_constants.TWO``); ``cosine``, ``sine``: of Δ; D = dM12/dΔ.
    """
    return (
        two.m11,
        two.e * cosine + two.f * sine,
        two.m22,
        two.f * cosine - two.e * sine,
    )


@inlined_kernel
def ground_impact(before, after, product, turn, omega1, omega2):
    """Rates ω1⁺ and ω2⁺ after the ground closes (Psycharis, 1990): both momenta about the new pivots stay.

    ``before``, ``after``: constants (TWO) of the contact states; ``product``: K11 of new and old pivots
    (``IMPACT.ground``); ``turn``: cosine and sine of θ2 - θ1; ``omega1``, ``omega2``: rates before, in the unit of
    those returned.
    """
    _, old12, m22, _ = mass_matrix(before, turn[0], turn[1])
    m11, m12, _, _ = mass_matrix(after, turn[0], turn[1])
    l1 = product * omega1 + m12 * omega2
    l2 = old12 * omega1 + m22 * omega2
    fraction = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * l1 - m12 * l2) * fraction, (m11 * l2 - m12 * l1) * fraction


@inlined_kernel
def interface_impact(after, products, omega1, omega2):
    """Rates ω1⁺ and ω2⁺ after the interface closes, at θ1 = θ2: momenta of the whole and of the statue stay.

    ``after``: constants (TWO) of the contact state; ``products``: K11 to K22 of new and old pivots
    (``IMPACT.both11`` and its like); ``omega1``, ``omega2``: rates before, in the unit of those returned.
    """
    # M12 = E cos Δ + F sin Δ at Δ = 0
    m11, m12, m22 = after.m11, after.e, after.m22
    l1 = products.both11 * omega1 + products.both12 * omega2
    l2 = products.both21 * omega1 + products.both22 * omega2
    fraction = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * l1 - m12 * l2) * fraction, (m11 * l2 - m12 * l1) * fraction


# --------------------------------------------------------------------------- the lone block


@inlined_kernel
def block_impact(from_pivot, rate):
    """Return ψ' after an impact at the rate ψ' > 0 that ends rocking on a pivot, by the restitution of that pivot.

    ψ = θc - |θ| is a lone block's angle to balance, so that its rate changes its sign, in whatever unit it is;
    ``from_pivot`` is a record ``lanes.block.PIVOT``.
    """
    return -rate * from_pivot.restitution
