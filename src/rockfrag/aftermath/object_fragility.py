"""Fragility of each object of an inventory as other programs take it: medians and β of two limit states.

In goes an inventory; out comes an :class:`ObjectFragility` an object, in PGA or PGV of the ground under the
building, or of what the object itself stands on. β holds the motions and all that is not known, as the curves that
``rockfrag assess`` exports do. Docs: ``docs/how-to/export.md``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.assess.answer import Assessment
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.inventory import assess_each
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.place import Place
from rockfrag.assess.request import Level, Request
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS
from rockfrag.runtime.progress import Progress
from rockfrag.words.catalogue import catalogue
from rockfrag.words.findings import listed

OF_STATICS = 0.1
"""Standard deviation of ln level of what is not known of where rocking begins [-]: contact, centre of gravity. An
estimate of ours."""

ASKED = {
    "PGA": 0.2,
    "PGV": 20.0,
}  # A level to ask at [g; cm/s]; curves do not depend on it
NORMAL_TENTH = 1.2816  # Standard deviations from a median to its tenth
ROUNDING = 1e-6  # Difference of ln levels that is none [-]


@dataclass(frozen=True)
class LognormalState:
    """Lognormal curve of a limit state: median in the unit of its measure, and β [-]."""

    median: float
    beta: float


@dataclass(frozen=True)
class ObjectFragility:
    """Fragility of an object.

    Attributes
    ----------
    request : the object, and where it is
    measure : of the curves, PGA [g] or PGV [cm/s]
    on_floor : whether that is of what the object stands on, and not of the ground
    states : curves by limit state, the milder first
    motions, earthquakes : by how many the curves were found
    """

    request: Request
    measure: IntensityMeasure
    on_floor: bool
    states: dict[str, LognormalState]
    motions: int
    earthquakes: int

    @property
    def size(self) -> str:
        """Size in words, such as ``0.35 × 1.2 m``."""
        block = self.request.objects.block
        return f"{block.width:.3g} × {block.height:.3g} m"

    @property
    def held_by(self) -> str:
        """What holds it in words, such as ``wax or putty``; empty of what stands free."""
        holders = self.request.objects.under.holders
        return catalogue().say(listed([each.short for each in holders]))


def object_fragilities(
    requests: Sequence[Request],
    motions: MotionSet,
    measure: IntensityMeasure,
    *,
    on_floor: bool = False,
    progress: Progress | None = None,
) -> tuple[list[ObjectFragility], list[str]]:
    """Find the fragility of each object.

    Parameters
    ----------
    requests, motions : the objects, and the ground motions by which they are shaken
    measure : PGA or PGV
    on_floor : give the curves in the motion of what each object stands on, as if that were the ground
    progress : called with the number of objects done and of all

    Returns
    -------
    The fragilities, and the names of objects without a median: fewer than half of the motions topple them at any
    level.
    """
    level = Level(measure, ASKED[measure.imt])
    asked = [replace(each, level=level, hazard=()) for each in requests]
    if on_floor:
        asked = [replace(each, place=Place()) for each in asked]
    found, without = [], []
    answers = assess_each(asked, motions, progress)
    for own, assessed in zip(requests, answers, strict=True):
        topples = _overturning(assessed)
        if topples is None:
            without.append(own.name)
            continue
        states = {ROCKS: _rocking(assessed, topples), OVERTURNS: topples}
        about = ObjectFragility(
            own,
            measure,
            on_floor,
            states,
            motions=len(motions.ground),
            earthquakes=len(set(motions.earthquakes)),
        )
        found.append(about)
    return found, without


def _overturning(found: Assessment) -> LognormalState | None:
    """Curve of toppling with all that is not known; None where half of the motions do not reach it."""
    curve = found.predicted
    if not math.isfinite(curve.median):
        return None
    beta = math.hypot(curve.of_records, curve.of_unknown)
    if not math.isfinite(beta):
        tenth = found.amplitudes[0.1].value
        beta = math.log(curve.median / tenth) / NORMAL_TENTH
    return LognormalState(curve.median, max(beta, OF_STATICS))


def _rocking(found: Assessment, topples: LognormalState) -> LognormalState:
    """Curve of the level from which motions lift the object; what topples rocked before."""
    lifts = found.outcomes.lifts_from()
    ln_lifts = np.log(lifts[np.isfinite(lifts)])
    if not ln_lifts.size:
        return topples
    of_motions = float(ln_lifts.std())
    # in PGA all motions lift it at one level but for rounding
    if found.measure == PGA and of_motions < ROUNDING:
        of_motions = 0.0
    median = min(float(np.exp(np.median(ln_lifts))), topples.median)
    return LognormalState(median, math.hypot(of_motions, OF_STATICS))
