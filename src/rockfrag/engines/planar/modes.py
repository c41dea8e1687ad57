"""From a contact event to the mode in which the touching contacts go on (``docs/contact.md``, 5 to 9)."""

from rockfrag.elementary import sin_cos
from rockfrag.engines.kernels.jit import kernel
from rockfrag.engines.planar.search import mode_number, search, take_number, try_mode
from rockfrag.engines.planar.solve import end_of, look_at, rate, solve, standing_bodies

STILL = 1e-11  # fraction of √(g b) below which a speed is rounding


@kernel
def project(p, w):
    """Take away what rounding and integration have left at the closed contacts of ``q`` and ``v``."""
    q, v = w.q, w.v
    look_at(p, w, q)
    for k in range(p.count):
        if w.closed[k, 0] == 0 and w.closed[k, 1] == 0:
            continue
        if w.closed[k, 0] == 1 and w.closed[k, 1] == 1:
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
    w.resting = 0
    if standing_bodies(p, w) == p.count:
        moving = 0.0
        for d in range(3 * p.count):
            moving = max(moving, abs(v[d]))
        if moving < 1e-9 * p.speed:
            w.resting = 1
            for d in range(3 * p.count):
                v[d] = 0.0


@kernel
def slip_speed(p, w, v, k, trial):
    """Speed along interface k at its first closed (or, on ``trial``, touching) end; 0 if it is rounding."""
    ends = w.touching if trial else w.closed
    if ends[k, 0] == 0 and ends[k, 1] == 0:
        return 0.0
    end = 0 if ends[k, 0] == 1 else 1
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
    speed = rate(p, w.q, v, k, x, y, tx, ty)
    return speed if abs(speed) > STILL * p.speed else 0.0


@kernel
def approach(p, w, k, end):
    """Speed at which an end parts [m/s]."""
    kind = w.kind[k, end] if w.closed[k, end] == 1 or w.touching[k, end] == 1 else -1
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, kind)
    return rate(p, w.q, w.v, k, x, y, -ty, tx)


@kernel
def settle(p, w, ah, av, exclude):
    """Find the mode in which touching ends go on, not the old one on ``exclude``; False if there is none."""
    all_touch = True
    for k in range(p.count):
        w.limit[k] = p.static[k]
        for end in range(2):
            if w.touching[k, end] == 1 and approach(p, w, k, end) >= STILL * p.speed:
                w.touching[k, end] = 0
            all_touch = all_touch and w.old_closed[k, end] <= w.touching[k, end]
        speed = slip_speed(p, w, w.v, k, True)
        w.moves[k] = 1 if speed > 0.0 else (-1 if speed < 0.0 else 0)
    old = mode_number(p, w.old_closed, w.old_slides)
    wrong = search(p, w, ah, av, False, p.weight, p.g, old if exclude else -1)
    if exclude and wrong > 1e-7 and all_touch:
        # nothing else is better: the old mode failed by rounding only
        found = mode_number(p, w.closed, w.slides)
        take_number(p, w, old)
        again = max(0.0, -try_mode(p, w, False, p.weight, p.g))
        if again < wrong:
            wrong = again
        else:
            take_number(p, w, found)
    solve(p, w, w.q, w.v, ah, av, False)
    remember_slides(p, w)
    project(p, w)
    return wrong < 1e-6


@kernel
def remember_slides(p, w):
    """Keep which interfaces have reached their limit."""
    for k in range(p.count):
        if w.slides[k] != 0:
            w.slid[k] = 1


@kernel
def kinetic_energy(p, v):
    """Kinetic energy of the velocities ``v`` relative to the ground [J]."""
    total = 0.0
    for d in range(3 * p.count):
        total += 0.5 * v[d] * v[d] / p.inverse[d]
    return total
