"""A site with the branches of its hazard and the objects that stand there, as ``site.yaml`` describes it."""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rockfrag.assess.hazard.curve import PGA, read_level, read_measure
from rockfrag.errors import InputError, errors_of
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.schema import checked
from rockfrag.survival.branches import Branch, read_branches
from rockfrag.survival.evidence import Age, StandingObject, VelocityRatio, lognormal_coefficients
from rockfrag.yaml_file import read_yaml

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
