"""The whole assessment as one page, ``rockfrag app``: what it computes with, and what it is made of."""

import math
from importlib.resources import files
from typing import Any

import numpy as np
from scipy import special, stats

from rockfrag.assess import mitigations, narrowing, objects, place, risk, sources
from rockfrag.assess.conversion import MOST_LEVELS, OF_DISPLACEMENT, VelocityRelation
from rockfrag.assess.hazard.curve import DAMAGING, EC8_SLOPE, EC8_SLOPE_SD, HIGHEST, HazardCurve
from rockfrag.assess.hazard.measure import PGA, PGV
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import (
    AT_REST,
    FEW_LEVELS,
    LARGEST_FACTOR,
    LEVELS,
    make_intensity_levels,
)
from rockfrag.assess.request import LONGEST_PERIOD, Records
from rockfrag.building.model import ModalDamping
from rockfrag.fragility.held_out import FOLDS, WORST_SCORE
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.fragility.vector import INTERACTION_LEVEL
from rockfrag.motions.declared import IntensityMeasure
from rockfrag.plausibility import (
    DENSITIES,
    DEPTHS,
    FIRST_PERIODS,
    LARGEST_PEAK,
    STONE,
    STOREY_HEIGHTS,
)
from rockfrag.rocking.browser import driver_text
from rockfrag.units import DIMENSIONS, EXAMPLES, GRAVITY

SCRIPTS = ("statistics", "risk", "conversion", "building", "objects", "answer")
"""Scripts that compute, in the order in which they need each other."""

_FLANK = 0.84
"""Quantile of a level that is continued with the upper exponent (:func:`curve_of_one_level`)."""


def script(name: str) -> str:
    """Return the text of one of the page's files."""
    return (files(__name__) / name).read_text(encoding="utf-8")


def computing() -> str:
    """Return the script that computes an answer, in a worker of a page or in Node."""
    return "\n".join([driver_text("ensemble"), *(script(f"{name}.js") for name in SCRIPTS)])


def data_of(motions: MotionSet, *, on_floor: bool = False) -> dict[str, Any]:
    """Return what the page computes with, but for the samples of the motions.

    Parameters
    ----------
    motions
        The motions of the ground.
    on_floor
        Whether they were recorded on the floor of the object.
    """
    names = list(dict.fromkeys(motions.earthquakes))
    return {
        "earthquakes": [names.index(name) for name in motions.earthquakes],
        "motions": motions.words,
        "names": [motion.name for motion in motions.ground],
        "onFloor": on_floor,
        "measures": {measure.imt: _measure(motions, measure) for measure in (PGA, PGV)},
        "measurements": {name: item.left for name, item in narrowing.MEASUREMENTS.items()},
        "constants": _constants(),
        "limits": {"storey": STOREY_HEIGHTS, "period": FIRST_PERIODS},
        "units": {
            "dimensions": DIMENSIONS,
            "examples": EXAMPLES,
            "known": {name: ", ".join(units) for name, units in DIMENSIONS.items()},
        },
    }


def _measure(motions: MotionSet, measure: IntensityMeasure) -> dict[str, Any]:
    levels, few = (
        make_intensity_levels(motions, measure, (), count).levels.tolist()
        for count in (LEVELS, FEW_LEVELS)
    )
    ratios = None
    if measure != PGV:
        logs = motions.log_ratios(measure)
        relation = VelocityRelation.of(motions.about, motions.log_ratios(measure, of_all=True))
        ratios = {
            "logs": logs.tolist(),
            "median": float(np.median(logs)),
            "spread": relation.unknown(Records()),
        }
    return {
        "unit": measure.unit,
        "levels": levels,
        "few": few,
        "values": motions.values(measure).tolist(),
        "ratios": ratios,
        "highest": HIGHEST[measure.openquake],
        "damaging": DAMAGING[measure.openquake],
    }


def _constants() -> dict[str, Any]:
    return {
        "GRAVITY": GRAVITY,
        "AT_REST": AT_REST,
        "LARGEST_FACTOR": LARGEST_FACTOR,
        "LARGEST_PEAK": LARGEST_PEAK,
        "LEVEL": risk.LEVEL,
        "HALF": risk.HALF,
        "Z": float(stats.norm.ppf(0.5 + risk.LEVEL / 2)),
        "FLANK_Z": float(special.ndtri(_FLANK)),
        "EC8_SLOPE": EC8_SLOPE,
        "EC8_SLOPE_SD": EC8_SLOPE_SD,
        "LIKELY": narrowing.LIKELY,
        "UNLIKELY": narrowing.UNLIKELY,
        "LEAST_GAIN": narrowing.LEAST_GAIN,
        "MOST_NAMED": narrowing.MOST_NAMED,
        "MODEL": MODEL_ERRORS[CUT].beyond,
        "SPACE": sources.SPACE,
        "MOST_LEVELS": MOST_LEVELS,
        "OF_DISPLACEMENT": OF_DISPLACEMENT,
        "INTERACTION_LEVEL": INTERACTION_LEVEL,
        "FOLDS": FOLDS,
        "WORST_SCORE": WORST_SCORE,
        "STONE": STONE,
        "DENSITIES": DENSITIES,
        "DEPTHS": DEPTHS,
        **{
            name: getattr(mitigations, name)
            for name in (
                *("WIDER", "PLATE", "STEEL", "LOWER", "BALLAST", "BALLAST_AT"),
                "PEDESTAL_HEIGHT",
            )
        },
        **{
            name: getattr(place, name)
            for name in ("PERIOD_FACTORS", "STOREY_HEIGHT", "STOREY_MASS", "HIGHEST_BUILDING")
        },
        "DAMPING": ModalDamping().ratio,
        "TOLERANCES": objects.TOLERANCES,
        "PLACE_TOLERANCES": place.TOLERANCES,
        "KNOWN_PERIOD": place.TOLERANCE_OF_KNOWN_PERIOD,
        "LONGEST_PERIOD": LONGEST_PERIOD,
    }


def curve_data(curve: HazardCurve) -> dict[str, Any]:
    """Return a hazard curve as the page knows it."""
    return {
        "levels": curve.levels.tolist(),
        "rates": curve.rates.tolist(),
        "quantiles": [
            {"z": float(special.ndtri(q)), **curve_data(each)}
            for q, each in curve.quantiles.items()
            if 0 < q < 1 and not math.isnan(q)
        ],
    }
