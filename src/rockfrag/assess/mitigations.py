"""What helps: the object changed, as a body, shaken by the same motions, as a factor on the probability."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.assess.objects import Objects, stretched_block
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import LEVEL, Target, earthquake_weights
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.fragility.intervals import half_width
from rockfrag.system.blocks import Block, Body, Stack, stacked
from rockfrag.words.findings import Finding, finding, percent, three

WIDER = 1.25  # Width of a foot plate over that of the base
# Thickness of a foot plate [m], square and of steel [kg/m³]
PLATE, STEEL = 0.02, 7850.0
LOWER = 0.8  # Factor of a lower centre of gravity

BALLAST, BALLAST_AT = 0.25, 0.05  # Its mass and its height over those of the object

PEDESTAL_HEIGHT = 0.5  # Height of another pedestal over that of the one that is there


@dataclass(frozen=True)
class Mitigation:
    """What a change does."""

    change: Finding  # What is changed
    value: float  # The probability, fraction or amplitude with it
    # That over the one without it [-]; 0 where no motion topples the object any more
    factor: float
    # Limits of the factor, of the same motions with and without it; NaN where there are none
    lower: float
    upper: float
    # Whether the object is better off: the risk shrinks, or an amplitude grows
    helps: bool
    # Whether the motions show that it is, beyond what one earthquake decides
    shown: bool


def mitigations_of(objects: Objects) -> dict[Finding, Body]:
    """Bodies that result from each change of the object."""
    block, pedestals = objects.block, objects.pedestals
    lower = {
        finding(Text.LOWER_CENTRE, part=percent(1 - LOWER)): stretched_block(
            block, height=LOWER
        ),
        finding(Text.BALLAST, part=percent(BALLAST)): with_ballast(block),
    }
    if not pedestals:
        return {_plate(Text.PLATE_UNDER_IT, block): on_plate(block), **lower}
    lowest, highest = pedestals[0], pedestals[-1]
    where = Text.PLATE_UNDER_LOWEST if objects.many else Text.PLATE_UNDER_PEDESTAL
    found: dict[Finding, Body] = {
        _plate(where, lowest): stacked((on_plate(lowest), *pedestals[1:], block))
    }
    if WIDER * block.width <= highest.width:
        # beyond the pedestal's edges a plate carries no further out
        found[_plate(Text.PLATE_UNDER_OBJECT, block)] = stacked(
            (*pedestals, on_plate(block))
        )
    found |= {name: stacked((*pedestals, body)) for name, body in lower.items()}
    half = replace(
        lowest,
        height=PEDESTAL_HEIGHT * lowest.height,
        mass=PEDESTAL_HEIGHT * lowest.mass,
    )
    lower_one = finding(Text.LOWER_PEDESTAL, height=three(100 * half.height))
    found[lower_one] = stacked((half, *pedestals[1:], block))
    return found | _fixed(objects)


def on_plate(block: Block) -> Block:
    """The block fixed to a square plate of steel under it, wider than its base."""
    width = WIDER * block.width
    plate = Block(width, PLATE, STEEL * PLATE * width**2)
    return Stack(plate, block).rigidly_joined()


def _plate(where: Text, block: Block) -> Finding:
    wide, thick = three(100 * WIDER * block.width), three(100 * PLATE)
    return finding(where, width=wide, thick=thick)


def with_ballast(block: Block) -> Block:
    """The block with ballast near its foot, in the middle of its base."""
    added = BALLAST * block.mass
    mass = block.mass + added
    at = BALLAST_AT * block.height
    height = (block.mass * block.h + added * at) / mass
    aside = block.mass * block.cg_offset / mass
    own = block.mass * ((block.h - height) ** 2 + (block.cg_offset - aside) ** 2)
    inertia = block.centroidal_inertia + own + added * ((at - height) ** 2 + aside**2)
    return replace(block, mass=mass, cg_height=height, cg_offset=aside, inertia=inertia)


def _fixed(objects: Objects) -> dict[Finding, Body]:
    """Bodies that result where a joint is closed for good, each by itself and all."""
    blocks = (*objects.pedestals, objects.block)
    if not objects.many:
        return {
            finding(Text.FIX_OBJECT): stacked(blocks).rigidly_joined(),
            finding(Text.FIX_PEDESTAL): objects.block,
        }
    found: dict[Finding, Body] = {}
    for k in range(len(blocks) - 1):
        if len(blocks) > k + 2 and blocks[k + 2].width > blocks[k + 1].width:
            continue  # the two as one block would carry it further out
        above, below = len(blocks) - 2 - k, len(blocks) - 1 - k
        what = finding(Text.FIX_OBJECT_TO, number=below)
        if above:
            what = finding(Text.FIX_PEDESTAL_TO, upper=above, lower=below)
        joined = stacked(blocks[k : k + 2]).rigidly_joined()
        found[what] = stacked((*blocks[:k], joined, *blocks[k + 2 :]))
    return found | {
        finding(Text.FIX_TO_EACH_OTHER): stacked(blocks).rigidly_joined(),
        finding(Text.FIX_LOWEST): stacked(blocks[1:]),
        finding(Text.FIX_ALL): objects.block,
    }


def compare(
    target: Target, now: ObjectOutcomes, changed: Mapping[Finding, ObjectOutcomes]
) -> list[Mitigation]:
    """Estimate again with each change of the object."""
    weights = earthquake_weights(now.earthquakes)
    before = target.value(now)
    # without each earthquake
    left_out = np.array([target.value(now, w) for w in weights])
    found = []
    for change, outcomes in changed.items():
        after, factor, limits = target.value(outcomes), math.nan, (math.nan, math.nan)
        if math.isfinite(before) and before > 0 and math.isfinite(after):
            factor = after / before
            limits = _limits(factor, left_out, target, outcomes)
        grows = math.isinf(target.certain)
        helps = after > before if grows else after < before
        shown = limits[0] > 1 if grows else limits[1] < 1
        if factor == 0:
            # no motion is left; more than one earthquake must have had one
            shown = len(weights) > 1 and bool((left_out > 0).all())
        found.append(Mitigation(change, after, factor, *limits, helps, helps and shown))
    return found


def _limits(
    factor: float, left_out: Floats, target: Target, outcomes: ObjectOutcomes
) -> tuple[float, float]:
    """Limits of a factor by a jackknife over earthquakes; NaN where one of them decides alone."""
    weights = earthquake_weights(outcomes.earthquakes)
    after = np.array([target.value(outcomes, w) for w in weights])
    pairs = np.array([after, left_out])
    if len(weights) < 2 or not np.isfinite(pairs).all() or not (pairs > 0).all():
        return math.nan, math.nan
    half = float(half_width(np.log(after / left_out), LEVEL))
    return factor * math.exp(-half), factor * math.exp(half)
