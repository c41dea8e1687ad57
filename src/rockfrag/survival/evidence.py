"""What stands at a site: how fragile it is, how sure that is, and for how long it has stood."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats

from rockfrag.assess.hazard.curve import PGA, PGV, VELOCITY_PER_G
from rockfrag.motions.declared import IntensityMeasure
from rockfrag.survival.rates import ShakingRates

Floats = NDArray[np.float64]

TAIL = 6.0
"""Standard deviations from the median beyond which a fragility no longer changes."""


@dataclass(frozen=True)
class Age:
    """For how long an object has stood as fragile as it is today [year]: certain, a range, or lognormal."""

    low: float  # ends of a range in which every value is equally probable; equal for a certain age
    high: float
    # standard deviation of the logarithm of a lognormal age with the median ``low``; 0 for the others
    sd_ln: float = 0.0
    # longest time for which it has been so fragile, which limits the age; infinite if none is given
    fragile_for: float = math.inf

    def exposure(self, uniform: Floats) -> Floats:
        """Years of exposure at given probabilities, shape (n,)."""
        if self.sd_ln > 0:
            age = self.low * np.exp(self.sd_ln * special.ndtri(uniform))
        else:
            age = self.low + uniform * (self.high - self.low)
        return np.asarray(np.minimum(age, self.fragile_for), dtype=np.float64)


@dataclass(frozen=True)
class StandingObject:
    """An object that still stands, with its fragility in PGA, PGV, Sa(T), or PGA and PGV/PGA.

    P(topples | x) = Φ(c0 + c1 ln x), or Φ(c0 + c1 ln PGA + c2 ln(PGV/PGA)) with PGA in g and PGV/PGA in s.
    """

    name: str
    measure: IntensityMeasure  # intensity measure of c1
    coefficients: tuple[float, ...]  # (c0, c1) or (c0, c1, c2)
    # standard deviation of ln of the shaking that it withstands, for what is not known of it [-]
    sd_ln: float
    age: Age

    @property
    def measures(self) -> set[IntensityMeasure]:
        """Measures that its fragility needs."""
        return {PGA, PGV} if len(self.coefficients) == 3 else {self.measure}

    @property
    def reach(self) -> tuple[float, float]:
        """Lowest and highest level of ``measure`` between which its fragility changes."""
        c0, c1 = self.coefficients[:2]
        wide = TAIL * (1 / c1 + self.sd_ln)
        # the second measure moves the median by as much as PGV/PGA of 0.02 to 0.5 s may
        aside = (
            [self.coefficients[2] * math.log(r) for r in (0.02, 0.5)]
            if len(self.coefficients) > 2
            else [0.0]
        )
        middle = [-(c0 + shift) / c1 for shift in aside]
        return math.exp(min(middle) - wide), math.exp(max(middle) + wide)

    def index(self, shaking: ShakingRates) -> Floats:
        """Normal score of toppling at points of shaking, the fragility as it is estimated, shape (points,)."""
        c = self.coefficients
        if len(c) == 2:
            return np.asarray(c[0] + c[1] * np.log(shaking.values[self.measure]))
        pga, pgv = shaking.values[PGA], shaking.values[PGV]
        return np.asarray(c[0] + c[1] * np.log(pga) + c[2] * np.log(pgv / (VELOCITY_PER_G * pga)))

    def probability(self, index: Floats, error: float) -> Floats:
        """Probability of toppling where the object withstands exp(error) times the shaking estimated."""
        return np.asarray(special.ndtr(index - self.coefficients[1] * error))


def lognormal_coefficients(theta: float, beta: float) -> tuple[float, float]:
    """Coefficients (c0, c1) of a lognormal fragility with median θ and logarithmic standard deviation β."""
    return -math.log(theta) / beta, 1.0 / beta


def draw_errors(objects: int, shared: float, samples: int, seed: int = 0) -> tuple[Floats, Floats]:
    """Draw errors of fragilities and positions in ages, evenly spread (Sobol; a power of two).

    Returns standard normal errors, correlated between objects as ``shared`` says [-], and independent uniform
    numbers, each of shape (samples, objects).
    """
    sobol = stats.qmc.Sobol(2 * objects + 1, scramble=True, rng=np.random.default_rng(seed))
    drawn = sobol.random(samples)
    normal = special.ndtri(np.clip(drawn[:, : objects + 1], 1e-12, 1 - 1e-12))
    common, own = normal[:, :1], normal[:, 1:]
    return math.sqrt(shared) * common + math.sqrt(1.0 - shared) * own, drawn[:, objects + 1 :]
