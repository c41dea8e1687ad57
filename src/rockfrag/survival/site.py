"""A site as ``site.yaml`` describes it: branches of its hazard, and what stands there, how fragile and how old."""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special, stats

from rockfrag.arrays import Floats
from rockfrag.assess.hazard.curve import (
    PGA,
    PGV,
    VELOCITY_PER_G,
    HazardCurve,
    rate_weights,
    read_level,
    read_measure,
)
from rockfrag.errors import InputError, errors_of
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.schema import checked
from rockfrag.survival.branches import Branch, read_branches
from rockfrag.yaml_file import read_yaml

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


RECORDS = "resources/records"  # Folder of fetched records

ANY_LEVEL = {"PGA": 0.1, "SA": 0.1, "PGV": 10.0}
"""A level in each measure: only fractions over all levels are used."""

SHAKING = ("pga", "pgv", "sa", "hazard", "return_period", "return_period_years", "years")
"""Keys of ``statue.yaml`` that say what shakes the site, which the branches of the hazard do here."""


@dataclass(frozen=True)
class Site:
    """What is known of a site."""

    name: str  #: What the site is called
    branches: tuple[Branch, ...]  #: Branches of its hazard
    objects: tuple[StandingObject, ...]  #: What stands there
    #: Correlation of the errors of the objects' fragilities, 0 (each its own) to 1 (all the same) [-]
    shared_error: float = 0.0
    same_earthquakes: bool = True  #: Whether the objects feel the same earthquakes
    velocity: VelocityRatio | None = None  #: PGV that comes with a PGA; None if not stated

    @property
    def measure(self) -> IntensityMeasure:
        """Measure in which curves are compared: PGA where the branches give it."""
        measures = list(self.branches[0].curves)
        return PGA if PGA in measures else measures[0]


def read_site(path: str | os.PathLike[str], records: str | Path = RECORDS) -> Site:
    """Read a site from a YAML file such as ``site.yaml``: branches, objects and how these depend on each other.

    Paths in it are relative to it; ``records`` is the folder of fetched records, for objects that are simulated.
    """
    known = checked(read_yaml(path), "site", str(path))
    try:
        return _site(known, Path(path).parent, Path(records))
    except InputError as error:
        text = str(error)
        raise InputError(
            text if text.startswith(str(Path(path).parent)) else f"{path}: {text}"
        ) from None


def _site(known: Mapping[str, Any], folder: Path, records: Path) -> Site:
    hazard = known["hazard"]
    realizations = hazard.get("realizations")
    velocity = hazard.get("velocity")
    site = Site(
        name=known.get("name", "the site"),
        branches=tuple(
            read_branches(
                [folder / name for name in hazard["curves"]],
                folder / realizations if realizations else None,
            )
        ),
        objects=(),
        shared_error=float(known.get("shared_error", 0.0)),
        same_earthquakes=bool(known.get("same_earthquakes", True)),
        velocity=velocity and VelocityRatio(**velocity),
    )
    return replace(site, objects=tuple(_objects(known["objects"], site, folder, records)))


def _objects(
    given: Sequence[Mapping[str, Any]], site: Site, folder: Path, records: Path
) -> list[StandingObject]:
    found: list[StandingObject] = []
    for at, settings in enumerate(given, start=1):
        name = settings.get("name", f"object {at}")
        if any(body.name == name for body in found):
            raise InputError(f"objects: {name} is given twice; give each its own name.")
        with errors_of(f"objects, {name}"):
            measure = site.measure if "statue" in settings else PGA
            if "measure" in settings:
                measure = read_measure(settings["measure"], "measure")
            if "statue" in settings:
                coefficients, sd_ln = _simulated(settings, measure, site, folder, records)
            else:
                coefficients, sd_ln = _stated(settings, measure), 0.0
            sd_ln = float(settings.get("median_sd_ln", sd_ln))
            found.append(StandingObject(name, measure, coefficients, sd_ln, _age(settings)))
    return found


def _simulated(
    known: Mapping[str, Any], measure: IntensityMeasure, site: Site, folder: Path, records: Path
) -> tuple[tuple[float, ...], float]:
    """Coefficients of the fragility, and the spread of what is not known of its median in ln level [-].

    The object is the path of a ``statue.yaml``, or what would stand in it, simulated as ``rockfrag assess`` does.
    With the velocity of the site known the fragility is one in PGA and PGV/PGA. An object that no motion, or every
    one, topples at all levels that were tried is refused.
    """
    # imported when an object is simulated: others should not wait for numba
    from rockfrag.assess.answer import assess
    from rockfrag.assess.request import Level, make_request
    from rockfrag.fragility.estimators import fragility_of

    given = [key for key in ("median", "beta", "coefficients") if key in known]
    if given:
        raise InputError(
            f"{given[0]} follows from the simulation of statue; leave one of them out."
        )
    settings, where = known["statue"], "statue"
    if isinstance(settings, str):
        where, path = settings, folder / settings
        settings, folder = read_yaml(path), path.parent
    unused = [key for key in SHAKING if key in settings]
    if unused:
        raise InputError(
            f"{where}: key {unused[0]} has no effect, as the branches of the hazard say how it is shaken; "
            "leave it out."
        )
    request = make_request(settings, where, folder)
    request = replace(request, level=Level(measure, ANY_LEVEL[measure.openquake]))
    found = assess(request, records, brief=True)
    with_velocity = measure == PGA and site.velocity is not None
    coefficients: tuple[float, ...] | None = None
    if not with_velocity:
        curve = fragility_of(found.counted.outcomes()).fit
        if math.isfinite(curve.theta) and curve.beta > 0:
            coefficients = lognormal_coefficients(curve.theta, curve.beta)
    elif found.conversion:
        coefficients = found.conversion.fragility.coefficients
    sources = dict(found.amplitudes[0.5].sources)
    if with_velocity:
        sources.pop("conversion", None)
    spread = math.sqrt(sum(size**2 for size in sources.values()))
    if coefficients is None or not sources or not math.isfinite(spread):
        raise InputError(
            f"{where}: the motions do not say from which shaking it topples; too few topple it, or all do at "
            "every level."
        )
    return coefficients, spread


def _stated(settings: Mapping[str, Any], measure: IntensityMeasure) -> tuple[float, ...]:
    coefficients = settings.get("coefficients")
    if (coefficients is None) == ("median" not in settings):
        raise InputError("give statue, median and beta, or coefficients, of its fragility.")
    if coefficients is None:
        if "beta" not in settings:
            raise InputError(
                "beta is missing; give the logarithmic standard deviation of its fragility."
            )
        median = read_level(settings["median"], measure)
        if not median > 0:
            raise InputError(f"median: expected more than 0, found {settings['median']}.")
        coefficients = lognormal_coefficients(median, settings["beta"])
    if coefficients[1] <= 0:
        raise InputError(
            "coefficients: the second one, of ln PGA, must be above 0, or shaking would help it stand."
        )
    if len(coefficients) == 3 and measure != PGA:
        raise InputError(
            "coefficients: three of them are of 1, ln PGA and ln(PGV/PGA); leave measure out."
        )
    return tuple(coefficients)


def _age(settings: Mapping[str, Any]) -> Age:
    age, longest = settings["age_years"], float(settings.get("fragile_for_years", math.inf))
    if isinstance(age, Mapping):
        return Age(age["median"], age["median"], age["sd_ln"], longest)
    low, high = age if isinstance(age, list) else (age, age)
    if high < low:
        raise InputError(
            f"age_years: the range [{low:g}, {high:g}] ends before it begins; write the lower end first."
        )
    return Age(float(low), float(high), 0.0, longest)
