"""Impacts: what the velocities are after contacts have closed.

Point impact, no bounce, no impulse at a pole that leaves: momentum before is projected on the velocity fields
after, M(test, new) ω⁺ = B(test, old) ω⁻ (``docs/derivation.md``; thesis eq. 2.12, 2.76-2.86).  The test fields
turn about the
points where the impulses act: the new poles, or what a measured restitution asks for.

Every outcome of every impact is worked out here, so a contact law has its place here:

- ``impact``: any contacts of any body.  One history follows it, and the tables of landings are made with it.
- ``ground_impact``, ``interface_impact``: one contact of two closes while the other stays open, which makes
  nearly all impacts of a stack in an ensemble, by the products of velocity fields that the stack's table holds.
- ``block_impact``: the lone block of an ensemble.
"""

from rockfrag.rocking.kernels.equations import kinetic_energy, metric, pole, turn_between
from rockfrag.rocking.kernels.jit import inlined_kernel, kernel


@kernel
def impact(body, state, closes1, closes2):
    """State and velocities after contacts of a state close: (c1, c2, ω1⁺, ω2⁺).

    Energy never grows: where a measured restitution would make it grow in this configuration, the impulse acts
    at the pole.
    """
    n1, n2, w1, w2 = _admissible(body, state, closes1, closes2, body.measured)
    if body.measured:
        before = kinetic_energy(body, state)
        after = _energy_with(body, state, n1, n2, w1, w2)
        if after > before * (1.0 + 1e-9):
            n1, n2, w1, w2 = _admissible(body, state, closes1, closes2, False)
    return n1, n2, w1, w2


@kernel
def stuck(body, state, n1, n2):
    """Velocities after an impact that is made to end with the contacts (n1, n2)."""
    new = pole(n1), pole(n2)
    return _projected(body, state, n1, n2, new)


@kernel
def _energy_with(body, state, n1, n2, w1, w2):
    """Kinetic energy in a state, with other contacts and velocities [J]."""
    poles = pole(n1), pole(n2)
    k11, k12, _, k22 = metric(body, poles, poles, turn_between(body, state))
    return 0.5 * (k11 * w1 * w1 + 2.0 * k12 * w1 * w2 + k22 * w2 * w2)


@kernel
def _projected(body, state, n1, n2, test):
    """Velocities after an impact that ends with the contacts (n1, n2), 0 being stuck.

    ``test`` are the points where the impulses act.
    """
    if n1 == 0 and n2 == 0:
        return 0.0, 0.0
    turn = turn_between(body, state)
    k11, k12, k21, k22 = metric(body, test, (pole(n1), pole(n2)), turn)
    b11, b12, b21, b22 = metric(body, test, (pole(state.c1), pole(state.c2)), turn)
    l1 = b11 * state.omega1 + b12 * state.omega2
    l2 = b21 * state.omega1 + b22 * state.omega2
    if n1 == 0:
        return 0.0, l2 / k22
    if n2 == 0:
        both = (l1 + l2) / (k11 + k12 + k21 + k22)
        return both, both
    determinant = k11 * k22 - k12 * k21
    return (k22 * l1 - k12 * l2) / determinant, (k11 * l2 - k21 * l1) / determinant


@kernel
def _impulse_moments(body, state, new, after, test):
    """Impulse moments on the fields that turn block 1 and block 2 about the points ``test``."""
    turn = turn_between(body, state)
    k11, k12, k21, k22 = metric(body, test, new, turn)
    b11, b12, b21, b22 = metric(body, test, (pole(state.c1), pole(state.c2)), turn)
    w1, w2 = after
    one = k11 * w1 + k12 * w2 - b11 * state.omega1 - b12 * state.omega2
    two = k21 * w1 + k22 * w2 - b21 * state.omega1 - b22 * state.omega2
    return one, two


@kernel
def _pushed(body, state, contacts, after, test):
    """Whether the contacts that an impact leaves closed get impulses that push, at both their corners."""
    n1, n2 = contacts
    new = pole(n1), pole(n2)
    speed = abs(state.omega1) + abs(state.omega2)
    if n1 == 0 and not body.fixed:
        for corner in (1.0, -1.0):
            one, two = _impulse_moments(body, state, new, after, (corner, test[1]))
            moment = one + two if n2 == 0 else one
            if corner * moment < -1e-12 * body.i1 * speed:
                return False
    if n2 == 0:
        for corner in (1.0, -1.0):
            _, moment = _impulse_moments(body, state, new, after, (test[0], corner))
            if corner * moment < -1e-12 * body.i2 * speed:
                return False
    return True


@kernel
def _choice(number, c, closes):
    """The ``number``-th state that a contact may have after an impact, open before stuck; 2 if there is none.

    One that closes does not rebound on its old pole; one that is open and does not close stays as it is.
    """
    if number == 0:
        return -c if closes else (1 if c == 0 else c)
    if number == 1:
        return 2 if closes or c != 0 else -1
    return 0 if closes or c == 0 else 2


@kernel
def _admissible(body, state, closes1, closes2, measured):
    """Try the states an impact may lead to, open before stuck; the first admissible one.

    Open contacts separate, and closed ones are pushed together at both corners.
    """
    c1, c2 = state.c1, state.c2
    # velocities that rounding alone leaves count as none
    tiny = 1e-13 * (abs(state.omega1) + abs(state.omega2))
    free1 = closes1 or c1 == 0
    free2 = closes2 or c2 == 0
    for number1 in range(3):
        n1 = _choice(number1, c1, closes1)
        if n1 == 2 or (body.fixed and n1 != 0):
            continue
        for number2 in range(3):
            n2 = _choice(number2, c2, closes2)
            if n2 == 2:
                continue
            t1, t2 = pole(n1), pole(n2)
            if measured:
                if closes1 and n1 != 0:
                    t1 = n1 * (body.eta1r if n1 > 0 else body.eta1l)
                if closes2 and n2 != 0:
                    t2 = n2 * (body.eta2r if n2 > 0 else body.eta2l)
            w1, w2 = _projected(body, state, n1, n2, (t1, t2))
            if free1 and n1 != 0 and n1 * w1 <= tiny:
                continue
            if free2 and n2 != 0 and n2 * (w2 - w1) <= tiny:
                continue
            if _pushed(body, state, (n1, n2), (w1, w2), (t1, t2)):
                return n1, n2, w1, w2
    # no admissible solution: what met stays together (thesis, after eq. 2.78)
    n1 = 0 if free1 else c1
    n2 = 0 if free2 else c2
    w1, w2 = stuck(body, state, n1, n2)
    return n1, n2, w1, w2


# --------------------------------------------------------------------------- by the table of a stack


@inlined_kernel
def mass_matrix(two, cosine, sine):
    """M11, M12, M22 and D of a contact state in which both blocks rotate, at cos Δ, sin Δ."""
    return two.m11, two.e * cosine + two.f * sine, two.m22, two.f * cosine - two.e * sine


@inlined_kernel
def ground_impact(before, after, product, turn, omega1, omega2):
    """Velocities after the ground closes (thesis eq. 2.68-2.71): both momenta about the new poles.

    Parameters
    ----------
    before, after : constants of the contact states (``stack_constants.TWO``)
    product : ``ground`` of ``stack_constants.IMPACT``
    turn : cosine and sine of θ2 - θ1
    """
    _, old12, m22, _ = mass_matrix(before, turn[0], turn[1])
    m11, m12, _, _ = mass_matrix(after, turn[0], turn[1])
    l1 = product * omega1 + m12 * omega2
    l2 = old12 * omega1 + m22 * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * l1 - m12 * l2) * share, (m11 * l2 - m12 * l1) * share


@inlined_kernel
def interface_impact(after, products, omega1, omega2):
    """Velocities after the interface closes, Δ = 0: momentum of the whole and of the statue."""
    m11, m12, m22 = after.m11, after.e, after.m22
    l1 = products.both11 * omega1 + products.both12 * omega2
    l2 = products.both21 * omega1 + products.both22 * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * l1 - m12 * l2) * share, (m11 * l2 - m12 * l1) * share


# --------------------------------------------------------------------------- the lone block


@inlined_kernel
def block_impact(from_pole, rate):
    """ψ' on the new pole after an impact at rate ψ' > 0 that ends rocking on a pole (``block.POLE``)."""
    return -rate * from_pole.restitution
