"""Taylor series of a rocking motion over one step, and events found on them.

Time τ runs from 0 to 1 over a step of h seconds; ``ORDER + 1`` coefficients from place ``row`` of a flat array
``q`` stand for q(τ) = Σ q[row + k] τᵏ (a flat array and places in it, because a view of a row costs more than a
step).  The ground acceleration is linear over a step, so every coefficient
follows exactly from those before it (the Taylor series method: Moore 1966; Jorba and Zou 2005).
"""

import math

from rockfrag.rocking._compile import kernel

ORDER = 7
"""Order of the series: with p h ≤ 0.1 the remainder is below 1e-13 rad."""


@kernel
def value(q, row, tau):
    """Evaluate q(τ)."""
    total = q[row + ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * tau + q[row + k]
    return total


@kernel
def slope(q, row, tau):
    """Evaluate dq/dτ."""
    total = ORDER * q[row + ORDER]
    for k in range(ORDER - 1, 0, -1):
        total = total * tau + k * q[row + k]
    return total


@kernel
def extend_circular(q, k, angle, sine, cosine):
    """Append coefficient ``k`` ≥ 1 of sin and cos of the series at ``angle``."""
    ds = 0.0
    dc = 0.0
    for j in range(k):
        rate = (k - j) * q[angle + k - j]
        ds += q[cosine + j] * rate
        dc += q[sine + j] * rate
    q[sine + k] = ds / k
    q[cosine + k] = -dc / k


@kernel
def extend_rotation(q, k, linear, angle, sine, cosine):
    """Append coefficient ``k`` of sin and cos, or of θ and 1 in the linearised equations."""
    if linear:
        q[sine + k] = q[angle + k]
        q[cosine + k] = 1.0 if k == 0 else 0.0
    elif k == 0:
        q[sine] = math.sin(q[angle])
        q[cosine] = math.cos(q[angle])
    else:
        extend_circular(q, k, angle, sine, cosine)


@kernel
def first_root(q, row, start, end):
    """Find where q falls through zero in (start, end], given q(end) < 0; -1.0 if it never was positive.

    Newton's method kept inside a bracket.
    """
    low = start
    if value(q, row, low) <= 0.0:
        return -1.0
    high = end
    tau = 0.5 * (low + high)
    for _ in range(200):
        f = value(q, row, tau)
        if f > 0.0:
            low = tau
        else:
            high = tau
        d = slope(q, row, tau)
        guess = tau - f / d if d != 0.0 else low
        if not (low < guess < high):
            guess = 0.5 * (low + high)
        if abs(guess - tau) <= 1e-15 or high - low <= 1e-15:
            return guess
        tau = guess
    return tau


@kernel
def lowest_point(q, row, start, end):
    """Find the minimum inside (start, end) of a q that falls at ``start`` and rises at ``end``."""
    low = start
    high = end
    for _ in range(60):
        tau = 0.5 * (low + high)
        if slope(q, row, tau) < 0.0:
            low = tau
        else:
            high = tau
        if high - low < 1e-12:
            break
    return 0.5 * (low + high)


PARTS = 8
"""Parts of a step that are searched one by one: a contact may close and be pulled open within one."""


@kernel
def closing_time(q, row, end):
    """Find when an open contact closes within (0, end]; 2.0 if it stays open.

    The series at ``row`` is the opening angle, positive while open; it may start from exactly zero (an
    opening).
    """
    least = q[row]
    for k in range(1, ORDER + 1):
        least += min(0.0, q[row + k])
    if least > 0.0:
        return 2.0
    before = 0.0
    if q[row] <= 0.0:
        # opened this instant: look behind the root at τ = 0
        before = 1e-3 * end
        while value(q, row, before) <= 0.0:
            before *= 0.1
            if before < 1e-13:
                return 0.0 if value(q, row, end) < 0.0 else 2.0
    falls = slope(q, row, before) < 0.0
    for part in range(1, PARTS + 1):
        after = end * part / PARTS
        if after <= before:
            continue
        if value(q, row, after) < 0.0:
            return first_root(q, row, before, after)
        rises = slope(q, row, after) > 0.0
        if falls and rises:
            low = lowest_point(q, row, before, after)
            if value(q, row, low) < 0.0:
                return first_root(q, row, before, low)
        falls = not rises
        before = after
    return 2.0


@kernel
def crossing_time(q, row):
    """Find when a q that starts at zero or above falls through zero, given q(1) < 0.

    Chebyshev's method inside a bracket, from the root of the parabola that q begins as.  A q that dips below
    zero and comes back before is for ``closing_time``.
    """
    q0 = max(0.0, q[row])
    q1, q2, q3, q4 = q[row + 1], q[row + 2], q[row + 3], q[row + 4]
    q5, q6, q7 = q[row + 5], q[row + 6], q[row + 7]
    square = q1 * q1 - 4.0 * q2 * q0
    tau = 0.5
    low = 0.0
    high = 1.0
    if q0 == 0.0:
        if q2 < 0.0 and 0.0 < -q1 / q2 < 1.0:
            tau = -q1 / q2
        # look behind the root at zero
        low = 1e-3 * tau
        while value(q, row, low) <= 0.0:
            low *= 0.1
            if low < 1e-13:
                return 0.0
    elif square > 0.0:
        tau = 2.0 * q0 / (math.sqrt(square) - q1)
    for _ in range(100):
        if not low < tau < high:
            tau = 0.5 * (low + high)
        # pairs of terms side by side, which is quicker than Horner's chain
        t2 = tau * tau
        t4 = t2 * t2
        f = (q0 + q1 * tau) + t2 * (q2 + q3 * tau) + t4 * ((q4 + q5 * tau) + t2 * (q6 + q7 * tau))
        d = (q1 + 2.0 * q2 * tau) + t2 * (3.0 * q3 + 4.0 * q4 * tau)
        d += t4 * ((5.0 * q5 + 6.0 * q6 * tau) + 7.0 * q7 * t2)
        if f > 0.0:
            low = tau
        else:
            high = tau
        # Chebyshev's step: Newton's with the curve's bend
        step = 2.0
        if d != 0.0:
            per = 1.0 / d
            step = f * per
            step += step * step * (q2 + 3.0 * q3 * tau) * per
        tau -= step
        # the error after this step is below its square
        if abs(step) <= 1e-7 or high - low <= 1e-15:
            break
    return min(max(tau, 0.0), 1.0)
