"""Response spectra and rocking spectra of a set of motions, computed once for all hypotheses about them."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rockfrag.motions.spectra import ResponseSpectrum, response_spectrum
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.rocking.spectra import uniform_block

Floats = NDArray[np.float64]

SIZES = np.geomspace(1.0, 8.0, 80)
"""2π/p of the blocks of a rocking spectrum [s]: heights from 0.4 to 24 m."""
PERIODS = np.geomspace(0.1, 10.0, 60)
"""Periods of the oscillators [s]."""


@dataclass(frozen=True)
class MotionSpectra:
    """Spectra of motions as recorded; each is computed when it is first asked for."""

    motions: Sequence[Motion]  # Ground motions
    alpha: Floats  # Critical angles of the blocks [rad], rising, shape (slendernesses,)
    threads: int | None  # Threads to use; the results do not depend on it
    _oscillator: dict[float, list[ResponseSpectrum]] = field(default_factory=dict)
    _rotation: dict[float, Floats] = field(default_factory=dict)

    def oscillator(self, damping: float) -> list[ResponseSpectrum]:
        """Response spectra over `PERIODS`, one per motion."""
        if damping not in self._oscillator:
            self._oscillator[damping] = [
                response_spectrum(motion, PERIODS, damping) for motion in self.motions
            ]
        return self._oscillator[damping]

    def displacement(self, damping: float) -> Floats:
        """Sd over `PERIODS`, shape (motions, periods) [m]."""
        return np.array([spectrum.displacement for spectrum in self.oscillator(damping)])

    def rotation(self, factor: float = 1.0) -> Floats:
        """Largest |θ|/θc over `SIZES`, shape (slendernesses, motions, sizes) [-]; infinite if it fell.

        The critical angles are ``alpha`` times the factor.
        """
        if factor not in self._rotation:
            blocks = [uniform_block(a * factor, T) for a in self.alpha for T in SIZES]
            found = overturns(blocks, self.motions, scales=[1.0], threads=self.threads)
            shape = (self.alpha.size, SIZES.size, len(self.motions))
            self._rotation[factor] = np.moveaxis(found.of_top("peak_rotation").reshape(shape), 2, 1)
        return self._rotation[factor]
