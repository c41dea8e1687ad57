"""Finding the mode in which touching contacts go on, after a contact event and in an impact (``docs/contact.md``).

A search starts from a mode, mends what it violates most, and goes on so until nothing is violated.  It is begun
from the mode that has just failed, from the one in which all is open and, unless these two meet, from the one in
which all is closed; of those that are consistent the one with fewest closed ends is taken.  Where none ends so, it
is begun with all bodies leaning, then the violation at the lowest contact is mended first, or that at the highest
(a least index: K. G. Murty, Opsearch 11, 1974, 123-130), and then the neighbours of all tried modes are tried.

In: a record ``BODY`` and its working memory. Out: in that memory the mode, and whether several were consistent.
Theory there: "Which mode follows", equations 4 to 6; impacts 8 and 9.
"""

import math
from typing import NamedTuple

import numpy as np

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.equations import solve_equations
from rockfrag.engines.planar.solve import (
    COUPLE,
    SHEAR,
    bias,
    end_of,
    fill_row,
    rate,
)
from rockfrag.engines.planar.support import GUIDED, rubbing, slope
from rockfrag.engines.planar.ties import fill_tie_accelerations

# violation below which a mode is consistent: forces over the weight, accelerations over g [-].  Less than the
# slack of contact events, so that a mode that has just failed is not
CONSISTENT = 2e-13
# relative motion of a closed end where a mode was singular but for rounding [-]
UNSOLVED = 1e-6
# violation of how a motion goes on, and of an impact, up to which a mode fails by rounding only
ROUNDING, ROUNDING_OF_IMPACTS = 1e-7, 1e-10
# modes that are tried at most where a motion cannot go on: a jam of more than three contacts has none
TRIES_OF_MOTIONS = 256
FAILS, SEEN = -1, -2  # what a mode that is tried is, unless it is consistent
# what changes between modes: whether the end 0 or 1 is closed, or how an interface slides
SLIP = 2
CHANGES = 5  # of one contact: both ends, and three ways to slide
NONE = (-1, -1)  # no mode
# what a search mends: the worst violation, that of the lowest contact, or that of the highest
WORST, LOWEST, HIGHEST = 0, 1, 2
RULES = 3
# what a search begins with after the mode in memory: whether left ends are closed, right ones, and walls
STARTS = (
    (0, 0, 0),
    (1, 1, 1),
    # leaning, as what is stopped at its foot does
    (0, 1, 0),
    (0, 1, 1),
    (1, 0, 0),
    (1, 0, 1),
)
USUAL = 2  # of these that are always tried: all open, all closed
BONDED = 1  # what a contact is that neither opens nor slides


class Trial(NamedTuple):
    """What modes are tried for: an impact, or how a motion goes on."""

    ah: float  # horizontal acceleration of the ground [m/s²]
    av: float  # likewise upwards
    impact: bool
    force: float  # unit of forces or impulses
    motion: float  # unit of accelerations or velocities


@kernel
def prepare(p, w, trial):
    """Fill what all modes of the ends that touch share: motion without forces, and motion for unit forces.

    ``w.basis[k]`` has a row a direction at contact k, per coordinate of the bodies below and above (3 each):
    normal and tangent of the left end, of the right end, and a couple.  ``w.free[k]`` has the motion without
    forces along the first four.
    """
    if p.ties + p.is_sprung > 0 and not trial.impact:
        fill_tie_accelerations(p, w, w.q, w.v)
    for k in range(p.contacts):
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            x, y, tx, ty, _, _, kind = end_of(p, w, w.q, k, end, w.kind[k, end])
            for along in range(2):
                dx, dy = (tx, ty) if along == 1 else (-ty, tx)
                row = 2 * end + along
                fill_row(p, w.q, k, x, y, dx, dy, w.basis[k, row])
                if trial.impact:
                    w.free[k, row] = rate(p, w.q, w.v, k, x, y, dx, dy)
                    continue
                w.free[k, row] = bias(p, w.q, w.v, k, x, y, dx, dy, kind)
                if p.lower[k] < 0:
                    w.free[k, row] -= dx * trial.ah + dy * (p.g + trial.av)
                if p.ties + p.is_sprung > 0:
                    w.free[k, row] += _drift_along(p, w, k, w.basis[k, row])
        w.basis[k, 4, :] = 0.0
        w.basis[k, 4, 5], w.basis[k, 4, 2] = 1.0, -1.0 if p.lower[k] >= 0 else 0.0
    w.listed[:] = -1


@kernel
def _drift_along(p, w, k, row):
    """Motion of contact k that the accelerations by ties bring about."""
    total, base = 0.0, 3 * p.upper[k] - 3
    for d in range(3 if p.lower[k] < 0 else 0, 6):
        total += row[d] * w.drift[base + d]
    return total


@kernel
def _list_equations(p, w, k, impact):
    """Fill rows, columns and right-hand sides of contact k in its mode in ``w`` from what :func:`prepare` left.

    One equation for the normal force of each closed end, one for the shear of a contact that sticks, one for the
    couple that a law of restitution asks for (``docs/contact.md``, 3; impacts 7).
    """
    friction = rubbing(p, w, w.q, k, impact)
    m, needs_shear = 3 * k, w.slides[k] == 0
    for end in range(2):
        if w.closed[k, end] == 0:
            continue
        normal, tangent = w.basis[k, 2 * end], w.basis[k, 2 * end + 1]
        w.what[m] = end
        w.right[m] = (w.back[k, end] if impact else 0.0) - w.free[k, 2 * end]
        for d in range(6):
            w.row[m, d] = normal[d]
            w.column[m, d] = normal[d] - friction * tangent[d]
        if impact and w.fraction[k, end] > 0.0:
            # the other end gets a fraction of this end's impulse
            other_normal = w.basis[k, 2 - 2 * end]
            other_tangent = w.basis[k, 3 - 2 * end]
            for d in range(6):
                w.column[m, d] += w.fraction[k, end] * (
                    other_normal[d] - friction * other_tangent[d]
                )
        m += 1
        if needs_shear:
            w.what[m] = SHEAR
            w.right[m] = -w.free[k, 2 * end + 1]
            for d in range(6):
                w.row[m, d] = tangent[d]
                w.column[m, d] = tangent[d]
            m += 1
        # one shear holds both ends, which lie on one line
        needs_shear = False
    if impact and w.drive[k] >= 0:
        w.what[m] = COUPLE
        w.right[m] = w.depart[k] - w.free[k, 2 * w.drive[k]]
        for d in range(6):
            w.row[m, d] = w.basis[k, 2 * w.drive[k], d]
            w.column[m, d] = w.basis[k, 4, d]
        m += 1
    w.unknowns[k] = m - 3 * k


@kernel
def _solve_mode(p, w, impact):
    """Forces of the mode in ``w``, and the motion that they bring about; False if its equations are singular.

    Equations are listed anew for the contacts whose mode is not the one that they were listed for since
    :func:`prepare`.  Of a column what is above the uppermost of these need not be eliminated again.
    """
    uppermost_changed = -1
    for k in range(p.contacts):
        digit = _digit(w.closed, w.slides, k)
        if w.listed[k] == digit:
            continue
        _list_equations(p, w, k, impact)
        w.listed[k] = digit
        if k < p.count:
            uppermost_changed = k
    return solve_equations(p, w, w.q, 0, uppermost_changed)


@kernel
def _motion_of(p, w, k, row):
    """Relative motion of interface k under the mode that was solved, along a row of its basis."""
    found, base = w.free[k, row], 3 * p.upper[k] - 3
    for d in range(3 if p.lower[k] < 0 else 0, 6):
        found += w.basis[k, row, d] * w.moved[base + d]
    return found


@kernel
def _note_worst(w, worst, margin, k, what, way):
    """Least margin so far; remember what would mend it, or the violation that is to be mended first."""
    if w.mends == WORST:
        is_next = margin < worst
    else:
        is_next = margin < -CONSISTENT and (w.mends == HIGHEST or w.flip[0] < 0)
    if is_next:
        w.flip[0], w.flip[1], w.flip[2] = k, what, way
    return min(worst, margin)


@kernel
def try_mode(p, w, trial):
    """Least margin of the mode in ``w`` after :func:`prepare`, negative if inconsistent; ``w.flip`` mends it."""
    w.flip[0] = -1
    if not _solve_mode(p, w, trial.impact):
        return -math.inf
    worst = math.inf
    for k in range(p.contacts):
        pressed, shear, at = 0.0, 0.0, 3 * k
        slides = w.slides[k]
        closed = -1
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            apart = _motion_of(p, w, k, 2 * end)
            if trial.impact:
                apart -= w.back[k, end]
            if w.closed[k, end] == 0:
                if w.drive[k] != end:
                    worst = _note_worst(w, worst, apart / trial.motion, k, end, 1)
                continue
            if not abs(apart) < UNSOLVED * trial.motion:
                w.flip[0] = -1
                return -math.inf
            # a force that friction multiplies counts as the shear that it brings about
            push = w.force[at] * (max(1.0, p.kinetic[k]) if slides != 0 else 1.0)
            if w.whole[k] == 0:
                worst = _note_worst(w, worst, push / trial.force, k, end, 0)
            pressed += w.force[at] * (1.0 + w.fraction[k, end])
            at += 1
            if closed < 0:
                closed = end
                if slides == 0:
                    shear = w.force[at]
                    at += 1
        if w.drive[k] >= 0 and closed < 0:
            return -math.inf
        if closed < 0 or w.whole[k] == BONDED:
            continue
        if slides == 0:
            if not trial.impact:
                shear += slope(p, w, w.q, k) * pressed
            limit = w.along[k] if w.slid[k] * shear >= 0.0 else w.against[k]
            margin = (limit * pressed - abs(shear)) / max(limit, 1.0)
            worst = _note_worst(
                w, worst, margin / trial.force, k, SLIP, -1 if shear > 0.0 else 1
            )
        elif trial.impact or w.moves[k] == 0:
            speed = _motion_of(p, w, k, 2 * closed + 1)
            worst = _note_worst(w, worst, slides * speed / trial.motion, k, SLIP, 0)
    return worst


@kernel
def change(w, k, what, way, impact):
    """Change one thing of the mode in ``w``."""
    if what == SLIP:
        w.slides[k] = way
        return
    was_open = not w.closed[k].any()
    w.closed[k, what] = 1 - w.closed[k, what]
    if was_open or not w.closed[k].any():
        w.slides[k] = w.moves[k] if was_open and not impact else 0


@kernel
def _digit(closed, slides, k):
    """Mode of interface k as one number: its closed ends (bits) and 4 × (slip + 1)."""
    return closed[k, 0] + 2 * closed[k, 1] + 4 * (slides[k] + 1)


@kernel
def mode_number(p, closed, slides):
    """Mode of the contacts of bodies with each other as one number, a digit each."""
    number = 0
    for k in range(p.count):
        number += _digit(closed, slides, k) << (4 * k)
    return number


@kernel
def wall_number(p, closed, slides):
    """Mode of the contacts with walls as one number, 0 if there are none."""
    number = 0
    for k in range(p.count, p.contacts):
        number += _digit(closed, slides, k) << (4 * (k - p.count))
    return number


@kernel
def whole_mode(p, closed, slides):
    """Mode of all contacts as two numbers: of bodies with each other, and with walls."""
    return mode_number(p, closed, slides), wall_number(p, closed, slides)


@kernel
def take_mode(p, w, mode):
    """Set the mode in ``w`` to that of two numbers."""
    for k in range(p.contacts):
        number, place = (mode[0], k) if k < p.count else (mode[1], k - p.count)
        digit = (number >> (4 * place)) & 15
        w.closed[k, 0] = digit & 1
        w.closed[k, 1] = (digit >> 1) & 1
        w.slides[k] = (digit >> 2) - 1


@kernel
def _take_tried(p, w, place):
    """Set the mode in ``w`` to one of the list of those that have been tried."""
    take_mode(p, w, (w.tried[place, 0], w.tried[place, 1]))


@kernel
def _closed_ends(p, w, place):
    """Number of closed ends of a mode that was tried, to which that of ``w`` is set."""
    _take_tried(p, w, place)
    return w.closed[: p.contacts].sum()


@kernel
def _place_of(w, mode):
    """Place of a mode in the list of those that have been tried by the same rule, -1 if it has not been."""
    for i in range(w.first, w.count):
        if w.tried[i, 0] == mode[0] and w.tried[i, 1] == mode[1]:
            return i
    return -1


@kernel
def _try_anew(p, w, trial, exclude):
    """Try the mode in ``w`` and list it; its place if it is consistent, FAILS, or SEEN if it was tried before.

    ``exclude``: a mode that is known to fail.  A full list takes no more.
    """
    mode = whole_mode(p, w.closed, w.slides)
    if w.count == w.wrong.size or _place_of(w, mode) >= 0:
        return SEEN
    margin = try_mode(p, w, trial)
    fails = mode[0] == exclude[0] and mode[1] == exclude[1]
    place = w.count
    w.tried[place, 0], w.tried[place, 1] = mode
    w.wrong[place] = math.inf if fails else max(0.0, -margin)
    w.count += 1
    return place if margin >= -CONSISTENT and not fails else FAILS


@kernel
def _descend(p, w, trial, exclude):
    """Mend the worst of the mode in ``w`` until none is left, its place, or a mode comes back."""
    found, shut = _try_anew(p, w, trial, exclude), -1
    while found == FAILS:
        k, what = w.flip[0], w.flip[1]
        if k >= 0:
            change(w, k, what, w.flip[2], trial.impact)
            shut = k if what < SLIP and w.closed[k, what] == 1 else -1
        elif not (shut >= 0 and _let_slide(p, w, shut)):
            break
        found = _try_anew(p, w, trial, exclude)
    return found


@kernel
def _let_slide(p, w, shut):
    """Let slide what sticks although something else holds it already; False if nothing does.

    A mode is singular since contact ``shut`` has closed: a wall stops a body that its base holds as well. So that
    contact slides, and if this is not enough the base of its body.
    """
    for k in (shut, p.upper[shut]):
        if w.closed[k].any() and w.slides[k] == 0 and w.whole[k] != BONDED:
            speed = w.free[k, 1] if w.closed[k, 0] == 1 else w.free[k, 3]
            w.slides[k] = 1 if speed >= 0.0 else -1
            return True
    return False


@kernel
def _try_neighbours(p, w, trial, exclude):
    """Try all modes that differ in one thing from those that were tried, then their neighbours, until one fits.

    Returned is its place in the list, or ``FAILS``.
    """
    at, most = 0, w.wrong.size
    if not trial.impact and p.contacts > 3:
        most = TRIES_OF_MOTIONS
    # a full list takes no more
    while at < w.count and w.count < most:
        for k in range(p.contacts):
            for what in range(CHANGES):
                _take_tried(p, w, at)
                if _change_to_neighbour(w, trial, k, what):
                    found = _try_anew(p, w, trial, exclude)
                    if found >= 0:
                        return found
        at += 1
    return FAILS


@kernel
def _change_to_neighbour(w, trial, k, what):
    """Change one thing of contact k in ``w``; False if it may not change.

    ``what``: 0 or 1 opens or closes that end, 2 to 4 set the sign of slip to -1, 0 or 1.
    """
    if w.whole[k] == BONDED:
        return False
    if what < SLIP:
        if w.whole[k] != 0 or w.touching[k, what] == 0 or w.drive[k] >= 0:
            return False
        change(w, k, what, 0, trial.impact)
        return True
    way, given = what - SLIP - 1, 0 if trial.impact else w.moves[k]
    if not w.closed[k].any() or (given != 0 and way != given):
        return False
    w.slides[k] = way
    return True


@kernel
def _only_touching(p, w, trial):
    """Open what does not touch, and let what touches slide as it moves."""
    for k in range(p.contacts):
        for end in range(2):
            w.closed[k, end] *= w.touching[k, end]
        if not w.closed[k].any():
            w.slides[k] = 0
        elif not trial.impact and w.moves[k] != 0:
            w.slides[k] = w.moves[k]


@kernel
def _try_slips(p, w, trial, found):
    """Try the other ways to slide of a consistent mode; the one to take, and whether more were consistent."""
    several = False
    for k in range(p.contacts):
        _take_tried(p, w, found)
        slides = w.slides[k]
        lasts = _digit(w.closed, w.slides, k) == _digit(w.old_closed, w.old_slides, k)
        is_given = not trial.impact and w.moves[k] != 0
        if lasts or is_given or not w.closed[k].any() or w.whole[k] == BONDED:
            continue
        for way in range(-1, 2):
            if way == slides:
                continue
            _take_tried(p, w, found)
            w.slides[k] = way
            other = _try_anew(p, w, trial, NONE)
            several = several or other >= 0
            # sticking goes before sliding
            if other >= 0 and way == 0:
                found = other
    return found, several


@kernel
def _begin(p, w, rule, start):
    """Close the ends of a ``start`` that touch and let them stick, but for what a given speed of an end needs.

    What another ``rule`` of mending has tried may come again.
    """
    left, right, at_walls = start
    if rule != w.mends:
        w.mends, w.first = rule, w.count
    for k in range(p.contacts):
        closes = (left, right) if k < p.count else (at_walls, at_walls)
        w.slides[k] = 0
        for end in range(2):
            stays = 1 if w.whole[k] != 0 else closes[end]
            w.closed[k, end] = stays * w.touching[k, end]
        touches = closes[0] + closes[1] > 0 and w.closed[k].any()
        if touches or w.whole[k] == GUIDED:
            w.slides[k] = w.moves[k]
        if w.drive[k] >= 0:
            w.closed[k, w.drive[k]] = 0
            w.closed[k, 1 - w.drive[k]] = 1


@kernel
def _is_inconsistent(w, trial):
    """Whether all modes that have been tried are violated by more than rounding."""
    least = w.wrong[np.argmin(w.wrong[: w.count])]
    return least > (ROUNDING_OF_IMPACTS if trial.impact else ROUNDING)


@kernel
def search(p, w, trial, exclude):
    """Set the mode of ``w`` to a consistent one that its touching ends allow, or the least violated; by how much.

    The mode in ``w`` is where the search starts.  ``w.moves``: signs of slip that are given.  ``exclude``: a mode
    that has just failed, or ``NONE``.
    """
    prepare(p, w, trial)
    _only_touching(p, w, trial)
    w.count, w.mends, w.first = 0, WORST, 0
    found, several = -1, False
    for start in range(1 + RULES * len(STARTS)):
        if start > USUAL and not _is_inconsistent(w, trial):
            break
        if start > 0:
            rule, row = (start - 1) // len(STARTS), (start - 1) % len(STARTS)
            _begin(p, w, rule, STARTS[row])
        other = _descend(p, w, trial, exclude)
        if other >= 0:
            several = several or found >= 0
            if found < 0 or _closed_ends(p, w, other) < _closed_ends(p, w, found):
                found = other
        elif other == SEEN and found >= 0:
            # it has come upon what was tried before: two ways lead to the same mode
            break
    w.mends, w.first = WORST, 0
    if found >= 0:
        found, more = _try_slips(p, w, trial, found)
        several = several or more
    if several:
        w.outcome.several_modes += 1
    if _is_inconsistent(w, trial):
        found = _try_neighbours(p, w, trial, exclude)
    if found < 0:
        found = np.argmin(w.wrong[: w.count])
    _take_tried(p, w, found)
    return w.wrong[found]
