"""The lone block, many cases side by side.

Each lane carries one case; one pass of the vector loop advances every lane by one sample with the same
straight-line arithmetic, and what is rare (impacts, rest, verdicts, the next case) is handled lane by lane
between passes.  A case's numbers depend on that case alone, so neither the number of lanes nor their
neighbours nor the threads change a bit of them.

With ψ = θc - |θ| and A the ground acceleration over g, positive where it pushes the block back down, the
equation of motion on either pole is ψ'' = p² (sin ψ + A cos ψ) (thesis eq. 2.4).  Time is counted in samples.
"""

import math

import numba
import numpy as np

from rockfrag.rocking._compile import entry_kernel, inlined_kernel, kernel
from rockfrag.rocking._intrinsics import lowest_bit, take_next
from rockfrag.rocking._passes import QUIET, next_samples
from rockfrag.rocking._pendulum import HALF_TURN, hops, rate, rates, sine_cosine, travel
from rockfrag.rocking._rest import BLOCK, uplift
from rockfrag.rocking._series import crossing

LANES = 32
# Columns of the body table, for the right pole and, POLE further on, for the left: critical angle, its
# tangent, sine and cosine, p² dt², the ratio e of angular velocities of an impact that ends rocking on it,
# 1/θc and 1/(p² dt² θc²).
ALPHA, TAN, SIN, COS, SWING, E_FROM, PER_ALPHA, PER_SWING = range(8)
POLE = 8
BODY = 2 * POLE


@numba.njit(inline="always")
def _at(side):
    """Where the columns of a pole begin."""
    return 0 if side > 0 else POLE


# Columns of the results: verdict; sample at which it was certain; largest θ/θc; largest |θ'| per sample;
# number of impacts; least distance from the unstable equilibrium.
OVERTURNED, CERTAIN, RATIO, SPEED, IMPACTS, CLOSEST = range(6)
RESULTS = 6

MAX_IMPACTS_PER_SAMPLE = 400


# Rows of the lanes, in one flat array so that the compiler sees that rows do not overlap.
(
    PSI,  # the state
    RATE,
    A0,  # A now and at the end of the sample
    A1,
    REST_OF,  # the part of the sample that is left
    LOW,  # extremes of the case so far: ψ/θc, ψ', distance from balance squared
    FAST,
    NEAR,
    WAS_PSI,  # these where the step began
    WAS_RATE,
    WAS_REST_OF,
    WAS_LOW,
    WAS_FAST,
    WAS_NEAR,
    ANGLE,
    KAPPA,
    BOUND,  # the most that A can be from here on, and √(1 + bound²)
    CREST,
    FLAG,
    W1,  # Taylor coefficients of ψ'
    W2,
    W3,
    W4,
    W5,
    W6,
    PER_ANGLE,  # 1/θc and 1/(κ θc²)
    PER_SPEED,
    FACTOR,  # scale of the motion over g, and that times the side of the pole
    SIGNED,
    TAU,  # time since sample K, between events
) = (LANES * row for row in range(30))
ROWS = 30

# Rows of the lanes' integers.
(
    CASE,  # -1 for none
    K,  # the sample it has reached, its motion's last one and first
    END,
    START,
    SIDE,  # 1 on the right pole, -1 on the left, 0 at rest
    BASE,  # place of its body in the table
    FELL,
    CROWDED,  # the sample of the last impact, and how many it has had
    CROWD,
) = (LANES * row for row in range(9))
INTEGERS = 9

TOUCHES, CERTAIN_FALL = 1.0, 2.0


@kernel
def advance(x):
    """Advance every lane to the end of its sample, and flag those with an event in between.

    Everything is stored in every lane: conditional stores cost many times as much.

    A fall is certain, whatever the ground does, in this case.  Let tan φ = ``BOUND``, the most that A can
    be in the rest of the motion.  ψ'' ≤ κ (sin ψ + tan φ cos ψ) = κ sin(ψ + φ) / cos φ, whose right side
    grows with ψ: a block that the constant A = tan φ cannot bring back is brought back by no smaller A.
    With ψ' < 0 that pendulum passes its upper equilibrium ψ = -φ if ψ'²/2 ≥ κ (1 - cos(ψ + φ)) / cos φ.
    """
    for i in range(LANES):
        psi = x[PSI + i]
        speed = x[RATE + i]
        left = x[REST_OF + i]
        kappa = x[KAPPA + i]
        angle = x[ANGLE + i]
        a = x[A0 + i]
        a_end = x[A1 + i]
        w = speed * left
        s, c = sine_cosine(psi)
        w1, w2, w3, w4, w5, w6 = rates(s, c, w, kappa * left * left, a, a_end - a)
        p = psi + travel(w, w1, w2, w3, w4, w5, w6, 1.0)
        v = rate(w, w1, w2, w3, w4, w5, w6, 1.0)
        x[W1 + i], x[W2 + i], x[W3 + i], x[W4 + i], x[W5 + i], x[W6 + i] = w1, w2, w3, w4, w5, w6
        certain = (w < 0.0) & (0.5 * speed * speed >= kappa * (x[CREST + i] - c + x[BOUND + i] * s))
        grazes = (w > 0.0) & (v < 0.0)
        touches = p >= angle
        lies = p <= angle - HALF_TURN
        # leaves, and may fall back and be pulled open again before the sample is over
        falls_back = hops(angle - psi, -w, -v, -w1)
        flag = TOUCHES if touches | grazes | lies | falls_back else QUIET
        flag = CERTAIN_FALL if certain else flag
        x[FLAG + i] = flag
        # the turning point of a parabola lies between the samples
        turn = psi + 0.5 * w * w / min(w - v, -1e-300)
        low = (turn if (w < 0.0) & (v > 0.0) else p) * x[PER_ANGLE + i]
        v = v / left
        near = low * low + v * v * x[PER_SPEED + i]
        was_low, was_fast, was_near = x[LOW + i], x[FAST + i], x[NEAR + i]
        x[WAS_LOW + i], x[WAS_FAST + i], x[WAS_NEAR + i] = was_low, was_fast, was_near
        x[LOW + i] = min(was_low, low)
        x[FAST + i] = max(was_fast, abs(v))
        x[NEAR + i] = min(was_near, near)
        x[WAS_PSI + i], x[WAS_RATE + i], x[WAS_REST_OF + i] = psi, speed, left
        x[PSI + i] = p
        x[RATE + i] = v
        x[A0 + i] = a_end
        x[REST_OF + i] = 1.0


@inlined_kernel
def _flight(gap, w, w1, w2, w3, w4, w5, w6, end):
    """Time at which ψ reaches the angle of impact, ``gap`` below it, passed by the time ``end``; 2 if it stays."""
    t = crossing(
        -gap, -w, -0.5 * w1, -1 / 3 * w2, -0.25 * w3, -0.2 * w4, -1 / 6 * w5, -1 / 7 * w6, end
    )
    return 2.0 if gap >= 0.0 and t == 0.0 else t


@kernel
def _graze(gap, w, w1, w2, w3, w4, w5, w6):
    """Time of impact of a ψ that rises and falls again within a step; 2 if it stays clear."""
    most = gap + max(0.0, w) + max(0.0, 0.5 * w1) + max(0.0, w2) + max(0.0, w3)
    if most + max(0.0, w4) + max(0.0, w5) + max(0.0, w6) < 0.0:
        # as nearly always: it turns back far from there
        return 2.0
    low = 0.0
    high = 1.0
    while high - low > 1e-9:
        t = 0.5 * (low + high)
        if rate(w, w1, w2, w3, w4, w5, w6, t) > 0.0:
            low = t
        else:
            high = t
    if gap + travel(w, w1, w2, w3, w4, w5, w6, low) < 0.0:
        return 2.0
    high = low
    low = 0.0
    while high - low > 1e-15:
        t = 0.5 * (low + high)
        if gap + travel(w, w1, w2, w3, w4, w5, w6, t) < 0.0:
            low = t
        else:
            high = t
    return high


@inlined_kernel
def _dies_out(w, side, k, tau, end, factor, samples, b, o):
    """Whether the impacts after a launch at speed ``w`` end before anything else can happen.

    With restoring accelerations of at least κ D and κ' D' on the two poles a flight lasts 2 w / (κ D) at
    most and each impact leaves e of the speed, so all flights together last 2 w (1/κD + e/κ'D')/(1 - e e').
    If the ground stays below the threshold of rocking that long, the block is at rest afterwards,
    exactly, however the flights went; w² ≤ 0.04 κ D² keeps D within 2 % over a flight.
    """
    here = _at(side)
    there = POLE - here
    kappa = b[o + here + SWING]
    a = factor * samples[k]
    a += tau * (factor * samples[k + 1] - a)
    s, c = b[o + here + SIN], side * b[o + here + COS]
    s_there, c_there = b[o + there + SIN], side * b[o + there + COS]
    d = s + a * c
    d_there = s_there - a * c_there
    loss = 1.0 - b[o + here + E_FROM] * b[o + there + E_FROM]
    if loss <= 0.0:
        return False
    flight = 2.06 * w / (kappa * loss)
    back = b[o + here + E_FROM] * kappa / b[o + there + SWING]
    most = a
    least = a
    for ahead in range(1, 33):
        # flight × (1/D + e κ/κ' 1/D') with the least D and D' so far
        d = s + (least if c > 0.0 else most) * c
        d_there = s_there - (most if c > 0.0 else least) * c_there
        if d <= 0.0 or d_there <= 0.0 or w * w > 0.04 * kappa * d * d:
            return False
        time = flight * (d_there + back * d)
        if ahead > 1 and time <= (ahead - 1 - tau) * d * d_there:
            return True
        if time > (32.0 - tau) * d * d_there:
            return False
        a = factor * samples[k + ahead] if k + ahead <= end else 0.0
        most = max(most, a)
        least = min(least, a)
    return False


@inlined_kernel
def _event(x, i, tally, r):
    """Time of the next impact in the lane's step, or 2; ψ and ψ' then or at the end; whether it never left.

    What the response reaches on the way goes into the tally.
    """
    psi = x[WAS_PSI + i]
    left = x[WAS_REST_OF + i]
    angle = x[ANGLE + i]
    kappa = x[KAPPA + i]
    w = x[WAS_RATE + i] * left
    w1, w2, w3, w4, w5, w6 = (
        x[W1 + i], x[W2 + i], x[W3 + i], x[W4 + i], x[W5 + i], x[W6 + i],
    )  # fmt: skip
    gap = psi - angle
    p, v = x[PSI + i], x[RATE + i]
    t = 2.0
    if p >= angle:
        t = _flight(gap, w, w1, w2, w3, w4, w5, w6, 1.0)
        if t > 1.0:
            return t, p, v, True
    elif w > 0.0 and v < 0.0:
        t = _graze(gap, w, w1, w2, w3, w4, w5, w6)
    elif w <= 0.0 and v < 0.0 and min(gap, 0.0) + 0.5 * w1 >= 0.0:
        # may fall back within the step and be pulled open again before its end
        for part in range(1, 8):
            if min(gap, 0.0) + travel(w, w1, w2, w3, w4, w5, w6, part / 8) >= 0.0:
                t = _flight(gap, w, w1, w2, w3, w4, w5, w6, part / 8)
                break
    if t > 1.0:
        _note(tally, r, p, v, angle, kappa)
        if w < 0.0 and v > 0.0:
            low = psi + travel(w, w1, w2, w3, w4, w5, w6, w / (w - v * left))
            _note(tally, r, low, 0.0, angle, kappa)
        return t, p, v, False
    v = max(0.0, rate(w, w1, w2, w3, w4, w5, w6, t)) / left
    if gap >= 0.0:
        # the highest point of a flight that begins and ends in this step
        low = psi + travel(w, w1, w2, w3, w4, w5, w6, 0.5 * t)
        _note(tally, r, low, v, angle, kappa)
    tally[r + SPEED] = max(tally[r + SPEED], v)
    return t, angle, v, False


@inlined_kernel
def _note(tally, r, psi, w, angle, kappa):
    """Keep the largest rotation and speed and the closest approach to balance."""
    tally[r + RATIO] = max(tally[r + RATIO], 1.0 - psi / angle)
    tally[r + SPEED] = max(tally[r + SPEED], abs(w))
    if abs(psi) < tally[r + CLOSEST] * angle:
        tally[r + CLOSEST] = min(tally[r + CLOSEST], math.sqrt(psi * psi + w * w / kappa) / angle)


@kernel
def _left_alone(psi, w, side, b, o, tally, r):
    """Whether the block falls once the ground is still; every speed follows from energy."""
    for _ in range(64):
        if side == 0:
            return False
        angle = b[o + _at(side) + ALPHA]
        kappa = b[o + _at(side) + SWING]
        energy = 0.5 * w * w + kappa * math.cos(psi)
        if (psi > 0.0 and w <= 0.0) or psi <= 0.0:
            if psi > 0.0 and energy < kappa:
                _note(tally, r, math.acos(energy / kappa), 0.0, angle, kappa)
            elif psi > 0.0 or w <= 0.0 or energy < kappa:
                _note(tally, r, 0.0, math.sqrt(2.0 * abs(energy - kappa)), angle, kappa)
                return True
        v = math.sqrt(max(0.0, 2.0 * (energy - kappa * math.cos(angle))))
        tally[r + SPEED] = max(tally[r + SPEED], v)
        w = -v * (b[o + _at(side) + E_FROM])
        side = -side
        psi = b[o + _at(side) + ALPHA]
        kappa = b[o + _at(side) + SWING]
        other = b[o + POLE - _at(side) + SWING]
        other_angle = b[o + POLE - _at(side) + ALPHA]
        if 0.5 * w * w < kappa * (1.0 - math.cos(psi)) and 0.5 * w * w < other * (
            1.0 - math.cos(other_angle)
        ):
            _note(tally, r, math.acos(0.5 * w * w / kappa + math.cos(psi)), 0.0, psi, kappa)
            return False
    return False


def working_arrays():
    """Arrays that a thread works in: rows of the lanes, of numbers and of integers, and results of their cases."""
    return np.zeros(ROWS * LANES), np.zeros(INTEGERS * LANES, np.int64), np.zeros(RESULTS * LANES)


@entry_kernel
def lone_blocks(
    counter, count, table, factors, rows, offsets, lasts, samples, highest, lowest, ahead_high, ahead_low,
    results, x, n, tally,
):  # fmt: skip
    """March cases of bodies × motions × scales, the scale running fastest, until none is left.

    Parameters
    ----------
    counter : (1,) the next case to take, shared by all threads
    count : number of cases
    table : (bodies × motions × BODY,)
    factors : (motions, scales) scale over g, for samples in m/s²
    rows : (bodies, motions) which of the sampled motions to use
    offsets : (sampled motions + 1,) where each begins; each ends with a sample of zero
    lasts : (sampled motions,) its last sample
    samples : all sampled motions end to end [m/s²]
    highest, lowest : extremes of each BLOCK of ``samples``
    ahead_high, ahead_low : largest and smallest sample from here to the end of the motion
    results : (count × RESULTS,)
    x, n, tally : ``working_arrays``; what two threads wrote side by side would cost them time

    Returns
    -------
    Number of steps that lanes were advanced by, alone in a tuple.
    """
    busy = 0
    for i in range(LANES):
        n[CASE + i] = -1
        _carry_on(
            i, x, n, counter, count, table, factors, rows, offsets, lasts, samples, highest, lowest, tally,
            results,
        )  # fmt: skip
        _place(i, x, n, table, samples, ahead_high, ahead_low)
        if n[CASE + i] >= 0:
            busy += 1
    passes = 0
    while busy > 0:
        passes += 1
        advance(x)
        stops = _next_samples(x, n, samples)
        while stops != 0:
            i = lowest_bit(stops)
            stops &= stops - 1
            if n[CASE + i] < 0:
                continue
            if x[FLAG + i] == CERTAIN_FALL:
                _fall(i, x, n, tally)
            elif x[FLAG + i] != QUIET:
                _take_event(i, x, n, table, samples, tally)
            else:
                x[TAU + i] = 0.0
            if n[FELL + i] != 0 or n[SIDE + i] == 0 or n[K + i] >= n[END + i]:
                _carry_on(
                    i, x, n, counter, count, table, factors, rows, offsets, lasts, samples, highest, lowest,
                    tally, results,
                )  # fmt: skip
                if n[CASE + i] < 0:
                    busy -= 1
            _place(i, x, n, table, samples, ahead_high, ahead_low)
    return (passes * LANES,)


@inlined_kernel
def _next_samples(x, n, samples):
    return next_samples(x, n, FLAG, SIGNED, A1, K, END, LANES, samples)


@inlined_kernel
def _fall(i, x, n, tally):
    """Take note of a certain fall, which passes balance at the latest at the speed that energy leaves it."""
    r = RESULTS * i
    _restore_extremes(i, x)
    psi, w = x[WAS_PSI + i], x[WAS_RATE + i]
    near = w * w / x[KAPPA + i]
    if psi > 0.0:
        near -= 2.0 * (1.0 - math.cos(psi))
    else:
        near += psi * psi
    near = math.sqrt(max(0.0, near)) / x[ANGLE + i]
    tally[r + CLOSEST] = min(tally[r + CLOSEST], near)
    n[FELL + i] = 1


@inlined_kernel
def _restore_extremes(i, x):
    """Forget what the step of a lane would have reached without its event."""
    x[LOW + i], x[FAST + i], x[NEAR + i] = x[WAS_LOW + i], x[WAS_FAST + i], x[WAS_NEAR + i]


@inlined_kernel
def _take_event(i, x, n, b, samples, tally):
    """Take a lane through the impact in its step, or to the step's end if there is none."""
    r = RESULTS * i
    o, k, side = n[BASE + i], n[K + i], n[SIDE + i]
    _restore_extremes(i, x)
    t, psi, w, stays = _event(x, i, tally, r)
    tau = 1.0
    if stays:
        side = 0
    elif t > 1.0:
        if psi <= x[ANGLE + i] - HALF_TURN:
            n[FELL + i] = 1
    else:
        tau -= x[WAS_REST_OF + i] * (1.0 - t)
        tally[r + IMPACTS] += 1.0
        if n[CROWDED + i] != k:
            n[CROWDED + i] = k
            n[CROWD + i] = 0
        n[CROWD + i] += 1
        w = -w * b[o + _at(side) + E_FROM]
        side = -side
        psi = b[o + _at(side) + ALPHA]
        still = w > -1e-12 or n[CROWD + i] > MAX_IMPACTS_PER_SAMPLE
        if still or _dies_out(-w, side, k, tau, n[END + i], x[FACTOR + i], samples, b, o):
            side = 0
    if tau >= 1.0 - 1e-13:
        n[K + i] = k + 1
        tau = 0.0
    n[SIDE + i] = side
    x[PSI + i], x[RATE + i], x[TAU + i] = psi, w, tau


@kernel
def _carry_on(
    i, x, n, counter, count, b, factors, rows, offsets, lasts, samples, highest, lowest, tally, results
):  # fmt: skip
    """Take a lane through rest and the ends of motions, and through as many cases as end there."""
    n_motions, n_scales = factors.shape
    r = RESULTS * i
    while True:
        case, o = n[CASE + i], n[BASE + i]
        if case >= 0:
            k, end, factor = n[K + i], n[END + i], x[FACTOR + i]
            if n[FELL + i] == 0 and n[SIDE + i] == 0 and k < end and factor != 0.0:
                k, tau, now = uplift(
                    k, x[TAU + i], -b[o + TAN], b[o + POLE + TAN], factor, samples, highest, lowest, end
                )  # fmt: skip
                if k >= 0:
                    # the ground pushes the block over the other way
                    side = -1 if now > 0.0 else 1
                    n[K + i], x[TAU + i], n[SIDE + i] = k, tau, side
                    x[PSI + i], x[RATE + i] = b[o + _at(side) + ALPHA], 0.0
            if n[FELL + i] == 0 and n[SIDE + i] != 0:
                if n[K + i] < end:
                    return
                if _left_alone(x[PSI + i], x[RATE + i], n[SIDE + i], b, o, tally, r):
                    n[FELL + i] = 1
            if n[FELL + i] != 0:
                tally[r + OVERTURNED] = 1.0
                tally[r + CERTAIN] = n[K + i] - n[START + i]
            _take_over(x, i, tally, r)
            for m in range(RESULTS):
                results[RESULTS * case + m] = tally[r + m]
        case = take_next(counter)
        if case >= count:
            n[CASE + i] = -1
            return
        motion = (case // n_scales) % n_motions
        n[CASE + i] = case
        n[BASE + i] = BODY * (case // n_scales)
        for m in range(RESULTS):
            tally[r + m] = 0.0
        tally[r + CLOSEST] = math.inf
        x[LOW + i], x[FAST + i], x[NEAR + i] = 1.0, 0.0, math.inf
        x[FACTOR + i] = factors[motion, case % n_scales]
        x[TAU + i] = 0.0
        sampled = rows[case // (n_scales * n_motions), motion]
        n[START + i] = offsets[sampled]
        n[K + i] = offsets[sampled]
        n[END + i] = lasts[sampled]
        n[SIDE + i], n[FELL + i], n[CROWDED + i] = 0, 0, -1


@inlined_kernel
def _place(i, x, n, b, samples, ahead_high, ahead_low):
    """Place what a lane rocks on with; a lane without a case stands still at a harmless place."""
    if n[CASE + i] < 0:
        for m in range(ROWS):
            x[m * LANES + i] = 0.0
        for m in range(1, INTEGERS):
            n[m * LANES + i] = 0
        x[REST_OF + i] = 1.0
        x[ANGLE + i] = 1.0
        x[CREST + i] = 10.0
        return
    k, side, factor, tau = n[K + i], n[SIDE + i], x[FACTOR + i], x[TAU + i]
    signed = side * factor
    x[SIGNED + i] = signed
    before = signed * samples[k]
    after = signed * samples[k + 1]
    x[A0 + i] = before + tau * (after - before)
    x[A1 + i] = after
    x[REST_OF + i] = 1.0 - tau
    j = n[BASE + i] + _at(side)
    x[ANGLE + i] = b[j + ALPHA]
    x[KAPPA + i] = b[j + SWING]
    x[PER_ANGLE + i] = b[j + PER_ALPHA]
    x[PER_SPEED + i] = b[j + PER_SWING]
    bound = _bound(side, factor, ahead_high[k // BLOCK], ahead_low[k // BLOCK])
    x[BOUND + i] = bound
    x[CREST + i] = math.sqrt(1.0 + bound * bound)


@inlined_kernel
def _bound(side, factor, most, least):
    """Largest A that can still push a block on this pole back down."""
    return max(0.0, factor * most * side, factor * least * side)


@inlined_kernel
def _take_over(x, i, tally, r):
    """Take a lane's extremes over into the tally of its case."""
    tally[r + RATIO] = max(tally[r + RATIO], 1.0 - x[LOW + i])
    tally[r + SPEED] = max(tally[r + SPEED], x[FAST + i])
    tally[r + CLOSEST] = min(tally[r + CLOSEST], math.sqrt(x[NEAR + i]))
