"""Which contacts a mode keeps closed, and how each of them moves.

In: a solution of the problem of contacts, or what happened to one of them. Out: the mode, in ``s``, and the places
that hold what sticks. Theory: ``docs/space.md``, "Friction and impacts".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``s.closed``: numbers of the ``s.count`` contacts of the mode; ``s.which``: of a small system
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _closed_forms as closed
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _limits as limits

# velocity below which a point without a way of slip does not slip [m/s]; shear over the limit of its cone from
# which it does [-]
NO_SLIP, AT_LIMIT = 1e-12, 1 - 1e-9


@kernel
def kind_of_mode(s):
    """PIVOT or HINGE of a mode in which nothing is closed but one point or two that stick, or else GENERAL."""
    kind = case.kind_of(s)
    return kind if kind in (case.PIVOT, case.HINGE) else case.GENERAL


@kernel
def hold(body, y, rows, s):
    """Take from the state y the velocity that the conditions of its mode forbid, by the least kinetic energy.

    What sticks may not move, what slides only along its surface. The impulses that see to it are without friction;
    of all changes of velocity that do it theirs is that of the least kinetic energy (Gauss).
    """
    n = s.count
    if n == 0:
        return
    kind = kind_of_mode(s)
    if kind != case.GENERAL:
        hold_still(body, y, rows, kind, s)
        return
    twist = delassus.twist_of(body, s)
    delassus.fill_velocities(body, y, rows, s.closed, n, s.free, twist)
    forces.solve_general(body, y, rows, n, False, s)
    for i in range(n):
        push = (s.lam[i, 0], s.lam[i, 1], s.lam[i, 2])
        delassus.push_at(body, y, rows, s.closed[i], push, twist)


@kernel
def hold_still(body, y, rows, kind, s):
    """Stop the point or the edge that sticks by an impulse, in the state y (``docs/space.md``, equations 11, 12).

    ``kind`` is PIVOT or HINGE, as :func:`kind_of_mode` found. To both ends of an edge one load is given, the
    velocity of the centre of mass, so that an impulse can stop both: :func:`_forces.stop_edge` needs no tolerance.
    """
    velocity = algebra.to_body(rows, solid.centre_velocity(y))
    momentum = algebra.times(body.inertia, solid.omega_of(y))
    i = s.closed[0]
    if kind == case.PIVOT:
        turn, push = closed.stop_point(body, rows[2], i, velocity, momentum)
    else:
        turn, push, _, _, _ = closed.stop_edge(
            body, rows[2], i, s.closed[1], velocity, velocity, momentum, 0.0
        )
    pushed = algebra.to_world(rows, push)
    solid.set_velocity(y, algebra.plus(solid.centre_velocity(y), pushed))
    solid.set_spin(y, turn)


@kernel
def anchor_all(body, y, s):
    """Note in s.anchor where the closed points are in the plan, (x, y) [m]: what sticks is put back there."""
    rows = algebra.rotation(y)
    for k in range(s.count):
        p = solid.position_of_base(y, rows, solid.arm(body, rows[2], s.closed[k]))
        s.anchor[k, 0], s.anchor[k, 1] = p[0], p[1]


@kernel
def write_mode(body, y, rows, n, found, s):
    """Write the mode of a solution to ``s``: the contacts of the set ``found`` are closed, and stick or slide.

    What had a way of slip given slides there. What had none slides, the way it accelerates, where its force is at
    the limit of its cone.
    """
    count = 0
    s.rests = 0
    for i in range(n):
        if not case.in_set(found, i):
            continue
        s.closed[count] = s.which[i]
        s.slides[count] = case.STICKS
        u, v = s.after[3 * i], s.after[3 * i + 1]
        if s.given[i]:
            s.slides[count] = case.SLIDES
            s.direction[count, 0], s.direction[count, 1] = s.way[i, 0], s.way[i, 1]
        else:
            shear = algebra.norm(s.impulse[3 * i], s.impulse[3 * i + 1])
            limit = s.grip[i] * s.impulse[3 * i + 2]
            size = algebra.norm(u, v)
            if size > NO_SLIP and shear > limit * AT_LIMIT:
                s.slides[count] = case.SLIDES
                s.direction[count, 0], s.direction[count, 1] = u / size, v / size
                s.counters[limits.SLIDINGS] += 1
        count += 1
    s.count = count
    anchor_all(body, y, s)


@kernel
def insist(body, what, s):
    """Change one contact of a mode that was chosen again and again though it ends at once.

    ``what`` is what ends it. If it OPENS, the contact with the least normal force opens; else the one furthest out
    of its cone slides, against its shear.
    """
    worst, value = 0, limits.NO_LIMIT
    for i in range(s.count):
        shear = algebra.norm(s.lam[i, 0], s.lam[i, 1])
        grip = solid.static_of(body, s.closed[i])
        here = s.lam[i, 2] if what == limits.OPENS else grip * s.lam[i, 2] - shear
        if here < value and (what == limits.OPENS or s.slides[i] == case.STICKS):
            worst, value = i, here
    if what == limits.OPENS:
        for i in range(worst, s.count - 1):
            s.closed[i], s.slides[i] = s.closed[i + 1], s.slides[i + 1]
            for k in range(2):
                s.direction[i, k], s.anchor[i, k] = (
                    s.direction[i + 1, k],
                    s.anchor[i + 1, k],
                )
        s.count -= 1
    else:
        shear = algebra.norm(s.lam[worst, 0], s.lam[worst, 1])
        s.slides[worst] = case.SLIDES
        for k in range(2):
            s.direction[worst, k] = -s.lam[worst, k] / shear


@kernel
def jam(body, y, s):
    """Let all that is closed stick without a look at the cones (Painlevé), until one opens or one lands.

    Contacts without friction go on to slide. What sticks does no work, so no energy comes in.
    """
    for i in range(s.count):
        if not solid.is_smooth(body, s.closed[i]):
            s.slides[i] = case.STICKS
    s.jammed = 1
    anchor_all(body, y, s)
    hold(body, y, algebra.rotation(y), s)
