"""Gaps and slips that integration leaves at closed contacts are taken away, and what lies down is laid flat.

In: a state whose closed contacts are nearly closed. Out: the state with them closed. Theory: ``docs/space.md``,
"Steps".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _delassus as delassus

# compliance of contacts, over the largest of a body, by which gaps at walls are closed [-], and how many times
GAP_SOFTNESS, CLOSINGS = 1e-3, 3


@kernel
def settle(body, y, s):
    """Put the state y back on the conditions of its mode, from which steps drift by their error.

    Of a pivot or a hinge place and velocity follow from the attitude and the spin; what else is closed is moved to
    the ground and stopped by what is least in kinetic energy.
    """
    rows = algebra.rotation(y)
    kind = case.kind_of(s)
    if kind in (case.PIVOT, case.HINGE):
        i = s.closed[0]
        p = solid.arm(body, rows[2], i)
        omega = solid.omega_of(y)
        if kind == case.HINGE:
            q = solid.arm(body, rows[2], s.closed[1])
            e = algebra.minus(q, p)
            omega = algebra.scaled(algebra.dot(e, omega) / algebra.dot(e, e), e)
            solid.set_spin(y, omega)
        moved = algebra.to_world(rows, p)
        y[solid.HEIGHT] = -moved[2]
        if i != solid.rim_contact(body):
            x, z = s.anchor[0, 0] - moved[0], s.anchor[0, 1] - moved[1]
            solid.set_place(y, x, z)
        solid.set_velocity(y, algebra.to_world(rows, algebra.cross(p, omega)))
    elif kind in (case.GENERAL, case.SLIDER):
        close_gaps(body, y, rows, s)
        contacts.hold(body, y, algebra.rotation(y), s)


@kernel
def close_gaps(body, y, rows, s):
    """Move the body so that its closed points are on the ground, by what is least in its kinetic energy.

    Of two points each is lifted as a vertical impulse there would: two equations W_nn P = -gap with the
    compliances of both (``docs/space.md``, equation 10). A face is laid flat.
    """
    n = s.count
    if case.at_wall(s):
        close_gaps_at_wall(body, y, s)
        return
    if n >= 3:
        lay_flat(body, y)
        return
    delassus.fill_delassus(body, rows, s.closed, n, s.delassus)
    first = solid.gap(body, y, rows[2], s.closed[0])
    if n == 1:
        y[solid.HEIGHT] -= first
        return
    second = solid.gap(body, y, rows[2], s.closed[1])
    # vertical displacement at each by a vertical impulse at each: row 3 k + 2 is the vertical at point k
    own, mixed, other = s.delassus[2, 2], s.delassus[2, 5], s.delassus[5, 5]
    determinant = own * other - mixed * mixed
    lift_first = -(other * first - mixed * second) / determinant
    lift_second = -(own * second - mixed * first) / determinant
    lift_at(body, y, rows, s.closed[0], lift_first)
    lift_at(body, y, rows, s.closed[1], lift_second)


@kernel
def close_gaps_at_wall(body, y, s):
    """Move the body by what its closed points are off the ground and the walls, as impulses P there would.

    Four contacts of an upright body may say one thing twice, and contradict each other by the errors of steps. So
    the gaps are closed as by soft contacts, (W_nn + soft) P = -gap, W_nn the rows and columns 3 k + 2 of the
    Delassus matrix, which do not move the body far for that; and what this leaves of the gaps twice more.
    """
    n = s.count
    for _ in range(CLOSINGS):
        rows = algebra.rotation(y)
        delassus.fill_delassus(body, rows, s.closed, n, s.delassus)
        soft = GAP_SOFTNESS * delassus.largest_compliance(s, n)
        for i in range(n):
            for j in range(n):
                s.matrix[i, j] = s.delassus[3 * i + 2, 3 * j + 2]
            s.matrix[i, i] += soft
            s.vector[i] = -solid.gap_of(body, y, rows, s.closed[i])
        if not algebra.factor(s.matrix, s.order, n):
            return
        algebra.substitute(s.matrix, s.order, n, s.vector)
        for i in range(n):
            shift_at(body, y, rows, s.closed[i], s.vector[i])


@kernel
def shift_at(body, y, rows, i, size):
    """Displace the body as a small impulse at contact i, away from its surface, would in a unit of time.

    ``size`` is that of the impulse for a unit of mass, in a unit of time a length [m].
    """
    p = solid.arm(body, rows[2], i)
    push = algebra.scaled(size, delassus.push_along(body, rows, i, 2))
    moved = algebra.to_world(rows, push)
    for k in range(3):
        y[k] += moved[k]
    algebra.turn(y, algebra.times(body.inverse, algebra.cross(p, push)))


@kernel
def lift_at(body, y, rows, i, size):
    """Displace the body as a small vertical impulse at point i of the base would: see :func:`shift_at`."""
    p = solid.arm(body, rows[2], i)
    y[solid.HEIGHT] += size
    algebra.turn(
        y, algebra.scaled(size, algebra.times(body.inverse, algebra.cross(p, rows[2])))
    )


@kernel
def come_to_rest(body, y, s):
    """Let the body rest where it is: no velocity, flat, and the mode in ``s``."""
    s.count, s.rests = 0, 1
    solid.set_velocity(y, (0.0, 0.0, 0.0))
    solid.set_spin(y, (0.0, 0.0, 0.0))
    lay_flat(body, y)


@kernel
def lay_flat(body, y):
    """Turn the base into the ground's plane by the least rotation, and set it down; changes the state y.

    The rotation is about the horizontal axis across the tilt, by the sine of it; two more rounds take what this
    leaves of its third power.
    """
    for _ in range(3):
        up = algebra.rotation(y)[2]
        algebra.turn(y, (-up[1], up[0], 0.0))
    y[solid.HEIGHT] = body.height
