"""The place along a velocity at which a pulse of given period and cycles explains most of it.

The even and the odd pulse, (1 + cos φ/γ)/2 times cos φ and sin φ with φ = 2πt/T, are each a sum of three
harmonics of the frequencies 1, 1 + 1/γ and 1 - 1/γ over T.  The product of such a harmonic with a window
of the velocity follows from that of the window one sample earlier: leave out the sample that goes, turn by
one sample, and add the sample that comes (a sliding discrete Fourier transform).  Products with both pulses
at all n places thus cost n steps, whatever the length of the pulse.

No pulse explains more of a velocity than lies in its window (Cauchy and Schwarz), so that places whose window
holds less than is explained elsewhere need no look.
"""

import math

import numpy as np
from numpy.typing import NDArray

from rockfrag.machine_code import cached_njit

Floats = NDArray[np.float64]


@cached_njit()
def half_length(length: float, dt: float) -> int:
    """Samples to either side of the middle of a pulse of a length [s]."""
    return math.floor(length / 2 / dt)


@cached_njit(error_model="numpy")
def best_place(
    velocity: Floats, energy: Floats, dt: float, period: float, cycles: float, known: float
) -> tuple[float, int, float, float]:
    """Find the best place of a pulse of a period [s], γ = ``cycles`` ≥ 1, by least squares at each place.

    ``velocity`` [m/s] has shape (n,), ``energy`` [m²/s²] is the sum of its squares before each sample and in
    all, shape (n + 1,); only a pulse that explains more than ``known`` [m²/s²] is of interest. Returned are the
    explained sum of squares, the sample in the middle of the pulse, and the amplitudes of the even and the odd
    pulse [m/s]: all zero without a pulse of interest, or where it is longer than the velocity.
    """
    half = half_length(cycles * period, dt)
    first, last = half, velocity.size - half - 1
    while first <= last and energy[first + half + 1] - energy[first - half] <= known:
        first += 1
    while first <= last and energy[last + half + 1] - energy[last - half] <= known:
        last -= 1
    if first > last:
        return 0.0, 0, 0.0, 0.0

    # one sample's turn of each harmonic, and its value at the last sample of the pulse
    step = 2 * math.pi * dt / period
    turn0, edge0 = _phasor(step), _phasor(step * half)
    turn1, edge1 = _phasor(step * (1 + 1 / cycles)), _phasor(step * (1 + 1 / cycles) * half)
    turn2, edge2 = _phasor(step * (1 - 1 / cycles)), _phasor(step * (1 - 1 / cycles) * half)

    # norms of both pulses, and the products of the first window
    wave0 = wave1 = wave2 = complex(1.0, 0.0)
    sum0 = sum1 = sum2 = complex(velocity[first], 0.0)
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
            gone, come = velocity[middle - half], velocity[middle + half + 1]
            sum0 = (sum0 - gone * edge0.conjugate()) * turn0.conjugate() + come * edge0
            sum1 = (sum1 - gone * edge1.conjugate()) * turn1.conjugate() + come * edge1
            sum2 = (sum2 - gone * edge2.conjugate()) * turn2.conjugate() + come * edge2
    return gain, place, best.real / even_norm, best.imag / odd_norm


@cached_njit(error_model="numpy")
def best_pulse(
    velocity: Floats,
    energy: Floats,
    dt: float,
    every: int,
    periods: Floats,
    cycles: Floats,
    best: tuple[float, float, float],
) -> tuple[float, float, float]:
    """Find the best of several pulses, if it explains more than the best so far.

    ``best`` and what is returned: what the best pulse so far explains [m²/s²], its period [s] and its cycles [-].
    The velocity has every ``every``-th sample of the record.
    """
    hopeless = 0.0
    for period in periods:
        for cycle in cycles:
            length = cycle * period
            if length <= hopeless or 2 * half_length(length, dt) + 1 > velocity.size:
                continue
            # less by what rounding may do, so that equals are looked at
            known = best[0] / every * (1 - 1e-9)
            gain = best_place(velocity, energy, dt, period, cycle, known)[0]
            found = (every * gain, period, cycle)
            best = found if found > best else best
            # a shorter window of the same samples holds no more
            hopeless = length if gain == 0 else hopeless
    return best


@cached_njit()
def _phasor(angle: float) -> complex:
    return complex(math.cos(angle), math.sin(angle))
