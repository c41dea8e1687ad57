"""A site as ``site.yaml`` describes it: branches of its hazard, and what stands there, how fragile and how old.

Branches are a logic tree's end branches, each with its weight and a hazard curve a measure: OpenQuake's exports or
tables of levels with the columns ``branch`` and ``weight``.

In: ``site.yaml``, and the files that it names. Out: a site, SI units. Docs: ``docs/survival.md``, "What a site
file holds".
"""

import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special, stats

from rockfrag.assess.hazard.curve import (
    LARGEST_FILE,
    PGA,
    PGV,
    VELOCITY_PER_G,
    HazardCurve,
    rate_weights,
    read_level,
    read_levels,
    read_measure,
    read_openquake,
)
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.tabular import Row, read_table
from rockfrag.base.text_files import read_text
from rockfrag.base.yaml_file import read_yaml
from rockfrag.config.schema import checked
from rockfrag.motions.intensity import IntensityMeasure

MOST_BRANCHES = 10_000  # Branches of one site

# Of the sum of weights from 1, which rounding to four digits explains
WEIGHT_ERROR = 1e-3


@dataclass(frozen=True)
class Branch:
    """One end branch of a logic tree at a site: its weight, of sum 1, and its hazard curves by measure."""

    name: str
    weight: float
    curves: dict[IntensityMeasure, HazardCurve] = field(default_factory=dict)


def read_branches(
    paths: Sequence[str | os.PathLike[str]],
    realizations: str | os.PathLike[str] | None = None,
) -> list[Branch]:
    """Read the branches of a site in the order of the file, with weights of sum 1 to the last digit.

    Parameters
    ----------
    paths : tables of branches, one a measure; or OpenQuake's files of hazard curves
    realizations : OpenQuake's file of realizations, with such files

    Returns
    -------
    The branches with their curves, the same measures for all.
    """
    named = _realizations(realizations) if realizations else {}
    for path in paths:
        curves = (
            [_of_openquake(path, realizations, named)]
            if realizations
            else _of_table(path, named)
        )
        for name, branch, curve in curves:
            if curve.measure in branch.curves:
                raise InputError(
                    f"{path}: {curve.measure.imt} of {name} is given twice."
                )
            branch.curves[curve.measure] = curve
    found, where = list(named.values()), str(realizations or paths[0])
    if len(found) > MOST_BRANCHES:
        raise InputError(
            f"{where}: {len(found)} branches are more than the {MOST_BRANCHES} allowed."
        )
    _check(found, where)
    total = sum(branch.weight for branch in found)
    return [Branch(b.name, b.weight / total, b.curves) for b in found]


def _check(branches: Sequence[Branch], where: str) -> None:
    """Refuse weights of branches that are not above 0, or do not sum to 1."""
    for branch in branches:
        if branch.weight <= 0:
            raise InputError(
                f"{where}: branch {branch.name[:60]} has the weight {branch.weight:g}; a weight is above 0."
            )
    total = sum(branch.weight for branch in branches)
    if abs(total - 1.0) > WEIGHT_ERROR:
        raise InputError(
            f"{where}: the weights of the {len(branches)} branches sum to {total:.6g} and not to 1; give every "
            "end branch once."
        )
    for branch in branches[1:]:
        if set(branch.curves) != set(branches[0].curves):
            raise InputError(
                f"{where}: branch {branch.name[:60]} has curves of {_names(branch)}, branch "
                f"{branches[0].name[:60]} of {_names(branches[0])}; give the same measures for all."
            )


def _names(branch: Branch) -> str:
    """Measures of which a branch has curves, in words."""
    return " and ".join(sorted(measure.imt for measure in branch.curves)) or "nothing"


def _of_table(
    path: str | os.PathLike[str], named: dict[str, Branch]
) -> Iterator[tuple[str, Branch, HazardCurve]]:
    """Yield each branch of a table with what messages call it and its curve; new ones join those ``named``."""
    every, curve = read_levels(path, labels=("branch", "weight"))
    rows: dict[str, list[Row]] = {}
    for row in every:
        rows.setdefault(row.text("branch"), []).append(row)
    for name, mine in rows.items():
        weight = mine[0].number("weight")
        for row in mine:
            if row.number("weight") != weight:
                raise row.error(
                    "weight",
                    f"branch {name} has the weight {weight:g} in an earlier row",
                )
        branch = named.setdefault(name, Branch(name, weight))
        called = f"branch {name[:60]}"
        if branch.weight != weight:
            raise InputError(
                f"{path}: {called} has the weight {weight:g}, and {branch.weight:g} elsewhere."
            )
        yield called, branch, curve(mine, f"{path}, {called}")


def _of_openquake(
    path: str | os.PathLike[str], realizations: object, named: Mapping[str, Branch]
) -> tuple[str, Branch, HazardCurve]:
    """Return the branch of a file of OpenQuake's, with what messages call it and its curve.

    The realization stands in the first line of the file or in its name; ``named``: branches by its number;
    ``realizations``: file that lists them, for messages.
    """
    text = read_text(path, LARGEST_FILE)
    found = _RLZ.search(text.partition("\n")[0]) or _RLZ.search(Path(path).name)
    if found is None:
        raise InputError(
            f"{path}: neither its first line nor its name says which realization it is of (such as rlz-003); "
            "export with individual_rlzs = true."
        )
    number = str(int(found[1]))
    if number not in named:
        raise InputError(f"{path}: realization {number} is not in {realizations}.")
    curve = read_openquake(text, str(path)).curve
    return f"realization {number}", named[number], curve


_RLZ = re.compile(r"rlz-(\d+)")


def _realizations(path: str | os.PathLike[str]) -> dict[str, Branch]:
    """Branches without curves, by the number of the realization."""
    table = read_table(path)
    if not {"rlz_id", "weight"} <= set(table.titles):
        raise InputError(
            f"{path}: expected OpenQuake's realizations with the columns rlz_id, branch_path and weight; found "
            f"{', '.join(table.titles)[:120] or 'nothing'}."
        )
    found: dict[str, Branch] = {}
    for row in table.rows(table.titles):
        try:
            number = int(row.cells["rlz_id"])
        except ValueError:
            raise row.error("rlz_id", "expected a whole number") from None
        if str(number) in found:
            raise InputError(f"{path}: realization {number} is given twice.")
        name = f"rlz-{number:03d} {row.cells.get('branch_path', '')}".strip()
        found[str(number)] = Branch(name, row.number("weight"))
    return found


GRID = 600  # Levels on which a hazard curve is integrated
# Nodes of Gauss and Hermite over the velocity that comes with a level of acceleration
NODES = 15


@dataclass(frozen=True)
class VelocityRatio:
    """How fast the ground moves at a site when its peak acceleration is known: ln(PGV/PGA) is normal."""

    median_s: float  # Median of PGV/PGA [s]
    # Standard deviation of its logarithm from one earthquake to the next [-]
    sd_ln: float


@dataclass(frozen=True)
class ShakingRates:
    """Points of shaking with the annual rates that they stand for in each branch of the hazard."""

    # Value of each measure at each point, in the measure's unit, shape (points,)
    values: Mapping[IntensityMeasure, Floats]
    # Annual rate of each point [1/year], shape (branches, points); above a level they sum to its rate
    rates: Floats


def shaking_rates(
    branches: Sequence[Mapping[IntensityMeasure, HazardCurve]],
    wanted: set[IntensityMeasure],
    velocity: VelocityRatio | None,
    reach: tuple[float, float],
) -> ShakingRates:
    """Points of shaking at a site in all measures that the objects are sensitive to, the same for all branches.

    The points lie on a grid of levels of the one measure, and for PGA and PGV on nodes of the velocity at each.

    Parameters
    ----------
    branches : hazard curves of each branch by measure
    wanted : measures of the objects' fragilities
    velocity : PGV that comes with a PGA, where PGV is wanted and the branches have no curve of it, or both are
        wanted
    reach : levels between which fragilities change, a range to be covered

    Returns
    -------
    The points with their rates in each branch.
    """
    measures = set(branches[0])
    if len(wanted) == 1 and wanted <= measures:
        (measure,) = wanted
        levels, rates = _on_grid([curves[measure] for curves in branches], reach)
        return ShakingRates({measure: levels}, rates)
    if wanted <= {PGA, PGV} and PGA in measures and velocity is not None:
        levels, rates = _on_grid([curves[PGA] for curves in branches], reach)
        # the rate of a level is divided over the velocities that may come with it
        nodes, weight = np.polynomial.hermite_e.hermegauss(NODES)
        ratio = velocity.median_s * np.exp(velocity.sd_ln * nodes)
        pgv = VELOCITY_PER_G * (levels[:, np.newaxis] * ratio).ravel()
        spread = rates[:, :, np.newaxis] * (weight / weight.sum())
        return ShakingRates(
            {PGA: np.repeat(levels, NODES), PGV: pgv}, spread.reshape(len(rates), -1)
        )
    missing = sorted(measure.imt for measure in wanted - measures) or [
        "PGV that comes with PGA"
    ]
    raise InputError(
        f"hazard: an object's fragility needs {' and '.join(missing)}, but the branches give "
        f"{', '.join(sorted(measure.imt for measure in measures))}; give velocity: {{median_s: …, sd_ln: …}}, "
        "the PGV/PGA of the site, or a fragility in that measure."
    )


def _on_grid(
    curves: Sequence[HazardCurve], reach: tuple[float, float]
) -> tuple[Floats, Floats]:
    """Levels over all curves and the reach of the fragilities, and the rates that they stand for in each curve.

    Returned are the levels, shape (levels,), and annual rates [1/year], shape (curves, levels).
    """
    known = np.concatenate([curve.levels for curve in curves])
    grid = np.geomspace(min(known.min(), reach[0]), max(known.max(), reach[1]), GRID)
    # a few hundred branches with levels of their own would make the grid needlessly fine
    levels = (
        np.union1d(grid, np.unique(known)) if np.unique(known).size <= GRID else grid
    )
    return levels, np.array([rate_weights(curve, levels) for curve in curves])


def quantile_weights(values: Floats, weights: Floats, quantiles: Floats) -> Floats:
    """Quantiles of values with weights of sum 1, interpolated in the sum of the weights.

    Parameters
    ----------
    values : shape (branches, n)
    weights : of the branches, shape (branches,)
    quantiles : wanted [-], shape (quantiles,)

    Returns
    -------
    The quantiles in the unit of the values, shape (quantiles, n).
    """
    order = np.argsort(values, axis=0)
    cumulative = np.cumsum(weights[order], axis=0)
    ordered = np.take_along_axis(values, order, axis=0)
    columns = zip(cumulative.T, ordered.T, strict=True)
    return np.array([np.interp(quantiles, c, v) for c, v in columns]).T


# Standard deviations from the median beyond which a fragility no longer changes
TAIL = 6.0


@dataclass(frozen=True)
class Age:
    """For how long an object has stood as fragile as it is today [year]: certain, a range, or lognormal."""

    # ends of a range in which every value is equally probable; equal for a certain age
    low: float
    high: float
    # standard deviation of ln of a lognormal age of median ``low``, else 0
    sd_ln: float = 0.0
    # longest time of being so fragile, which limits the age
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
        # in ln of the measure
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
        return np.asarray(
            c[0] + c[1] * np.log(pga) + c[2] * np.log(pgv / (VELOCITY_PER_G * pga))
        )

    def probability(self, index: Floats, error: float) -> Floats:
        """Probability of toppling where the object withstands exp(error) times the shaking estimated [-].

        ``index``: normal scores of points of shaking, shape (points,), which is that of the result.
        """
        return np.asarray(special.ndtr(index - self.coefficients[1] * error))


def lognormal_coefficients(theta: float, beta: float) -> tuple[float, float]:
    """Coefficients (c0, c1) of a lognormal fragility with median θ and logarithmic standard deviation β."""
    return -math.log(theta) / beta, 1.0 / beta


def draw_errors(objects: int, shared: float, samples: int) -> tuple[Floats, Floats]:
    """Draw errors of fragilities, and positions in ages, spread evenly (Sobol; a power of two).

    Parameters
    ----------
    objects, samples : their numbers
    shared : correlation of the errors of two objects [-]

    Returns
    -------
    Standard normal errors, and uniform positions from 0 to 1, shape (samples, objects) each.
    """
    sobol = stats.qmc.Sobol(
        2 * objects + 1, scramble=True, rng=np.random.default_rng(0)
    )
    drawn = sobol.random(samples)
    normal = special.ndtri(np.clip(drawn[:, : objects + 1], 1e-12, 1 - 1e-12))
    common, own = normal[:, :1], normal[:, 1:]
    errors = math.sqrt(shared) * common + math.sqrt(1.0 - shared) * own
    return errors, drawn[:, objects + 1 :]


RECORDS = "resources/records"  # Folder of fetched records
UNNAMED = "the site"  # What a site without a name is called

# One a measure: fractions at all levels count
ANY_LEVEL = {"PGA": 0.1, "SA": 0.1, "PGV": 10.0}

SHAKING = (
    "pga",
    "pgv",
    "sa",
    "hazard",
    "return_period",
    "return_period_years",
    "years",
)
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
    #: PGV that comes with a PGA; None if not stated
    velocity: VelocityRatio | None = None

    @property
    def measure(self) -> IntensityMeasure:
        """Measure in which curves are compared: PGA where the branches give it."""
        measures = list(self.branches[0].curves)
        return PGA if PGA in measures else measures[0]


def read_site(path: str | os.PathLike[str], records: str | Path = RECORDS) -> Site:
    """Read a site from a YAML file such as ``site.yaml``: branches, objects and how these depend on each other.

    Paths in it are relative to it; ``records`` is the folder of fetched records, for objects that are simulated.

    Parameters
    ----------
    path, records : YAML file, and the folder of fetched records

    Returns
    -------
    The :class:`Site`.
    """
    known, folder = checked(read_yaml(path), "site", str(path)), Path(path).parent
    hazard, velocity = known["hazard"], known["hazard"].get("velocity")
    realizations = hazard.get("realizations")
    try:
        curves = [folder / name for name in hazard["curves"]]
        branches = read_branches(
            curves, folder / realizations if realizations else None
        )
        site = Site(
            name=known.get("name", UNNAMED),
            branches=tuple(branches),
            objects=(),
            shared_error=float(known.get("shared_error", 0.0)),
            same_earthquakes=bool(known.get("same_earthquakes", True)),
            velocity=velocity and VelocityRatio(**velocity),
        )
        return replace(
            site, objects=tuple(_objects(known["objects"], site, folder, Path(records)))
        )
    except InputError as error:
        text = str(error)
        raise InputError(
            text if text.startswith(str(folder)) else f"{path}: {text}"
        ) from None


def _objects(
    given: Sequence[Mapping[str, Any]], site: Site, folder: Path, records: Path
) -> list[StandingObject]:
    """The objects that stand at a site, of their settings.

    Parameters
    ----------
    given : settings of each
    site : its branches and velocity
    folder, records : of the files that settings name, and of fetched records
    """
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
                coefficients, sd_ln = _simulated(
                    settings, measure, site, folder, records
                )
            else:
                coefficients, sd_ln = _stated(settings, measure), 0.0
            sd_ln = float(settings.get("median_sd_ln", sd_ln))
            found.append(
                StandingObject(name, measure, coefficients, sd_ln, _age(settings))
            )
    return found


def _simulated(
    known: Mapping[str, Any],
    measure: IntensityMeasure,
    site: Site,
    folder: Path,
    records: Path,
) -> tuple[tuple[float, ...], float]:
    """Fragility of an object of a site that is simulated, as ``rockfrag assess`` does.

    With the site's velocity known it is one in PGA and PGV/PGA.

    Parameters
    ----------
    known : what the site says of the object, with ``statue``
    measure : of the site's hazard
    site : where it stands
    folder : below which its file lies
    records : folder of fetched records

    Returns
    -------
    Coefficients of the fragility, and the spread of what is not known of its median in ln level [-].
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
    settings, where, beside = _statue_of(known["statue"], folder)
    request = make_request(settings, where, beside)
    request = replace(request, level=Level(measure, ANY_LEVEL[measure.openquake]))
    found = assess(request, records, brief=True)
    with_velocity = measure == PGA and site.velocity is not None
    coefficients: tuple[float, ...] | None = None
    if not with_velocity:
        curve = fragility_of(found.counted.outcomes()).fit
        if math.isfinite(curve.theta) and curve.beta > 0:
            coefficients = lognormal_coefficients(curve.theta, curve.beta)
    elif found.conversion:
        coefficients = found.conversion.coefficients
    # what is not known of the median; the site's velocity is told by the branches of its hazard
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


def _statue_of(
    stated: str | Mapping[str, Any], folder: Path
) -> tuple[Mapping[str, Any], str, Path]:
    """Keys of an object, their name in messages and the folder of its files, from the file if one is named."""
    settings: Any = stated
    where = "statue"
    if isinstance(stated, str):
        where, path = stated, folder / stated
        settings, folder = read_yaml(path), path.parent
    unused = [key for key in SHAKING if key in settings]
    if unused:
        raise InputError(
            f"{where}: key {unused[0]} has no effect, as the branches of the hazard say how it is shaken; "
            "leave it out."
        )
    return settings, where, folder


def _stated(
    settings: Mapping[str, Any], measure: IntensityMeasure
) -> tuple[float, ...]:
    """Coefficients of a fragility that is stated, by median and β or as they are: (c0, c1) or (c0, c1, c2).

    ``measure``: of c1 and of the median.
    """
    coefficients = settings.get("coefficients")
    if (coefficients is None) == ("median" not in settings):
        raise InputError(
            "give statue, median and beta, or coefficients, of its fragility."
        )
    if coefficients is None:
        if "beta" not in settings:
            raise InputError(
                "beta is missing; give the logarithmic standard deviation of its fragility."
            )
        median = read_level(settings["median"], measure)
        if not median > 0:
            raise InputError(
                f"median: expected more than 0, found {settings['median']}."
            )
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
    """For how long an object has stood [years]: one number, a range, or a median with its spread."""
    age = settings["age_years"]
    longest = float(settings.get("fragile_for_years", math.inf))
    if isinstance(age, Mapping):
        return Age(age["median"], age["median"], age["sd_ln"], longest)
    low, high = age if isinstance(age, list) else (age, age)
    if high < low:
        raise InputError(
            f"age_years: the range [{low:g}, {high:g}] ends before it begins; write the lower end first."
        )
    return Age(float(low), float(high), 0.0, longest)
