"""The whole assessment as one page, ``rockfrag app``: what it computes with, and what it is made of."""

import math
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

from scipy import special, stats

from rockfrag.assess import mitigations, narrowing, objects, place, risk, sources, words
from rockfrag.assess.app.space import in_space, ratios_of
from rockfrag.assess.conversion import MOST_LEVELS, OF_DISPLACEMENT
from rockfrag.assess.hazard.curve import (
    DAMAGING,
    EC8_SLOPE,
    EC8_SLOPE_SD,
    FLANKS,
    HIGHEST,
    HazardCurve,
)
from rockfrag.assess.hazard.measure import PGA, PGV
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.outcomes import (
    AT_REST,
    FEW_LEVELS,
    LARGEST_FACTOR,
    LEVELS,
    make_intensity_levels,
)
from rockfrag.assess.place import Place
from rockfrag.assess.request import LONGEST_PERIOD, Request
from rockfrag.assess.scale import STEPS
from rockfrag.building.model import ModalDamping, ShearBuilding
from rockfrag.building.response import find_modes
from rockfrag.fragility.held_out import FOLDS, WORST_SCORE
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.fragility.vector import INTERACTION_LEVEL
from rockfrag.motions.declared import IntensityMeasure
from rockfrag.motions.spectra import oscillator_matrix
from rockfrag.rocking.browser import driver_text
from rockfrag.units import (
    DENSITIES,
    DEPTHS,
    DIMENSIONS,
    EXAMPLES,
    FIRST_PERIODS,
    GRAVITY,
    LARGEST_PEAK,
    STONE,
    STOREY_HEIGHTS,
)

SCRIPTS = ("statistics", "risk", "conversion", "building", "space", "objects", "answer")
"""Scripts that compute, in the order in which they need each other."""

TABLED_STOREYS = 8
"""Storeys up to which floors of the usual building have the bits of the package: their modes stand in the page."""


def script(name: str) -> str:
    """Return the text of one of the page's files."""
    return (files(__package__) / name).read_text(encoding="utf-8")


def computing() -> str:
    """Return the script that computes an answer, in a worker of a page or in Node."""
    return "\n".join(
        [driver_text("ensemble", "space"), *(script(f"{name}.js") for name in SCRIPTS)]
    )


def data_of(motions: MotionSet, request: Request | None = None) -> dict[str, Any]:
    """Return what the page computes with, but for the samples of the motions.

    Parameters
    ----------
    motions
        The motions of the ground.
    request
        Where they were recorded, and the building and hazard that the form does not tell; nothing if None.
    """
    asked = (
        [] if request is None else [known for known in (request.level, *request.hazard) if known]
    )
    measures = dict.fromkeys((PGA, PGV, *(known.measure for known in asked)))
    intervals = sorted({motion.dt for motion in motions.ground})
    names = list(dict.fromkeys(motions.earthquakes))
    return {
        "earthquakes": [names.index(name) for name in motions.earthquakes],
        "motions": motions.words,
        "names": [motion.name for motion in motions.ground],
        "measures": {measure.imt: _measure(motions, measure) for measure in measures},
        "both": in_space(motions, measures),
        "onFloor": request is not None and request.records.on_floor,
        "quantiles": [] if request is None else _quantiles(request.hazard),
        "measurements": {
            name: measurement.left for name, measurement in narrowing.MEASUREMENTS.items()
        },
        "constants": _constants(),
        "floors": _floors(intervals),
        "own": request and _own(request.place, intervals),
        "steps": [
            {"name": step.name, "below": step.below if math.isfinite(step.below) else None}
            for step in STEPS
        ],
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
    return {
        "unit": measure.unit,
        "levels": levels,
        "few": few,
        "values": motions.values(measure).tolist(),
        "ratios": ratios_of(motions, measure),
        "highest": HIGHEST[measure.openquake],
        "damaging": DAMAGING[measure.openquake],
    }


def _floors(intervals: Sequence[float]) -> dict[int, Any]:
    """Modes of buildings of which only the storeys are known, as they are and with each property moved."""
    found = {}
    for storeys in range(1, TABLED_STOREYS + 1):
        found[storeys] = _with_variants(
            place.make_place({"floor": f"1/{storeys}"}, Path()), intervals
        )
    return found


def _with_variants(at: Place, intervals: Sequence[float]) -> dict[str, Any]:
    each = {"": at}
    for moved in at.variants():
        each |= {f"{moved.name}{sign}": side for sign, side in zip("-+", moved.sides, strict=True)}
    return {name: _modes(side.building, intervals) for name, side in each.items()}


def _own(at: Place, intervals: Sequence[float]) -> dict[str, Any] | None:
    """A building that was given: its modes, the levels of its floors, and what is said of it."""
    building = at.building
    if building is None:
        return None
    usual = place.make_place({"floor": f"{building.level(at.floor)}/{building.storeys}"}, Path())
    if building == usual.building:
        return None
    top = replace(building, floors={**building.floors, "": building.storeys})
    return {
        "storeys": building.storeys,
        "levels": dict(building.floors),
        "modes": _with_variants(replace(at, building=top, floor=""), intervals),
        "total": sum(building.heights),
        "period": float(find_modes(building).period[0]),
        # all of it is given; of one made of what is known of it the floor is called so
        "whole": at.floor != "floor",
    }


def _quantiles(hazard: Sequence[HazardCurve]) -> list[dict[str, Any]]:
    """Curves of the hazard's quantiles, by the standard normal score of each."""
    return [
        {"z": float(special.ndtri(q)), "levels": each.levels.tolist(), "rates": each.rates.tolist()}
        for curve in hazard
        for q, each in curve.quantiles.items()
    ]


def _modes(model: ShearBuilding | None, intervals: Sequence[float]) -> list[dict[str, Any]]:
    """What :func:`rockfrag.building.response.respond_elastically` does with each mode, by sampling interval."""
    assert model is not None
    modes, found = find_modes(model), []
    fractions = (modes.participation * modes.shape).T
    for period, damping, fraction in zip(
        modes.period.tolist(), modes.damping.tolist(), fractions.tolist(), strict=True
    ):
        omega = 2 * math.pi / period
        found.append(
            {
                "fractions": fraction,
                "damper": 2 * damping * omega,
                "spring": omega**2,
                "steps": {dt: oscillator_matrix(omega, damping, dt).tolist() for dt in intervals},
            }
        )
    return found


def _constants() -> dict[str, Any]:
    return {
        "GRAVITY": GRAVITY,
        "AT_REST": AT_REST,
        "LARGEST_FACTOR": LARGEST_FACTOR,
        "LARGEST_PEAK": LARGEST_PEAK,
        "LEVEL": risk.LEVEL,
        "HALF": risk.HALF,
        "Z": float(stats.norm.ppf(0.5 + risk.LEVEL / 2)),
        "FLANK_Z": float(special.ndtri(FLANKS[1])),
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
        "MANY": words.MANY,
        "FEW": words.FEW,
        "LEAST_PART": words.LEAST_PART,
        "MOST_SOURCES": words.MOST_SOURCES,
        "MOST_ASSUMPTIONS": words.MOST_ASSUMPTIONS,
        "DAMPING": ModalDamping().ratio,
        "TOLERANCES": objects.TOLERANCES,
        "PLACE_TOLERANCES": place.TOLERANCES,
        "KNOWN_PERIOD": place.TOLERANCE_OF_KNOWN_PERIOD,
        "LONGEST_PERIOD": LONGEST_PERIOD,
    }
