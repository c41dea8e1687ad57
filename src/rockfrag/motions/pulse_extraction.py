"""The strongest pulse in a record: its period, amplitude, cycles and phase.

The even and the odd pulse, (1 + cos φ/γ)/2 times cos φ and sin φ with φ = 2πt/T, are sums of three harmonics,
whose products with a window of the velocity follow from those one sample earlier (a sliding discrete Fourier
transform). No pulse explains more than lies in its window: places whose window holds less need no look.

In: a velocity [m/s]. Out: period [s], amplitude [m/s], cycles and phase. Theory: ``docs/motions.md``, "The
strongest pulse".
"""

import math
from dataclasses import dataclass
from itertools import groupby, product

import numpy as np
from scipy.optimize import minimize_scalar

from rockfrag.base.arrays import Floats
from rockfrag.base.short_repr import short_repr
from rockfrag.records.motion import Motion, integrate
from rockfrag.runtime.machine_code import cached_njit

CYCLES = (1.0, 1.5, 2.0, 2.5, 3.0)
"""Oscillatory characters γ that are tried; recorded near-fault pulses have 1 to 3 (Mavroeidis &
Papageorgiou 2003)."""

SHORTEST_PERIOD, LONGEST_PERIOD, PERIOD_RATIO = 0.1, 15.0, 1.05
"""Periods that are tried [s] and the ratio of one to the next; none is shorter than 10 samples or
longer than the record.  The best is then refined between its neighbours."""

# a wavelet needs no finer; denser records are thinned for the search
SAMPLES_PER_PERIOD = 40


@dataclass(frozen=True)
class StrongestPulse:
    """The velocity pulse that explains most of a record.

    Attributes
    ----------
    period : prevailing period Tp [s]
    velocity : amplitude of the velocity pulse [m/s], positive
    cycles : oscillatory character γ [-]
    phase_deg : phase ν [degrees], from -180 to 180
    time : middle of the pulse [s]
    explained : fraction of the record's ∫ v² dt that goes when the pulse is subtracted, 0 to 1: the matching index
    """

    period: float
    velocity: float
    cycles: float
    phase_deg: float
    time: float
    explained: float

    __repr__ = short_repr


NO_PULSE = StrongestPulse(*[math.nan] * 6)  # of a motion of zeros, or one too short


def strongest_pulse(motion: Motion) -> StrongestPulse:
    """Find the velocity pulse that explains the largest fraction of a record's velocity.

    Pulses of the form of Mavroeidis & Papageorgiou (2003, Bull. Seism. Soc. Am. 93(3), 1099-1131) are slid along
    the velocity, as in the extended wavelet transform of Vassiliou & Makris (2011, Bull. Seism. Soc. Am. 101(2),
    596-618), over periods, cycles and phases.  For given period and cycles the amplitude and the phase follow from
    least squares, because the symmetric and the antisymmetric pulse are orthogonal and any phase is a sum of the
    two.  The best fit is the one that takes most of ∫ v² dt, which is what Baker (2007, Bull. Seism. Soc. Am.
    97(5), 1486-1501) asks of his pulse too.

    Parameters
    ----------
    motion : acceleration; its velocity from rest should not drift

    Returns
    -------
    The pulse; of NaN for a motion of zeros or one too short to hold a pulse.
    """
    velocity, _ = integrate(motion.acceleration, motion.dt)
    energy = _energy(velocity)
    shortest = max(SHORTEST_PERIOD, 10 * motion.dt)
    longest = min(LONGEST_PERIOD, float(motion.time[-1]))
    if energy[-1] <= 0 or longest < shortest:
        return NO_PULSE
    count = math.ceil(math.log(longest / shortest) / math.log(PERIOD_RATIO)) + 1
    periods = np.geomspace(shortest, longest, count)
    gain, period, cycles = _best_of(velocity, motion.dt, periods)
    step = math.log(PERIOD_RATIO)
    longest = motion.time[-1] / cycles
    refined = minimize_scalar(
        # near the best period no place explains less than half as much
        lambda x: (
            -best_place(velocity, energy, motion.dt, math.exp(x), cycles, gain / 2)[0]
        ),
        bounds=(
            math.log(period) - step,
            min(math.log(period) + step, math.log(longest)),
        ),
        method="bounded",
        options={"xatol": 1e-4},
    )
    period = math.exp(refined.x)
    gain, middle, even, odd = best_place(
        velocity, energy, motion.dt, period, cycles, 0.0
    )
    return StrongestPulse(
        period=period,
        velocity=math.hypot(even, odd),
        cycles=cycles,
        phase_deg=math.degrees(math.atan2(-odd, even)),
        time=middle * motion.dt,
        explained=gain / float(energy[-1]),
    )


def _best_of(
    velocity: Floats, dt: float, periods: Floats
) -> tuple[float, float, float]:
    """Try pulses of all periods and cycles; return what the best one explains [m²/s²], its period [s] and cycles.

    ``velocity`` [m/s] has samples ``dt`` [s] apart; ``periods`` [s] rise.
    """
    best = (0.0, 0.0, 0.0)
    # long pulses first: they cost little and leave few places at which a short one could explain more
    longest_first = periods[::-1].tolist()
    for every, some in groupby(
        longest_first, lambda T: max(1, int(T / (SAMPLES_PER_PERIOD * dt)))
    ):
        thinned = np.ascontiguousarray(velocity[::every])
        energy, step, hopeless = _energy(thinned), every * dt, 0.0
        for period, cycles in product(some, CYCLES[::-1]):
            length = cycles * period
            if length <= hopeless or 2 * half_length(length, step) + 1 > thinned.size:
                continue
            # less by what rounding may do, so that equals are looked at
            known = best[0] / every * (1 - 1e-9)
            gain = best_place(thinned, energy, step, period, cycles, known)[0]
            best = max(best, (every * gain, period, cycles))
            # a shorter window of the same samples holds no more
            hopeless = length if gain == 0 else hopeless
    return best


def _energy(velocity: Floats) -> Floats:
    """Sum of squares before each sample and in all [m²/s²], shape (n + 1,)."""
    return np.concatenate([[0.0], np.cumsum(velocity**2)])


@cached_njit()
def half_length(length: float, dt: float) -> int:
    """Samples to either side of the middle of a pulse of a length [s]."""
    return math.floor(length / 2 / dt)


@cached_njit(error_model="numpy")
def best_place(
    velocity: Floats,
    energy: Floats,
    dt: float,
    period: float,
    cycles: float,
    known: float,
) -> tuple[float, int, float, float]:
    """Find the best place of a pulse of a period and γ = ``cycles`` ≥ 1, by least squares at each place.

    Parameters
    ----------
    velocity : [m/s], shape (n,)
    energy : sum of its squares before each sample and in all [m²/s²], shape (n + 1,)
    dt, period : sampling interval and period [s]
    cycles : γ [-]
    known : sum of squares [m²/s²] that a pulse must explain more than, to be of interest

    Returns
    -------
    Explained sum of squares [m²/s²], sample in the middle of the pulse, amplitudes of the even and the odd pulse
        [m/s]; all zero without a pulse of interest, or where it is longer than the velocity.
    """
    half = half_length(cycles * period, dt)
    first, last = half, velocity.size - half - 1
    while first <= last and energy[first + half + 1] - energy[first - half] <= known:
        first += 1
    while first <= last and energy[last + half + 1] - energy[last - half] <= known:
        last -= 1
    if first > last:
        return 0.0, 0, 0.0, 0.0

    # places at the ends whose windows hold no more than what is known have been left out; the even pulse is the
    # real part of e^iφ/2 + (e^iφ(1 + 1/γ) + e^iφ(1 - 1/γ))/4, the odd one its imaginary part;
    # of the harmonics 1, 1 + 1/γ and 1 - 1/γ: turn of a sample, and value at the last sample of the pulse
    step = 2 * math.pi * dt / period
    turn0, edge0 = _phasor(step), _phasor(step * half)
    turn1 = _phasor(step * (1 + 1 / cycles))
    edge1 = _phasor(step * (1 + 1 / cycles) * half)
    turn2 = _phasor(step * (1 - 1 / cycles))
    edge2 = _phasor(step * (1 - 1 / cycles) * half)

    # norms of both pulses, and the products of the first window
    unit = complex(1.0, 0.0)
    wave0, wave1, wave2 = unit, unit, unit
    start = complex(velocity[first], 0.0)
    sum0, sum1, sum2 = start, start, start
    even_norm, odd_norm = 1.0, 0.0
    for j in range(1, half + 1):
        wave0, wave1, wave2 = wave0 * turn0, wave1 * turn1, wave2 * turn2
        after, before = velocity[first + j], velocity[first - j]
        sum0 += after * wave0 + before * wave0.conjugate()
        sum1 += after * wave1 + before * wave1.conjugate()
        sum2 += after * wave2 + before * wave2.conjugate()
        pulse = wave0 / 2 + (wave1 + wave2) / 4
        even_norm += 2 * pulse.real**2
        odd_norm += 2 * pulse.imag**2

    gain, place, best = -1.0, first, complex(0.0, 0.0)
    for middle in range(first, last + 1):
        product = sum0 / 2 + (sum1 + sum2) / 4
        explained = product.real**2 / even_norm + product.imag**2 / odd_norm
        if explained > gain:
            gain, place, best = explained, middle, product
        if middle < last:
            # one sample leaves the window, the others turn, and one comes in
            gone, come = velocity[middle - half], velocity[middle + half + 1]
            sum0 = (sum0 - gone * edge0.conjugate()) * turn0.conjugate() + come * edge0
            sum1 = (sum1 - gone * edge1.conjugate()) * turn1.conjugate() + come * edge1
            sum2 = (sum2 - gone * edge2.conjugate()) * turn2.conjugate() + come * edge2
    return gain, place, best.real / even_norm, best.imag / odd_norm


@cached_njit()
def _phasor(angle: float) -> complex:
    """Complex number of unit size at an angle [rad]."""
    return complex(math.cos(angle), math.sin(angle))
