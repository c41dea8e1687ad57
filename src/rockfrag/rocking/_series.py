"""Taylor series of a rocking motion over one step, and events found on them.

Time τ runs from 0 to 1 over a step of h seconds; ``ORDER + 1`` coefficients from place ``row`` of a flat array
``q`` stand for q(τ) = Σ q[row + k] τᵏ (a flat array and places in it, because a view of a row costs more than a
step).  The ground acceleration is linear over a step, so every coefficient
follows exactly from those before it (the Taylor series method: Moore 1966; Jorba and Zou 2005).
"""

import math

from rockfrag.rocking._compile import inlined_kernel, kernel
from rockfrag.rocking._intrinsics import fma

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
    """Find when the q at ``row``, which starts at zero or above and ends below, falls through zero."""
    return crossing(
        q[row],
        q[row + 1],
        q[row + 2],
        q[row + 3],
        q[row + 4],
        q[row + 5],
        q[row + 6],
        q[row + 7],
        1.0,
    )


@inlined_kernel
def crossing(q0, q1, q2, q3, q4, q5, q6, q7, end):
    """Find when Σ qₖ τᵏ falls through zero, given that it is negative at ``end``; 0 if it never was positive.

    It starts at zero or above.  Chebyshev's method from the root of the parabola that it begins as.  A q that dips
    below zero and comes back before is for ``closing_time``.
    """
    if q0 <= 0.0:
        # it leaves zero this instant: divide the root at τ = 0 out, and once more if it leaves without speed
        q0, q1, q2, q3, q4, q5, q6, q7 = q1, q2, q3, q4, q5, q6, q7, 0.0
        if q0 == 0.0:
            q0, q1, q2, q3, q4, q5, q6 = q1, q2, q3, q4, q5, q6, 0.0
        if q0 <= 0.0:
            return 0.0
    square = q1 * q1 - 4.0 * q2 * q0
    tau = 2.0 * q0 / (math.sqrt(square) - q1) if square > 0.0 else 0.5 * end
    d2, d3, d4, d5, d6, d7 = 2.0 * q2, 3.0 * q3, 4.0 * q4, 5.0 * q5, 6.0 * q6, 7.0 * q7
    for _ in range(6):
        # pairs of terms side by side, which is quicker than Horner's chain
        t2 = tau * tau
        t4 = t2 * t2
        f = fma(t2, fma(q3, tau, q2), fma(q1, tau, q0))
        f = fma(t4, fma(t2, fma(q7, tau, q6), fma(q5, tau, q4)), f)
        d = fma(t2, fma(d4, tau, d3), fma(d2, tau, q1))
        d = fma(t4, fma(t2, d7, fma(d6, tau, d5)), d)
        # Chebyshev's step: Newton's with the curve's bend
        per = 1.0 / d
        step = f * per
        step = fma(step * step * per, fma(d3, tau, q2), step)
        tau -= step
        # the error after this step is below its square
        if abs(step) <= 1e-7:
            break
    if 0.0 < tau <= end and abs(step) <= 1e-7:
        return tau
    return _bisected(q0, q1, q2, q3, q4, q5, q6, q7, end)


@kernel
def _bisected(q0, q1, q2, q3, q4, q5, q6, q7, end):
    """Find a root of Σ qₖ τᵏ, which is positive at 0 and negative at ``end``, by halving."""
    low = 0.0
    high = end
    for _ in range(60):
        tau = 0.5 * (low + high)
        f = q7
        for q in (q6, q5, q4, q3, q2, q1, q0):
            f = f * tau + q
        if f > 0.0:
            low = tau
        else:
            high = tau
    return high
