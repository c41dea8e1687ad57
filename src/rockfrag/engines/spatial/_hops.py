"""Hops of one end of an edge beside the other, which after an impact need not be followed.

In: velocities after an impact. Out: contacts that are slow enough to be kept closed at once. Theory:
``docs/space.md``, "Friction and impacts" and "Derivations".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``
"""

import math

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _closed_forms as closed
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _ties as ties

# hops of one end of an edge beside the other: speed above which they are followed [m/s]; part by which each is
# slower than the one before, at least [-]; and what closing them may change of the body's angular velocity [rad/s]
FASTEST_HOP, SLOWING, CHATTER = 1e-2, 0.05, 1e-6


@kernel
def keep_slow_contacts(body, y, rows, gravity, n, found, closes, s):
    """Write the mode after an impact to ``s``: contacts that pushed, leave more slowly than s.close, or chatter.

    In: the n contacts s.which with s.after, the set ``found`` that pushed, and whether what chatters ``closes``.
    What is kept though it would leave is held, which changes the state y by little.
    """
    count = 0
    slow = False
    hops = -1
    if closes:
        hops = hopping(body, y, rows, gravity, n, found, s)
    for i in range(n):
        leaving = s.after[3 * i + 2]
        if case.in_set(found, i) or leaving < s.close or i == hops:
            slow = slow or not case.in_set(found, i)
            s.closed[count] = s.which[i]
            slip = algebra.norm(s.after[3 * i], s.after[3 * i + 1])
            slides = slip > max(s.close, limits.AT_REST) and i != hops
            slides = slides or solid.is_smooth(body, s.which[i])
            s.slides[count] = case.SLIDES if slides else case.STICKS
            count += 1
    s.count, s.rests = count, 0
    if slow:
        contacts.hold(body, y, rows, s)


@kernel
def hopping(body, y, rows, gravity, n, found, s):
    """Place in s.which of a contact that chatters beside the only one that pushed, and stuck; -1 if there is none.

    Rims do not hop. Of several contacts it is the one that leaves slowest.
    """
    slowest, alone = -1, -1
    for k in range(n):
        if found == 1 << k:
            alone = k
        elif slowest < 0 or s.after[3 * k + 2] < s.after[3 * slowest + 2]:
            slowest = k
    if alone < 0 or slowest < 0 or body.rim > 0.0:
        return -1
    if algebra.norm(s.after[3 * alone], s.after[3 * alone + 1]) > limits.AT_REST:
        return -1
    leaving = s.after[3 * slowest + 2]
    closes = chatters(body, y, rows, gravity, alone, slowest, leaving, s)
    return slowest if closes else -1


@kernel
def chatters(body, y, rows, gravity, i, k, leaving, s):
    """Whether contact k hops so little beside contact i, on which the body pivots, that both may close.

    ``i`` and ``k`` are places in s.which, ``leaving`` the speed of the hop [m/s]. Impacts at either end conserve
    the momentum about the edge between them, with which the body goes on when the hops are over. What is left out
    of it is at most that of equation 18 (``docs/space.md``), and must be below CHATTER.
    """
    if leaving > FASTEST_HOP:
        return False
    up, omega = rows[2], solid.omega_of(y)
    weight = ties.load_on(body, y, rows, gravity, s)
    here, there = s.which[i], s.which[k]
    p, turned = solid.arm_and_bias(body, up, omega, here)
    alpha, force = closed.pivot_acceleration(body, p, turned, omega, weight, here, s)
    q = solid.arm(body, up, there)
    # acceleration of the far end while the body pivots
    far = algebra.plus(weight, solid.bias(body, up, omega, q, there))
    far = algebra.plus(far, algebra.plus(force, algebra.cross(alpha, q)))
    falls = -algebra.dot(up, far)
    if falls <= 0.0:
        return False
    edge = algebra.minus(q, p)
    length = math.sqrt(algebra.dot(edge, edge))
    g = s.field[case.GRAVITY]
    left_out = leaving**3 * g / (SLOWING * falls**2 * length * body.height)
    return left_out < CHATTER
