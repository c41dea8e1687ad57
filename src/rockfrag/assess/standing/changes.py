"""What may help: the object with a wider foot, a lower centre of gravity, ballast, or joints that are closed.

In: an object as it stands. Out: the changed objects. Docs: ``docs/assess.md``, "What helps".
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rockfrag.assess.core import bodies
from rockfrag.assess.core.bodies import BALLAST, LOWER
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.system.blocks import Block, Body, Stack, stacked
from rockfrag.words.findings import Finding, finding, percent, three, two


def row_of(block: Block, depth: float = math.nan) -> Floats:
    """The numbers of a block as :mod:`rockfrag.assess.core.bodies` has them.

    Parameters
    ----------
    block : in the plane in which it rocks
    depth : of its base across that plane [m]

    Returns
    -------
    Its sizes, mass, inertia and centre of gravity, shape (7,) [m, kg]; NaN for what is not given.
    """
    sizes = [block.width, block.height, block.mass, block.inertia, block.cg_height]
    numbers = [*sizes, block.cg_offset, depth]
    known = [math.nan if number is None else number for number in numbers]
    return np.array(known, dtype=np.float64)


def changed_block(
    block: Block, change: Callable[..., None], *numbers: float | Floats
) -> Block:
    """A block as a function of :mod:`rockfrag.assess.core.bodies` changes it.

    Parameters
    ----------
    block : the block
    change : the function
    *numbers : what it is given

    Returns
    -------
    The changed block.
    """
    found = np.zeros(bodies.DEPTH + 1)
    change(row_of(block), *numbers, found)
    width, height, mass, inertia, centre, aside, _ = found.tolist()
    return replace(
        block,
        width=width,
        height=height,
        mass=mass,
        inertia=None if math.isnan(inertia) else inertia,
        cg_height=None if math.isnan(centre) else centre,
        cg_offset=aside,
    )


def usual_changes(block: Block, pedestals: Sequence[Block]) -> dict[Finding, Body]:
    """Bodies that result from each change of an object and what it stands on, from below.

    Parameters
    ----------
    block : the object
    pedestals : what it stands on, from below

    Returns
    -------
    The bodies by what is changed.
    """
    lower = {
        finding(Text.LOWER_CENTRE, part=percent(1 - LOWER)): _lowered(block),
        finding(Text.BALLAST, part=percent(BALLAST)): with_ballast(block),
    }
    if not pedestals:
        return {_plate(Text.PLATE_UNDER_IT, block): on_plate(block), **lower}
    lowest, highest = pedestals[0], pedestals[-1]
    where = Text.PLATE_UNDER_LOWEST if len(pedestals) > 1 else Text.PLATE_UNDER_PEDESTAL
    found: dict[Finding, Body] = {
        _plate(where, lowest): stacked((on_plate(lowest), *pedestals[1:], block))
    }
    if bodies.carries_plate(row_of(block), row_of(highest)):
        # beyond the pedestal's edges a plate carries no further out
        found[_plate(Text.PLATE_UNDER_OBJECT, block)] = stacked(
            (*pedestals, on_plate(block))
        )
    found |= {name: stacked((*pedestals, body)) for name, body in lower.items()}
    half = changed_block(lowest, bodies.make_lower)
    lower_one = finding(Text.LOWER_PEDESTAL, height=three(100 * half.height))
    found[lower_one] = stacked((half, *pedestals[1:], block))
    return found | _fixed(block, pedestals)


def on_plate(block: Block) -> Block:
    """The block fixed to a square plate of steel under it, wider than its base."""
    return Stack(changed_block(block, bodies.make_plate), block).rigidly_joined()


def _plate(where: Text, block: Block) -> Finding:
    """The plate under a block in words, with its width and thickness [cm]."""
    plate = changed_block(block, bodies.make_plate)
    wide, thick = two(100 * plate.width), three(100 * plate.height)
    return finding(where, width=wide, thick=thick)


def with_ballast(block: Block) -> Block:
    """The block with ballast near its foot, in the middle of its base."""
    return changed_block(block, bodies.add_ballast, BALLAST)


def _fixed(block: Block, pedestals: Sequence[Block]) -> dict[Finding, Body]:
    """Bodies that result where a joint is closed for good, each by itself and all."""
    blocks = (*pedestals, block)
    if len(pedestals) == 1:
        return {
            finding(Text.FIX_OBJECT): stacked(blocks).rigidly_joined(),
            finding(Text.FIX_PEDESTAL): block,
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
        finding(Text.FIX_ALL): block,
    }


def _lowered(block: Block) -> Block:
    """The block with a lower centre of gravity, mass and inertia as they are."""
    return changed_block(block, bodies.stretch, 1.0, LOWER, 1.0)
