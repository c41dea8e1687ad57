"""What helps: the object changed, as a body, shaken by the same motions, as a factor on the probability."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.arrays import Floats
from rockfrag.assess.objects import Objects, stretched_block
from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import LEVEL, Evidence, Target
from rockfrag.system.blocks import Block, Body, Stack, stacked

WIDER = 1.25  # Width of a foot plate over that of the base
# Thickness of a foot plate [m], square and of steel [kg/m³]
PLATE, STEEL = 0.02, 7850.0
LOWER = 0.8  # Factor of a lower centre of gravity

BALLAST, BALLAST_AT = 0.25, 0.05  # Its mass and its height over those of the object

PEDESTAL_HEIGHT = 0.5  # Height of another pedestal over that of the one that is there


@dataclass(frozen=True)
class Mitigation:
    """What a change does."""

    name: str  # What is changed, in words
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


def mitigations_of(objects: Objects) -> dict[str, Body]:
    """Bodies that result from each change of the object."""
    block, pedestals = objects.block, objects.pedestals
    lower = {
        f"a centre of gravity {100 * (1 - LOWER):.0f} % lower": stretched_block(
            block, height=LOWER
        ),
        f"ballast of {100 * BALLAST:.0f} % of its mass in its foot": with_ballast(
            block
        ),
    }
    if not pedestals:
        return {_plate_words(block, "it"): on_plate(block), **lower}
    lowest, highest = pedestals[0], pedestals[-1]
    where = "the lowest pedestal" if objects.many else "the pedestal"
    found = {
        _plate_words(lowest, where): stacked((on_plate(lowest), *pedestals[1:], block))
    }
    if WIDER * block.width <= highest.width:
        # beyond the pedestal's edges a plate carries no further out
        found[_plate_words(block, "the object")] = stacked(
            (*pedestals, on_plate(block))
        )
    found |= {name: stacked((*pedestals, body)) for name, body in lower.items()}
    half = replace(
        lowest,
        height=PEDESTAL_HEIGHT * lowest.height,
        mass=PEDESTAL_HEIGHT * lowest.mass,
    )
    found[f"another pedestal, {100 * half.height:.3g} cm high and as wide"] = stacked(
        (half, *pedestals[1:], block)
    )
    return found | _fixed(objects)


def on_plate(block: Block) -> Block:
    """The block fixed to a square plate of steel under it, wider than its base."""
    width = WIDER * block.width
    plate = Block(width, PLATE, STEEL * PLATE * width**2)
    return Stack(plate, block).rigidly_joined()


def _plate_words(block: Block, what: str) -> str:
    wide, thick = 100 * WIDER * block.width, 100 * PLATE
    return f"a steel plate of {wide:.3g} cm, {thick:g} cm thick, fixed under {what}"


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


def _fixed(objects: Objects) -> dict[str, Body]:
    """Bodies that result where a joint is closed for good, each by itself and all."""
    blocks = (*objects.pedestals, objects.block)
    if not objects.many:
        return {
            "fixing the object to its pedestal": stacked(blocks).rigidly_joined(),
            "fixing the pedestal to the floor": objects.block,
        }
    found: dict[str, Body] = {}
    for k in range(len(blocks) - 1):
        if len(blocks) > k + 2 and blocks[k + 2].width > blocks[k + 1].width:
            continue  # the two as one block would carry it further out
        above, below = len(blocks) - 2 - k, len(blocks) - 1 - k
        what = f"pedestal {above}" if above else "the object"
        joined = stacked(blocks[k : k + 2]).rigidly_joined()
        found[f"fixing {what} to pedestal {below}"] = stacked(
            (*blocks[:k], joined, *blocks[k + 2 :])
        )
    return found | {
        "fixing the object and its pedestals to each other": stacked(
            blocks
        ).rigidly_joined(),
        "fixing the lowest pedestal to the floor": stacked(blocks[1:]),
        "fixing all pedestals to the floor": objects.block,
    }


def compare(
    target: Target,
    evidence: Evidence,
    now: ObjectOutcomes,
    changed: Mapping[str, ObjectOutcomes],
) -> list[Mitigation]:
    """Estimate again with each change of the object, with the same errors of all that is not known.

    Limits of the factor are over the earthquakes; a change is shown to help if they leave nothing else open.
    """
    before, by_weights = _compared(target, evidence, now)
    found = []
    for name, outcomes in changed.items():
        after, with_it = _compared(target, evidence, outcomes)
        factor, limits = math.nan, (math.nan, math.nan)
        if math.isfinite(before) and before > 0 and math.isfinite(after):
            factor = after / before
            both = np.isfinite(by_weights) & np.isfinite(with_it) & (by_weights > 0)
            ratios = with_it[both] / by_weights[both]
            ends = [(1 - LEVEL) / 2, (1 + LEVEL) / 2]
            if ratios.size:
                low, high = np.quantile(ratios, ends).tolist()
                limits = min(low, factor), max(high, factor)
        helps = after > before if target.is_level else after < before
        shown = limits[0] > 1 if target.is_level else limits[1] < 1
        found.append(Mitigation(name, after, factor, *limits, helps, shown))
    return found


def _compared(
    target: Target, evidence: Evidence, outcomes: ObjectOutcomes
) -> tuple[float, Floats]:
    """What is estimated, and by each set of weights of the earthquakes, shape (sets,)."""
    prediction = evidence.of(outcomes)
    values = target.shown(evidence.drawn(target, prediction))
    sets = values.reshape(len(prediction.draws.weights), -1)
    if target.is_level:
        return float(np.quantile(values, 0.5, method="lower")), np.median(sets, axis=1)
    return float(values.mean()), sets.mean(axis=1)
