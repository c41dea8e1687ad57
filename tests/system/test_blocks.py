"""Blocks, stacks and columns: as one rigid body, and what is said of those that cannot stand."""

import math

import numpy as np
import pytest

from rockfrag import Block, Column, InputError, Stack
from rockfrag.system.blocks import stacked


def rasters(column: Column, cells: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Places of the cells of uniform upright blocks on each other, shape (n, 2) [m], and their masses [kg]."""
    places, masses = [], []
    middle, bottom = 0.0, 0.0
    for block, offset in zip(column.blocks, (0.0, *column.offsets), strict=True):
        middle += offset
        across = (np.arange(cells) + 0.5) / cells
        x, z = np.meshgrid(
            middle + (across - 0.5) * block.width, bottom + across * block.height
        )
        places.append(np.column_stack([x.ravel(), z.ravel()]))
        masses.append(np.full(cells * cells, block.mass / cells**2))
        bottom += block.height
    return np.concatenate(places), np.concatenate(masses)


@pytest.mark.parametrize("offsets", [(0.05, -0.03), (-0.08, 0.1), None])
def test_a_column_as_one_body_has_the_moments_of_its_parts(offsets):
    blocks = (Block(0.8, 0.4, 200.0), Block(0.6, 0.5, 90.0), Block(0.3, 0.9, 40.0))
    column = Column(blocks, offsets)
    whole, (at, masses) = column.rigidly_joined(), rasters(column)
    centre = masses @ at / masses.sum()
    assert (whole.cg_offset, whole.h) == pytest.approx(tuple(centre))
    assert (whole.width, whole.height) == pytest.approx((0.8, 1.8))
    assert whole.mass == column.mass == pytest.approx(330.0)
    inertia = masses @ np.square(at - centre).sum(axis=1)
    # cells have an inertia of their own, 1/60² of that of the blocks
    assert whole.centroidal_inertia == pytest.approx(inertia, rel=1e-3)


def test_a_column_of_two_as_one_body_is_the_stack_as_one_body():
    lower, upper = Block(0.7, 0.5, 150.0, lean=0.02), Block(0.4, 1.1, 60.0, lean=-0.01)
    found, expected = (
        made.rigidly_joined()
        for made in (Column((lower, upper), (0.06,)), Stack(lower, upper, 0.06))
    )
    for name in ("width", "height", "mass", "centroidal_inertia", "h", "cg_offset"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name)), name


@pytest.mark.parametrize("side", [1, -1])
def test_a_statue_that_could_touch_the_ground_is_refused_with_how_far_it_reaches(side):
    """A base of 1.2 m, 0.1 m off the middle of a pedestal of 0.4 m: 0.5 m beyond it, which is 0.3 m high."""
    with pytest.raises(
        InputError, match=r"reaches 0\.5 m beyond .* as low as 0\."
    ) as says:
        Stack(Block(0.4, 0.3, 500.0), Block(1.2, 0.3, 20.0), side * 0.1)
    low = float(str(says.value).split("as low as ")[1].split()[0])
    # its edge comes down while the pedestal turns to where it balances
    assert 0.0 < low <= 0.3


def test_narrowing_moves_both_edges_in():
    block = Block(0.4, 1.0, 50.0, cg_offset=0.03)
    narrow = block.narrowed(0.02)
    for pivot in (1, -1):
        # from the edge to below the centre of gravity
        wide, less = (
            each.radius(pivot) * math.sin(each.critical_angle(pivot))
            for each in (block, narrow)
        )
        assert wide - less == pytest.approx(0.02)
    column = Column((Block(0.8, 0.2, 90.0), block)).narrowed(0.02)
    assert [each.width for each in column.blocks] == pytest.approx([0.76, 0.36])


def test_edges_are_distances_from_the_centre_of_gravity():
    block = Block.from_edges(0.15, 0.25, height=1.0, mass=50.0)
    for pivot, edge in ((1, 0.25), (-1, 0.15)):
        assert math.tan(block.critical_angle(pivot)) == pytest.approx(edge / 0.5)


def test_blocks_on_each_other_are_a_block_a_stack_or_a_column():
    blocks = [Block(0.8, 0.2, 90.0), Block(0.5, 0.3, 50.0), Block(0.3, 0.9, 40.0)]
    assert stacked(blocks[:1]) == blocks[0]
    assert stacked(blocks[:2]) == Stack(*blocks[:2])
    assert stacked(blocks) == Column(tuple(blocks))


def test_a_centre_of_gravity_may_be_as_high_as_the_top_and_no_higher():
    assert Block(0.4, 1.0, 50.0, inertia=4.0, cg_height=1.0).h == 1.0
    with pytest.raises(InputError, match="is above the top"):
        Block(0.4, 1.0, 50.0, inertia=4.0, cg_height=1.001)


@pytest.mark.parametrize("size", [(2e6, 1.0), (1.0, 2e6)])
def test_a_block_of_a_thousand_kilometres_is_refused_whichever_side_is_so_long(size):
    with pytest.raises(InputError, match=r"no block is larger than 1e\+06 m"):
        Block(*size, 100.0)
