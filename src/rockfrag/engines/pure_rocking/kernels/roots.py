"""Instants within a step: when a contact closes, when a closed one lets go, when a rotation turns.

Time τ runs from 0 to 1 over a step.  A series q stands for q(τ) = Σ q[k] τᵏ.

In: coefficients of series. Out: times in steps. Theory: ``docs/kernels.md``, "Series".
"""

import math

from rockfrag.engines.compile.jit import fma, inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.taylor import ORDER, rate_at, travel

NEVER = 2.0  # the time of what does not happen in a step

# --------------------------------------------------------------------------- values of a series


@inlined_kernel
def value(q, tau):
    """Evaluate q(τ)."""
    total = q[ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * tau + q[k]
    return total


@inlined_kernel
def slope(q, tau):
    """Evaluate dq/dτ."""
    total = ORDER * q[ORDER]
    for k in range(ORDER - 1, 0, -1):
        total = total * tau + k * q[k]
    return total


@inlined_kernel
def bend(q, tau):
    """Evaluate d²q/dτ²."""
    total = ORDER * (ORDER - 1) * q[ORDER]
    for k in range(ORDER - 1, 1, -1):
        total = total * tau + k * (k - 1) * q[k]
    return total


# --------------------------------------------------------------------------- may a contact have closed?


@inlined_kernel
def dips(gap, out, out_at_end):
    """Whether a contact that falls at the start of a step and rises at its end may have closed in between.

    ``gap`` is its opening angle [rad], ``out`` and ``out_at_end`` are the rates of that per step. The parabola
    through them has its least value gap - out²/(2 (out_at_end - out)); the half is left out, so that no closing is
    missed.
    """
    return (out < 0.0) & (out_at_end > 0.0) & (gap * (out_at_end - out) < out * out)


@inlined_kernel
def hops(gap, out, out_at_end, bend):
    """Whether a contact that rises at the start of a step, and still does at its end, may have closed in between.

    By its rate and acceleration at the start and its rate at the end the gap is gap + τ (out + bend τ/2 + c τ²/3).
    It can close only where that parabola has a negative minimum within the step, bend² > 16/3 out c and -3/4 bend
    < c. So that no closing is missed, 3.5 and 1/2 stand for 16/3 and 3/4.
    """
    c = out_at_end - out - bend
    return (
        (out >= 0.0)
        & (out_at_end > 0.0)
        & (gap + 0.5 * bend < 0.0)
        & (-0.5 * bend < c)
        & (bend * bend > 3.5 * out * c)
    )


# --------------------------------------------------------------------------- closing: a gap falls through zero


@inlined_kernel
def crossing(q, end):
    """Find the time τ [-] when Σ q_k τᵏ falls through zero, given that it is negative at the time ``end``.

    ``q`` has eight coefficients. The series starts at zero or above; returned is 0 if it never was positive.
    Chebyshev's method from the root of the parabola that it begins as.  A q that dips below zero and is above it
    again at ``end`` is for ``closing_time``.
    """
    q0, q1, q2, q3, q4, q5, q6, q7 = q
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
    step = 0.0
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
    return _halved((q0, q1, q2, q3, q4, q5, q6, q7), end)


@kernel
def _halved(q, end):
    """Find a root of Σ q_k τᵏ, which is positive at 0 and negative at the time ``end`` [-], by halving."""
    low = 0.0
    high = end
    for _ in range(60):
        tau = 0.5 * (low + high)
        f = ((q[7] * tau + q[6]) * tau + q[5]) * tau + q[4]
        f = (((f * tau + q[3]) * tau + q[2]) * tau + q[1]) * tau + q[0]
        if f > 0.0:
            low = tau
        else:
            high = tau
    return high


@kernel
def crossing_time(q):
    """Find the time in a step [-] at which a series that starts at zero or above, and ends below, is zero."""
    return crossing((q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7]), 1.0)


@kernel
def closing_time(q, end):
    """Find when an open contact closes within (0, end]; NEVER if it stays open.

    The series is the opening angle, positive while open; it may start from exactly zero (an opening).  Each eighth
    of the time is searched by itself: a contact may close and be pulled open within one step.
    """
    least = q[0]
    for k in range(1, ORDER + 1):
        least += min(0.0, q[k])
    if least > 0.0:
        return NEVER
    before = 0.0
    if q[0] <= 0.0:
        # opened this instant: look behind the root at τ = 0
        before = 1e-3 * end
        while value(q, before) <= 0.0:
            before *= 0.1
            if before < 1e-13:
                return 0.0 if value(q, end) < 0.0 else NEVER
    falls = slope(q, before) < 0.0
    for part in range(1, 9):
        after = end * part / 8
        if after <= before:
            continue
        if value(q, after) < 0.0:
            return _first_root(q, before, after)
        rises = slope(q, after) > 0.0
        if falls and rises:
            low = _lowest_point(q, before, after)
            if value(q, low) < 0.0:
                return _first_root(q, before, low)
        falls = not rises
        before = after
    return NEVER


@kernel
def _first_root(q, start, end):
    """Find by Newton's method the time at which q falls through zero in (start, end], given that q(end) < 0.

    A step that leaves the bracket is a halving. Returned is -1.0 if q is not positive at ``start``.
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
def _lowest_point(q, start, end):
    """Find the time of the minimum inside (start, end) of a q that falls at ``start`` and rises at ``end``."""
    low = start
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
def graze(gap, rates):
    """Time in a step [-] at which a lone block that comes down and leaves again within it touches; NEVER if not.

    ``gap`` is ψ less the critical angle as the step begins, negative while the block is off the ground; ``rates``
    are the Taylor coefficients of ψ' per step, positive at the start and negative at the end.
    """
    # the most that ψ can rise: positive coefficients alone
    most = gap + max(0.0, rates[0]) + max(0.0, 0.5 * rates[1]) + max(0.0, rates[2])
    most += max(0.0, rates[3])
    if most + max(0.0, rates[4]) + max(0.0, rates[5]) + max(0.0, rates[6]) < 0.0:
        # as nearly always: it turns back far from there
        return NEVER
    low = 0.0
    high = 1.0
    while high - low > 1e-9:
        t = 0.5 * (low + high)
        if rate_at(rates, t) > 0.0:
            low = t
        else:
            high = t
    if gap + travel(rates, low) < 0.0:
        return NEVER
    high = low
    low = 0.0
    while high - low > 1e-15:
        t = 0.5 * (low + high)
        if gap + travel(rates, t) < 0.0:
            low = t
        else:
            high = t
    return high


# --------------------------------------------------------------------------- letting go: a hold becomes negative


@inlined_kernel
def guess_between(bracket):
    """Next point of regula falsi in a bracket, off both of its ends.

    The hold of a contact, a function of the time, is what keeps it closed, negative where it would have to be
    pulled. A bracket is (low, hold at low, ≥ 0, high, hold at high, < 0, which end moved last: 1 low, -1 high, 0
    none).
    """
    low, at_low, high, at_high, _ = bracket
    tau = high - at_high * (high - low) / (at_high - at_low)
    return min(max(tau, low + 4e-14), high - 4e-14)


@inlined_kernel
def narrowed(bracket, tau, hold):
    """Return the bracket (:func:`guess_between`) narrowed to the side of τ on which the hold changes sign.

    The hold at an end that stays twice is halved (Illinois variant), so that both ends move.
    """
    low, at_low, high, at_high, moved = bracket
    if hold >= 0.0:
        return tau, hold, high, 0.5 * at_high if moved == 1 else at_high, 1
    return low, 0.5 * at_low if moved == -1 else at_low, tau, hold, -1


@inlined_kernel
def is_narrow(bracket):
    """Whether a bracket is at most 1e-13 of the step wide."""
    low, _, high, _, _ = bracket
    return high - low <= 1e-13


@inlined_kernel
def end_of(bracket):
    """Time of the end of a bracket [-], at which the contact has let go."""
    _, _, high, _, _ = bracket
    return high
