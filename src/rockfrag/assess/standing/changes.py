"""What may help: the object with a wider foot, a lower centre of gravity, ballast, or joints that are closed.

In: an object as it stands. Out: the changed objects. Docs: ``docs/assess.md``, "What helps".
"""

from collections.abc import Sequence
from dataclasses import replace

from rockfrag.assess.texts import Text
from rockfrag.system.blocks import Block, Body, Stack, stacked
from rockfrag.words.findings import Finding, finding, percent, three

WIDER = 1.25  # Width of a foot plate over that of the base
# Thickness of a foot plate [m], square and of steel [kg/m³]
PLATE, STEEL = 0.02, 7850.0
LOWER = 0.8  # Factor of a lower centre of gravity

BALLAST, BALLAST_AT = 0.25, 0.05  # Its mass and its height over those of the object

PEDESTAL_HEIGHT = 0.5  # Height of another pedestal over that of the one that is there


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
    return found | _fixed(block, pedestals)


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
    height = min(block.h * LOWER, block.height)
    return replace(block, inertia=block.centroidal_inertia, cg_height=height)
