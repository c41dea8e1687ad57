"""The strongest pulse in a record: its period, amplitude, cycles and phase."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.signal import correlate

from rockfrag.motions.integration import integrate
from rockfrag.motions.pulses import mavroeidis_papageorgiou
from rockfrag.records.motion import Motion

Floats = NDArray[np.float64]

CYCLES = (1.0, 1.5, 2.0, 2.5, 3.0)
"""Oscillatory characters γ that are tried; recorded near-fault pulses have 1 to 3 (Mavroeidis &
Papageorgiou 2003)."""

SHORTEST_PERIOD, LONGEST_PERIOD, PERIOD_RATIO = 0.1, 15.0, 1.05
"""Periods that are tried [s] and the ratio of one to the next; none is shorter than 10 samples or
longer than the record.  The best is then refined between its neighbours."""

SAMPLES_PER_PERIOD = 40
"""A wavelet needs no finer sampling; denser records are thinned while they are searched."""


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
        Share of the record's ∫ v² dt that goes when the pulse is subtracted, 0 to 1: the matching
        index.
    """

    period: float
    velocity: float
    cycles: float
    phase_deg: float
    time: float
    explained: float


NO_PULSE = StrongestPulse(*[math.nan] * 6)
"""What a motion of zeros, or one too short to hold a pulse, gives."""


def strongest_pulse(motion: Motion) -> StrongestPulse:
    """Find the velocity pulse that explains the largest share of a record's velocity.

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
    energy = float((velocity**2).sum())
    periods = _periods(motion)
    if energy <= 0 or periods.size == 0:
        return NO_PULSE
    gain, period, cycles = max(
        (_thinned_gain(velocity, motion.dt, period, cycles), period, cycles)
        for cycles in CYCLES
        for period in periods
    )
    step = math.log(PERIOD_RATIO)
    longest = motion.time[-1] / cycles
    refined = minimize_scalar(
        lambda log_period: -_fit(velocity, motion.dt, math.exp(log_period), cycles)[0],
        bounds=(math.log(period) - step, min(math.log(period) + step, math.log(longest))),
        method="bounded",
        options={"xatol": 1e-4},
    )
    period = math.exp(refined.x)
    gain, middle, even, odd = _fit(velocity, motion.dt, period, cycles)
    return StrongestPulse(
        period=period,
        velocity=math.hypot(even, odd),
        cycles=cycles,
        phase_deg=math.degrees(math.atan2(-odd, even)),
        time=middle * motion.dt,
        explained=gain / energy,
    )


def pulse_motion(pulse: StrongestPulse, dt: float) -> Motion:
    """Return an extracted pulse as an input motion of its own; it starts where the pulse does."""
    return mavroeidis_papageorgiou(pulse.velocity, pulse.period, pulse.cycles, pulse.phase_deg, dt)


def _periods(motion: Motion) -> Floats:
    shortest = max(SHORTEST_PERIOD, 10 * motion.dt)
    longest = min(LONGEST_PERIOD, float(motion.time[-1]))
    if longest < shortest:
        return np.empty(0)
    count = math.ceil(math.log(longest / shortest) / math.log(PERIOD_RATIO)) + 1
    return np.geomspace(shortest, longest, count)


def _thinned_gain(velocity: Floats, dt: float, period: float, cycles: float) -> float:
    every = max(1, int(period / (SAMPLES_PER_PERIOD * dt)))
    return every * _fit(velocity[::every], every * dt, period, cycles)[0]


def _fit(
    velocity: Floats, dt: float, period: float, cycles: float
) -> tuple[float, int, float, float]:
    """Best place of a pulse: explained sum of squares, middle sample, even and odd amplitude."""
    half = math.floor(cycles * period / 2 / dt)
    if 2 * half + 1 > velocity.size:
        return 0.0, 0, 0.0, 0.0
    phase = 2 * np.pi / period * dt * np.arange(-half, half + 1)
    envelope = (1 + np.cos(phase / cycles)) / 2
    even, odd = envelope * np.cos(phase), envelope * np.sin(phase)
    # "valid" keeps to the places where the whole pulse lies inside the record
    along_even = correlate(velocity, even, mode="valid", method="fft")
    along_odd = correlate(velocity, odd, mode="valid", method="fft")
    norms = float((even**2).sum()), float((odd**2).sum())
    gain = along_even**2 / norms[0] + along_odd**2 / norms[1]
    best = int(np.argmax(gain))
    return (
        float(gain[best]),
        best + half,
        float(along_even[best]) / norms[0],
        float(along_odd[best]) / norms[1],
    )
