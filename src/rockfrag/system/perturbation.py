"""Bodies that differ a little from a given one."""

from dataclasses import replace

import numpy as np

from rockfrag.errors import InputError
from rockfrag.system.blocks import Block, Column, Stack
from rockfrag.system.system import System

Written = Block | Stack | Column


def perturbed(body: Written | System, size: float, rng: np.random.Generator) -> Written:
    """Return a body whose widths and heights differ by at most ``size``, relative, drawn evenly.

    Raises
    ------
    InputError
        For a system that is not written as blocks.
    """
    if isinstance(body, System):
        raise InputError(
            "bodies: widths and heights of a System are not known apart; write it of blocks."
        )
    if isinstance(body, Block):
        return _perturbed(body, size, rng)
    blocks = tuple(_perturbed(block, size, rng) for block in body.blocks)
    if isinstance(body, Column):
        return replace(body, blocks=blocks)
    return replace(body, pedestal=blocks[0], statue=blocks[1])


def _perturbed(block: Block, size: float, rng: np.random.Generator) -> Block:
    across, up = (1 + size * rng.uniform(-1, 1, 2)).tolist()
    height = None if block.cg_height is None else block.cg_height * up
    return replace(block, width=block.width * across, height=block.height * up, cg_height=height)
