"""The whole assessment as one page, ``rockfrag app``: what it computes with, and what it is made of.

In: the motions and modules of the package. Out: what the page embeds, as text. Docs: ``docs/app.md``.
"""

import math
from base64 import b64encode
from collections.abc import Iterable
from dataclasses import asdict, replace
from importlib.resources import files
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from scipy import special

from rockfrag.assess import (
    findings,
    outcomes,
    place,
    request,
    sources,
    standing,
)
from rockfrag.assess.answer import LEVELS_OF_HOLDERS
from rockfrag.assess.app.form import GROUPS, form_fields
from rockfrag.assess.conversion import NODES, VelocityRelation, published_velocity
from rockfrag.assess.core import bodies, choices, draws, holding
from rockfrag.assess.hazard import curve
from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records, Request
from rockfrag.assess.standing import box, contract, rolling
from rockfrag.assess.standing.declared import as_declared
from rockfrag.assess.standing.holders import (
    Beside,
    Bracket,
    Casters,
    Cords,
    Holder,
    Pendulum,
    Putty,
    Springs,
    WithoutWall,
)
from rockfrag.base import plausible, units
from rockfrag.base.arrays import Floats
from rockfrag.building.model import ModalDamping, ShearBuilding
from rockfrag.building.response import find_modes
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.system.mounts import ROLLING
from rockfrag.web import driver_text
from rockfrag.words.findings import as_data
from rockfrag.words.numbers import UNITS

SCRIPTS = (
    "core",
    "risk",
    "floors",
    "space",
    "objects",
    "held",
    "plan",
    "findings",
    "answer",
)
"""Scripts that compute, in the order in which they need each other."""


def script(name: str) -> str:
    """Return the text of one of the page's files."""
    return (files(__package__) / name).read_text(encoding="utf-8")


def computing() -> str:
    """Return the script that computes an answer, in a worker of a page or in Node."""
    return "\n".join(
        [
            driver_text("ensemble", "space", "plane"),
            *(script(f"{name}.js") for name in SCRIPTS),
        ]
    )


def data_of(motions: MotionSet, asked: Request | None = None) -> dict[str, Any]:
    """Return what the page computes with of ground motions, but for their samples.

    ``asked`` says where they were recorded, and has the building and hazard that the form does not tell.
    """
    hazard = asked.hazard if asked else ()
    given = asked.records if asked else Records()
    level = [asked.level.measure] if asked and asked.level else []
    measures = dict.fromkeys((PGA, PGV, *level, *(each.measure for each in hazard)))
    names = list(dict.fromkeys(motions.earthquakes))
    left = [[name, source.left] for name, source in sources.MEASUREMENTS.items()]
    return {
        "earthquakes": [names.index(name) for name in motions.earthquakes],
        "fields": [asdict(field) for field in form_fields(measures)],
        "groups": GROUPS,
        "kinds": {word: as_declared(kind) for word, kind in standing.options().items()},
        "motions": as_data(motions.about_set),
        "motionsInSpace": as_data(motions.with_both_components().about_set),
        "names": [motion.name for motion in motions.ground],
        "measures": {
            measure.imt: _measure(motions, measure, given) for measure in measures
        },
        "both": in_space(motions, measures, given),
        "holding": _holding(motions, measures),
        "onFloor": asked is not None and asked.records.on_floor,
        # curves of the hazard's quantiles, by the standard normal score of each
        "quantiles": [
            {
                "z": float(special.ndtri(q)),
                "levels": c.levels.tolist(),
                "rates": c.rates.tolist(),
            }
            for each in hazard
            for q, c in each.quantiles.items()
        ],
        "measurements": left,
        "draws": _draws(motions),
        "choices": {of.__name__: texts for of, texts in findings.TEXTS.items()},
        "constants": _constants(),
        "own": asked and _own(asked.place),
        "limits": {
            "storey": plausible.STOREY_HEIGHTS,
            "period": plausible.FIRST_PERIODS,
        },
        "units": {
            "dimensions": units.DIMENSIONS,
            "examples": units.EXAMPLES,
            "said": UNITS,
            "known": {
                name: ", ".join(known) for name, known in units.DIMENSIONS.items()
            },
        },
    }


def _measure(
    motions: MotionSet, measure: IntensityMeasure, given: Records
) -> dict[str, Any]:
    """What a page has to know of the motions in one measure."""
    return {
        "unit": measure.unit,
        "levels": _levels(motions, measure, outcomes.LEVELS),
        "few": _levels(motions, measure, outcomes.FEW_LEVELS),
        "values": motions.values(measure).tolist(),
        "ratios": ratios_of(motions, measure, given),
        "highest": curve.HIGHEST[measure.openquake],
        "damaging": curve.DAMAGING[measure.openquake],
    }


def _levels(motions: MotionSet, measure: IntensityMeasure, count: int) -> list[float]:
    """Levels that are tried where none is asked for."""
    shaking = outcomes.make_intensity_levels(motions, measure, (), count)
    values: list[float] = shaking.levels.tolist()
    return values


def _own(at: Place) -> dict[str, Any] | None:
    """A building that was given: its modes, the levels of its floors, and what is said of it."""
    building = at.building
    if building is None:
        return None
    usual = place.make_place(
        {"floor": f"{building.level(at.floor)}/{building.storeys}"}, Path()
    )
    if building == usual.building:
        return None
    top = replace(building, floors={**building.floors, "": building.storeys})
    variants = {"": replace(at, building=top, floor="")}
    for moved in variants[""].variants():
        for sign, side in zip("-+", moved.sides, strict=True):
            variants[f"{moved.name}{sign}"] = side
    return {
        "storeys": building.storeys,
        "levels": dict(building.floors),
        "floors": {name: _modes(side.building) for name, side in variants.items()},
        "total": sum(building.heights),
        "period": float(find_modes(building).period[0]),
        # all of it is given; of one made of what is known of it the floor is called so
        "whole": at.floor != "floor",
    }


def _modes(model: ShearBuilding | None) -> dict[str, Any]:
    """Frequency, damping and fractions of each mode [rad/s, -]."""
    assert model is not None
    modes = find_modes(model)
    fractions = (modes.participation * modes.shape).T
    each = (values.tolist() for values in (modes.frequency, modes.damping, fractions))
    names = ("omega", "damping", "fractions")
    found = [dict(zip(names, mode, strict=True)) for mode in zip(*each, strict=True)]
    return {"modes": found}


def _variants(period: float) -> dict[str, Any]:
    """Factor on the periods and damping of a sketched building, as it is and with each moved by its spread."""
    ratio = ModalDamping().ratio
    found = {"": {"slower": 1.0, "damping": ratio}}
    for sign, side in (("-", -1), ("+", 1)):
        found[f"period{sign}"] = {"slower": 1 + side * period, "damping": ratio}
    for sign, side in (("-", -1), ("+", 1)):
        damped = ratio * (1 + side * place.TOLERANCES["damping"])
        found[f"damping{sign}"] = {"slower": 1.0, "damping": damped}
    return found


# sources of uncertainty that an object of the form has at most (``answer.sources``)
SOURCES_DRAWN = 10


def _draws(motions: MotionSet) -> dict[str, Any]:
    """Random draws of an answer's members, made beforehand so that the page and the command use the same ones.

    Weights of earthquakes are drawn for as many of them as all motions have, those of which every second motion is
    left in space, and those of which every fourth is left in the plane.

    Returns
    -------
    ``columns`` and ``size``: sources of uncertainty, and draws. ``normals``: standard normal numbers, float64,
    (size, columns). ``bins``: the bin of each among its source's, bytes, (columns, size). ``weights``: by the
    number n of earthquakes, of each and of the next one, float64, (BLOCKS, n + 1). Arrays are in base 64, by row.
    """
    count = len(set(motions.earthquakes))
    fewer = motions.with_both_components().thinned()
    # every fourth motion
    fewest = motions.thinned().thinned()
    counts = {count, *(len(set(each.earthquakes)) for each in (fewer, fewest))}
    made = draws.make_draws(SOURCES_DRAWN, count)
    return {
        "columns": SOURCES_DRAWN,
        "size": draws.BLOCKS * draws.MEMBERS,
        "normals": _packed(made.sources),
        "bins": b64encode(made.bins.tobytes()).decode(),
        "weights": {n: _packed(draws.make_draws(0, n).weights) for n in counts},
    }


def _packed(values: Floats) -> str:
    """Numbers as little-endian float64 in base 64, rows one after the other, for the typed arrays of the page."""
    return b64encode(np.ascontiguousarray(values, dtype="<f8").tobytes()).decode()


def _of(module: ModuleType, *names: str) -> dict[str, Any]:
    """Constants of a module by their names."""
    return {name: getattr(module, name) for name in names}


def _constants() -> dict[str, Any]:
    """Constants of the package that scripts use, so that both have the same ones."""
    return {
        **_of(units, "GRAVITY"),
        **_of(draws, "MEMBERS", "FEW_MEMBERS"),
        "FLANK_Z": float(special.ndtri(curve.FLANKS[1])),
        **_of(curve, "EC8_SLOPE", "EC8_SLOPE_SD"),
        "MODEL": MODEL_ERRORS[CUT].beyond,
        **_of(sources, "SPACE"),
        **_of(plausible, "STONE", "DENSITIES", "DEPTHS"),
        **_of(bodies, "LOWER", "BALLAST"),
        **_of(
            holding, "UNBROKEN", "PADS_AT", "PLATE", "RADIUS", "SLIDES_AT", "LOCKED_AT"
        ),
        "ROLLS_AT": ROLLING.kinetic,
        **_of(
            place, "PERIOD_FACTORS", "STOREY_HEIGHT", "STOREY_MASS", "HIGHEST_BUILDING"
        ),
        **_of(findings, "MOST_SOURCES", "MOST_CHANGES", "MANY_LEAN"),
        **_of(choices, "FEWEST_EARTHQUAKES"),
        **_of(request, "ACCEPTED_AT_A_LEVEL", "ACCEPTED_IN_FIFTY_YEARS"),
        "VARIANTS": {
            "assumed": _variants(place.TOLERANCES["period"]),
            "known": _variants(place.TOLERANCE_OF_KNOWN_PERIOD),
        },
        # both sides of each property
        "TOLERANCES": {
            name: [1 - spread, 1 + spread]
            for name, spread in contract.TOLERANCES.items()
        },
        **_of(request, "LONGEST_PERIOD"),
    }


def in_space(
    motions: MotionSet, measures: Iterable[IntensityMeasure], given: Records
) -> dict[str, Any]:
    """Return records, levels and constants of bodies in space, of motions one component at a time."""
    both = motions.with_both_components()
    fewer = both.thinned()
    names = [motion.name for motion in both.ground]
    levels = {}
    for measure in measures:
        about = {
            "levels": _levels(both, measure, outcomes.FEW_LEVELS),
            "fewer": _levels(fewer, measure, outcomes.FEW_LEVELS),
            "fewest": _levels(fewer, measure, outcomes.FEWEST_LEVELS),
            "values": both.values(measure).tolist(),
        }
        levels[measure.imt] = {**about, "ratios": ratios_of(both, measure, given)}
    turns = [math.radians(angle) for angle in range(0, 180, outcomes.STEP_DEG)]
    return {
        "records": [
            {"first": pair[0], "second": pair[1], "times": _times(both, pair)}
            for pair in both.pairs
        ],
        "fewer": [names.index(motion.name) for motion in fewer.ground],
        "measures": levels,
        "turns": [[math.cos(angle), math.sin(angle)] for angle in turns],
        "aside": box.ASIDE,
        "rolling": rolling.ROLLING,
    }


HOLDERS: dict[str, tuple[Holder, str, float]] = {
    "putty": (Putty(1.0), "force", 1.0),
    "bracket": (Bracket(1.0), "force", 1.0),
    "cord": (Cords(1.0), "force", 1.0),
    "isolator": (Pendulum(1.0), "stroke", 100.0),
    "springs": (Springs(1.0), "stroke", 100.0),
    "wall": (Beside(1.0), "distance", 100.0),
    "casters": (Casters(), "", 1.0),
    "off_wall": (WithoutWall(), "", 1.0),
    "locked": (Casters(locked=True), "", 1.0),
}
"""What a page tries, and where in its text stands how much of it there is, times a factor."""


def _holding(
    motions: MotionSet, measures: Iterable[IntensityMeasure]
) -> dict[str, Any]:
    """What may hold an object, and by which motions at which levels it is tried, as ``assess.holding`` has it."""
    both = motions.with_both_components()
    return {
        "kinds": {name: _tries(*about) for name, about in HOLDERS.items()},
        "motions": {
            "plane": _tried_by(motions, measures, motions.thinned().thinned()),
            "space": _tried_by(both, measures, both.thinned()),
        },
    }


def _tries(holder: Holder, place: str, factor: float) -> dict[str, Any]:
    """What a page knows of something that may hold an object."""
    unbroken = type(holder)().bears
    return {
        "called": as_data(holder.called()),
        "place": place,
        "factor": factor,
        "demand": DEMANDS.get(holder.demand, ""),
        "times": holder.times if holder.demand else 0.0,
        "slow": holder.slow,
        "unbroken": unbroken if math.isfinite(unbroken) else None,
    }


DEMANDS = {"largest_force": "force", "stroke": "stroke"}
"""Columns of outcomes that say what a holder must bear, as the modules of a page name them."""


def _tried_by(
    motions: MotionSet, measures: Iterable[IntensityMeasure], few: MotionSet
) -> dict[str, Any]:
    """Which motions holders are tried with, and the levels to which these are scaled.

    Returned are the indices into ``motions.ground`` of every second motion (``slow``: for holders whose histories
    take long) and of the ``few`` (for all others), and ``measures``: by the name of a measure the levels of the
    few in its own unit, as of :func:`_levels`.
    """
    names = [motion.name for motion in motions.ground]
    levels = {
        measure.imt: _levels(few, measure, LEVELS_OF_HOLDERS) for measure in measures
    }
    indices = {
        name: [names.index(motion.name) for motion in some.ground]
        for name, some in (("slow", motions.thinned()), ("few", few))
    }
    return {**indices, "measures": levels}


def _times(motions: MotionSet, pair: tuple[int, int]) -> list[dict[str, Any] | None]:
    """Which times of each component are common to both; None where it is all of them."""
    found: list[dict[str, Any] | None] = []
    for own, common in zip(pair, motions.components(pair), strict=True):
        if common is motions.base[own]:
            found.append(None)
            continue
        step = common.provenance[-1]
        begin = float(step["left_out_at_beginning_s"])
        skip = None if step["interpolated"] else round(begin / motions.base[own].dt)
        about = {
            "begin": begin,
            "skip": skip,
            "count": common.acceleration.size,
            "dt": common.dt,
        }
        found.append(about)
    return found


def ratios_of(
    motions: MotionSet, measure: IntensityMeasure, given: Records
) -> dict[str, Any] | None:
    """Return what is known of PGV over a measure in the motions and at the site; None of PGV itself."""
    if measure == PGV:
        return None
    logs = motions.log_ratios(measure)
    relation = VelocityRelation.of(
        motions.about, motions.log_ratios(measure, of_all=True)
    )
    published, of_site = published_velocity(measure, given), None
    if published is not None:
        of_site = {
            "lines": published.lines(given).tolist(),
            "ofSite": published.of_site,
            "nodes": (published.within * NODES).tolist(),
        }
    return {
        "logs": logs.tolist(),
        "median": float(np.median(logs)),
        "spread": relation.unknown(given, of_site=False),
        "published": of_site,
    }
