"""From a contact event to the mode in which touching contacts go on, by an impact or not (``docs/contact.md``).

An impact has impulses at touching ends, Coulomb's law on them, and each contact's own law.

In: a record ``BODY`` and its working memory with coordinates, velocities [m/s, rad/s] and the mode that has
failed. Out: in that memory the mode that follows, and the velocities after the impact (equations 7 to 9, 15).
"""

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.bonds import break_pulled
from rockfrag.engines.planar.routh import contact_alone, strike_alone
from rockfrag.engines.planar.search import (
    NONE,
    ROUNDING,
    Trial,
    search,
    take_mode,
    try_mode,
    whole_mode,
)
from rockfrag.engines.planar.solve import (
    bias,
    copy,
    end_of,
    look_at,
    rate,
    solve_impact,
    solve_motion,
    solve_nearest,
    standing_bodies,
)
from rockfrag.engines.planar.walls import any_closed, note_impulses
from rockfrag.engines.planar.witness import SHUT
from rockfrag.engines.pure_rocking.kernels.laws import moves_impulse, scales_momentum
from rockfrag.engines.pure_rocking.kernels.laws import rate as lawful_rate
from rockfrag.laws.momentum import NUMBER as MOMENTUM

NO_GAIN = 1e-12  # fraction of the kinetic energy below which a gain is rounding
HALVINGS = 40  # halvings of the interval in which a law that gives way keeps the energy
MANY_CONTACT_EVENTS = 100
"""Contact events within a sample after which speeds below the closing speed count as none, whatever pulls."""
PULLS = 1e-9  # acceleration over g towards a wall above which it is none of rounding
UNREACHED = 1e-7  # violation above which an impact has no outcome under a law
VANISHING = 1e-7  # speed of approach over √(g b) that stands for none [-]
STILL = 1e-11  # fraction of √(g b) below which a speed is rounding


@kernel
def project(p, w):
    """Take away what rounding and integration have left at the closed contacts of ``q`` and ``v``."""
    q, v = w.q, w.v
    look_at(p, w, q)
    if any_closed(p, w):
        _project_jointly(p, w)
        return
    for k in range(p.count):
        if not w.closed[k].any():
            continue
        if w.closed[k].all():
            q[3 * k + 2] = q[3 * k - 1] if k > 0 else 0.0
            v[3 * k + 2] = v[3 * k - 1] if k > 0 else 0.0
            w.sin[k], w.cos[k] = sin_cos(q[3 * k + 2])
        end = 0 if w.closed[k, 0] == 1 else 1
        x, y, tx, ty, gap, _, _ = end_of(p, w, q, k, end, w.kind[k, end])
        for body in range(k, p.count):
            q[3 * body] += gap * ty
            q[3 * body + 1] -= gap * tx
        x, y, tx, ty, _, _, _ = end_of(p, w, q, k, end, w.kind[k, end])
        normal = rate(p, q, v, k, x, y, -ty, tx)
        along = rate(p, q, v, k, x, y, tx, ty) if w.slides[k] == 0 else 0.0
        for body in range(k, p.count):
            v[3 * body] -= along * tx - normal * ty
            v[3 * body + 1] -= along * ty + normal * tx
    moving = 0.0
    for d in range(3 * p.count):
        moving = max(moving, abs(v[d]))
    w.resting = standing_bodies(p, w) == p.count and moving < 1e-9 * p.speed
    if w.resting:
        v[:] = 0.0


@kernel
def _project_jointly(p, w):
    """What :func:`project` does where walls close a chain of contacts: the least change that shuts all at once."""
    w.resting = 0
    for k in range(p.contacts):
        for end in range(2):
            if w.closed[k, end] == 1:
                _, _, _, _, gap, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
                w.back[k, end] = -gap
    solved = solve_nearest(p, w, w.zero)
    w.back[:] = 0.0
    if solved:
        for d in range(3 * p.count):
            w.q[d] += w.out[d]
        look_at(p, w, w.q)
    if solve_nearest(p, w, w.v):
        copy(p, w.out, w.v)


@kernel
def slip_speed(p, w, v, k, trial):
    """Speed along interface k at its first closed (or, on ``trial``, touching) end; 0 if it is rounding."""
    ends = w.touching[k] if trial else w.closed[k]
    if not ends.any():
        return 0.0
    end = 0 if ends[0] == 1 else 1
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
    speed = rate(p, w.q, v, k, x, y, tx, ty)
    return speed if abs(speed) > STILL * p.speed else 0.0


@kernel
def parting_speed(p, w, k, end):
    """Speed at which an end of contact k opens [m/s], negative if it closes."""
    kind = w.kind[k, end] if w.closed[k, end] == 1 or w.touching[k, end] == 1 else -1
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, kind)
    return rate(p, w.q, w.v, k, x, y, -ty, tx)


@kernel
def settle(p, w, ah, av, exclude):
    """Find the mode in which touching ends go on, not the old one on ``exclude``; False if there is none.

    Accelerations and forces are then those of this mode.
    """
    all_touch = True
    for k in range(p.contacts):
        static = p.static[k]
        w.against[k] = static
        w.along[k] = static
        for end in range(2):
            parts = w.whole[k] == 0 and w.touching[k, end] == 1
            if parts and parting_speed(p, w, k, end) >= STILL * p.speed:
                w.touching[k, end] = 0
            all_touch = all_touch and w.old_closed[k, end] <= w.touching[k, end]
        speed = slip_speed(p, w, w.v, k, True)
        w.moves[k] = 1 if speed > 0.0 else (-1 if speed < 0.0 else 0)
    old = whole_mode(p, w.old_closed, w.old_slides)
    trial = Trial(ah, av, False, p.weight, p.g)
    wrong = search(p, w, trial, old if exclude else NONE)
    if exclude and wrong > ROUNDING and all_touch:
        # nothing else is better: the old mode failed by rounding only
        found = whole_mode(p, w.closed, w.slides)
        take_mode(p, w, old)
        again = max(0.0, -try_mode(p, w, trial))
        if again < wrong:
            wrong = again
        else:
            take_mode(p, w, found)
    remember_slides(p, w)
    project(p, w)
    solve_motion(p, w, w.q, w.v, ah, av)
    return wrong < 1e-6


@kernel
def remember_slides(p, w):
    """Keep which interfaces have reached their limit."""
    for k in range(p.count):
        w.outcome.slid[k] |= w.slides[k] != 0


@kernel
def kinetic_energy(p, v):
    """Kinetic energy of the velocities ``v`` relative to the ground [J]."""
    total = 0.0
    for d in range(3 * p.count):
        total += 0.5 * v[d] * v[d] / p.inverse[d]
    return total


@kernel
def strike(p, w, ah, av, closing):
    """Give the touching ends that approach their impulses (``docs/contact.md``, 7 to 9).

    Mode and velocities are then those after the impact, and the ends that touch are those that are closed.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    ah, av : accelerations of the ground, to the right and upwards [m/s²]
    closing : speed below which an end that parts and would fall shut again stays closed [m/s]
    """
    before = kinetic_energy(p, w.v)
    has_laws = _read_laws(p, w, closing)
    if p.count > 1 and _meets_wall(p, w):
        # a body that a wall stops asks shear of what it carries, and no pressure: but for the weight that presses
        # both together no impulse at all would do as well as one that sticks, and the motion could not go on
        _press_together(p, w)
    _read_slips(p, w)
    _give_impulses(p, w, has_laws)
    _end_impact(p, w, ah, av, closing, before)


@kernel
def strike_unapproached(p, w, ah, av, closing):
    """Give impulses where nothing approaches but no mode is consistent (``docs/contact.md``, "Painlevé's cases").

    They are those that a vanishing speed of approach calls forth. In and out as of :func:`strike`.
    """
    before = kinetic_energy(p, w.v)
    _forget_laws(p, w)
    _read_slips(p, w)
    _press_together(p, w)
    _give_impulses(p, w, False)
    _end_impact(p, w, ah, av, closing, before)


@kernel
def _press_together(p, w):
    """Let all bodies come down with a vanishing speed."""
    for k in range(p.count):
        w.v[3 * k + 1] -= VANISHING * p.speed


@kernel
def _meets_wall(p, w):
    """Whether a body comes on against a wall, or the plate of an isolator against its stop."""
    for k in range(p.count, p.contacts):
        for end in range(2):
            touches = w.touching[k, end] == 1
            if touches and parting_speed(p, w, k, end) < -VANISHING * p.speed:
                return True
    return False


@kernel
def _read_slips(p, w):
    """Read the sign of the slip of each contact before an impact, and its coefficients of friction in it."""
    for k in range(p.contacts):
        slip = slip_speed(p, w, w.v, k, True)
        w.moves[k], w.slid[k] = 0, 1 if slip > 0.0 else (-1 if slip < 0.0 else 0)
        w.along[k] = p.static[k]
        w.against[k] = p.static[k] if slip == 0.0 else p.kinetic[k]


@kernel
def _give_impulses(p, w, has_laws):
    """Find mode, impulses and velocities after an impact, bonds that it breaks left out."""
    # units of what is found: the fastest corner's speed, more than zero, and the mass
    speed = 1e-300
    mass = 0.0
    for k in range(p.count):
        mass += p.mass[k]
        speed = max(
            speed, abs(w.v[3 * k]), abs(w.v[3 * k + 1]), p.size * abs(w.v[3 * k + 2])
        )
    trial = Trial(0.0, 0.0, True, mass * speed, speed)
    _find_impulses(p, w, trial, has_laws)
    while p.is_held == 1 and break_pulled(p, w, trial.force):
        _find_impulses(p, w, trial, has_laws)
    note_impulses(p, w)
    _let_bounce(p, w)
    lift_laws(p, w)
    remember_slides(p, w)
    copy(p, w.out, w.v)


@kernel
def _end_impact(p, w, ah, av, closing, before):
    """Shut what parts too slowly, and write down what the impact has lost of the kinetic energy ``before`` [J]."""
    for k in range(p.contacts):
        read_slip(p, w, k, 0.0)
    while _shut_weak(p, w, ah, av, closing):
        solve_nearest(p, w, w.v)
        copy(p, w.out, w.v)
    project(p, w)
    touch_closed(p, w)
    w.impact_loss += before - kinetic_energy(p, w.v)
    w.outcome.impacts += 1


@kernel
def _find_impulses(p, w, trial, has_laws):
    """Fill in impulses (w.normal, w.shear) and velocities (w.out) after an impact.

    It follows the laws of its contacts if they have an outcome. ``trial`` is the mode that the search begins with.
    """
    search(p, w, trial, NONE)
    solve_impact(p, w)
    if has_laws:
        _obey(p, w, trial)
        return
    # of one contact alone the whole course of an impact is known: how long it slips and when it turns round
    k, end = contact_alone(p, w)
    if k >= 0:
        strike_alone(p, w, k, end)


@kernel
def _let_bounce(p, w):
    """Open the ends at walls that leave with a speed."""
    for k in range(p.count, p.contacts):
        for end in range(2):
            if w.back[k, end] > 0.0:
                w.closed[k, end] = 0


@kernel
def touch_closed(p, w):
    """Let the ends that are closed be those that touch, beside walls also those that touched and do not part."""
    for k in range(p.contacts):
        for end in range(2):
            stays = p.contacts > p.count and w.touching[k, end] == 1
            if not stays or parting_speed(p, w, k, end) >= STILL * p.speed:
                w.touching[k, end] = w.closed[k, end]


@kernel
def lift_laws(p, w):
    """Let impulses be plastic."""
    w.fraction[:] = 0.0
    w.back[:] = 0.0
    w.drive[:] = -1


@kernel
def _forget_laws(p, w):
    """Note that no contact comes down: no end of an interface, ``falls``, and no side at a speed, ``came``."""
    for k in range(p.count):
        w.falls[k] = -1
    for k in range(p.count, p.contacts):
        for end in range(2):
            w.came[k, end] = 0.0


@kernel
def _read_laws(p, w, closing):
    """Note which interfaces come down on one end while the other is closed; whether any of them has a law.

    What would leave a wall more slowly than ``closing`` [m/s] does not bounce: pressed to it, it would for ever.
    """
    _forget_laws(p, w)
    has_laws = False
    for k in range(p.count):
        for end in range(2):
            other_holds = w.touching[k].all() and w.old_closed[k, 1 - end] == 1
            if not other_holds or w.old_closed[k, end] == 1:
                continue
            speed = parting_speed(p, w, k, end)
            if speed < 0.0 and p.law[k, end] != MOMENTUM:
                w.falls[k] = end
                w.goal[k, 1] = -speed
                has_laws = True
    for k in range(p.count, p.contacts):
        for end in range(2):
            came = 0.0
            if w.touching[k, end] == 1:
                came = max(0.0, -parting_speed(p, w, k, end))
            w.came[k, end] = came if came * p.bounce[k] >= closing else 0.0
            has_laws = has_laws or w.came[k, end] * p.bounce[k] > 0.0
    return has_laws


@kernel
def _obey(p, w, trial):
    """Let the laws of the contacts act on the plastic outcome that is in ``w``, as far as no energy is gained."""
    energy = kinetic_energy(p, w.v)
    for k in range(p.count):
        end = w.falls[k]
        if end < 0:
            continue
        x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, 1 - end, w.kind[k, 1 - end])
        w.goal[k, 0] = max(0.0, rate(p, w.q, w.out, k, x, y, -ty, tx))
        law, before = p.law[k, end], w.goal[k, 1]
        w.goal[k, 1] = lawful_rate(law, p.number[k, end], w.goal[k, 0], before, before)
        if scales_momentum(law) and (
            w.closed[k, end] == 0 or w.closed[k, 1 - end] == 1
        ):
            # it stays shut, or leaves altogether: nothing to multiply
            w.falls[k] = -1
    if _outcome(p, w, trial, 1.0, energy):
        return
    w.outcome.given_way += 1
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if _outcome(p, w, trial, middle, energy):
            low = middle
        else:
            high = middle
    _outcome(p, w, trial, low, energy)


@kernel
def _outcome(p, w, trial, part, before):
    """Outcome of an impact that obeys a ``part`` of the laws; whether there is one that gains no energy."""
    lift_laws(p, w)
    for k in range(p.count):
        end = w.falls[k]
        if end < 0 or part == 0.0:
            continue
        if moves_impulse(p.law[k, end]):
            place = p.number[k, end]
            w.fraction[k, end] = part * (1.0 - place) / (1.0 + place)
        else:
            w.drive[k] = 1 - end
            w.depart[k] = w.goal[k, 0] + part * (w.goal[k, 1] - w.goal[k, 0])
            w.closed[k, end], w.closed[k, 1 - end] = 1, 0
    for k in range(p.count, p.contacts):
        for end in range(2):
            w.back[k, end] = part * p.bounce[k] * w.came[k, end]
    wrong = search(p, w, trial, NONE)
    solve_impact(p, w)
    return wrong <= UNREACHED and kinetic_energy(p, w.out) <= before * (1.0 + NO_GAIN)


@kernel
def _can_hold(p, w, still):
    """Whether beside walls all closed contacts can be held, with no more than what is slower than ``still`` asks.

    Two that ask for the same thing cannot be, as a wall and a face may; two that all but do, such as a corner
    right under the edge of a kerb, can, but only by a body that stops.
    """
    if not any_closed(p, w):
        return True
    if not solve_nearest(p, w, w.v):
        return False
    most = SHUT * max(still, STILL * p.speed)
    for d in range(3 * p.count):
        size = p.size if d % 3 == 2 else 1.0
        if not size * abs(w.out[d] - w.v[d]) <= most:
            return False
    return True


@kernel
def read_slip(p, w, k, still):
    """Let closed contact k slide as it moves, and stick only if it slips no faster than ``still`` [m/s].

    After an impact nothing else decides between the two: what sticks is held by shear without a bound where ends
    are shut, so what slips may never be called stuck.  What a wall stops goes on as what slides.
    """
    speed, slid = slip_speed(p, w, w.v, k, False), w.slides[k]
    w.slides[k] = 0 if abs(speed) <= still else (1 if speed > 0.0 else -1)
    if slid != 0 and w.slides[k] == 0 and not _can_hold(p, w, still):
        w.slides[k] = slid


@kernel
def _any_slow_end(p, w, closing):
    """Whether a touching end that is open parts too slowly."""
    for k in range(p.contacts):
        for end in range(2):
            is_open = w.touching[k, end] == 1 and w.closed[k, end] == 0
            if is_open and parting_speed(p, w, k, end) < closing:
                return True
    return False


@kernel
def _shut_weak(p, w, ah, av, closing):
    """Close the ends that part, and end the slips that are, too slow after an impact; whether there are any.

    Slow ends close where they fall back, and among many contact events wherever: which way an end is pulled
    depends on the sign of a slip, so that slow slips and slow ends would call forth each other without an end.
    At walls ends close one by one, so that none is closed that the others hold already.
    """
    found = False
    if _any_slow_end(p, w, closing):
        solve_motion(p, w, w.q, w.v, ah, av)
    for k in range(p.contacts):
        at_wall = k >= p.count or any_closed(p, w)
        are_many = w.met > MANY_CONTACT_EVENTS and not at_wall
        least = -PULLS * p.g if at_wall else 0.0
        was_open = not w.closed[k].any()
        for end in range(2):
            if w.touching[k, end] == 1 and w.closed[k, end] == 0:
                x, y, tx, ty, _, _, kind = end_of(p, w, w.q, k, end, w.kind[k, end])
                if rate(p, w.q, w.v, k, x, y, -ty, tx) >= closing:
                    continue
                parting = rate(p, w.q, w.out, k, x, y, -ty, tx)
                parting += bias(p, w.q, w.v, k, x, y, -ty, tx, kind)
                if parting < least or are_many:
                    slid = w.slides[k]
                    w.closed[k, end] = 1
                    if not any_closed(p, w):
                        found = True
                        continue
                    if was_open:
                        read_slip(p, w, k, closing)
                    if w.slides[k] == 0 and not _can_hold(p, w, closing):
                        # a face holds it along the wall
                        w.slides[k] = 1
                    if _can_hold(p, w, closing):
                        return True
                    # as it was: what is changed here and again below never ends
                    w.closed[k, end], w.slides[k] = 0, slid
                    solve_motion(p, w, w.q, w.v, ah, av)
        if was_open or w.slides[k] != 0:
            slides = w.slides[k] != 0
            read_slip(p, w, k, closing)
            found = found or (slides and w.slides[k] == 0)
    return found
