"""How often a site sees shaking near given levels: a hazard curve as weights of points in one or two measures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.assess.hazard.curve import PGA, PGV, VELOCITY_PER_G, HazardCurve, rate_weights
from rockfrag.errors import InputError
from rockfrag.motions.declared import IntensityMeasure

Floats = NDArray[np.float64]

GRID = 600
"""Levels on which a hazard curve is integrated."""

NODES = 15
"""Nodes of Gauss and Hermite over the velocity that comes with a level of acceleration."""


@dataclass(frozen=True)
class VelocityRelation:
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
    velocity: VelocityRelation | None,
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
