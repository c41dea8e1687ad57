"""The fragility of an object that stands at a site, simulated as ``rockfrag assess`` does."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rockfrag.assess.answer import assess_with
from rockfrag.assess.motions import motion_set
from rockfrag.assess.request import Level, make_request
from rockfrag.errors import InputError
from rockfrag.fragility.estimators import fragility_of
from rockfrag.motions.declared import IntensityMeasure
from rockfrag.survival.evidence import lognormal_coefficients
from rockfrag.yaml_file import read_yaml

ANY_LEVEL = {"PGA": 0.1, "SA": 0.1, "PGV": 10.0}
"""A level in each measure: only fractions over all levels are used."""

SHAKING = ("pga", "pgv", "sa", "hazard", "return_period", "return_period_years", "years")
"""Keys of ``statue.yaml`` that say what shakes the site, which the branches of the hazard do here."""


@dataclass(frozen=True)
class Simulated:
    """Fragility of a simulated object."""

    coefficients: tuple[float, ...]  # Of Φ(c0 + c1 ln x), or of Φ(c0 + c1 ln PGA + c2 ln(PGV/PGA))
    sd_ln: float  # Standard deviation of the logarithm of what is not known of its median [-]


def simulate_object(
    given: str | Mapping[str, Any],
    folder: Path,
    measure: IntensityMeasure,
    records: Path,
    *,
    with_velocity: bool,
) -> Simulated:
    """Simulate an object that ``statue.yaml`` could describe: the path of such a file, or what would stand in it.

    With the velocity of the site known the fragility is one in PGA and PGV/PGA. An object that no motion, or
    every one, topples at all levels that were tried is refused.
    """
    settings, where = given, "statue"
    if isinstance(given, str):
        settings, where = read_yaml(folder / given), given
        folder = (folder / given).parent
    assert isinstance(settings, Mapping)
    unused = [key for key in SHAKING if key in settings]
    if unused:
        raise InputError(
            f"{where}: key {unused[0]} has no effect, as the branches of the hazard say how it is shaken; "
            "leave it out."
        )
    request = make_request(settings, where, folder)
    request = replace(request, level=Level(measure, ANY_LEVEL[measure.openquake]))
    motions = motion_set(request.records, request.place, records)
    found = assess_with(request, motions, brief=True)
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
    return Simulated(coefficients, spread)
