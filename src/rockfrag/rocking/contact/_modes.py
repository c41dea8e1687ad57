"""Finding the mode in which touching contacts go on, after an event and in an impact.

Every mode that the touching ends allow is tried, fewer closed ends first; the first one that is consistent is
taken, or the one that violates its inequalities least (``docs/contact.md``, 5 to 9).
"""

import math

from rockfrag.engines.kernels.jit import inlined_kernel, kernel
from rockfrag.rocking.contact._solve import (
    bias,
    eliminate,
    end_of,
    fill_row,
    look_at,
    rate,
    solve,
)

CONSISTENT = 2e-13
"""Violation below which a mode is consistent: forces over the weight, accelerations over g [-].  Less than the
slack of events, so that a mode that has just failed is not."""
UNSOLVED = 1e-6
"""Relative motion of a closed end beyond which the equations of a mode were singular but for rounding."""
STILL = 1e-11
"""Share of √(g b) below which a speed is rounding."""


@kernel
def is_full_stick(p, w):
    """Whether all interfaces are closed at both ends and stick."""
    stuck = 0
    for k in range(p.count):
        if w.closed[k, 0] == 1 and w.closed[k, 1] == 1 and w.slides[k] == 0:
            stuck += 1
    return stuck == p.count


@kernel
def project(p, w):
    """Take away what rounding and integration have left at the closed contacts of ``q`` and ``v``."""
    q, v = w.q, w.v
    for k in range(p.count):
        if w.closed[k, 0] == 0 and w.closed[k, 1] == 0:
            continue
        if w.closed[k, 0] == 1 and w.closed[k, 1] == 1:
            q[3 * k + 2] = q[3 * k - 1] if k > 0 else 0.0
            v[3 * k + 2] = v[3 * k - 1] if k > 0 else 0.0
        end = 0 if w.closed[k, 0] == 1 else 1
        look_at(p, w, q)
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
    if is_full_stick(p, w):
        moving = 0.0
        for d in range(3 * p.count):
            moving = max(moving, abs(v[d]))
        if moving < 1e-9 * p.speed:
            w.resting = 1
            for d in range(3 * p.count):
                v[d] = 0.0
    look_at(p, w, q)


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
def _weigh(p, w, ah, av, impact):
    """Fill what forces at the touching ends do to each other, which is the same in all modes."""
    size = 3 * p.count
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            x, y, tx, ty, _, _, kind = end_of(p, w, w.q, k, end, w.kind[k, end])
            for turn in range(2):
                dx, dy = (-ty, tx) if turn == 0 else (tx, ty)
                row = 4 * k + 2 * end + turn
                fill_row(p, w.q, k, x, y, dx, dy, w.arm[row])
                total = 0.0 if impact else bias(w.q, w.v, k, x, y, dx, dy, kind)
                for body in range(p.count):
                    at = 3 * body
                    if impact:
                        total += w.arm[row, at] * w.v[at] + w.arm[row, at + 1] * w.v[at + 1]
                        total += w.arm[row, at + 2] * w.v[at + 2]
                    else:
                        total -= w.arm[row, at] * ah + w.arm[row, at + 1] * (p.g + av)
                w.free[row] = total
    for row in range(4 * p.count):
        if w.touching[row // 4, (row // 2) % 2] == 0:
            continue
        for other in range(row + 1):
            if w.touching[other // 4, (other // 2) % 2] == 0:
                continue
            total = 0.0
            for d in range(size):
                total += w.arm[row, d] * p.inverse[d] * w.arm[other, d]
            w.give[row, other] = total
            w.give[other, row] = total


@kernel
def _try_mode(p, w, impact, force, motion):
    """How far the mode in ``w`` is from consistent, in units of ``force`` and of ``motion``; needs `_weigh`."""
    m = 0
    for k in range(p.count):
        first = True
        for end in range(2):
            if w.closed[k, end] == 0:
                continue
            w.along[m] = 4 * k + 2 * end
            w.rub[m] = -w.slides[k] * p.kinetic[k]
            m += 1
            if first and w.slides[k] == 0:
                w.along[m] = 4 * k + 2 * end + 1
                w.rub[m] = 0.0
                m += 1
            first = False
    for i in range(m):
        row = w.along[i]
        for j in range(m):
            w.matrix[i, j] = _gives(w, row, j)
        w.matrix[i, 6] = -w.free[row]
    if not eliminate(w.matrix, m):
        return math.inf
    worst = 0.0
    at = 0
    for k in range(p.count):
        pressed, shear = 0.0, 0.0
        slides = w.slides[k]
        closed = -1
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            row = 4 * k + 2 * end
            apart = w.free[row]
            for j in range(m):
                apart += _gives(w, row, j) * w.matrix[j, 6]
            if w.closed[k, end] == 0:
                worst = max(worst, -apart / motion)
                continue
            if not abs(apart) < UNSOLVED * motion:
                return math.inf
            worst = max(worst, -w.matrix[at, 6] / force)
            pressed += w.matrix[at, 6]
            at += 1
            if closed < 0:
                closed = end
                if slides == 0:
                    shear = w.matrix[at, 6]
                    at += 1
        if closed < 0:
            continue
        if slides == 0:
            margin = (w.limit[k] * pressed - abs(shear)) / max(w.limit[k], 1.0)
            worst = max(worst, -margin / force)
        elif impact or w.moves[k] == 0:
            row = 4 * k + 2 * closed + 1
            speed = w.free[row]
            for j in range(m):
                speed += _gives(w, row, j) * w.matrix[j, 6]
            worst = max(worst, -slides * speed / motion)
    return worst


@inlined_kernel
def _gives(w, row, unknown):
    """What unit of an unknown force gives along a row of ``w.give``."""
    at = w.along[unknown]
    if w.rub[unknown] == 0.0:
        return w.give[row, at]
    return w.give[row, at] + w.rub[unknown] * w.give[row, at + 1]


@kernel
def _set_interface(w, k, code, way):
    """Let interface k be closed at the ends in ``code`` (bits: left, right) and slide as ``way`` says."""
    w.closed[k, 0] = code & 1
    w.closed[k, 1] = code >> 1
    w.slides[k] = 0 if way == 2 else way


@kernel
def _is_mode(p, w, closed, slides):
    for k in range(p.count):
        if w.closed[k, 0] != closed[k, 0] or w.closed[k, 1] != closed[k, 1]:
            return False
        if w.slides[k] != slides[k]:
            return False
    return True


@kernel
def _search(p, w, ah, av, impact, force, motion, exclude):
    """Set the mode of ``w`` to the first consistent one that its touching ends allow, or the least violated.

    ``w.moves``: signs of slip that are given.  ``exclude``: the old mode has just failed.

    Returns
    -------
    The violation of the mode found; its solution is in ``w``.
    """
    _weigh(p, w, ah, av, impact)
    touch0 = w.touching[0, 0] + 2 * w.touching[0, 1]
    touch1 = w.touching[1, 0] + 2 * w.touching[1, 1] if p.count > 1 else 0
    best = math.inf
    for total in range(5):
        for code0 in range(4):
            if code0 & touch0 != code0:
                continue
            for code1 in range(4):
                if code1 & touch1 != code1:
                    continue
                ends = (code0 & 1) + (code0 >> 1) + (code1 & 1) + (code1 >> 1)
                if ends != total:
                    continue
                for turn0 in range(3):
                    way0 = turn0 if turn0 < 2 else -1
                    if not _possible(w, 0, code0, way0, impact):
                        continue
                    for turn1 in range(3):
                        way1 = turn1 if turn1 < 2 else -1
                        if not _possible(w, 1, code1, way1, impact):
                            continue
                        _set_interface(w, 0, code0, way0)
                        _set_interface(w, 1, code1, way1)
                        if exclude and _is_mode(p, w, w.old_closed, w.old_slides):
                            continue
                        wrong = _try_mode(p, w, impact, force, motion)
                        if wrong <= CONSISTENT:
                            solve(p, w, w.q, w.v, ah, av, impact)
                            return wrong
                        if wrong < best:
                            best = wrong
                            for k in range(2):
                                w.best_closed[k, 0] = w.closed[k, 0]
                                w.best_closed[k, 1] = w.closed[k, 1]
                                w.best_slides[k] = w.slides[k]
    for k in range(2):
        w.closed[k, 0] = w.best_closed[k, 0]
        w.closed[k, 1] = w.best_closed[k, 1]
        w.slides[k] = w.best_slides[k]
    solve(p, w, w.q, w.v, ah, av, impact)
    return best


@kernel
def _possible(w, k, code, way, impact):
    """Whether interface k, closed at ``code``, may stick (0) or slide as ``way`` says."""
    if code == 0:
        return way == 0
    return impact or w.moves[k] == 0 or way == w.moves[k]


@kernel
def approach(p, w, k, end):
    """Speed at which an end parts [m/s]."""
    kind = w.kind[k, end] if w.closed[k, end] == 1 or w.touching[k, end] == 1 else -1
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, kind)
    return rate(p, w.q, w.v, k, x, y, -ty, tx)


@kernel
def _only_touching(p, w):
    """Whether all closed ends of the mode still touch."""
    for k in range(p.count):
        for end in range(2):
            if w.closed[k, end] == 1 and w.touching[k, end] == 0:
                return False
    return True


@kernel
def settle(p, w, ah, av, exclude):
    """Find the mode in which the touching ends go on; False if none is consistent."""
    for k in range(p.count):
        w.limit[k] = p.static[k]
        for end in range(2):
            if w.touching[k, end] == 1 and approach(p, w, k, end) >= STILL * p.speed:
                w.touching[k, end] = 0
        speed = slip_speed(p, w, w.v, k, True)
        w.moves[k] = 1 if speed > 0.0 else (-1 if speed < 0.0 else 0)
    wrong = _search(p, w, ah, av, False, p.weight, p.g, exclude)
    if exclude and wrong > 1e-7:
        # nothing else is better: the old mode failed by rounding only
        now_closed = (w.closed[0, 0], w.closed[0, 1], w.closed[1, 0], w.closed[1, 1])
        now_slides = (w.slides[0], w.slides[1])
        for k in range(2):
            w.closed[k, 0] = w.old_closed[k, 0]
            w.closed[k, 1] = w.old_closed[k, 1]
            w.slides[k] = w.old_slides[k]
        old = math.inf
        if _only_touching(p, w):
            old = _try_mode(p, w, False, p.weight, p.g)
        if old < wrong:
            solve(p, w, w.q, w.v, ah, av, False)
            wrong = old
        else:
            w.closed[0, 0], w.closed[0, 1] = now_closed[0], now_closed[1]
            w.closed[1, 0], w.closed[1, 1] = now_closed[2], now_closed[3]
            w.slides[0], w.slides[1] = now_slides[0], now_slides[1]
    _remember_slides(p, w)
    project(p, w)
    return wrong < 1e-6


@kernel
def _remember_slides(p, w):
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


@kernel
def strike(p, w, ah, av, closing, push):
    """Plastic impulses at the touching ends, with Coulomb's law on them; sets mode and velocities.

    ``closing``: speed [m/s] below which a contact that parts and would fall shut again stays closed.  ``push``:
    nothing approaches, but no mode was consistent; see ``docs/contact.md``, 7.
    """
    before = kinetic_energy(p, w.v)
    for k in range(p.count):
        w.moves[k] = 0
        w.limit[k] = p.static[k] if slip_speed(p, w, w.v, k, True) == 0.0 else p.kinetic[k]
        if push:
            w.v[3 * k + 1] -= 1e-7 * p.speed
    scale = 1e-300
    mass = 0.0
    for k in range(p.count):
        mass += p.mass[k]
        scale = max(scale, abs(w.v[3 * k]), abs(w.v[3 * k + 1]), p.size * abs(w.v[3 * k + 2]))
    _search(p, w, ah, av, True, mass * scale, scale, False)
    _remember_slides(p, w)
    for d in range(3 * p.count):
        w.v[d] = w.out[d]
    while _shut_weak(p, w, ah, av, closing):
        solve(p, w, w.q, w.v, ah, av, True, False)
        for d in range(3 * p.count):
            w.v[d] = w.out[d]
    project(p, w)
    w.struck += before - kinetic_energy(p, w.v)
    w.impacts += 1


@kernel
def _shut_weak(p, w, ah, av, closing):
    """Close the ends that part so slowly after an impact that they would only chatter; whether there are any."""
    weak = False
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 1 and w.closed[k, end] == 0:
                weak = weak or approach(p, w, k, end) < closing
    if not weak:
        return False
    solve(p, w, w.q, w.v, ah, av, False)
    found = False
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 1 and w.closed[k, end] == 0:
                x, y, tx, ty, _, _, kind = end_of(p, w, w.q, k, end, w.kind[k, end])
                pull = rate(p, w.q, w.out, k, x, y, -ty, tx) + bias(
                    w.q, w.v, k, x, y, -ty, tx, kind
                )
                if pull < 0.0 and rate(p, w.q, w.v, k, x, y, -ty, tx) < closing:
                    w.closed[k, end] = 1
                    found = True
    return found
