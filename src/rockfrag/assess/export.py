"""The answer as JSON, for other programs: every number of the page and what an independent computation needs.

In: an answer. Out: JSON, SI units or those of the keys. Docs: ``docs/assess.md``.
"""

import json
import math
from dataclasses import is_dataclass
from enum import Enum
from typing import Any

import numpy as np

from rockfrag import __version__
from rockfrag.assess.answer import Assessment
from rockfrag.assess.core.estimates import INSIDE
from rockfrag.assess.findings import (
    assumptions,
    details,
    details_of,
    first_screen,
    lines_of,
    quality_flags,
)
from rockfrag.assess.risk import Estimate
from rockfrag.assess.texts import Text
from rockfrag.fragility.exports import identifiers, model_text
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.words.catalogue import catalogue
from rockfrag.words.findings import Finding, as_data, finding, three, two


def as_json(found: Assessment) -> str:
    """Return the answer as JSON, its sentences in English; infinite and unknown numbers are null.

    Parameters
    ----------
    found : the answer

    Returns
    -------
    The text, which ends with a line break.
    """
    texts = catalogue()
    request = found.request
    answer = {
        "rockfrag": __version__,
        "name": request.name,
        "place": texts.say(request.where),
        "floor": texts.say(request.place.floor_name or ""),
        "lines": lines_of(found),
        "details": details_of(found),
        "findings": [as_data(each) for each in first_screen(found)],
        "findings_behind": [
            {"title": as_data(title), "findings": [as_data(each) for each in said]}
            for title, said in details(found).items()
        ],
        "measure": found.measure.imt,
        "unit": found.measure.unit,
        "level": None if found.level is None else found.level.value,
        "years": request.years,
        "interval_level": INSIDE,
        "rocks_from": found.rocks_from,
        "does_not_move": found.does_not_move,
        "accepted": request.accepted,
        "fraction_rocking": found.rocking,
        "counts": _counts(found),
        "fraction_toppling_with_sliding": found.sliding_fraction,
        "fraction_toppling": found.fraction,
        "fraction_toppling_or_left_leaning": found.leans,
        "probability": found.probability,
        "decision": found.decision,
        "amplitude_toppling": {f"{p:g}": e for p, e in found.amplitudes.items()},
        "arrangements": found.by_arrangement,
        "in_space": found.motions.both,
        "in_one_plane": found.planar,
        "flip_rate": found.flip_rate,
        "directions": found.directions,
        "mitigations": found.mitigations,
        "rules_of_thumb": found.rules,
        "effects": found.effects,
        "fragility": _fragility(found),
        "two_measures": _two_measures(found),
        "hazard": _hazard(found),
        "motions": _motions(found),
        "assumed": texts.lines(assumptions(found)),
        "quality_flags": texts.lines(quality_flags(found)),
    }
    return (
        json.dumps(_plain(answer), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    )


def _counts(found: Assessment) -> dict[str, int] | None:
    """Numbers of motions, of those that rock the object, and of those that topple it; None where none were run."""
    if found.counts is None:
        return None
    return dict(zip(("motions", "rock", "topple"), found.counts, strict=True))


def _fragility(found: Assessment) -> dict[str, Any]:
    """Fractions and probabilities at the levels of the measure, by limit state, and the curve if there is one."""
    outcomes, predicted = found.outcomes, found.predicted
    fragility = {
        "levels": outcomes.intensity_levels.levels,
        "fraction": outcomes.fractions(),
        "probability": predicted.fractions,
        "median": predicted.median,
        "beta_of_records": predicted.of_records,
        "beta_of_what_is_unknown": predicted.of_unknown,
        "other_states": {
            name: outcomes.fractions(state=name) for name in outcomes.others
        },
    }
    if found.curve is None:
        return fragility
    fit, interval = found.curve.fit, found.curve.interval
    return fragility | {
        "theta": fit.theta,
        "theta_limits": interval.theta,
        "beta": fit.beta,
        "beta_limits": interval.beta,
        "warnings": found.curve.warnings,
    }


def _hazard(found: Assessment) -> dict[str, Any] | None:
    """Annual rates at which levels are exceeded [1/year], with their source; None without a hazard."""
    if found.hazard is None:
        return None
    return {
        "source": found.hazard.source,
        "levels": found.hazard.levels,
        "annual_rates": found.hazard.rates,
    }


def _motions(found: Assessment) -> list[dict[str, Any]]:
    """Name, earthquake and value of the measure of each motion."""
    motions = found.motions
    values = motions.values(found.measure).tolist()
    rows = zip(motions.ground, motions.earthquakes, values, strict=True)
    return [
        {"name": motion.name, "earthquake": earthquake, "value": value}
        for motion, earthquake, value in rows
    ]


def _two_measures(found: Assessment) -> dict[str, Any] | None:
    """Fragility in the measure and PGV over it [s], and what is known of that at the site."""
    about = found.conversion
    if about is None or found.level is None:
        return None
    known = about.known and {
        "log_ratio": about.site_log(found.level),
        "sd_between_earthquakes": about.known.spread,
    }
    return {
        "measures": [f"{about.measure.imt} [{about.measure.unit}]", "PGV over it [s]"],
        "coefficients": about.coefficients,
        "weight": about.weight,
        "standard_error_of_weight": about.error,
        "at_the_site": known,
        "sd_of_mean": about.spread,
    }


def _plain(value: Any) -> Any:
    """Values as JSON knows them."""
    if isinstance(value, Estimate):
        limits = {"value": value.value, "lower": value.lower, "upper": value.upper}
        return _plain({**limits, "standard_deviations": dict(value.sources)})
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Finding):
        return {**_plain(as_data(value)), "words": catalogue().say(value)}
    if is_dataclass(value):
        return _plain(vars(value))
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def as_nrml(found: Assessment) -> str:
    """Return the fragility of the object as it stands; OpenQuake joins its levels by lines in the level itself."""
    name, outcomes = found.request.name, found.outcomes
    reached = {*outcomes.others, OVERTURNS}
    states = [state.name for state in limit_states() if state.name in reached]
    function = {
        "id": identifiers([name], "_:-")[name],
        "imt": found.measure.imt,
        "levels": outcomes.intensity_levels.levels.tolist(),
        "chances": {state: _chances(found, state) for state in states},
    }
    kind = found.request.objects.measured_as
    error = MODEL_ERRORS[kind]
    about = {"where": found.request.where, "motions": found.motions.about_set}
    said = [
        finding(
            Text.IN_NRML,
            name=name,
            error=three(error.beyond),
            kind=kind,
            about=error.words,
            **about,
        )
    ]
    curve = found.predicted
    if math.isfinite(curve.median + curve.of_records + curve.of_unknown):
        spreads = {"records": two(curve.of_records), "unknown": two(curve.of_unknown)}
        median = finding(
            Text.QUANTITY, value=two(curve.median), unit=found.measure.unit
        )
        said.append(finding(Text.IN_NRML_SPREADS, median=median, **spreads))
    return model_text(" ".join(catalogue().lines(said)), states, [function])


def _chances(found: Assessment, state: str) -> list[float]:
    """Probability of a limit state at each level, that of toppling with all that is not known; none is less."""
    toppling = found.predicted.fractions
    if state == OVERTURNS:
        return list(map(float, toppling))
    return list(map(float, np.maximum(found.outcomes.fractions(state=state), toppling)))
