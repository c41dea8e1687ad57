"""Taylor series of a rocking motion over one step, and events found on them.

Time τ runs from 0 to 1 over a step of h seconds; a coefficient array ``q`` of length ``ORDER + 1``
stands for q(τ) = Σ q[k] τᵏ.  The ground acceleration is linear over a step, so every coefficient
follows exactly from those before it (the Taylor series method: Moore 1966; Jorba and Zou 2005).
"""

import math

from rockfrag.rocking._compile import kernel

ORDER = 7
"""Order of the series: with p h ≤ 0.1 the remainder is below 1e-13 rad."""


@kernel
def value(q, tau):
    """Evaluate q(τ)."""
    total = q[ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * tau + q[k]
    return total


@kernel
def slope(q, tau):
    """Evaluate dq/dτ."""
    total = ORDER * q[ORDER]
    for k in range(ORDER - 1, 0, -1):
        total = total * tau + k * q[k]
    return total


@kernel
def extend_circular(k, angle, sine, cosine):
    """Append coefficient ``k`` ≥ 1 of sin and cos of the series ``angle``."""
    ds = 0.0
    dc = 0.0
    for j in range(k):
        rate = (k - j) * angle[k - j]
        ds += cosine[j] * rate
        dc += sine[j] * rate
    sine[k] = ds / k
    cosine[k] = -dc / k


@kernel
def extend_rotation(k, linear, angle, sine, cosine):
    """Append coefficient ``k`` of sin and cos, or of θ and 1 in the linearised equations."""
    if linear:
        sine[k] = angle[k]
        cosine[k] = 1.0 if k == 0 else 0.0
    elif k == 0:
        sine[0] = math.sin(angle[0])
        cosine[0] = math.cos(angle[0])
    else:
        extend_circular(k, angle, sine, cosine)


@kernel
def first_root(q, start, end):
    """Find where q falls through zero in (start, end], given q(end) < 0; -1.0 if it never was positive.

    Newton's method kept inside a bracket.
    """
    low = start
    if value(q, low) <= 0.0:
        return -1.0
    high = end
    tau = 0.5 * (low + high)
    for _ in range(200):
        f = value(q, tau)
        if f > 0.0:
            low = tau
        else:
            high = tau
        d = slope(q, tau)
        guess = tau - f / d if d != 0.0 else low
        if not (low < guess < high):
            guess = 0.5 * (low + high)
        if abs(guess - tau) <= 1e-15 or high - low <= 1e-15:
            return guess
        tau = guess
    return tau


@kernel
def lowest_point(q, end):
    """Find the minimum inside (0, end) of a q that falls at 0 and rises at ``end``."""
    low = 0.0
    high = end
    for _ in range(60):
        tau = 0.5 * (low + high)
        if slope(q, tau) < 0.0:
            low = tau
        else:
            high = tau
        if high - low < 1e-12:
            break
    return 0.5 * (low + high)


@kernel
def closing_time(gap, end):
    """Find when an open contact closes within (0, end]; 2.0 if it stays open.

    ``gap`` is the opening angle, positive while open; it may start from exactly zero (an opening).
    """
    at_end = value(gap, end)
    if gap[0] <= 0.0:
        # opened this instant: divide the root at τ = 0 out, and look at what is left
        if at_end >= 0.0:
            return 2.0
        low = 1e-3 * end
        while value(gap, low) <= 0.0:
            low *= 0.1
            if low < 1e-13:
                return 0.0
        return first_root(gap, low, end)
    if at_end < 0.0:
        return first_root(gap, 0.0, end)
    if gap[1] < 0.0 and slope(gap, end) > 0.0:
        low = lowest_point(gap, end)
        if value(gap, low) < 0.0:
            return first_root(gap, 0.0, low)
    return 2.0
