"""What stands at a site, how fragile and how old it is, and how often shaking near given levels is seen there."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special, stats

from rockfrag.arrays import Floats
from rockfrag.assess.hazard.curve import PGA, PGV, VELOCITY_PER_G, HazardCurve, rate_weights
from rockfrag.errors import InputError
from rockfrag.motions.intensity import IntensityMeasure

GRID = 600  # Levels on which a hazard curve is integrated
NODES = 15  # Nodes of Gauss and Hermite over the velocity that comes with a level of acceleration


@dataclass(frozen=True)
class VelocityRatio:
    """How fast the ground moves at a site when its peak acceleration is known: ln(PGV/PGA) is normal.

    ``median_s`` is the median of PGV/PGA [s], ``sd_ln`` the standard deviation of its logarithm from one
    earthquake to the next [-].
    """

    median_s: float
    sd_ln: float


@dataclass(frozen=True)
class ShakingRates:
    """Points of shaking with the annual rates that they stand for in each branch of the hazard."""

    # Value of each measure at each point, in the measure's unit, shape (points,)
    values: Mapping[IntensityMeasure, Floats]
    # Annual rate of each point [1/year], shape (branches, points).  Their sum over points above a
    # level is how often that level is exceeded
    rates: Floats


def shaking_rates(
    branches: Sequence[Mapping[IntensityMeasure, HazardCurve]],
    wanted: set[IntensityMeasure],
    velocity: VelocityRatio | None,
    reach: tuple[float, float],
) -> ShakingRates:
    """Points of shaking at a site in all measures that the objects are sensitive to, the same for all branches.

    ``velocity`` is the PGV that comes with a PGA, where PGV is wanted and the branches have no curve of it, or
    both are wanted; ``reach`` are the levels between which fragilities change, a range to be covered. The points
    lie on a grid of levels of the one measure, and for PGA and PGV on nodes of the velocity at each.
    """
    measures = set(branches[0])
    if len(wanted) == 1 and wanted <= measures:
        (measure,) = wanted
        levels, rates = _on_grid([curves[measure] for curves in branches], reach)
        return ShakingRates({measure: levels}, rates)
    if wanted <= {PGA, PGV} and PGA in measures and velocity is not None:
        levels, rates = _on_grid([curves[PGA] for curves in branches], reach)
        nodes, weight = np.polynomial.hermite_e.hermegauss(NODES)
        ratio = velocity.median_s * np.exp(velocity.sd_ln * nodes)
        pgv = VELOCITY_PER_G * (levels[:, np.newaxis] * ratio).ravel()
        spread = rates[:, :, np.newaxis] * (weight / weight.sum())
        return ShakingRates(
            {PGA: np.repeat(levels, NODES), PGV: pgv}, spread.reshape(len(rates), -1)
        )
    missing = sorted(measure.imt for measure in wanted - measures) or ["PGV that comes with PGA"]
    raise InputError(
        f"hazard: an object's fragility needs {' and '.join(missing)}, but the branches give "
        f"{', '.join(sorted(measure.imt for measure in measures))}; give velocity: {{median_s: …, sd_ln: …}}, "
        "the PGV/PGA of the site, or a fragility in that measure."
    )


def _on_grid(curves: Sequence[HazardCurve], reach: tuple[float, float]) -> tuple[Floats, Floats]:
    """Levels over all curves and the reach of the fragilities, and the rates that they stand for in each curve."""
    known = np.concatenate([curve.levels for curve in curves])
    grid = np.geomspace(min(known.min(), reach[0]), max(known.max(), reach[1]), GRID)
    # a few hundred branches with levels of their own would make the grid needlessly fine
    levels = np.union1d(grid, np.unique(known)) if np.unique(known).size <= GRID else grid
    return levels, np.array([rate_weights(curve, levels) for curve in curves])


def quantile_weights(values: Floats, weights: Floats, quantiles: Floats) -> Floats:
    """Weighted quantiles along the first axis, the cumulative weight interpolated, shape (quantiles, n).

    Values have the shape (branches, n), their weights (branches,) and the sum 1.
    """
    order = np.argsort(values, axis=0)
    cumulative = np.cumsum(weights[order], axis=0)
    ordered = np.take_along_axis(values, order, axis=0)
    columns = zip(cumulative.T, ordered.T, strict=True)
    return np.array([np.interp(quantiles, c, v) for c, v in columns]).T


TAIL = 6.0  # Standard deviations from the median beyond which a fragility no longer changes


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
        c0, c1, *others = self.coefficients
        wide = TAIL * (1 / c1 + self.sd_ln)
        # the second measure moves the median by as much as PGV/PGA of 0.02 to 0.5 s may
        aside = [c * math.log(ratio) for c in others for ratio in (0.02, 0.5)] or [0.0]
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
