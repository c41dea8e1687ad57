"""How an object stands, which nobody measured: a distribution for each unknown, with its source.

A scan says where the surface is, not which of its points carry; nor is it known where the object faces and what
its impacts take.  A cut block stands on the edges that were measured, so that little is open.  Whoever measures
one of the unknowns puts its value in the place of the distribution.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import pandas as pd
from scipy.stats import norm

from rockfrag.campaign.trials import (
    Trials,
    body_of,
    even_guesses,
    possible_restitution,
    uniform,
)
from rockfrag.errors import InputError
from rockfrag.fragility.model_error import CUT, SCAN
from rockfrag.rocking.options import system_of
from rockfrag.system.blocks import Block
from rockfrag.system.mesh import Shape

SCAN_ACCURACY_MM = 0.5
"""Standard deviation of the height of a scanned point where none is stated [mm], of ours."""

LEAST_ANGLE_DEG = 2.0
"""Critical angle below which an object is not set up to stand free [degrees]: of ours; tan 2° is 0.035 g, which a
floor out of level and a push reach."""


@dataclass(frozen=True)
class Unknown:
    """Something about how an object stands that nobody measured."""

    words: str  # What it is
    source: str  # Where its distribution comes from
    quantile: Callable[[float], float]  # Its quantile function


def lognormal(median: float, spread: float, fraction: float) -> float:
    """Quantile of a lognormal distribution by its median and the standard deviation of the logarithm."""
    return median * math.exp(spread * float(norm.ppf(fraction)))


def unknowns_of(kind: str, scan_accuracy_mm: float | None = None) -> dict[str, Unknown]:
    """Distributions of what nobody measured of a ``cut block``, or of a ``scan`` of this accuracy [mm]."""
    if kind == CUT:
        return {
            "edge_retreat_mm": Unknown(
                "how far the edges carry further in",
                "uniform from 0 to 2 mm, of ours: edges of cut stone are broken by a millimetre or two",
                partial(uniform, 0.0, 2.0),
            ),
            "restitution_ratio": Unknown(
                "the restitution over that of momentum",
                "normal, 1 ± 0.05, of ours, about Housner (1963)",
                lambda fraction: 1 + 0.05 * float(norm.ppf(fraction)),
            ),
        }
    spread = 0.5 if scan_accuracy_mm is None else 0.3
    median = 2 * (scan_accuracy_mm or SCAN_ACCURACY_MM)
    return {
        "direction_deg": Unknown(
            "the direction of shaking", "uniform: any direction", partial(uniform, 0.0, 360.0)
        ),
        "contact_tolerance_mm": Unknown(
            "the height up to which points carry",
            f"lognormal, median {median:g} mm (two standard deviations of a scanned height, which is as much as "
            f"noise lowers the lowest of many points), ± {100 * spread:g} %, of ours",
            partial(lognormal, median, spread),
        ),
        "edge_retreat_mm": Unknown(
            "how far the edges carry further in",
            "uniform from 0 to 10 mm, of ours: natural and worn edges are round",
            partial(uniform, 0.0, 10.0),
        ),
        "restitution_ratio": Unknown(
            "the restitution over that of momentum",
            "uniform from 0.7 to 1, of ours: a body on few points takes more than momentum; 0.6 to 0.98 were "
            "plausible for a granite rock",
            partial(uniform, 0.7, 1.0),
        ),
    }


def ways_to_stand(
    thing: Shape | Block,
    unknowns: Mapping[str, Unknown],
    count: int,
    seed: int,
    known: Mapping[str, float] | None = None,
) -> Trials:
    """Draw ways in which an object may stand, evenly over the distributions (scrambled Sobol points).

    Ways in which it would not have been set up (:data:`LEAST_ANGLE_DEG`) are left out. ``thing`` is a shape, or
    the planar block of a cut one; a power of two fills the distributions most evenly. ``known`` is what was
    measured, by the name of the unknown; restitution conserves momentum if it is in neither.
    """
    rows, systems = [], []
    quantiles = {name: unknown.quantile for name, unknown in unknowns.items()}
    for guess in even_guesses(quantiles, count, seed):
        way = dict(known or {}) | guess
        try:
            block = body_of(thing, way)
        except InputError:
            continue
        angle = math.degrees(block.alpha)
        if angle < LEAST_ANGLE_DEG:
            continue
        momentum = min(block.momentum_restitution(+1), block.momentum_restitution(-1))
        rows.append(way | {"width_m": block.width, "alpha_deg": angle})
        ratio = possible_restitution(block, way.get("restitution_ratio", 1.0) * momentum)
        systems.append(system_of(block, restitution=ratio))
    if not rows:
        raise InputError(
            f"under none of {count} guesses of what was not measured could the object stand at "
            f"{LEAST_ANGLE_DEG:g}° or more; check that it stands as its mesh does, and its unit."
        )
    return Trials(pd.DataFrame(rows), tuple(systems))


def kind_of(thing: Shape | Block) -> str:
    """Kind of a body: scanned, or cut to measured edges."""
    return SCAN if isinstance(thing, Shape) else CUT
