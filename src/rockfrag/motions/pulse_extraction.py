"""The strongest pulse in a record: its period, amplitude, cycles and phase."""

import math
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from rockfrag.motions.sliding_pulse import best_place, best_pulse
from rockfrag.records.integration import integrate
from rockfrag.records.motion import Motion
from rockfrag.short_repr import short_repr

Floats = NDArray[np.float64]

CYCLES = (1.0, 1.5, 2.0, 2.5, 3.0)
"""Oscillatory characters γ that are tried; recorded near-fault pulses have 1 to 3 (Mavroeidis &
Papageorgiou 2003)."""

SHORTEST_PERIOD, LONGEST_PERIOD, PERIOD_RATIO = 0.1, 15.0, 1.05
"""Periods that are tried [s] and the ratio of one to the next; none is shorter than 10 samples or
longer than the record.  The best is then refined between its neighbours."""

SAMPLES_PER_PERIOD = 40
"""A wavelet needs no finer sampling; denser records are thinned while they are searched."""


_TRIED = np.array(CYCLES[::-1])


@dataclass(frozen=True)
class StrongestPulse:
    """The velocity pulse that explains most of a record.

    Attributes
    ----------
    period
        Prevailing period Tp [s].
    velocity
        Amplitude of the velocity pulse [m/s], positive.
    cycles
        Oscillatory character γ [-].
    phase_deg
        Phase ν [degrees], from -180 to 180.
    time
        Middle of the pulse [s].
    explained
        Fraction of the record's ∫ v² dt that goes when the pulse is subtracted, 0 to 1: the matching
        index.
    """

    period: float
    velocity: float
    cycles: float
    phase_deg: float
    time: float
    explained: float

    __repr__ = short_repr


NO_PULSE = StrongestPulse(*[math.nan] * 6)
"""What a motion of zeros, or one too short to hold a pulse, gives."""


def strongest_pulse(motion: Motion) -> StrongestPulse:
    """Find the velocity pulse that explains the largest fraction of a record's velocity.

    Pulses of the form of Mavroeidis & Papageorgiou (2003, Bull. Seism. Soc. Am. 93(3), 1099-1131)
    are slid along the velocity, as in the extended wavelet transform of Vassiliou & Makris (2011,
    Bull. Seism. Soc. Am. 101(2), 596-618), over periods, cycles and phases.  For given period and
    cycles the amplitude and the phase follow from least squares, because the symmetric and the
    antisymmetric pulse are orthogonal and any phase is a sum of the two.  The best fit is the one
    that takes most of ∫ v² dt, which is what Baker (2007, Bull. Seism. Soc. Am. 97(5), 1486-1501)
    asks of his pulse too.

    Parameters
    ----------
    motion
        Acceleration; its velocity from rest should not drift.

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
        lambda x: -best_place(velocity, energy, motion.dt, math.exp(x), cycles, gain / 2)[0],
        bounds=(math.log(period) - step, min(math.log(period) + step, math.log(longest))),
        method="bounded",
        options={"xatol": 1e-4},
    )
    period = math.exp(refined.x)
    gain, middle, even, odd = best_place(velocity, energy, motion.dt, period, cycles, 0.0)
    return StrongestPulse(
        period=period,
        velocity=math.hypot(even, odd),
        cycles=cycles,
        phase_deg=math.degrees(math.atan2(-odd, even)),
        time=middle * motion.dt,
        explained=gain / float(energy[-1]),
    )


def _best_of(velocity: Floats, dt: float, periods: Floats) -> tuple[float, float, float]:
    """What the best of the pulses that are tried explains [m²/s²], its period and its cycles."""
    best = (0.0, 0.0, 0.0)
    # long pulses first: they cost little and leave few places at which a short one could explain more
    for every, some in groupby(periods[::-1], lambda T: max(1, int(T / (SAMPLES_PER_PERIOD * dt)))):
        thinned = np.ascontiguousarray(velocity[::every])
        best = best_pulse(
            thinned, _energy(thinned), every * dt, every, np.array([*some]), _TRIED, best
        )
    return best


def _energy(velocity: Floats) -> Floats:
    """Sum of squares before each sample and in all [m²/s²], shape (n + 1,)."""
    return np.concatenate([[0.0], np.cumsum(velocity**2)])
