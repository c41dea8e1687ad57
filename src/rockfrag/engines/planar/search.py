"""Finding the mode in which touching contacts go on, after a contact event and in an impact (``docs/contact.md``).

A search starts from a mode, mends what it violates most, and goes on so until nothing is violated.  It is begun
from the mode that has just failed and from the one in which all is open; of two that are consistent the one with
fewer closed ends is taken.  Where neither ends, all modes are tried, the neighbours of those tried first.
"""

import math

from rockfrag.engines.kernels.jit import kernel
from rockfrag.engines.planar.solve import bias, eliminate, end_of, fill_row

# violation below which a mode is consistent: forces over the weight, accelerations over g [-].  Less than the
# slack of contact events, so that a mode that has just failed is not
CONSISTENT = 2e-13
UNSOLVED = 1e-6  # relative motion of a closed end where a mode was singular but for rounding [-]
ROUNDING = 1e-10  # violation up to which a mode is taken where none is consistent
FAILS, SEEN = -1, -2  # what a mode that is tried is, unless it is consistent
SLIP = 2  # what changes between modes: whether the end 0 or 1 is closed, or how an interface slides


@kernel
def weigh(p, w, ah, av, impact):
    """Fill what forces at the touching ends do to each other, which is the same in all modes."""
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            x, y, tx, ty, _, _, kind = end_of(p, w, w.q, k, end, w.kind[k, end])
            for turn in range(2):
                dx, dy = (-ty, tx) if turn == 0 else (tx, ty)
                row = 4 * k + 2 * end + turn
                fill_row(w.q, k, x, y, dx, dy, w.arm[row])
                total = 0.0 if impact else bias(w.q, w.v, k, x, y, dx, dy, kind)
                for part in range(0 if k > 0 else 1, 2):
                    at = 3 * (k - 1 + part)
                    if impact:
                        total += (
                            w.arm[row, 3 * part] * w.v[at] + w.arm[row, 3 * part + 1] * w.v[at + 1]
                        )
                        total += w.arm[row, 3 * part + 2] * w.v[at + 2]
                    else:
                        total -= w.arm[row, 3 * part] * ah + w.arm[row, 3 * part + 1] * (p.g + av)
                w.free[row] = total
    for k in range(p.count):
        for row in range(4 * k, 4 * k + 4):
            if w.touching[k, (row // 2) % 2] == 0:
                continue
            for other in range(max(0, 4 * k - 4), row + 1):
                below = other // 4
                if w.touching[below, (other // 2) % 2] == 0:
                    continue
                total = 0.0
                if below == k:
                    for d in range(0 if k > 0 else 3, 6):
                        total += w.arm[row, d] * p.inverse[3 * k - 3 + d] * w.arm[other, d]
                else:
                    for d in range(3):
                        total += w.arm[row, d] * p.inverse[3 * k - 3 + d] * w.arm[other, d + 3]
                w.give[row, other - 4 * k + 4] = total
                w.give[other, row - 4 * below + 4] = total


@kernel
def _gives(p, w, row, unknown):
    """What a unit of an unknown force gives along a row."""
    k = row // 4
    at = w.along[unknown]
    if at < 0:
        return _turns(p, w, row, -1 - at)
    near = at - 4 * k + 4
    if w.rub[unknown] == 0.0:
        found = w.give[row, near]
    else:
        found = w.give[row, near] + w.rub[unknown] * w.give[row, near + 1]
    owner, end = at // 4, (at // 2) % 2
    if at % 2 == 0 and w.fraction[owner, end] > 0.0:
        # the other end's normal and tangent: two places on, or back
        far = near + 2 - 4 * end
        more = w.give[row, far] + w.rub[unknown] * w.give[row, far + 1]
        found += w.fraction[owner, end] * more
    return found


@kernel
def _turns(p, w, row, k):
    """What a unit couple between body k and what is below it gives along a row."""
    above = row // 4
    total = 0.0
    if above == k:
        total += w.arm[row, 5] * p.inverse[3 * k + 2]
        if k > 0:
            total -= w.arm[row, 2] * p.inverse[3 * k - 1]
    elif above == k + 1:
        total += w.arm[row, 2] * p.inverse[3 * k + 2]
    elif above == k - 1:
        total -= w.arm[row, 5] * p.inverse[3 * k - 1]
    return total


@kernel
def _list_unknowns(p, w):
    """List the unknown forces of the mode in ``w``; their number."""
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
        if w.drive[k] >= 0:
            w.along[m] = -1 - k
            w.rub[m] = 0.0
            m += 1
        w.upto[k] = m
    return m


@kernel
def _solve_mode(p, w):
    """Solve for the forces of the mode in ``w``, into ``w.right``; their number, -1 if there are none."""
    m = _list_unknowns(p, w)
    for i in range(m):
        # row of the condition that the force keeps
        row = w.along[i]
        if row < 0:
            row = 4 * (-1 - w.along[i]) + 2 * w.drive[-1 - w.along[i]]
        k = row // 4
        high = w.upto[k + 2] if k + 2 < p.count else m
        begin = w.upto[k - 2] if k > 1 else 0
        end = w.upto[k + 1] if k + 1 < p.count else m
        for j in range(begin, end):
            w.matrix[i, j] = _gives(p, w, row, j)
        for j in range(end, high):
            w.matrix[i, j] = 0.0
        w.right[i] = -w.free[row]
        if w.along[i] < 0:
            w.right[i] += w.depart[k]
    return m if eliminate(p, w, m, 0) else -1


@kernel
def _motion_along(p, w, row, m):
    """Relative motion along a row under the forces in ``w.right``."""
    k = row // 4
    total = w.free[row]
    low = w.upto[k - 2] if k > 1 else 0
    high = w.upto[k + 1] if k + 1 < p.count else m
    for j in range(low, high):
        total += _gives(p, w, row, j) * w.right[j]
    return total


@kernel
def _note_worst(w, worst, margin, k, what, way):
    """Least margin so far; remember what would mend it."""
    if margin < worst:
        w.flip[0], w.flip[1], w.flip[2] = k, what, way
        return margin
    return worst


@kernel
def try_mode(p, w, impact, force, motion):
    """Least margin of the mode in ``w``, negative if inconsistent, after ``weigh``; ``w.flip`` mends it."""
    w.flip[0] = -1
    m = _solve_mode(p, w)
    if m < 0:
        return -math.inf
    worst = math.inf
    at = 0
    for k in range(p.count):
        pressed, shear = 0.0, 0.0
        slides = w.slides[k]
        closed = -1
        for end in range(2):
            if w.touching[k, end] == 0:
                continue
            apart = _motion_along(p, w, 4 * k + 2 * end, m)
            if w.closed[k, end] == 0:
                if w.drive[k] != end:
                    worst = _note_worst(w, worst, apart / motion, k, end, 1)
                continue
            if not abs(apart) < UNSOLVED * motion:
                w.flip[0] = -1
                return -math.inf
            # a force that friction multiplies counts as the shear that it brings about
            push = w.right[at] * (max(1.0, p.kinetic[k]) if slides != 0 else 1.0)
            worst = _note_worst(w, worst, push / force, k, end, 0)
            pressed += w.right[at] * (1.0 + w.fraction[k, end])
            at += 1
            if closed < 0:
                closed = end
                if slides == 0:
                    shear = w.right[at]
                    at += 1
        if w.drive[k] >= 0:
            at += 1
            if closed < 0:
                return -math.inf
        if closed < 0:
            continue
        if slides == 0:
            margin = (w.limit[k] * pressed - abs(shear)) / max(w.limit[k], 1.0)
            worst = _note_worst(w, worst, margin / force, k, SLIP, -1 if shear > 0.0 else 1)
        elif impact or w.moves[k] == 0:
            speed = _motion_along(p, w, 4 * k + 2 * closed + 1, m)
            worst = _note_worst(w, worst, slides * speed / motion, k, SLIP, 0)
    return worst


@kernel
def change(w, k, what, way, impact):
    """Change one thing of the mode in ``w``."""
    if what == SLIP:
        w.slides[k] = way
        return
    was_open = w.closed[k, 0] == 0 and w.closed[k, 1] == 0
    w.closed[k, what] = 1 - w.closed[k, what]
    if was_open:
        w.slides[k] = 0 if impact else w.moves[k]
    elif w.closed[k, 0] == 0 and w.closed[k, 1] == 0:
        w.slides[k] = 0


@kernel
def mode_number(p, closed, slides):
    """Mode as one number: for each interface its closed ends (bits) and 4 × (slip + 1)."""
    number = 0
    for k in range(p.count):
        number += (closed[k, 0] + 2 * closed[k, 1] + 4 * (slides[k] + 1)) << (4 * k)
    return number


@kernel
def take_number(p, w, number):
    """Set the contact modes in the working memory ``w`` to those of a number, a digit a contact."""
    for k in range(p.count):
        digit = (number >> (4 * k)) & 15
        w.closed[k, 0] = digit & 1
        w.closed[k, 1] = (digit >> 1) & 1
        w.slides[k] = (digit >> 2) - 1


@kernel
def _closed_ends(p, number):
    """Number of closed ends of a mode."""
    total = 0
    for k in range(p.count):
        digit = (number >> (4 * k)) & 3
        total += (digit & 1) + (digit >> 1)
    return total


@kernel
def _place_of(w, number):
    """Place of a mode in the list of those that have been tried, -1 if it is not there."""
    for i in range(w.count):
        if w.tried[i] == number:
            return i
    return -1


@kernel
def _try_anew(p, w, impact, force, motion, exclude):
    """Try the mode in ``w`` and list it; its number if it is consistent, FAILS, or SEEN if it was tried before.

    ``exclude``: number of a mode that is known to fail.  A full list takes no more.
    """
    number = mode_number(p, w.closed, w.slides)
    if w.count == w.tried.size or _place_of(w, number) >= 0:
        return SEEN
    margin = try_mode(p, w, impact, force, motion)
    w.tried[w.count] = number
    w.wrong[w.count] = math.inf if number == exclude else max(0.0, -margin)
    w.count += 1
    return number if margin >= -CONSISTENT and number != exclude else FAILS


@kernel
def _descend(p, w, impact, force, motion, exclude):
    """Mend the worst of the mode in ``w`` until none is left, its number, or a mode comes back."""
    found = _try_anew(p, w, impact, force, motion, exclude)
    while found == FAILS and w.flip[0] >= 0:
        change(w, w.flip[0], w.flip[1], w.flip[2], impact)
        found = _try_anew(p, w, impact, force, motion, exclude)
    return found


@kernel
def _try_neighbours(p, w, impact, force, motion, exclude):
    """Try all that differs in one thing from what has been tried, and so on; as :func:`_descend`."""
    at = 0
    while at < w.count:
        for k in range(p.count):
            for what in range(5):
                take_number(p, w, w.tried[at])
                if what < SLIP:
                    if w.touching[k, what] == 0 or w.drive[k] >= 0:
                        continue
                    change(w, k, what, 0, impact)
                else:
                    if w.closed[k, 0] == 0 and w.closed[k, 1] == 0:
                        continue
                    if not impact and w.moves[k] != 0 and what - 3 != w.moves[k]:
                        continue
                    w.slides[k] = what - 3
                found = _try_anew(p, w, impact, force, motion, exclude)
                if found >= 0:
                    return found
        at += 1
    return FAILS


@kernel
def _least_wrong(w):
    """Place in the list of the mode that is least violated."""
    best = 0
    for i in range(1, w.count):
        if w.wrong[i] < w.wrong[best]:
            best = i
    return best


@kernel
def _only_touching(p, w):
    """Open what does not touch, and let what touches slide as it moves."""
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 0:
                w.closed[k, end] = 0
        if w.closed[k, 0] == 0 and w.closed[k, 1] == 0:
            w.slides[k] = 0


@kernel
def _try_slips(p, w, impact, force, motion, found):
    """Try the other ways to slide of a consistent mode; the one to take, and whether more were consistent."""
    several = False
    for k in range(p.count):
        taken = (found >> (4 * k)) & 15
        old = w.old_closed[k, 0] + 2 * w.old_closed[k, 1] + 4 * (w.old_slides[k] + 1)
        if taken & 3 == 0 or taken == old or (not impact and w.moves[k] != 0):
            continue
        for way in range(-1, 2):
            take_number(p, w, found)
            if way == w.slides[k]:
                continue
            w.slides[k] = way
            other = _try_anew(p, w, impact, force, motion, -1)
            several = several or other >= 0
            if other >= 0 and way == 0:
                found = other
    return found, several


@kernel
def _set_all(p, w, closed):
    """Open all ends, or close and let stick all that touch, but for what a given speed of an end needs."""
    for k in range(p.count):
        w.slides[k] = 0
        for end in range(2):
            w.closed[k, end] = closed * w.touching[k, end]
        if closed == 1 and w.touching[k, 0] + w.touching[k, 1] > 0:
            w.slides[k] = w.moves[k]
        if w.drive[k] >= 0:
            w.closed[k, w.drive[k]] = 0
            w.closed[k, 1 - w.drive[k]] = 1


@kernel
def search(p, w, ah, av, impact, force, motion, exclude):
    """Set the mode of ``w`` to a consistent one that its touching ends allow, or the least violated; by how much.

    The mode in ``w`` is where the search starts.  ``w.moves``: signs of slip that are given.  ``exclude``: number
    of a mode that has just failed, -1 for none.
    """
    weigh(p, w, ah, av, impact)
    _only_touching(p, w)
    if not impact:
        for k in range(p.count):
            if w.moves[k] != 0 and w.closed[k, 0] + w.closed[k, 1] > 0:
                w.slides[k] = w.moves[k]
    w.count, found, several = 0, -1, False
    for start in range(3):
        if start > 0:
            _set_all(p, w, start - 1)
        other = _descend(p, w, impact, force, motion, exclude)
        if other >= 0:
            several = several or found >= 0
            if found < 0 or _closed_ends(p, other) < _closed_ends(p, found):
                found = other
    if found >= 0:
        found, more = _try_slips(p, w, impact, force, motion, found)
        several = several or more
    if several:
        w.told.several_modes += 1
    if found < 0 and w.wrong[_least_wrong(w)] > ROUNDING:
        found = _try_neighbours(p, w, impact, force, motion, exclude)
    if found < 0:
        found = w.tried[_least_wrong(w)]
    take_number(p, w, found)
    return w.wrong[_place_of(w, found)]
