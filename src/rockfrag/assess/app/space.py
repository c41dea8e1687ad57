"""What the page computes with where an object moves in space: both components of each record at once."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from rockfrag.assess import objects, outcomes
from rockfrag.assess.conversion import VelocityRelation
from rockfrag.assess.hazard.measure import PGV
from rockfrag.assess.motions import MotionSet, common_pair
from rockfrag.assess.outcomes import FEW_LEVELS, make_intensity_levels
from rockfrag.assess.request import Records
from rockfrag.motions.declared import IntensityMeasure
from rockfrag.records.motion import Motion


def in_space(motions: MotionSet, measures: Iterable[IntensityMeasure]) -> dict[str, Any]:
    """Return records, levels and constants of bodies in space, of motions one component at a time."""
    both = motions.with_both_components()
    fewer = both.thinned()
    names = [motion.name for motion in both.ground]
    turns = [math.radians(angle) for angle in range(0, 180, outcomes.WORST_STEP_DEG)]
    return {
        "records": [
            {"first": pair[0], "second": pair[1], "times": _times(both, pair)}
            for pair in both.pairs
        ],
        "fewer": [names.index(motion.name) for motion in fewer.ground],
        "measures": {measure.imt: _measure(both, fewer, measure) for measure in measures},
        "turns": [[math.cos(angle), math.sin(angle)] for angle in turns],
        "aside": objects.ASIDE,
        "higher": objects.HIGHER,
        "rolling": objects.ROLLING,
    }


def _times(motions: MotionSet, pair: tuple[int, int]) -> list[dict[str, Any] | None]:
    """Which times of each component are common to both; None where it is all of them."""
    found = []
    for own, common in zip(pair, common_pair(motions, pair), strict=True):
        found.append(None if common is motions.base[own] else _part(motions.base[own], common))
    return found


def _part(own: Motion, common: Motion) -> dict[str, Any]:
    step = common.provenance[-1]
    begin = float(step["left_out_at_beginning_s"])
    return {
        "begin": begin,
        "skip": None if step["interpolated"] else round(begin / own.dt),
        "count": common.acceleration.size,
        "dt": common.dt,
    }


def _measure(both: MotionSet, fewer: MotionSet, measure: IntensityMeasure) -> dict[str, Any]:
    few, fewest = (
        make_intensity_levels(each, measure, (), FEW_LEVELS).levels.tolist()
        for each in (both, fewer)
    )
    return {
        "levels": few, "fewer": fewest, "values": both.values(measure).tolist(),
        "ratios": ratios_of(both, measure),
    }  # fmt: skip


def ratios_of(motions: MotionSet, measure: IntensityMeasure) -> dict[str, Any] | None:
    """Return what is known of PGV over a measure in the motions; None of PGV itself."""
    if measure == PGV:
        return None
    logs = motions.log_ratios(measure)
    relation = VelocityRelation.of(motions.about, motions.log_ratios(measure, of_all=True))
    return {
        "logs": logs.tolist(),
        "median": float(np.median(logs)),
        "spread": relation.unknown(Records()),
    }
